"""Motion of any skeleton put onto the joints of a rig: names, rest poses, travel of the root."""

from tempose.rigging.motions.match import MotionMatch, match_motion, matched_motion
from tempose.rigging.motions.pairing import JointPairs, pair_joints, read_mapping

__all__ = ["JointPairs", "MotionMatch", "match_motion", "matched_motion", "pair_joints", "read_mapping"]
