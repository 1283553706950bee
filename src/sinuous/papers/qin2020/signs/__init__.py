"""3.2: signs and units of the virtual force."""
