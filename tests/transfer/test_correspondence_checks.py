"""Checks of pairs: nothing to say about good ones, each fault named where it is."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from correspondence_shapes import face_near, merged
from transfer_bodies import human_body
from transfer_zoo import sphere

from tempose.clips import Mesh
from tempose.samples.skeletons import human_skeleton
from tempose.transfer import Finding, Pairs, check_coverage, complete_ring, pairs_from_skin, select_pairs
from tempose.transfer.correspondence.closest import spread_points
from tempose.transfer.correspondence.reach import mark_distances


@pytest.fixture(scope="module")
def pairs() -> Pairs:
    return pairs_from_skin(human_skeleton(), human_body())


@pytest.fixture(scope="module")
def body() -> Mesh:
    return human_body().mesh


def kinds(found: tuple[Finding, ...]) -> set[str]:
    return {f.kind for f in found}


def without(pairs: Pairs, *names: str) -> Pairs:
    return select_pairs(pairs, [i for i, name in enumerate(pairs.source) if name not in names])


def test_good_pairs_raise_nothing(pairs: Pairs, body: Mesh) -> None:
    assert [f for f in check_coverage(pairs, body, human_skeleton()) if f.severity != "note"] == []


def test_an_uncovered_arm_is_named(pairs: Pairs, body: Mesh) -> None:
    bare = without(pairs, "left_forearm", "left_hand", "left_upper_arm")
    found = check_coverage(bare, body, human_skeleton())
    far = next(f for f in found if f.kind == "far")
    centres = body.vertices[body.faces[far.faces]].mean(axis=1)
    assert (centres[:, 0] > 0.2).all() and "left" in far.place
    missing = [f.place for f in found if f.kind == "part" and f.severity == "warning"]
    assert missing == ["left_upper_arm (left_upper_arm)", "left_forearm (left_forearm)"]


def test_exchanged_legs_are_an_error(pairs: Pairs, body: Mesh) -> None:
    other = {"left_shin": "right_shin", "right_shin": "left_shin"}
    crossed = replace(pairs, source=tuple(other.get(str(s), str(s)) for s in pairs.source))
    (found,) = [f for f in check_coverage(crossed, body, human_skeleton()) if f.severity == "error"]
    assert found.kind == "sides" and found.place == "shin"
    assert {crossed.source[i] for i in found.pairs} == {"left_shin", "right_shin"}


def test_all_exchanged_is_seen_by_the_feet(pairs: Pairs, body: Mesh) -> None:
    swap = {"left": "right", "right": "left"}
    names = [str(s).split("_", 1) for s in pairs.source]
    crossed = ["_".join([swap.get(n[0], n[0]), *n[1:]]) for n in names]
    found = check_coverage(replace(pairs, source=tuple(crossed)), body, human_skeleton())
    assert sum(f.kind == "sides" for f in found) >= 4


def test_a_limb_marked_on_one_side_only_is_found(pairs: Pairs, body: Mesh) -> None:
    shin = [i for i, s in enumerate(pairs.source) if s == "left_shin"]
    front = shin[int(body.vertices[body.faces[pairs.target[shin]]].mean(axis=1)[:, 2].argmax())]
    kept = [i for i in range(len(pairs)) if i not in shin or i == front]
    (found,) = [f for f in check_coverage(select_pairs(pairs, kept), body) if f.kind == "ring"]
    assert found.place == "left_shin" and "360 of 360" in found.message
    ring = complete_ring(None, body, (0, int(pairs.target[front])))
    full = Pairs("joints", ("left_shin",) * len(ring.target), ring.target, ("left_shin",) * len(ring.target))
    assert "ring" not in kinds(check_coverage(full, body))


@pytest.mark.parametrize("kind", ["faces", "vertices"])
def test_pairs_that_contradict_their_neighbours_are_named(body: Mesh, kind: str) -> None:
    P = body.vertices if kind == "vertices" else body.vertices[body.faces].mean(axis=1)
    places = spread_points(P, 40, P.mean(axis=0))
    source = np.array(places)
    assert check_coverage(Pairs(kind, source, places), body, body) == ()  # type: ignore[arg-type]
    source[[4, 20]] = source[[20, 4]]
    found = check_coverage(Pairs(kind, source, places), body, body)  # type: ignore[arg-type]
    named = [f.pairs[0] for f in found if f.kind == "neighbours"]
    assert {4, 20} <= set(named) and set(named[:2]) == {4, 20}


def test_a_reflected_list_is_an_error(body: Mesh) -> None:
    mesh = sphere(3)
    places = spread_points(mesh.vertices, 30, mesh.vertices.mean(axis=0))
    mirror = mesh.with_vertices(mesh.vertices * [-1, 1, 1])
    found = check_coverage(Pairs("vertices", places, places), mesh, mirror)
    assert found[0].severity == "error" and found[0].kind == "sides"
    assert "sides" not in kinds(check_coverage(Pairs("vertices", places, places), mesh, mesh))


def test_unconnected_pieces_are_told_apart(body: Mesh) -> None:
    hat = Mesh(sphere(1).vertices * 0.1 + [0, 2, 0], sphere(1).faces)
    both = merged(body, hat)
    faces = np.arange(0, len(body.faces), 60)
    found = check_coverage(
        Pairs("joints", ("hips", "head") * (len(faces) // 2), faces[: len(faces) // 2 * 2]), both
    )
    (piece,) = [f for f in found if f.kind == "piece"]
    assert piece.severity == "note" and len(piece.faces) == len(hat.faces)
    lost = check_coverage(Pairs("joints", ("hips", "head"), [len(body.faces), len(body.faces) + 1]), both)
    assert lost[0].kind == "piece" and lost[0].severity == "error"


def test_too_few_pairs_are_an_error(body: Mesh) -> None:
    found = check_coverage(Pairs("joints", ("hips",), [0]), body)
    assert found[0].kind == "few" and found[0].severity == "error"


def test_groups_of_a_template_without_marks_are_named(body: Mesh) -> None:
    grouped = replace(body, groups={"left_shin": np.arange(9), "head": np.arange(20, 40)})
    found = check_coverage(Pairs("faces", [0, 1, 2], [0, 100, 200]), body, grouped)
    assert [f.place for f in found if f.kind == "part"] == ["head"]


def test_distances_run_along_the_surface(body: Mesh) -> None:
    face = face_near(body, [0.09, 0.1, 0.05])
    distance, nearest = mark_distances(body, Pairs("joints", ("a",), [face]))
    assert distance[face] == 0 and (nearest == 0).all()
    other = face_near(body, [-0.09, 0.1, 0.05])
    # down one leg and up the other, not through the air
    assert distance[other] > 1.4


def test_findings_are_ready_for_json(pairs: Pairs, body: Mesh) -> None:
    found = check_coverage(without(pairs, "left_hand"), body, human_skeleton())
    table = json.loads(json.dumps([f.as_dict() for f in found]))
    assert table[0].keys() == {
        "kind",
        "severity",
        "place",
        "message",
        "advice",
        "faces",
        "first_face",
        "pairs",
    }


def test_pairs_that_do_not_fit_are_refused(body: Mesh) -> None:
    with pytest.raises(ValueError, match="but the target has"):
        check_coverage(Pairs("joints", ("a", "b"), [0, 10**7]), body)
