"""Bones in space: which there are, where they are, how far they reach."""
