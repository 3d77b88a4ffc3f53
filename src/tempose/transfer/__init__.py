"""Motion of a skeleton or a mesh moves a still mesh, without a skeleton or painted weights in it.

After de Aguiar, Zayer, Theobalt, Seidel, Magnor, "A Simple Framework for Natural Animation of Digitized
Models", SIBGRAPI 2007. The files, in the order in which data flows: bones, pairs, marks; reference,
alignment, signs; links, fields, glue; placement, measures.
"""

from tempose.transfer.matching import Found, Matched, find_pairs, match
from tempose.transfer.motion_transfer import Anchor, MotionTransfer
from tempose.transfer.pairs import Pairs
from tempose.transfer.pairs_io import load_pairs, save_pairs
from tempose.transfer.pairs_picture import bone_segments, mark_colors
from tempose.transfer.result import TransferResult
from tempose.transfer.run import transfer_motion
from tempose.transfer.signs import consistent_signs
from tempose.transfer.skeleton_picture import skeleton_mesh
from tempose.transfer.skin_pairs import pairs_from_skin
from tempose.transfer.template import template_clip

__all__ = [
    "Anchor",
    "Found",
    "Matched",
    "MotionTransfer",
    "Pairs",
    "TransferResult",
    "bone_segments",
    "consistent_signs",
    "find_pairs",
    "load_pairs",
    "mark_colors",
    "match",
    "pairs_from_skin",
    "save_pairs",
    "skeleton_mesh",
    "template_clip",
    "transfer_motion",
]
