"""Paths over the surface: shortest, at even pace, and they keep a twisted tube open."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation
from transfer_bodies import clip_of, t_body, t_pose
from transfer_zoo import pieces, sphere, tube, wxyz

from tempose.geometry import edge_list
from tempose.transfer import MotionTransfer, pairs_from_skin
from tempose.transfer.from_skeleton import prepare_skeleton
from tempose.transfer.turns.columns import Columns
from tempose.transfer.turns.geodesic_path import STATIONS, path_columns, shortest_paths, turning_far


def test_a_path_is_as_short_as_relaxing_every_edge_makes_it() -> None:
    """A slow twin: Bellman's recursion over all edges until nothing changes."""
    mesh = sphere(2)
    V, F = mesh.vertices, mesh.faces
    start, end = np.array([3, 40]), np.array([100, 120])
    edges = edge_list(F)
    length = np.linalg.norm(V[edges[:, 0]] - V[edges[:, 1]], axis=1)
    away = np.full(len(V), np.inf)
    away[start] = 0
    for _ in range(len(V)):
        before = away.copy()
        for i, j in (edges.T, edges.T[::-1]):
            np.minimum.at(away, j, before[i] + length)
        if (before == away).all():
            break
    path = shortest_paths(V, F, start, end, 1)[0]
    steps = np.linalg.norm(np.diff(V[path.vertices], axis=0), axis=1)
    assert steps.sum() == pytest.approx(away[end].min(), rel=1e-9)
    assert_allclose(np.diff(path.share), steps / steps.sum(), atol=1e-9)
    assert path.vertices[0] in start and path.vertices[-1] == end[away[end].argmin()]


def test_paths_join_rings_straight_and_all_round() -> None:
    mesh = tube(21, 12, 2.0, 0.25)
    low, high = np.arange(4 * 12, 5 * 12), np.arange(16 * 12, 17 * 12)
    paths = shortest_paths(mesh.vertices, mesh.faces, low, high, 6)
    assert len(paths) == 6
    angles = []
    for path in paths:
        P = mesh.vertices[path.vertices]
        assert_allclose(P[:, [0, 2]], np.broadcast_to(P[0, [0, 2]], (len(P), 2)), atol=1e-9)
        assert_allclose(path.share, np.linspace(0, 1, 13), atol=1e-9)
        angles.append(np.arctan2(P[0, 0], P[0, 2]))
    gaps = np.diff(np.sort(np.r_[angles, min(angles) + 2 * np.pi]))
    assert gaps.max() <= np.radians(90) + 1e-9


def test_pieces_that_do_not_meet_have_no_path() -> None:
    mesh = pieces()
    assert shortest_paths(mesh.vertices, mesh.faces, np.array([0]), np.array([len(mesh.vertices) - 1])) == []


def test_bones_are_found_by_how_far_they_turn() -> None:
    parents = np.array([-1, 0, 1])
    Q = np.tile([1.0, 0, 0, 0], (3, 3, 1))
    Q[2, 1:] = wxyz(Rotation.from_euler("x", 130, degrees=True))
    assert turning_far(Q, parents) == [1]
    Q[2, 1:] = wxyz(Rotation.from_euler("x", 110, degrees=True))
    assert turning_far(Q, parents) == []


def test_a_tube_twisted_by_nearly_a_round_stays_open_along_paths() -> None:
    mesh = tube(41, 24, 2.0, 0.2)
    V, F = mesh.vertices, mesh.faces
    low, high = np.arange(4 * 24, 6 * 24), np.arange(35 * 24, 37 * 24)
    marked, bones = np.concatenate([low, high]), np.repeat([0, 1], 48)
    parents = np.array([-1, 0])
    half = np.radians(np.linspace(0, 330, 34)) / 2
    Q = np.stack([np.tile([1.0, 0, 0, 0], (34, 1)), np.c_[np.cos(half), 0 * half, np.sin(half), 0 * half]], 1)
    between, vertices, stations = path_columns(V, F, marked, bones, parents, Q)
    assert len(between) == STATIONS and not np.isin(vertices, marked).any()
    columns = Columns(2, between)
    held = MotionTransfer(mesh, np.r_[marked, vertices], np.r_[bones, 2 + stations], len(columns))
    plain = MotionTransfer(mesh, marked, bones, 2)
    lengths = [
        np.linalg.norm(solver.field(q), axis=1).min()
        for solver, q in ((held, columns.rotations(Q)), (plain, Q))
    ]
    assert lengths[0] > 0.9 and lengths[1] < 0.3
    # slerp at even pace: the middle of the tube has turned half as far as its end
    middle = np.flatnonzero(np.isin(vertices, np.flatnonzero(np.abs(V[:, 1] - 1.0) < 0.03)))
    shares = np.array([1 + between[stations[m]].share for m in middle])
    assert_allclose(shares, 0.5, atol=0.5 / STATIONS + 1e-9)


def test_the_option_lays_paths_only_where_a_limb_turns_far() -> None:
    angle = np.radians(np.linspace(0, 200, 21))
    turns = {"left_shin": wxyz(Rotation.from_rotvec(angle[:, None] * [0, 1.0, 0]))}
    body, clip = t_body(), clip_of(t_pose(), turns, 21)
    pairs = pairs_from_skin(clip.skeleton, body)
    jobs = [prepare_skeleton(clip, body.mesh, pairs, singular=how, lead=0) for how in ("path", "none")]
    added = jobs[0].columns.between[len(jobs[1].columns.between) :]
    shin, thigh = (jobs[0].bones.find("left_" + part) for part in ("shin", "thigh"))
    assert {(e.first, e.second) for e in added} == {(thigh, shin)}
    lengths = [np.linalg.norm(j.solver.field(j.rotations), axis=1).min() for j in jobs]
    assert lengths[0] > lengths[1] + 0.05
