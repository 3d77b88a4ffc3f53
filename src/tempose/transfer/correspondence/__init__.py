"""Tools for placing pairs, after section 4.2 of the paper: what a person with two meshes before him needs.

The files, in the order of work: similarity, closest, front, rough (alignment on load); warp, ways, suggest
(partners); section, limb_axis, limb, rays, ring (the cross-section rule); side_names, topology, symmetry,
mirror; reach, source_parts, ring_check, agreement, coverage (checks); edit, preview.
"""

from tempose.transfer.correspondence.coverage import Finding, check_coverage
from tempose.transfer.correspondence.edit import add_pairs, joint_pairs, select_pairs
from tempose.transfer.correspondence.limb import Limb, find_limb
from tempose.transfer.correspondence.mirror import Mirrored, mirror_pairs
from tempose.transfer.correspondence.preview import Preview, preview_pairs
from tempose.transfer.correspondence.ring import Ring, complete_ring
from tempose.transfer.correspondence.rough import align_meshes
from tempose.transfer.correspondence.section import Loop, Sections
from tempose.transfer.correspondence.similarity import Alignment, align_points, turned
from tempose.transfer.correspondence.suggest import Candidate, PartnerFinder, suggest_partner
from tempose.transfer.correspondence.symmetry import Symmetry, find_symmetry

__all__ = [
    "Alignment",
    "Candidate",
    "Finding",
    "Limb",
    "Loop",
    "Mirrored",
    "PartnerFinder",
    "Preview",
    "Ring",
    "Sections",
    "Symmetry",
    "add_pairs",
    "align_meshes",
    "align_points",
    "check_coverage",
    "complete_ring",
    "find_limb",
    "find_symmetry",
    "joint_pairs",
    "mirror_pairs",
    "preview_pairs",
    "select_pairs",
    "suggest_partner",
    "turned",
]
