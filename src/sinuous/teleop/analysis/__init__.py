"""What a channel of waves does to energy, velocity and force, in theory and in its own ports."""
