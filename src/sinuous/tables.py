"""From a table in a file to a checked value in SI.

A table's shape is declared by a dataclass (or a pydantic model). `build` resolves the
units in its keys, checks it, and reports the first thing that is wrong in the words of
the file: the key and the value as the user wrote them.
"""

import json
import math
import types
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Annotated, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from pydantic import AllowInfNan, BaseModel, TypeAdapter, ValidationError

from sinuous.errors import InputError
from sinuous.explain import Place, Source, explain, show, unknown_key
from sinuous.quantities import Quantity

T = TypeVar("T")

_LARGEST = 1e300  # an integer beyond it would silently turn into infinity


def build(model: type[T], data: Mapping[str, object], *, file: str) -> T:
    """Build a value of a model from a table, units resolved and everything checked.

    Unknown keys, missing keys and wrong types are refused, and so are nan everywhere
    and infinity unless the field is annotated with `pydantic.AllowInfNan(True)`.
    Checks that concern several fields raise `FieldError` in the model's `__post_init__`.

    Arguments:
        model: a dataclass or pydantic model; dimensioned fields are annotated with the
            types of `sinuous.quantities` and hold SI
        data: the table, as TOML yields it
        file: where it comes from, for messages

    Raises:
        InputError: for the first thing that is wrong
    """
    source = Source(file=file, data=data)
    resolved = _Resolver(source=source).table(model, data, ())
    try:
        # Strict JSON is what TOML means: no text for numbers, no 1 for true, lists for tuples.
        return TypeAdapter(model).validate_json(json.dumps(resolved, default=str), strict=True)
    except ValidationError as error:
        problem = explain(error, resolved, source)
    raise problem


@dataclass(frozen=True, kw_only=True)
class _Resolver:
    """Walks a table beside its model: keys become fields, numbers become SI."""

    source: Source

    def table(self, model: type, data: Mapping[str, object], at: Place) -> dict[str, object]:
        hints = _field_types(model)
        keys = {name: _keys(name, hint) for name, hint in hints.items()}
        field_of = {key: name for name, choices in keys.items() for key in choices}
        self.source.choices.update({(*at, name): choices for name, choices in keys.items()})
        for key in data:
            if key not in field_of:
                raise unknown_key(self.source, at, key, keys)
        resolved: dict[str, object] = {}
        for key, value in data.items():
            name = field_of[key]
            place = (*at, name)
            if name in resolved:
                raise self._twice(place, key)
            quantity = _quantity(hints[name])
            if quantity is not None:
                self.source.keys[place] = key
                self.source.units[place] = quantity.units[key.removeprefix(f"{name}_")]
            resolved[name] = self._value(hints[name], value, place)
        return resolved

    def _value(self, hint: object, value: object, at: Place) -> object:
        if isinstance(value, Mapping):
            return self._mapping(hint, cast(Mapping[str, object], value), at)
        if isinstance(value, list):
            items = cast(list[object], value)
            return [
                self._value(_item_type(hint, index), item, (*at, index))
                for index, item in enumerate(items)
            ]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return self._number(hint, value, at)
        return value

    def _mapping(self, hint: object, value: Mapping[str, object], at: Place) -> object:
        for choice in _choices(hint):
            if _is_table(choice):
                return self.table(cast(type, choice), value, at)
            if get_origin(choice) is dict:
                item = get_args(choice)[1]
                return {key: self._value(item, each, (*at, key)) for key, each in value.items()}
        return {key: self._value(object, each, (*at, key)) for key, each in value.items()}

    def _number(self, hint: object, value: int | float, at: Place) -> int | float:
        limitless = value in (math.inf, -math.inf) and _allows_infinity(hint)
        if not (limitless or abs(value) < _LARGEST):  # so put because nan compares false
            raise self.source.error(
                at,
                expected="a finite number",
                found=show(value),
                remedy="Correct this value.",
            )
        unit = self.source.unit(at)
        return value if unit is None else unit.to_si(value)

    def _twice(self, place: Place, key: str) -> InputError:
        first = self.source.keys[place]
        return self.source.error(
            (*place[:-1], key),
            expected=f"the {place[-1]} once",
            found=f"both {first} and {key}",
            remedy="Keep one of them.",
        )


def _field_types(model: type) -> dict[str, object]:
    """Return the annotations of a model's fields, metadata included."""
    hints = get_type_hints(model, include_extras=True)
    if issubclass(model, BaseModel):
        return {name: hints[name] for name in model.model_fields}
    return {item.name: hints[item.name] for item in fields(model) if item.init}


def _is_table(hint: object) -> bool:
    return isinstance(hint, type) and (is_dataclass(hint) or issubclass(hint, BaseModel))


def _choices(hint: object) -> list[object]:
    """Return the alternatives of a type without their metadata."""
    if get_origin(hint) is Annotated:
        return _choices(get_args(hint)[0])
    if get_origin(hint) in (Union, types.UnionType):
        return [choice for part in get_args(hint) for choice in _choices(part)]
    return [hint]


def _item_type(hint: object, index: int) -> object:
    """Return the type of an item of a list or tuple, or the hint itself if it has none."""
    for choice in _choices(hint):
        items = get_args(choice)
        if get_origin(choice) is list:
            return items[0]
        if get_origin(choice) is tuple:
            if len(items) == 2 and items[1] is Ellipsis:
                return items[0]
            return items[min(index, len(items) - 1)]
    return hint


def _metadata(hint: object) -> list[object]:
    """Return all metadata in a type, that inside of lists and alternatives included."""
    if get_origin(hint) is Annotated:
        inner, *own = get_args(hint)
        return [*own, *_metadata(inner)]
    return [found for part in get_args(hint) for found in _metadata(part)]


def _quantity(hint: object) -> Quantity | None:
    """Return what a field measures.

    Raises:
        TypeError: if it measures two things at once, for its key has one unit
    """
    found = {item for item in _metadata(hint) if isinstance(item, Quantity)}
    if len(found) > 1:
        raise TypeError(f"a field measures one quantity, not {sorted(map(str, found))}")
    return found.pop() if found else None


def _keys(name: str, hint: object) -> list[str]:
    quantity = _quantity(hint)
    return [name] if quantity is None else quantity.keys(name)


def _allows_infinity(hint: object) -> bool:
    return any(isinstance(item, AllowInfNan) and item.allow_inf_nan for item in _metadata(hint))
