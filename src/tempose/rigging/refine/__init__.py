"""A rig made better by the clip it follows: joints moved, weights solved again."""

from tempose.rigging.refine.joints import JointRefinement, refine_joints

__all__ = ["JointRefinement", "refine_joints"]
