"""Records: groups of arrays and numbers that compiled code hands on as one pointer.

A named tuple is handed on field by field, which for a hundred arrays takes longer to compile, and
to call, than many a kernel takes to run.
"""

import sys
from typing import Any, TypeVar, cast, dataclass_transform

from numba.core import types
from numba.experimental import structref

T = TypeVar("T")


@dataclass_transform()
def record(cls: type[T]) -> type[T]:
    """Make a class of annotated fields a record.

    It is made in compiled code by its name and the fields in their order, and its fields are read
    there; Python only carries it.  A field must not be called `new`.
    """
    module = sys.modules[cls.__module__]
    fields = list(cls.__annotations__)
    name = f"{cls.__name__}Type"
    kind = type(name, (_Record,), {"__module__": cls.__module__})
    setattr(module, name, kind)  # where the cache of compiled code looks it up
    structref.register(kind)
    names = {"__module__": cls.__module__, "__doc__": cls.__doc__, "__slots__": ()}
    proxy = type(cls.__name__, (structref.StructRefProxy,), names)
    structref.define_proxy(proxy, kind, fields)
    return cast(type[T], proxy)


class _Record(types.StructRef):
    def __init__(self, fields: Any) -> None:
        super().__init__(fields)
        # Without the types of all fields, which would be part of the name of every function.
        self.name = f"{type(self).__module__}.{type(self).__name__}"

    def preprocess_fields(self, fields: Any) -> Any:
        return tuple((name, types.unliteral(kind)) for name, kind in fields)
