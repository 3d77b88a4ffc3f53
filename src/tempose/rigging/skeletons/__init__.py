"""Skeletons for a mesh: a human's found inside it, or one that is given."""

from tempose.rigging.skeletons.bind import bind, joint_bones, normalised_weights
from tempose.rigging.skeletons.bound import Bound
from tempose.rigging.skeletons.files import read_skeleton
from tempose.rigging.skeletons.given import given_skin
from tempose.rigging.skeletons.human import human_skin

__all__ = [
    "Bound",
    "bind",
    "given_skin",
    "human_skin",
    "joint_bones",
    "normalised_weights",
    "read_skeleton",
]
