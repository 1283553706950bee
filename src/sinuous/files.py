"""Reading and writing files: the only place where millimetres and degrees exist.

What it offers to the rest of the program: `read_toml` and `build` turn a file into a
checked value in SI, `override` changes fields from the command line, `read_path_csv`
reads a path, `write_text` writes whole files or nothing.
"""

import errno
import os
import re
import tomllib
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from sinuous.arrays import Array
from sinuous.csv_table import read_columns
from sinuous.errors import InputError
from sinuous.explain import FieldError, Place, did_you_mean, one_of
from sinuous.overrides import override
from sinuous.quantities import (
    Acceleration,
    Angle,
    Curvature,
    Decay,
    Density,
    Duration,
    Force,
    Frequency,
    Impedance,
    Inertia,
    Length,
    Mass,
    Modulus,
    Quantity,
    RotaryDamping,
    Speed,
    Stiffness,
    Turning,
    length_unit,
)
from sinuous.tables import build

__all__ = [
    "Acceleration",
    "Angle",
    "Curvature",
    "Decay",
    "Density",
    "Duration",
    "FieldError",
    "Force",
    "Frequency",
    "Impedance",
    "Inertia",
    "Length",
    "Mass",
    "Modulus",
    "Place",
    "Quantity",
    "RotaryDamping",
    "Speed",
    "Stiffness",
    "Turning",
    "build",
    "did_you_mean",
    "file_error",
    "length_unit",
    "one_of",
    "override",
    "read_path_csv",
    "read_text",
    "read_toml",
    "write_text",
]

_PATH_COLUMNS = {
    "t": Quantity.DURATION,
    "x": Quantity.LENGTH,
    "y": Quantity.LENGTH,
    "z": Quantity.LENGTH,
}
_ADVICE = {
    errno.ENOSPC: "Free some space or choose another folder.",
    errno.EDQUOT: "Free some space or choose another folder.",
    errno.EFBIG: "Free some space or choose another folder.",
    errno.EACCES: "Check its permissions or choose another folder.",
    errno.EPERM: "Check its permissions or choose another folder.",
    errno.EROFS: "Choose a folder that can be written.",
}


def file_error(path: str | Path, error: OSError, *, expected: str) -> InputError:
    """Return what the operating system said about a file as an error with advice.

    Arguments:
        path: the file that the user named
        error: what happened
        expected: what would have been good, such as "a readable file"
    """
    found = (error.strerror or type(error).__name__).lower()
    if error.errno in (errno.ENOTDIR, errno.EEXIST):
        found = "a file where a folder should be"
    return InputError(
        file=str(path),
        expected=expected,
        found=found,
        remedy=_ADVICE.get(error.errno or 0, "Check the path."),
    )


def read_text(path: str | Path) -> str:
    """Return the text of a UTF-8 file, with or without a byte order mark.

    Raises:
        InputError: if it is missing, a folder, unreadable or not UTF-8
    """
    path = Path(path)
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise _missing_file(path) from None
    except IsADirectoryError:
        raise _not_a_file(path, "a folder") from None
    except UnicodeDecodeError as error:
        raise InputError(
            file=str(path),
            expected="text in UTF-8",
            found=f"byte 0x{error.object[error.start]:02x} at offset {error.start}",
            remedy="Is it the right file? If so, save it as UTF-8.",
        ) from None
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        cause = error if isinstance(error, OSError) else OSError(errno.EINVAL, str(error))
        raise file_error(path, cause, expected="a readable file") from None


def _missing_file(path: Path) -> InputError:
    folder = path.parent
    while not folder.is_dir():
        folder = folder.parent
    if folder == path.parent:
        names = [entry.name for entry in folder.iterdir()]
        close = [str(folder / name) for name in get_close_matches(path.name, names, n=3)]
        remedy = f"Did you mean {one_of(close)}?" if close else "Check the path."
    else:
        remedy = f"The folder {path.parent} does not exist; {folder} does."
    return InputError(file=str(path), expected="a file", found="nothing there", remedy=remedy)


def read_toml(path: str | Path) -> dict[str, object]:
    """Return the top table of a TOML file.

    Raises:
        InputError: if the file cannot be read, or is not TOML (with line and column)
    """
    text = read_text(path)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        found = re.sub(r"\s*\((at .*)\)$", r" \1", str(error)) or "it nested too deeply"
        raise InputError(
            file=str(path),
            expected="valid TOML",
            found=found[0].lower() + found[1:],
            remedy="Correct that line.",
        ) from None


def read_path_csv(path: str | Path) -> tuple[Array, Array]:
    """Return the times [s] (K,) and points [m] (K, 3) of a path.

    The header names the columns t, x, y and z with their units, such as
    `t_s,x_mm,y_mm,z_mm`, in any order; other columns are passed over.

    Raises:
        InputError: naming row and column, if something is missing, not a finite number,
            or the times do not increase
    """
    found = read_columns(
        read_text(path), file=str(path), columns=_PATH_COLUMNS, example="t_s,x_mm,y_mm,z_mm"
    )
    return found["t"], np.stack([found[axis] for axis in ("x", "y", "z")], axis=1)


def write_text(path: str | Path, text: str) -> None:
    """Write a whole UTF-8 file or nothing; missing folders are made.

    The text goes to a file beside the target first, so that neither a full disk nor a
    killed process leaves half a file or destroys the one that was there.

    Raises:
        InputError: if it cannot be written
    """
    target = Path(os.path.realpath(path))  # a link keeps pointing at what it pointed at
    part = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        if target.exists() and not target.is_file():
            raise _not_a_file(path, "a folder" if target.is_dir() else "a device")
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            with part.open("w", encoding="utf-8", newline="\n") as stream:
                stream.write(text)
                stream.flush()
                os.fsync(stream.fileno())
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)
    except OSError as error:
        raise file_error(path, error, expected="a file that can be written") from None


def _not_a_file(path: str | Path, found: str) -> InputError:
    return InputError(file=str(path), expected="a file", found=found, remedy="Name a file.")
