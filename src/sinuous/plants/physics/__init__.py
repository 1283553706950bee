"""Robots as physics: MuJoCo models built from the same robot files; needs the extra `physics`."""
