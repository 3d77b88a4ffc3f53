"""The motion of a skeleton that brings its skin nearest to the frames of a clip."""

from tempose.rigging.pose_fit.fit import PoseFit, fit_poses

__all__ = ["PoseFit", "fit_poses"]
