"""Packages that a driver needs, and that come with an extra."""

import warnings
from importlib import import_module
from typing import Any

from sinuous.errors import InputError


def require(module: str, *, package: str, extra: str) -> Any:
    """A module of a package that may not be installed.

    Arguments:
        module: to import
        package: that has it
        extra: of sinuous that installs it

    Raises:
        InputError: naming the extra, if it cannot be imported
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # pysdl2 warns that it found the library it came with
            return import_module(module)
    except ImportError as error:
        raise InputError(
            file=f"leader {extra}",
            expected=f"the package {package}",
            found="that it is not installed",
            remedy=f"Install what this device needs: pip install sinuous[{extra}]",
        ) from error
