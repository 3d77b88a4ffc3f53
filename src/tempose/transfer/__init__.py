"""Motion of a skeleton or a mesh moves a still mesh, without a skeleton or painted weights in it.

After de Aguiar, Zayer, Theobalt, Seidel, Magnor, "A Simple Framework for Natural Animation of Digitized
Models", SIBGRAPI 2007. The rooms, in the order in which data flows: ``pairing``, which places move which;
``bodies``, bones in space; ``turns``, from motion to the rotations of marks; ``solver``, from there to the
mesh; ``feet``, where it stands; ``adjustments`` on top; ``quality``, how good it is. ``run`` leads through
them. Tools for placing pairs by hand stand in ``correspondence``.
"""

from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.adjustments.files import load_adjustments, save_adjustments
from tempose.transfer.adjustments.on_result import adjust
from tempose.transfer.bodies.template import template_clip
from tempose.transfer.correspondence import (
    Alignment,
    Candidate,
    Finding,
    Mirrored,
    PartnerFinder,
    Preview,
    Ring,
    Sections,
    Symmetry,
    add_pairs,
    align_meshes,
    align_points,
    check_coverage,
    complete_ring,
    find_symmetry,
    joint_pairs,
    mirror_pairs,
    preview_pairs,
    select_pairs,
    suggest_partner,
)
from tempose.transfer.pairing.found_pairs import Found, find_pairs
from tempose.transfer.pairing.matching import Matched, match
from tempose.transfer.pairing.pairs import Pairs
from tempose.transfer.pairing.pairs_io import load_pairs, save_pairs
from tempose.transfer.pairing.pairs_picture import bone_segments, mark_colors
from tempose.transfer.pairing.skin_pairs import pairs_from_skin
from tempose.transfer.result import TransferResult
from tempose.transfer.run import transfer_motion
from tempose.transfer.solver.motion_transfer import Anchor, MotionTransfer
from tempose.transfer.turns.signs import consistent_signs
from tempose.transfer.turns.skeleton_picture import skeleton_mesh

__all__ = [
    "Adjustment",
    "Alignment",
    "Anchor",
    "Candidate",
    "Finding",
    "Found",
    "Matched",
    "Mirrored",
    "MotionTransfer",
    "Pairs",
    "PartnerFinder",
    "Preview",
    "Ring",
    "Sections",
    "Symmetry",
    "TransferResult",
    "add_pairs",
    "adjust",
    "align_meshes",
    "align_points",
    "bone_segments",
    "check_coverage",
    "complete_ring",
    "consistent_signs",
    "find_pairs",
    "find_symmetry",
    "joint_pairs",
    "load_adjustments",
    "load_pairs",
    "mark_colors",
    "match",
    "mirror_pairs",
    "pairs_from_skin",
    "preview_pairs",
    "save_adjustments",
    "save_pairs",
    "select_pairs",
    "skeleton_mesh",
    "suggest_partner",
    "template_clip",
    "transfer_motion",
]
