"""Longer horizons and dead ends."""
