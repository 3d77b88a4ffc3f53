"""Targets as they come: soups, holes, fins, broken faces, loose pieces. They move as the clean body."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import pytest
from transfer_bodies import human_body, t_pose
from transfer_zoo import sphere

from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.samples.walk import walk
from tempose.transfer import TransferResult, transfer_motion

Change = Callable[[Mesh], tuple[np.ndarray, np.ndarray, np.ndarray]]
"""A mesh to the vertices behind the new ones (k,), new positions (k, 3) and faces (m, 3)."""


@lru_cache
def walking() -> SkeletonClip:
    return walk(t_pose(), duration=0.4, fps=20.0)


@lru_cache
def clean(embed: bool) -> TransferResult:
    return transfer_motion(walking(), human_body(), embed=embed, measure=False)


def soup(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every triangle with corners of its own."""
    index = mesh.faces.ravel()
    return index, mesh.vertices[index], np.arange(len(index)).reshape(-1, 3)


def broken_faces(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Doubled, flipped, collapsed and thread-like faces, and vertices that nothing uses."""
    F, n = mesh.faces, len(mesh.vertices)
    same = np.arange(n)
    extra = [F[:40], F[40:80][:, ::-1], F[80:120][:, [0, 0, 1]], np.repeat(F[120:140][:, :1], 3, axis=1)]
    middle = mesh.vertices[F[200:220, :2]].mean(axis=1)
    thread = np.c_[F[200:220, :2], n + np.arange(20)]
    index = np.r_[same, F[200:220, 0], [0, 1]]
    V = np.concatenate([mesh.vertices, middle, mesh.vertices[:2]])
    return index, V, np.concatenate([F, *extra, thread])


def holes(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Every thirtieth face is missing, and the crown of the head."""
    kept = np.arange(len(mesh.faces)) % 30 != 0
    kept &= mesh.vertices[mesh.faces][:, :, 1].max(axis=1) < mesh.vertices[:, 1].max() - 0.03
    return np.arange(len(mesh.vertices)), mesh.vertices, mesh.faces[kept]


def fins(mesh: Mesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges with three and four faces: small sails that stand on the skin."""
    F, n = mesh.faces[::40], len(mesh.vertices)
    normal = np.cross(
        mesh.vertices[F[:, 1]] - mesh.vertices[F[:, 0]], mesh.vertices[F[:, 2]] - mesh.vertices[F[:, 0]]
    )
    tips = mesh.vertices[F[:, :2]].mean(axis=1) + 0.015 * normal / np.linalg.norm(
        normal, axis=1, keepdims=True
    )
    sails = np.c_[F[:, :2], n + np.arange(len(F))]
    faces = np.concatenate([mesh.faces, sails, sails[::2, [1, 0, 2]]])
    return np.r_[np.arange(n), F[:, 0]], np.concatenate([mesh.vertices, tips]), faces


CHANGES: dict[str, Change] = {f.__name__: f for f in (soup, broken_faces, holes, fins)}


def changed(name: str) -> tuple[SkinnedMesh, np.ndarray]:
    """The body changed, and for each of its first vertices the one of the clean body."""
    body = human_body()
    index, V, F = CHANGES[name](body.mesh)
    return SkinnedMesh(Mesh(V, F), body.skeleton, body.weights[index]), index


@pytest.mark.parametrize("name", CHANGES)
@pytest.mark.parametrize("embed", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_a_damaged_body_moves_as_the_clean_one(name: str, embed: bool) -> None:
    target, index = changed(name)
    result = transfer_motion(walking(), target, embed=embed, measure=False)
    used = np.unique(target.mesh.faces)
    used = used[
        np.linalg.norm(target.mesh.vertices[used] - human_body().mesh.vertices[index[used]], axis=1) == 0
    ]
    apart = np.asarray(result.clip.vertices, float)[:, used] - clean(embed).clip.vertices[:, index[used]]
    away = np.linalg.norm(apart, axis=2)
    height = human_body().mesh.height
    # other faces are marked, and an embedded skeleton lies a little elsewhere
    assert np.sqrt((away**2).mean()) < (0.03 if embed else 0.015) * height
    assert away.max() < 0.1 * height
    assert result.report["warnings"] == []


def test_corners_at_one_place_stay_together() -> None:
    target, index = changed("soup")
    V = transfer_motion(walking(), target, measure=False).clip.vertices
    first = np.unique(index, return_index=True)[1]
    place = np.zeros(index.max() + 1, dtype=int)
    place[index[first]] = first
    assert np.abs(V - V[:, place[index]]).max() == 0


def filled() -> tuple[Mesh, dict[str, np.ndarray]]:
    """The body with two eyes and teeth inside its head, a bead in a fist, and a band round one arm."""
    mesh, skeleton = human_body().mesh, human_body().skeleton
    from tempose.kinematics import rest_transforms

    joints = dict(zip(skeleton.names, rest_transforms(skeleton)[1]))
    ball = sphere(1)
    small = 0.012 * (ball.vertices - ball.vertices.mean(axis=0))
    head = joints["head"] + [0, 0.06, 0]
    forearm = joints["left_hand"] - joints["left_forearm"]
    at = {
        "left eye": head + np.array([0.03, 0.02, 0.04]),
        "right eye": head + np.array([-0.03, 0.02, 0.04]),
        "teeth": head + np.array([0.0, -0.03, 0.04]),
        "bead": joints["left_hand"] + 0.04 * forearm / np.linalg.norm(forearm),
    }
    V, F, parts = [mesh.vertices], [mesh.faces], {}
    for name, place in at.items():
        start = sum(map(len, V))
        V.append(small + place)
        F.append(ball.faces + start)
        parts[name] = np.arange(start, start + len(small))
    return Mesh(np.concatenate(V), np.concatenate(F)), parts


@pytest.mark.parametrize("embed", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_loose_pieces_inside_go_with_what_is_round_them(embed: bool) -> None:
    mesh, parts = filled()
    target: Mesh | SkinnedMesh = mesh
    if not embed:
        body = human_body()
        # weights of the pieces are of no use: they name the wrong limb, as files often do
        weights = np.zeros((len(mesh.vertices), body.skeleton.n_joints))
        weights[: len(body.weights)] = body.weights
        weights[len(body.weights) :, body.skeleton.index("head")] = 1
        target = SkinnedMesh(mesh, body.skeleton, weights)
    V = np.asarray(transfer_motion(walking(), target, measure=False).clip.vertices, dtype=np.float64)
    n = len(human_body().mesh.vertices)
    for name, part in parts.items():
        if name == "bead" and not embed:
            continue  # a bead that its file binds to the head may go with the head
        centre = mesh.vertices[part].mean(axis=0)
        near = np.argsort(np.linalg.norm(mesh.vertices[:n] - centre, axis=1))[:40]
        for frame in V:
            R, shift = rigid(mesh.vertices[near], frame[near])
            assert np.linalg.norm(centre @ R.T + shift - frame[part].mean(axis=0)) < 0.012, name
            R, shift = rigid(mesh.vertices[part], frame[part])
            assert np.abs(mesh.vertices[part] @ R.T + shift - frame[part]).max() < 0.002, name


def rigid(P: np.ndarray, Q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Best rotation and shift from P to Q (Kabsch)."""
    p, q = P.mean(axis=0), Q.mean(axis=0)
    U, _, Vt = np.linalg.svd((P - p).T @ (Q - q))
    R = Vt.T @ np.diag([1, 1, np.sign(np.linalg.det(Vt.T @ U.T))]) @ U.T
    return R, q - R @ p


def test_nothing_is_turned_inside_out_by_damage() -> None:
    target, _ = changed("fins")
    result = transfer_motion(walking(), target)
    assert result.report["flipped_percent"] < 0.05
