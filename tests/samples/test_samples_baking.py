"""Clips from nothing: skinned motion, with or without flesh, loops that close."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.kinematics.skinning import bake
from tempose.samples import CHARACTERS, MOTIONS, human_character, sample_clip

SMALL = {"triangles": 2000, "fps": 30.0}


def test_clip_without_secondary_motion_is_the_skinned_motion() -> None:
    clip = sample_clip("human", "jump", secondary=False, duration=1.0, **SMALL)
    skin = human_character(2000).skin
    motion = MOTIONS["human"]["jump"](skin.skeleton, fps=30.0, duration=1.0)
    assert_allclose(clip.vertices, bake(skin, motion), atol=1e-6)
    assert_allclose(clip.rest, skin.mesh.vertices)
    assert clip.fps == 30.0


def test_secondary_motion_moves_only_what_is_soft_and_is_scaled() -> None:
    still, soft, twice = (
        sample_clip("human", "run", secondary=amount, duration=0.7, **SMALL).vertices
        for amount in (False, True, 2.0)
    )
    regions = human_character(2000).regions
    hard = np.all([mask == 0 for mask in regions.values()], axis=0)
    assert np.array_equal(still[:, hard], soft[:, hard])
    assert_allclose(twice - still, 2 * (soft - still), atol=1e-5)
    for mask in regions.values():
        assert np.abs(soft - still)[:, mask > 0.5].max() > 0.01


@pytest.mark.parametrize("motion", ["walk", "run"])
def test_loop_closes_with_cloth_and_flesh(motion: str) -> None:
    one = sample_clip("human", motion, loop=True, duration=0.1, **SMALL)
    n = one.n_frames
    two = sample_clip("human", motion, loop=True, duration=2 * n / 30.0, **SMALL)
    assert two.n_frames == 2 * n
    advance = two.vertices[n:] - two.vertices[:n]
    assert np.ptp(advance, axis=(0, 1)).max() < 0.004
    assert_allclose(two.vertices[:n], one.vertices, atol=0.004)


def test_every_character_has_every_motion_it_is_listed_with() -> None:
    assert set(MOTIONS) == set(CHARACTERS)
    assert {"walk", "run", "jump", "turn"} <= set(MOTIONS["human"])
    assert {"walk", "gallop"} <= set(MOTIONS["animal"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("ghost", "walk"), "character must be one of human, animal"),
        (("animal", "fly"), "one of walk, gallop"),
    ],
)
def test_unknown_names_are_refused_with_the_known_ones(arguments: tuple[str, str], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sample_clip(*arguments)


def test_importing_the_package_does_not_import_the_sculptor() -> None:
    code = (
        "import sys, tempose.samples as s; assert 'numba' not in sys.modules; assert s.MOTIONS; s.sample_clip"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
