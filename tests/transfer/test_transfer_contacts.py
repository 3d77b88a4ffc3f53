"""Contacts without chatter, and those that the user states."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from tempose.metrics import detect_contacts
from tempose.transfer.feet.contacts import given_contacts, intervals, steady_contacts

FPS, HEIGHT = 60.0, 1.7
NAMES = ("left_foot", "right_foot")


def foot(down: list[tuple[int, int]], T: int = 120, lift: float = 0.3) -> np.ndarray:
    """A foot at height 0 in some frames and high above in all others; it never moves sideways."""
    y = np.full(T, lift)
    for first, stop in down:
        y[first:stop] = 0.0
    return np.stack([0 * y, y, 0 * y], axis=1)[:, None]


@given(st.lists(st.booleans(), max_size=40))
def test_intervals_say_what_the_mask_says(values: list[bool]) -> None:
    mask = np.array(values, dtype=bool)
    again = np.zeros_like(mask)
    for first, stop in intervals(mask):
        assert mask[first:stop].all() and first < stop
        assert first == 0 or not mask[first - 1]
        assert stop == len(mask) or not mask[stop]
        again[first:stop] = True
    assert_array_equal(again, mask)


def test_clean_contacts_are_those_of_the_detector() -> None:
    points = foot([(10, 40), (60, 100)])
    assert_array_equal(steady_contacts([points], HEIGHT, FPS), detect_contacts(points, HEIGHT, FPS))


def test_a_short_flicker_is_no_gap_and_no_contact() -> None:
    """Raised by 4 % of the height for three frames: above the threshold, below half as much again."""
    points = foot([(0, 120)])
    points[50:53, 0, 1] = 0.04 * HEIGHT
    slow = np.convolve(np.pad(points[:, 0, 1], 6, mode="edge"), np.ones(13) / 13, "valid")
    points[:, 0, 1] = slow + 0.018 * HEIGHT * (np.abs(np.arange(120) - 51) < 2)
    points[:, 0, 1] = np.where(np.abs(np.arange(120) - 51) < 2, 0.034 * HEIGHT, 0.029 * HEIGHT)
    points[:30, 0, 1] = 0.0
    raw = detect_contacts(points, HEIGHT, FPS)
    assert len(intervals(raw[:, 0])) > 1
    assert intervals(steady_contacts([points], HEIGHT, FPS)[40:, 0]) == [(0, 80)]
    blip = foot([(30, 60), (90, 92)])
    blip[80:100, 0, 1] = np.where(np.arange(80, 100) == 90, 0.02, 0.1)
    found = steady_contacts([blip], HEIGHT, FPS)
    assert not found[70:].any() and found[31:59].all()


def test_a_gap_with_the_foot_in_the_air_stays() -> None:
    points = foot([(0, 50), (54, 120)])
    found = intervals(steady_contacts([points], HEIGHT, FPS)[:, 0])
    assert len(found) == 2


def test_a_foot_stands_from_heel_strike_to_toe_off() -> None:
    ball, heel = foot([(30, 80)]), foot([(15, 60)])
    found = intervals(steady_contacts([ball, heel], HEIGHT, FPS)[:, 0])
    assert len(found) == 1
    assert found[0][0] <= 17 and found[0][1] >= 78


def test_no_feet_have_no_contacts() -> None:
    assert steady_contacts([np.zeros((5, 0, 3))], HEIGHT, FPS).shape == (5, 0)


def test_contacts_by_name_and_by_column() -> None:
    mask = given_contacts({"right_foot": [[0, 3], [5, 8]], "left_foot": []}, NAMES, 8)
    assert_array_equal(mask, np.column_stack([np.zeros(8, bool), np.r_[1, 1, 1, 0, 0, 1, 1, 1].astype(bool)]))
    assert_array_equal(given_contacts(mask, NAMES, 8), mask)
    assert_array_equal(given_contacts(mask, NAMES, 8, first_frame=2), mask[2:])


@pytest.mark.parametrize(
    ("contacts", "said"),
    [
        ({"tail": [[0, 2]]}, "name the foot 'tail'; known are left_foot, right_foot"),
        ({"left_foot": [[0, 9]]}, r"of left_foot must be intervals .* <= 8, got \[0, 9\]"),
        ({"left_foot": [[3, 3]]}, "0 <= first < stop"),
        ({"left_foot": [[-1, 3]]}, "0 <= first < stop"),
        ({"left_foot": [[0, 1.5]]}, "0 <= first < stop"),
        ({"left_foot": [4]}, "must be intervals"),
        ({"left_foot": [["0", "4"]]}, "must be intervals"),
        ({"left_foot": [[0, True]]}, "must be intervals"),
        (np.zeros((8, 3), dtype=bool), r"bool of shape \(8, 2\), one column each for left_foot, right_foot"),
        (np.zeros((8, 2)), "got float64 of shape"),
    ],
)
def test_contacts_that_make_no_sense_are_refused(contacts: object, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        given_contacts(contacts, NAMES, 8)  # type: ignore[arg-type]
