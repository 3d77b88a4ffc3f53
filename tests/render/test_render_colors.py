"""Colour conversions: the standard's fixed points, and ramps through their stops."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.render.colors import RAMPS, as_colors, ramp_colors, to_linear, to_srgb
from tempose.render.themes import rgb


def test_srgb_fixed_points():
    # IEC 61966-2-1: black and white stay; middle grey 0.5 is 0.2140 of the light.
    assert_allclose(to_linear(np.array([0.0, 0.5, 1.0])), [0.0, 0.21404114, 1.0], atol=1e-8)
    bytes_ = np.arange(256) / 255
    assert_allclose(to_srgb(to_linear(bytes_)), bytes_, atol=1e-12)
    assert_allclose(to_srgb(np.array([-1.0, 2.0])), [0.0, 1.0])


@pytest.mark.parametrize("ramp", RAMPS)
def test_ramps_pass_through_their_stops_and_stop_at_the_ends(ramp):
    stops = np.array([rgb(code) for code in RAMPS[ramp]])
    at = np.linspace(-3, 5, len(stops))
    assert_allclose(ramp_colors(at, -3, 5, ramp), stops, atol=1e-12)
    assert_allclose(ramp_colors([-9, 99], -3, 5, ramp), stops[[0, -1]])
    assert_allclose(ramp_colors([(at[0] + at[1]) / 2], -3, 5, ramp)[0], stops[:2].mean(axis=0))
    assert_allclose(ramp_colors([np.nan], -3, 5, ramp), 0.5)


def test_colours_of_any_form_agree():
    expected = np.tile([1.0, 0.0, 0.2], (3, 1))
    for value in ("#ff0033", [1.0, 0.0, 0.2], np.array([255, 0, 51], np.uint8), expected):
        assert_allclose(as_colors(value, "colors", 3), expected)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ramp_colors([1], 0, 1, "rainbow"), "ramp must be one of heat, time, time-dark, signed"),
        (lambda: ramp_colors([1], 1, 1), "from low to high"),
        (lambda: ramp_colors([1], 0, np.inf), "from low to high"),
        (lambda: rgb("#12345"), "'#rrggbb'"),
        (lambda: rgb("#12345g"), "'#rrggbb'"),
        (lambda: as_colors([0, 0, 1.5], "colors", 2), "colors must lie from 0 to 1"),
    ],
)
def test_wrong_colours_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
