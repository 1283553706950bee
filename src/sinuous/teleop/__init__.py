"""Velocity one way and force back: ports, links, the two ends, and what keeps them passive."""
