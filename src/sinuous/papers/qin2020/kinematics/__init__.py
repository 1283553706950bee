"""2.2: forward and inverse kinematics."""
