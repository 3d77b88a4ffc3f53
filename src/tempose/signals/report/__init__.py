"""What a fit tells of itself: its errors, and those of simple interpolation."""
