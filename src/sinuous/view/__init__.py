"""How people meet a run: figures and tables."""

from sinuous.view.comparison import save_comparison
from sinuous.view.figures import save_figures
from sinuous.view.summary_table import print_summary

__all__ = ["print_summary", "save_comparison", "save_figures"]
