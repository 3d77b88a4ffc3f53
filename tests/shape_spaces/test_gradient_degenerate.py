"""Faces without area, turned over, of wrong numbers: still exact, or refused with a reason."""

from __future__ import annotations

import numpy as np
import pytest
from gradient_meshes import ball, deformed, dirty, sheet
from numpy.testing import assert_allclose, assert_array_equal

from tempose.shape_spaces import GradientSpace, PatchSpace
from tempose.shape_spaces.gradient.rest_faces import rest_faces

SPACES = pytest.mark.parametrize("Space", [GradientSpace, PatchSpace])


@SPACES
def test_a_collapsed_mesh_comes_back(Space, rng) -> None:
    """All in a plane, on a line, in a point; one face folded, one squeezed to a sliver."""
    V, F = ball(1)
    flat, line, sliver = V.copy(), V.copy(), V.copy()
    flat[:, 1] = 0
    line[:, 1:] = 0
    sliver[F[3, 2]] = (1 - 1e-9) * sliver[F[3, 0]] + 1e-9 * V[F[3, 1]]
    folded = V.copy()
    folded[F[5, 2]] = V[F[5, :2]].mean(axis=0) + (V[F[5, :2]].mean(axis=0) - V[F[5, 2]])
    frames = np.stack([V, flat, line, np.zeros_like(V) + 2.0, sliver, folded])
    for space in (Space(V, F), Space.from_clip(V, F, frames)):
        z = space.encode(frames)
        assert np.isfinite(z).all()
        assert_allclose(space.decode(z), frames, rtol=0, atol=1e-11)


@SPACES
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_mirrored_mesh_comes_back(Space, axis: int) -> None:
    """Turned inside out every face is only turned: determinants never become negative."""
    V, F = ball(1)
    mirrored = V * np.where(np.arange(3) == axis, -1.0, 1.0)
    space = Space(V, F)
    assert_allclose(space.decode(space.encode(mirrored)), mirrored, rtol=0, atol=1e-11)


def test_turning_a_flat_mesh_over_is_half_a_turn() -> None:
    V, F = sheet(2, 2)
    V[:, 1] = 0
    space = GradientSpace(V, F)
    R, S = space.deformations(space.encode(V * [1, 1, -1.0]))
    assert_allclose(R, np.broadcast_to(np.diag([1.0, -1, -1]), R.shape), atol=1e-9)
    assert_allclose(S, np.broadcast_to(np.eye(3), S.shape), atol=1e-12)


def test_faces_without_a_shape_at_rest_are_named(rng) -> None:
    V, F = dirty()
    space = GradientSpace(V, F)
    n = len(F) - 7
    assert set(space.gradients.shape.flat) == {n, n + 1, n + 2, n + 6}
    assert_allclose(space.gradients.shape.shares.sum(), 1, rtol=1e-12)
    assert space.gradients.shape.shares.min() > 0


@pytest.mark.parametrize("share", [0.2, 0.3, 1 / 3, 0.7])
def test_faces_on_a_line_get_frames_like_all_others(share: float) -> None:
    """Although rounding leaves them a normal of noise."""
    V = np.array([[0.1, 0.2, 0.3], [0.7, 0.9, -0.2], [0, 0, 0], [1, 5, 2.0]])
    V[2] = V[0] + share * (V[1] - V[0])
    found = rest_faces(V, np.array([[0, 1, 2], [0, 1, 3]]))
    axes = found.frames.transpose(2, 1, 0)
    assert_array_equal(found.flat, [0])
    assert_allclose(axes.swapaxes(1, 2) @ axes, np.broadcast_to(np.eye(3), axes.shape), atol=1e-12)
    assert_allclose(np.linalg.det(axes), 1, rtol=1e-12)


def test_a_nearly_flat_face_loses_no_accuracy(rng) -> None:
    """A sliver of 1e-5 of its length is measured against itself, one of 1e-8 is not."""
    for height in (1e-5, 1e-8):
        V, F = sheet(2, 2)
        V = np.concatenate([V, [(V[0] + V[1]) / 2 + [0, height, 0]]])
        F = np.concatenate([F, [[0, 1, len(V) - 1]]])
        frames = deformed(V, rng, 3)
        space = GradientSpace(V, F)
        assert len(space.gradients.shape.flat) == (height < 1e-6)
        assert_allclose(space.decode(space.encode(frames)), frames, rtol=0, atol=1e-10)


@SPACES
def test_meshes_that_cannot_be_are_refused(Space) -> None:
    V, F = sheet(2, 2)
    with pytest.raises(ValueError, match="at least one face, got none"):
        Space(V, F[:0])
    with pytest.raises(ValueError, match="face with an area, got 1 faces without"):
        Space(V, np.array([[0, 0, 1]]))
    with pytest.raises(ValueError, match="face with an area"):
        Space(np.zeros_like(V), F)
    with pytest.raises(ValueError, match=r"below 9, got 9 at index \(0, 2\)"):
        Space(V, np.array([[0, 1, 9]]))
    with pytest.raises(ValueError, match="rest must be finite"):
        Space(np.where(np.eye(9, 3) == 1, np.nan, V), F)
    with pytest.raises(ValueError, match=r"rest must have shape \(n, 3\)"):
        Space(V[:, :2], F)


@SPACES
def test_vectors_and_frames_that_do_not_fit_are_refused(Space) -> None:
    V, F = sheet(2, 2)
    space = Space(V, F)
    z = space.encode(V)
    with pytest.raises(ValueError, match=r"V must have shape \(9, 3\), got \(8, 3\)"):
        space.encode(V[:8])
    with pytest.raises(ValueError, match="V must be finite"):
        space.encode(np.full_like(V, np.inf))
    with pytest.raises(ValueError, match=r"V must have shape \(T, 9, 3\)"):
        space.encode_path(V)
    with pytest.raises(ValueError, match=rf"z must have shape \(T, {len(z)}\)"):
        space.decode(z[:-1])
    with pytest.raises(ValueError, match="z must be finite"):
        space.decode(z * np.nan)
    with pytest.raises(ValueError, match="after must have shape"):
        space.encode_path(V[None], after=z[1:])
    with pytest.raises(ValueError, match=r"references must have shape \(8, 3, 3\)"):
        Space(V, F, np.eye(3))
