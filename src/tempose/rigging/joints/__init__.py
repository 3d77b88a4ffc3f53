"""Skeletons from bones: which bone hangs on which, and where they meet."""

from tempose.rigging.joints.auto import auto_skin
from tempose.rigging.joints.pairs import PairJoints, pair_joints
from tempose.rigging.joints.settling import Settled, settle
from tempose.rigging.joints.skeleton import skeleton_from_bones

__all__ = ["PairJoints", "Settled", "auto_skin", "pair_joints", "settle", "skeleton_from_bones"]
