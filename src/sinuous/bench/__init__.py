"""`sinuous bench`: what the controller costs, measured beside others in the same run.

One file per WHAT, each with a `Benchmark`; `result.py` is what all of them return and
`printer.py` shows it. Nothing but the command line imports this package.
"""
