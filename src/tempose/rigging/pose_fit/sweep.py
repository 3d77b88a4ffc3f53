"""All frames of a clip, each from several starts, the best kept."""

from __future__ import annotations

import numpy as np
from numba import njit

from tempose.rigging.pose_fit.descent import descend
from tempose.rigging.pose_fit.linear_kernels import bone_rows, energy
from tempose.rigging.pose_fit.matrix_kernels import orthonormalise, product
from tempose.rigging.pose_fit.starts import closed_form_start
from tempose.rigging.pose_fit.tree_kernels import place
from tempose.typing import BoolArray, FloatArray, IntArray

_LOST = 1.05


@njit(cache=True, nogil=True)
def sweep_forward(
    start: int,
    stop: int,
    A: FloatArray,
    B: FloatArray,
    constants: FloatArray,
    sums: FloatArray,
    parents: IntArray,
    steps: FloatArray,
    R: FloatArray,
    root: FloatArray,
    values: FloatArray,
    iterations: IntArray,
    converged: BoolArray,
    most: int,
    tolerance: float,
) -> None:
    """Fit frames in order, each from the frames before and from its own moments.

    Parameters
    ----------
    start, stop : int
        Frames to fit; those before `start` are done.
    A : (4 J, 4 J) float
        Second moments about the joints.
    B : (T, 4 J, 3) float
        First moments.
    constants : (T,) float
        Sum of squares of each frame.
    sums : (J, 4) float
        From `bone_sums`.
    parents : (J,) int
        Parents first.
    steps : (J, 3) float
        From the parent to the joint in the bind pose.
    R : (T, J, 3, 3) float
        Turns of the bones, written.
    root : (T, 3) float
        Positions of the root, written.
    values : (T,) float
        Sums of squared distances, written.
    iterations : (T,) int
        Steps tried from all starts, written.
    converged : (T,) bool
        Written.
    most : int
        Largest number of steps from a start.
    tolerance : float
        Part of the energy that ends the descent.
    """
    J = len(parents)
    turned, shift = np.zeros((J, 3, 3)), np.zeros(3)
    other, moved = np.zeros((J, 3, 3)), np.zeros(3)
    for t in range(start, stop):
        iterations[t], values[t] = 0, np.inf
        if t > 0:
            R[t], root[t] = R[t - 1], root[t - 1]
            if t > 1:
                _go_on(R[t - 1], root[t - 1], R[t - 2], root[t - 2], other, moved)
                _take_lower(A, B[t], parents, steps, other, moved, R[t], root[t])
            values[t], iterations[t], converged[t] = descend(
                A, B[t], constants[t], parents, steps, R[t], root[t], most, tolerance, np.inf
            )
        closed_form_start(sums, B[t], parents, steps, True, turned, shift)
        closed_form_start(sums, B[t], parents, steps, False, other, moved)
        _take_lower(A, B[t], parents, steps, other, moved, turned, shift)
        value, used, done = descend(
            A, B[t], constants[t], parents, steps, turned, shift, most, tolerance, values[t]
        )
        iterations[t] += used
        if value < values[t]:
            R[t], root[t], values[t], converged[t] = turned, shift, value, done


@njit(cache=True, nogil=True)
def sweep_back(
    A: FloatArray,
    B: FloatArray,
    constants: FloatArray,
    parents: IntArray,
    steps: FloatArray,
    R: FloatArray,
    root: FloatArray,
    values: FloatArray,
    iterations: IntArray,
    converged: BoolArray,
    most: int,
    tolerance: float,
) -> None:
    """Start frames that fit worse than the one after them from that one; the better pose is kept.

    Parameters
    ----------
    A, B, constants, parents, steps : ndarray
        As in `sweep_forward`.
    R, root, values, iterations, converged : ndarray
        All frames as `sweep_forward` left them; overwritten where a lower energy is found.
    most : int
        Largest number of steps.
    tolerance : float
        Part of the energy that ends the descent.
    """
    for t in range(len(B) - 2, -1, -1):
        if values[t] <= _LOST * values[t + 1]:
            continue
        turned, shift = R[t + 1].copy(), root[t + 1].copy()
        value, used, done = descend(
            A, B[t], constants[t], parents, steps, turned, shift, most, tolerance, values[t]
        )
        iterations[t] += used
        if value < values[t]:
            R[t], root[t], values[t], converged[t] = turned, shift, value, done


@njit(cache=True, nogil=True)
def _go_on(
    R1: FloatArray, root1: FloatArray, R0: FloatArray, root0: FloatArray, R: FloatArray, root: FloatArray
) -> None:
    # the turn from frame t - 2 to t - 1, once more
    E = np.zeros((3, 3))
    for j in range(len(R1)):
        product(R1[j], R0[j].T, E)
        product(E, R1[j], R[j])
    orthonormalise(R)
    root[:] = 2 * root1 - root0


@njit(cache=True, nogil=True)
def _take_lower(
    A: FloatArray,
    B: FloatArray,
    parents: IntArray,
    steps: FloatArray,
    other: FloatArray,
    moved: FloatArray,
    R: FloatArray,
    root: FloatArray,
) -> None:
    J = len(parents)
    q, M, G = np.zeros((J, 3)), np.zeros((4 * J, 3)), np.zeros((4 * J, 3))
    place(R, root, parents, steps, q)
    bone_rows(R, q, M)
    value = energy(A, B, M, G)
    place(other, moved, parents, steps, q)
    bone_rows(other, q, M)
    if energy(A, B, M, G) < value:
        R[:], root[:] = other, moved
