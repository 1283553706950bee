"""Exit codes."""

GOOD = 0
NEGATIVE = 1  # it worked, and the answer is no
BAD_INPUT = 2
INTERRUPTED = 130  # 128 + SIGINT, as shells count
