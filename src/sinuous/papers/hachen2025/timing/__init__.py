"""III-F: the time of a step."""
