"""The command line: what `sinuous VERB` does."""

from sinuous.cli.main import main

__all__ = ["main"]
