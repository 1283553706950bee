"""III-D: way-points in passages."""
