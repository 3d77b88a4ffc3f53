"""Feet: where they stand, and how they are held there."""
