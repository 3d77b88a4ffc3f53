"""Pairs: what fits is taken as it is, what does not is refused with its place named."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tempose.transfer import Pairs

JOINTS = ("Hips", "Spine", "Head")


def of_vertices(source: object = (4, 7, 2), target: object = (9, 0, 5), **more: object) -> Pairs:
    return Pairs("vertices", np.array(source), np.array(target), **more)  # type: ignore[arg-type]


def of_joints(source: tuple[str, ...] = ("Hips", "Head", "Hips"), target: object = (3, 1, 2)) -> Pairs:
    return Pairs("joints", source, np.array(target))


def test_pairs_hold_what_they_were_given() -> None:
    pairs = of_vertices(parts=("leg", "leg", "ear"), origin="a.json")
    assert_array_equal(pairs.source, [4, 7, 2])
    assert_array_equal(pairs.target, [9, 0, 5])
    assert len(pairs) == 3 and pairs.parts == ("leg", "leg", "ear")
    pairs.check(8, 10)
    joints = Pairs("joints", ["Hips", "Head"], [1, 0], joints={"Hips": [0, 1, 2]}, ends={"Head": (3, 4, 5)})
    assert joints.source == ("Hips", "Head")
    assert_array_equal(joints.joints["Hips"], [0, 1, 2])
    assert_array_equal(joints.ends["Head"], [3, 4, 5])
    joints.check(0, 2, JOINTS)


def test_pairs_cannot_be_changed() -> None:
    pairs = of_vertices()
    for array in (pairs.source, pairs.target):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1  # type: ignore[index]


def test_the_callers_arrays_stay_writeable() -> None:
    source, target = np.array([1, 2, 3]), np.array([4, 5, 6])
    Pairs("faces", source, target)
    source[0], target[0] = 7, 7


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"kind": "edges"}, r"kind of pairs must be one of joints, faces, vertices, got 'edges'"),
        ({"target": [0.5, 1, 2]}, r"target of pairs must hold integers"),
        ({"target": [0, -1, 2]}, r"target of pairs must hold indices .* got -1 at index \(1,\)"),
        ({"target": [[0, 1, 2]]}, r"target of pairs must have shape \(k,\), got \(1, 3\)"),
        ({"source": [0, 1, 2**40]}, r"source of pairs must hold indices"),
        ({"source": [1, 2]}, r"as many sources as targets, got 2 and 3"),
        ({"parts": ("a",)}, r"part must name every one of the 3 pairs, got 1"),
        ({"joints": {"Hips": [1, 2]}}, r"joints\['Hips'\] must have shape \(3,\), got \(2,\)"),
        ({"ends": {"Hips": [1, 2, np.nan]}}, r"ends\['Hips'\] must be finite"),
    ],
)
def test_what_is_no_list_of_pairs_is_refused(fields: dict[str, object], message: str) -> None:
    good = {"kind": "vertices", "source": [0, 1, 2], "target": [3, 4, 5]}
    Pairs(**good)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=message):
        Pairs(**(good | fields))  # type: ignore[arg-type]


def test_a_target_that_does_not_exist_is_named() -> None:
    of_vertices().check(100, 10)
    with pytest.raises(ValueError, match=r"pair 0 names target vertex 9, but the target has 9 \(0 to 8\)"):
        of_vertices().check(100, 9)
    faces = Pairs("faces", [0, 1, 2], [0, 1, 12], origin="mine.json")
    message = "pair 2 in mine.json names target triangle 12, but the target has 12 (0 to 11)"
    with pytest.raises(ValueError, match=re.escape(message)):
        faces.check(3, 12)


def test_a_source_that_does_not_exist_is_named() -> None:
    with pytest.raises(ValueError, match=r"pair 1 names source vertex 7, but the source has 7 \(0 to 6\)"):
        of_vertices().check(7, 100)
    of_joints().check(0, 4, JOINTS)
    with pytest.raises(ValueError, match=r"pair 1 names joint 'Head', .* it has Hips, Spine"):
        of_joints().check(0, 4, ("Hips", "Spine"))


def test_a_target_named_twice_is_named_with_its_second_place() -> None:
    with pytest.raises(ValueError, match=r"pair 2 names target vertex 9 a second time"):
        of_vertices((1, 2, 3, 4), (9, 0, 9, 9)).check(10, 10)
    with pytest.raises(ValueError, match=r"pair 1 names target triangle 3 a second time"):
        of_joints(("Hips", "Head", "Hips"), (3, 3, 2)).check(0, 4, JOINTS)
    # one source may have many partners
    of_vertices((1, 1, 1), (9, 0, 5)).check(10, 10)


@pytest.mark.parametrize("kind", ["faces", "vertices"])
def test_fewer_than_three_pairs_are_too_few(kind: str) -> None:
    Pairs(kind, [0, 1, 2], [0, 1, 2]).check(3, 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=rf"pairs are too few: at least 3 pairs of {kind} are needed, got 2"):
        Pairs(kind, [0, 1], [0, 1]).check(3, 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"too few.* got 0"):
        Pairs(kind, np.zeros(0, int), np.zeros(0, int)).check(3, 3)  # type: ignore[arg-type]


def test_two_different_joints_are_the_least() -> None:
    of_joints(("Hips", "Head"), (0, 1)).check(0, 2, JOINTS)
    with pytest.raises(ValueError, match=r"at least 2 different joints are needed, got 1"):
        of_joints(("Hips", "Hips", "Hips"), (0, 1, 2)).check(0, 3, JOINTS)
