"""Fitting: a clip becomes signals, within a tolerance."""
