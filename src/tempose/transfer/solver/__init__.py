"""Rotations of a few marks in, a whole mesh out: fields, eq. (2), and glue, eqs. (3)-(4)."""
