"""Rotations as unit quaternions ``wxyz``, batched over leading axes."""

from tempose.rotations.alignment import polar_rotation, procrustes_rotation, shortest_rotation
from tempose.rotations.average import mean_rotation
from tempose.rotations.euler import (
    from_euler_degrees,
    from_rotation_vector,
    to_euler_degrees,
    to_rotation_vector,
)
from tempose.rotations.quaternions import (
    IDENTITY,
    angle_between,
    conjugate,
    continuous,
    from_matrix,
    multiply,
    normalise,
    rotate,
    slerp,
    to_matrix,
)
from tempose.rotations.swing_twist import swing_twist

__all__ = [
    "IDENTITY",
    "angle_between",
    "conjugate",
    "continuous",
    "from_euler_degrees",
    "from_matrix",
    "from_rotation_vector",
    "mean_rotation",
    "multiply",
    "normalise",
    "polar_rotation",
    "procrustes_rotation",
    "rotate",
    "shortest_rotation",
    "slerp",
    "swing_twist",
    "to_euler_degrees",
    "to_matrix",
    "to_rotation_vector",
]
