"""III-C: convergence under disturbances."""
