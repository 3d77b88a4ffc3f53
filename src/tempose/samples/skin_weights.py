"""Skinning weights from the solids: whose surface it is, and how far along its chain of joints."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.samples.field import WIDEN, Field
from tempose.samples.field_queries import mixture
from tempose.samples.parts import Node, ease
from tempose.typing import FloatArray

MOST = 4
"""Joints that may move one vertex."""


def skin_weights(
    field: Field,
    nodes: Sequence[Node],
    skeleton: Skeleton,
    V: FloatArray,
    softness: Mapping[str, float],
    special: Mapping[str, Callable[[FloatArray], FloatArray]],
) -> FloatArray:
    """Weights between the vertices of a character and its joints.

    Parameters
    ----------
    field : Field
        The surface.
    nodes : sequence of Node
        Its nodes, each with the chain of joints that moves it.
    skeleton : Skeleton
        J joints in the rest pose.
    V : (n, 3) float
        Vertices on the surface, metres.
    softness : mapping of str to float
        Half the width of the transition at a joint, metres.
    special : mapping of str to callable
        For nodes that no chain moves: takes (n, 3) points, gives (n, J) weights.

    Returns
    -------
    (n, J) ndarray
        Rows are non-negative, sum to 1 and have at most four entries.
    """
    shares = node_shares(field, V)
    weights = np.zeros((len(V), skeleton.n_joints))
    positions = rest_transforms(skeleton)[1]
    for k, node in enumerate(nodes):
        if node.name in special:
            weights += shares[:, k : k + 1] * special[node.name](V)
            continue
        here = np.flatnonzero(shares[:, k] > 0.0)
        joints = [skeleton.index(name) for name in node.chain]
        widths = np.array([softness[name] for name in node.chain])
        tip = np.zeros(3) if skeleton.tips is None else np.nan_to_num(skeleton.tips[joints[-1]])
        along = chain_weights(positions[joints], widths, V[here], tip)
        weights[here[:, None], joints] += shares[here, k : k + 1] * along
    return _sparse(weights)


def node_shares(field: Field, V: FloatArray) -> FloatArray:
    """Whose surface a point is on.

    Parameters
    ----------
    field : Field
        The surface, N nodes.
    V : (n, 3) float
        Points on it, metres.

    Returns
    -------
    (n, N) ndarray
        Rows are non-negative and sum to 1.
    """
    return mixture(field, V, WIDEN, np.eye(len(field.parent))[field.node])


def chain_weights(
    joints: FloatArray, softness: FloatArray, V: FloatArray, tip: FloatArray | None = None
) -> FloatArray:
    """Weights along one chain: a smooth step across the bisecting plane of every joint.

    Parameters
    ----------
    joints : (k, 3) float
        Joint positions from the body outwards, metres.
    softness : (k,) float
        Half the width of the step at each, metres; that of the first is not used.
    V : (n, 3) float
        Points, metres.
    tip : (3,) float, optional
        From the last joint to the end of its bone, metres: a horse's head hangs from its neck. Not given or
        zero, the last bone goes on straight.

    Returns
    -------
    (n, k) ndarray
        Rows are non-negative and sum to 1.
    """
    bones = np.diff(joints, axis=0)
    if tip is not None and tip.any():
        bones = np.vstack([bones, tip])
    bones /= np.linalg.norm(bones, axis=1, keepdims=True)
    weights = np.zeros((len(V), len(joints)))
    left = np.ones(len(V))
    for j in range(1, len(joints)):
        across = bones[j - 1] + bones[min(j, len(bones) - 1)]
        across /= np.linalg.norm(across)
        past = ease(0.5 + 0.5 * ((V - joints[j]) @ across) / softness[j])
        weights[:, j - 1] = left * (1.0 - past)
        left = left * past
    weights[:, -1] = left
    return weights


def _sparse(weights: FloatArray) -> FloatArray:
    """Keep the largest; what the first left out has is taken from all, so that nothing jumps."""
    if weights.shape[1] > MOST:
        weights = np.maximum(weights - np.sort(weights, axis=1)[:, -MOST - 1 : -MOST], 0.0)
    return weights / weights.sum(axis=1, keepdims=True)
