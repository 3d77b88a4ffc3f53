"""Joints end up inside; a skirt is told from four legs."""

from __future__ import annotations

import numpy as np
import pytest
from capsule_people import capsule
from numpy.testing import assert_array_equal

from tempose.embedding.cells import Cells, make_cells
from tempose.embedding.doubt import skirted, whole_penalty
from tempose.embedding.human import NAMES, PARENTS, joint_skeleton
from tempose.embedding.inside import pull_inside
from tempose.embedding.solid import make_solid
from tempose.kinematics import rest_transforms


def pill(unit: float = 1.0) -> Cells:
    """The inside of a capsule of radius 0.2 along Y from 0 to 1."""
    V, F = capsule(np.zeros(3), np.array([0, 1.0, 0]), 0.2)
    cells = make_cells(make_solid(unit * V, F), None)
    assert cells is not None
    return cells


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_joints_outside_come_in_and_the_others_stay(unit: float) -> None:
    cells = pill(unit)
    joints = np.tile([0.0, 0.5, 0.0], (18, 1)) * unit
    joints[3] = np.array([0.5, 0.6, 0.0]) * unit
    joints[NAMES.index("left_toes")] = np.array([0.0, -0.3, 0.0]) * unit
    moved = pull_inside(cells, joints, 1.7 * unit)
    others = [j for j in range(18) if j not in (3, NAMES.index("left_toes"))]
    assert_array_equal(moved[others], joints[others])
    depth = cells.solid.depth_at(moved)
    cell = cells.solid.spacing
    assert (
        depth[3] > 0.012 * 1.7 * unit - cell and depth[NAMES.index("left_toes")] > 0.004 * 1.7 * unit - cell
    )
    # to the nearest place: no further than the way to the surface and that depth
    assert np.linalg.norm(moved[3] - joints[3]) < 0.3 * unit + 0.012 * 1.7 * unit + 2 * cell


def test_in_a_body_too_slender_the_deepest_place_near_will_do() -> None:
    cells = pill()
    joints = np.tile([0.5, 0.5, 0.0], (18, 1))
    moved = pull_inside(cells, joints, 40.0)
    assert (cells.solid.depth_at(moved) > 0.15).all()


TERMS = dict.fromkeys(("head-hand", "hands", "hand-foot", "arms alike", "legs alike", "upright"), 0.4)


@pytest.mark.parametrize(
    ("feet", "crotch", "other", "answer"),
    [(-6.2, 3.8, 0.4, True), (-3.5, 4.3, 1.0, False), (-1.0, 3.8, 0.4, False), (-6.2, 1.0, 0.4, False)],
)
def test_legs_that_part_low_are_a_skirt_on_an_otherwise_human_body(
    feet: float, crotch: float, other: float, answer: bool
) -> None:
    terms = dict.fromkeys(TERMS, other) | {"feet": feet, "crotch": crotch}
    assert skirted(terms) is answer


def test_the_penalty_of_a_skirt_is_that_of_its_two_terms_held_at_two() -> None:
    class Leg:
        start = 0.515 + 4 * 0.035

    class Arm:
        start = 0.265

    class Ends:
        size = 1.0
        terms = TERMS | {"feet": -6.0}

    class Limbs:
        legs, arms, pit = (Leg, Leg), (Arm, Arm), 0.265

    penalty, terms = whole_penalty(Ends, Limbs)  # type: ignore[arg-type]
    assert terms["crotch"] == pytest.approx(4.0) and terms["feet"] == -6.0
    expected = np.sqrt((6 * 0.4**2 + 2 * 2.0**2) / 9) / 1.45
    assert penalty == pytest.approx(expected)


def test_the_skeleton_of_18_joints_lies_where_they_are(rng: np.random.Generator) -> None:
    joints = rng.normal(size=(18, 3))
    skeleton = joint_skeleton(joints, {"head": joints[3] + [0, 0.2, 0]})
    np.testing.assert_allclose(rest_transforms(skeleton)[1], joints, atol=1e-14)
    assert skeleton.names == NAMES and tuple(skeleton.parents) == PARENTS
    assert skeleton.tips is not None
    np.testing.assert_allclose(skeleton.tips[3], [0, 0.2, 0], atol=1e-14)
    assert np.isnan(skeleton.tips[0]).all()
