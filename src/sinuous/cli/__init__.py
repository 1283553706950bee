"""The command line: `sinuous run`, `sinuous check`, `sinuous compare`."""

from sinuous.cli.main import main

__all__ = ["main"]
