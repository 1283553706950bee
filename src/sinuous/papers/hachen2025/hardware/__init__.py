"""IV: like the hardware."""
