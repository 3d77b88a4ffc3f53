"""Skeletons in capsule people: right joints, whatever the pose, the axes, the unit, the numbering."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from capsule_people import block_person, dog, errors, person, sphere
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from tempose.clips import Mesh
from tempose.embedding import Embedding, embed_skeleton
from tempose.embedding.human import NAMES, TERMINALS
from tempose.kinematics import rest_transforms
from tempose.kinematics.roles import ROLES, find_roles


@pytest.fixture(scope="module")
def standing() -> Embedding:
    return embed_skeleton(person()[0])


def moved(joints: np.ndarray, R: np.ndarray, unit: float, shift: float) -> np.ndarray:
    return unit * (joints @ R.T) + shift


@pytest.mark.parametrize(
    ("mesh", "at"),
    [person(), person(0.0), person(40.0, 25.0), person(60.0, 20.0, 40.0), block_person()],
    ids=["A-pose", "T-pose", "stride", "knee", "one surface"],
)
def test_joints_are_found(mesh: Mesh, at: dict[str, np.ndarray]) -> None:
    e = embed_skeleton(mesh)
    found = errors(e.joints, e.names, at)
    assert np.median(list(found.values())) < 1.5 and max(found.values()) < 2.5
    assert not e.doubtful and e.penalty < 0.6 and e.confidence > 0.5 and e.up == "+y"
    assert_allclose(e.facing, np.eye(3), atol=0.1)
    for side in ("left", "right"):
        assert np.linalg.norm(e.ends[f"{side}_hand"] - at[f"{side}_finger"]) < 0.06
        assert np.linalg.norm(e.ends[f"{side}_toes"] - at[f"{side}_tip"]) < 0.06
    assert np.linalg.norm(e.ends["head"] - at["top"]) < 0.06


@pytest.mark.parametrize(
    ("axes", "up", "unit"),
    [([[1, 0, 0], [0, 0, -1], [0, 1, 0]], "+z", 100.0), ([[0, -1, 0], [1, 0, 0], [0, 0, 1]], "-x", 1e-2)],
)
def test_any_axes_and_unit(standing: Embedding, axes: list[list[int]], up: str, unit: float) -> None:
    R = np.array(axes, dtype=float)
    mesh, _ = person()
    e = embed_skeleton(mesh.with_vertices(moved(mesh.vertices, R, unit, 3 * unit)))
    expected = moved(standing.joints, R, unit, 3 * unit)
    assert np.abs(e.joints - expected).max() < 0.02 * 1.75 * unit
    assert e.up == up and not e.doubtful
    assert_allclose(e.facing @ R, np.eye(3), atol=0.1)
    assert_allclose(e.penalty, standing.penalty, atol=0.1)


@pytest.mark.parametrize("yaw", [37.0, 200.0])
def test_any_heading(standing: Embedding, yaw: float) -> None:
    R = Rotation.from_euler("y", yaw, degrees=True).as_matrix()
    mesh, _ = person()
    e = embed_skeleton(mesh.with_vertices(mesh.vertices @ R.T))
    assert np.abs(e.joints - standing.joints @ R.T).max() < 0.02 * 1.75
    assert_allclose(e.facing @ R, np.eye(3), atol=0.1)


def test_numbering_and_duplicate_vertices_change_nothing(
    standing: Embedding, rng: np.random.Generator
) -> None:
    mesh, _ = person()
    corners = rng.permutation(len(mesh.faces))
    V = mesh.vertices[mesh.faces[corners]].reshape(-1, 3)
    e = embed_skeleton(Mesh(V, np.arange(len(V)).reshape(-1, 3)))
    assert_array_equal(e.joints, standing.joints)


def test_the_mirror_image_exchanges_the_sides() -> None:
    mesh, _ = person(40.0, 25.0)
    plain = embed_skeleton(mesh)
    mirror = np.array([-1.0, 1, 1])
    e = embed_skeleton(Mesh(mesh.vertices * mirror, mesh.faces[:, ::-1]))
    swap = {"left": "right", "right": "left"}
    other = ["_".join([swap.get((w := n.split("_"))[0], w[0]), *w[1:]]) for n in NAMES]
    expected = plain.joints[[NAMES.index(n) for n in other]] * mirror
    assert np.abs(e.joints - expected).max() < 0.015 * 1.75


def test_holes_are_survived() -> None:
    mesh, at = block_person()
    away = np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1)[:, None] - mesh.vertices[::700], axis=2)
    e = embed_skeleton(replace(mesh, faces=mesh.faces[(away > 0.05).all(axis=1)]))
    assert not e.doubtful and max(errors(e.joints, e.names, at).values()) < 3


@pytest.mark.parametrize(("angle", "word", "up"), [(90.0, "lies", "+x"), (180.0, "head", "-y")])
def test_lying_and_upside_down_are_found_out(angle: float, word: str, up: str) -> None:
    R = Rotation.from_euler("z", -angle, degrees=True).as_matrix()
    mesh, at = person()
    mesh = mesh.with_vertices(mesh.vertices @ R.T)
    stated = embed_skeleton(mesh, up="y")
    assert stated.doubtful and len(stated.reasons) == 1 and word in stated.reasons[0]
    free = embed_skeleton(mesh)
    assert not free.doubtful and free.up == up
    assert max(errors(free.joints @ R, free.names, at).values()) < 2.5


def test_a_dog_is_doubted() -> None:
    e = embed_skeleton(dog())
    assert e.penalty > 1.3 and e.confidence < 0.4
    assert "not shaped like a human's: penalty" in e.reasons[0]


def test_without_limbs_an_average_person_stands_in_the_box() -> None:
    V, F = sphere(3)
    e = embed_skeleton(Mesh(V * [0.5, 1, 0.3], F))
    assert e.doubtful and "were not found" in e.reasons[0]
    assert (np.abs(e.joints) <= [0.5, 1, 0.3]).all()
    head, foot = (e.joints[NAMES.index(n)] for n in ("head", "left_foot"))
    assert head[1] > 0.5 and foot[1] < -0.8 and foot[0] > 0


def test_the_skeleton_holds_every_role_at_the_joints(standing: Embedding) -> None:
    skeleton = standing.skeleton
    assert set(find_roles(skeleton)) == set(ROLES) == set(skeleton.names)
    _, positions = rest_transforms(skeleton)
    for name, joint in zip(standing.names, standing.joints):
        assert_allclose(positions[skeleton.index(name)], joint, atol=1e-12)
    for name in TERMINALS:
        j = skeleton.index(name)
        assert skeleton.tips is not None
        assert_allclose(positions[j] + skeleton.tips[j], standing.ends[name], atol=1e-12)
    assert (standing.parents < np.arange(18)).all() and len(standing.names) == 18


def test_progress_and_bad_arguments() -> None:
    mesh, _ = person()
    calls: list[tuple[int, int, str]] = []
    embed_skeleton(mesh, progress=lambda done, total, stage: calls.append((done, total, stage)))
    assert [done for done, _, _ in calls] == [1, 2, 3] and {total for _, total, _ in calls} == {4}
    with pytest.raises(ValueError, match=r"up must be one of \+x, .*, got 'north'"):
        embed_skeleton(mesh, up="north")
    with pytest.raises(ValueError, match="needs a mesh with extent"):
        embed_skeleton(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)))
    with pytest.raises(ValueError, match="read-only"):
        embed_skeleton(mesh).joints[0] = 0.0
