"""The one error that bad input raises: what is wrong, where, and what to do."""

from dataclasses import dataclass


@dataclass(kw_only=True, eq=False)
class InputError(Exception):
    """Input that cannot be used.

    Arguments:
        file: the file (or command-line argument) that holds it
        field: the field in that file, dotted; empty if the file as a whole is meant
        expected: what would have been good
        found: what was there
        remedy: what the user can do about it, one sentence
    """

    file: str
    field: str = ""
    expected: str
    found: str
    remedy: str

    def __str__(self) -> str:
        where = f"{self.file}: {self.field}" if self.field else self.file
        return f"{where}: expected {self.expected}, found {self.found}. {self.remedy}"
