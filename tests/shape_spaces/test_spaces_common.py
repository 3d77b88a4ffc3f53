"""What every shape space must do, on every mesh of the zoo."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from spaces_zoo import ZOO, diagonal, poses

from tempose.shape_spaces import SPACES, shape_space, space_from_state

NAMES = pytest.mark.parametrize("name", list(SPACES))
MESHES = pytest.mark.parametrize("mesh", list(ZOO))


@NAMES
@MESHES
@pytest.mark.parametrize("given", [True, False])
def test_a_mesh_comes_back(name: str, mesh: str, given: bool) -> None:
    V, F = ZOO[mesh]()
    frames = poses(V)
    space = shape_space(name, V, F, frames if given else None)
    back = space.decode(space.encode(frames))
    assert np.abs(back - frames).max() < 1e-9 * diagonal(frames)


@NAMES
@pytest.mark.parametrize("unit", [1e-3, 1e3])
@pytest.mark.parametrize("mesh", ["parts", "slivers"])
def test_a_mesh_of_any_size_comes_back(name: str, mesh: str, unit: float) -> None:
    V, F = ZOO[mesh]()
    frames = unit * poses(V)
    space = shape_space(name, frames[0], F, frames)
    back = space.decode(space.encode(frames))
    assert np.abs(back - frames).max() < 1e-9 * diagonal(frames)


@NAMES
@MESHES
def test_a_path_comes_back_and_goes_on_smoothly(name: str, mesh: str) -> None:
    """A turn and a half of the body and a bend: no step is much longer than the others."""
    V, F = ZOO[mesh]()
    turns = np.linspace(0, 3 * np.pi, 41)
    R = Rotation.from_rotvec(turns[:, None] * [0, 0.6, 0.8]).as_matrix()
    bent = V + 0.1 * np.sin(np.linspace(0, 2, 41))[:, None, None] * np.sin(V @ np.diag([2.0, 1.0, 3.0]))
    frames = bent @ R.transpose(0, 2, 1)
    space = shape_space(name, V, F, frames)
    path = space.encode_path(frames)
    assert np.abs(space.decode(path) - frames).max() < 1e-9 * diagonal(frames)
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    assert steps.max() < 3 * np.median(steps)


@NAMES
def test_batches_equal_single_meshes(name: str) -> None:
    V, F = ZOO["parts"]()
    frames = poses(V, 6)
    space = shape_space(name, V, F, frames)
    z = space.encode(frames)
    assert z.shape == (6, space.dimension)
    assert z.dtype == np.float64
    for t in range(6):
        assert_array_equal(space.encode(frames[t]), z[t])
    between = 0.5 * (z[:3] + z[3:])
    X = space.decode(between)
    for t in range(3):
        assert_array_equal(space.decode(between[t]), X[t])
    assert_array_equal(space.encode(frames.reshape(3, 1, 2, -1, 3)), z.reshape(3, 1, 2, -1))
    assert_array_equal(space.decode(between.reshape(3, 1, -1)), X.reshape(3, 1, -1, 3))
    assert space.encode(frames[:0]).shape == (0, space.dimension)
    assert space.decode(z[:0]).shape == (0, space.n_vertices, 3)


@NAMES
@MESHES
def test_a_saved_space_is_the_same(name: str, mesh: str) -> None:
    V, F = ZOO[mesh]()
    frames = poses(V)
    space = shape_space(name, V, F, frames)
    state = space.state()
    again = space_from_state(name, {key: np.array(value) for key, value in state.items()})
    assert (again.dimension, again.n_vertices) == (space.dimension, len(V))
    z = space.encode(frames)
    assert_array_equal(again.encode(frames), z)
    middle = 0.5 * (z[1] + z[2])
    assert_array_equal(again.decode(middle), space.decode(middle))
    assert set(again.state()) == set(state)
    for key, value in again.state().items():
        assert_array_equal(value, state[key])


@NAMES
def test_coordinates_do_not_change_the_input(name: str) -> None:
    V, F = ZOO["closed"]()
    frames = poses(V)
    kept = frames.copy()
    space = shape_space(name, V, F, frames)
    z = space.encode_path(frames)
    z_kept = z.copy()
    space.decode(z)
    assert_array_equal(frames, kept)
    assert_array_equal(z, z_kept)


@NAMES
@MESHES
def test_between_two_poses_is_finite_and_in_place(name: str, mesh: str) -> None:
    V, F = ZOO[mesh]()
    frames = poses(V, 3)
    space = shape_space(name, V, F, frames)
    z = space.encode_path(frames)
    X = space.decode(0.5 * (z[1] + z[2]))
    assert np.isfinite(X).all()
    assert np.linalg.norm(X.mean(axis=0) - frames[1:].mean(axis=(0, 1))) < 0.5 * diagonal(frames)


@pytest.mark.parametrize("name", [name for name in SPACES if name != "vertex"])
@pytest.mark.parametrize("mesh", ["closed", "opened", "slivers"])
def test_turning_while_bending_keeps_lengths(name: str, mesh: str) -> None:
    """A quarter turn between two poses: straight lines would shrink the mesh by a third."""
    V, F = ZOO[mesh]()
    R = Rotation.from_rotvec([0, np.pi / 2, 0]).as_matrix()
    frames = np.stack([V, V @ R.T])
    space = shape_space(name, V, F, frames)
    X = space.decode(space.encode_path(frames).mean(axis=0))
    half = Rotation.from_rotvec([0, np.pi / 4, 0]).as_matrix()
    assert_allclose(X - X.mean(axis=0), (V - V.mean(axis=0)) @ half.T, atol=1e-6 * diagonal(V))


@NAMES
@pytest.mark.parametrize("mesh", ["closed", "opened"])
def test_renumbering_changes_nothing(name: str, mesh: str, rng: np.random.Generator) -> None:
    """Distances and in-between poses do not depend on the order of vertices and faces."""
    V, F = ZOO[mesh]()
    frames = poses(V, 3)
    to = rng.permutation(len(V))
    shuffled = np.zeros_like(frames)
    shuffled[:, to] = frames
    G = to[F][rng.permutation(len(F))]
    found, distances = [], []
    for X, faces in ((frames, F), (shuffled, G)):
        space = shape_space(name, X[0], faces, X)
        z = space.encode_path(X)
        distances.append(np.linalg.norm(z[1] - z[2]))
        found.append(space.decode(0.5 * (z[1] + z[2])))
    if name == "patch":
        # its seeds follow the numbering: the same only up to where patches begin
        assert_allclose(found[1][to], found[0], atol=0.05 * diagonal(V))
        return
    assert_allclose(distances[1], distances[0], rtol=1e-9)
    assert_allclose(found[1][to], found[0], atol=1e-3 * diagonal(V))


@NAMES
def test_coordinates_of_another_mesh_are_refused(name: str) -> None:
    V, F = ZOO["closed"]()
    space = shape_space(name, V, F)
    with pytest.raises(ValueError, match=r"\d"):
        space.encode(V[:-1])
    with pytest.raises(ValueError, match=r"\d"):
        space.decode(np.zeros(space.dimension - 1))


def test_an_unknown_space_is_refused() -> None:
    V, F = ZOO["closed"]()
    with pytest.raises(ValueError, match="space must be one of vertex, "):
        shape_space("laplacian", V, F)
