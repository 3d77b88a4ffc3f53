"""Bones drawn for a skeleton move as its joints do."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

from tempose.clips import SkeletonClip
from tempose.kinematics import forward_kinematics
from tempose.rotations import from_rotation_vector, to_matrix
from tempose.samples.skeletons import human_skeleton
from tempose.transfer.turns.skeleton_picture import skeleton_mesh


def test_each_bone_is_rigid_on_its_joint(rng: np.random.Generator) -> None:
    skeleton = human_skeleton()
    J = skeleton.n_joints
    clip = SkeletonClip(
        skeleton, from_rotation_vector(rng.normal(size=(4, J, 3))), rng.normal(size=(4, 3)), 25.0
    )
    drawn = skeleton_mesh(clip)
    turns, places = forward_kinematics(skeleton, clip.rotations, clip.root_position)
    assert (drawn.n_frames, drawn.fps, set(drawn.mesh.groups)) == (4, 25.0, set(skeleton.names))
    for j, name in enumerate(skeleton.names):
        mine = np.unique(drawn.faces[drawn.mesh.groups[name]])
        local = np.einsum(
            "tij,tni->tnj", to_matrix(turns[:, j]), drawn.vertices[:, mine] - places[:, None, j]
        )
        assert_allclose(local, np.broadcast_to(local[:1], local.shape), atol=1e-5)
        assert np.abs(local[0]).max() < 1.0, "a bone stands at its joint"
