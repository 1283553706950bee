"""III-E: targets outside the zone."""
