"""4: the two sets of the experiment, for C1 and C2."""
