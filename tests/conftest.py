"""What all tests share."""

from hypothesis import settings

# A fixed derivation makes CI repeat itself; no deadline, because a machine may be slow.
settings.register_profile("sinuous", deadline=None, derandomize=True)
settings.load_profile("sinuous")
