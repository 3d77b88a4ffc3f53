"""Clips from nothing: procedural characters and motions with known truth."""
