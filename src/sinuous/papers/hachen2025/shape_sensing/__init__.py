"""V: the whole body, sensed."""
