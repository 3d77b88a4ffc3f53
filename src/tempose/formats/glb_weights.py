"""Skin weights as one dense matrix over the joints of the skeleton."""

from __future__ import annotations

import numpy as np

from tempose.formats.glb_binding import holding_joint
from tempose.formats.glb_joints import Joints
from tempose.formats.glb_scene import Scene
from tempose.typing import FloatArray

_MOST_WEIGHTS = 2**29


def dense_weights(scene: Scene, joints: Joints) -> FloatArray:
    """Weights of every vertex the scene draws.

    Parameters
    ----------
    scene : Scene
        A file with a mesh.
    joints : Joints
        J joints.

    Returns
    -------
    (n, J) ndarray
        Rows sum to 1, or to 0 for what hangs on no joint.

    Raises
    ------
    FormatError
        If they would not fit into memory.
    """
    geometry = scene.geometry
    assert geometry is not None
    J = len(joints.nodes)
    if geometry.n * J > _MOST_WEIGHTS:
        raise scene.doc.top.error(f"{geometry.n} vertices by {J} joints are more weights than fit into 4 GB")
    weights = np.zeros((geometry.n, J))
    place = {node: j for j, node in enumerate(joints.nodes)}
    for part in geometry.parts:
        rows = np.arange(part.start, part.start + len(part.base))
        if part.skin is not None:
            columns = np.array([place[node] for node in scene.bindings[part.skin].joints])
            np.add.at(weights, (rows[:, None], columns[part.joints]), part.weights)
        elif (held := holding_joint(scene.nodes, part.node, scene.bindings)) is not None:
            weights[rows, place[held[0]]] = 1.0
    return weights
