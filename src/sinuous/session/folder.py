"""The folder of a run: what is in it, and what may be overwritten."""

import json
from collections.abc import Generator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from sinuous.errors import InputError
from sinuous.files import file_error, write_text
from sinuous.recording import Header, Recorder, read

RECORDING = "run.mcap"
SUMMARY = "summary.json"
FIGURES = "figures"


@dataclass(frozen=True, kw_only=True)
class RunFolder:
    """A folder that holds one run.

    Arguments:
        path: of the folder
        is_new: whether it did not exist before
    """

    path: Path
    is_new: bool

    @classmethod
    def prepare(cls, path: str | Path) -> Self:
        """Take a folder for a run: a new or empty one, or that of an earlier run.

        Raises:
            InputError: if it is a file, holds something else, or cannot be written
        """
        folder = Path(path)
        if not str(path).strip():
            raise _unfit(path, "an empty name", "Name a folder, like --out out/run.")
        try:
            if folder.exists() and not folder.is_dir():
                raise _unfit(path, "a file", "Name a folder, or remove the file.")
            is_new = not folder.exists()
            entries = [] if is_new else [entry.name for entry in folder.iterdir()]
            if entries and RECORDING not in entries:
                raise _unfit(
                    path,
                    f"other things in it, such as {min(entries)}",
                    "Name another folder; nothing in this one was touched.",
                )
            folder.mkdir(parents=True, exist_ok=True)
            made = cls(path=folder, is_new=is_new)
            made.clear()
        except (OSError, ValueError) as error:  # ValueError: a null byte in the name
            cause = error if isinstance(error, OSError) else OSError(0, str(error))
            raise file_error(path, cause, expected="a folder that can be written") from error
        return made

    @property
    def figures(self) -> Path:
        """The folder for figures."""
        return self.path / FIGURES

    def clear(self) -> None:
        """Remove what an earlier run left, so that old and new are never mixed."""
        for name in (RECORDING, SUMMARY):
            (self.path / name).unlink(missing_ok=True)
        for figure in self.figures.glob("*.png"):
            figure.unlink()
        with suppress(OSError):  # not there, or something else is in it
            self.figures.rmdir()

    @contextmanager
    def record(self, header: Header) -> Generator[Recorder]:
        """Record a run; a recording that holds no step is removed if it fails.

        Raises:
            InputError: if the recording cannot be written
        """
        path = self.path / RECORDING
        try:
            with Recorder(path, header) as recorder:
                yield recorder
        except InputError:
            self._drop_empty(path)
            raise

    def write_summary(self, summary: Mapping[str, object]) -> None:
        """Write the summary, whole or not at all."""
        write_text(self.path / SUMMARY, json.dumps(summary, indent=2) + "\n")

    def _drop_empty(self, path: Path) -> None:
        # Whatever goes wrong here, the first error is the one to tell.
        with suppress(InputError):
            if len(read(path)):
                return
        with suppress(OSError):
            path.unlink(missing_ok=True)
            if self.is_new:
                self.path.rmdir()


def _unfit(path: str | Path, found: str, remedy: str) -> InputError:
    return InputError(
        file=str(path) or "--out",
        expected="a new or empty folder, or that of an earlier run",
        found=found,
        remedy=remedy,
    )
