"""What a fit is told is checked before it begins, and a failed fit changes nothing."""

from __future__ import annotations

import numpy as np
import pytest
from model_clips import CORNERS, clip_of, repeating, swinging, wandering

from tempose.signals import SignalModel

BAD = [
    ({"k": 3}, "k must be a whole number from 4 to T . 2 .*, got 3"),
    ({"k": 15}, "k must be from 4 to 14 for a clip of 12 frames, got 15"),
    ({"k": 5.5}, "k must be a whole number"),
    ({"k": True}, "k must be a whole number"),
    ({"l": 2}, "l must be a whole number from 3 to T .*, got 2"),
    ({"l": 13}, "l must be from 3 to 12 for a clip of 12 frames, got 13"),
    ({"m": -1}, "m must be a whole number from 0 to T - 1 .*, got -1"),
    ({"m": 12}, "m must be from 0 to 11 for a clip of 12 frames, got 12"),
    ({"tolerance": 0}, "tolerance must be positive.*k = T \\+ 2, l = T and m = T - 1"),
    ({"tolerance": -1.0}, "tolerance must be positive"),
    ({"tolerance": np.nan}, "tolerance must be positive"),
    ({"tolerance": 1, "k": 5, "l": 5, "m": 5}, "not both"),
    ({"space": "verts"}, "space must be one of vertex, gradient"),
    ({"between": "cubic"}, "between must be one of path, paper, dense"),
    ({"layout": "pca"}, "layout must be one of auto, mds"),
    ({"period": 0}, "period must be"),
    ({"window": 3}, "window must be 16 frames or more"),
]
GOOD = [{"k": 4}, {"k": 14}, {"l": 3}, {"l": 12}, {"m": 0}, {"m": 11}, {"tolerance": 1e-6}, {"window": 16}]


@pytest.mark.parametrize(("options", "message"), BAD)
def test_options_out_of_range_are_refused_with_the_range(options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        SignalModel(**options).fit(wandering())  # type: ignore[arg-type]


@pytest.mark.parametrize("options", GOOD)
def test_options_at_the_ends_of_their_range_are_accepted(options: dict[str, object]) -> None:
    model = SignalModel(**options).fit(wandering())  # type: ignore[arg-type]
    for name in ("k", "l", "m"):
        if name in options and name != "m":
            assert model.report_[name] == (options[name] if model.report_["m"] else model.report_[name])
    assert np.isfinite(model.sample()).all()


def test_one_frame_is_refused() -> None:
    with pytest.raises(ValueError, match="needs 2 frames or more to become signals, got 1"):
        SignalModel().fit(clip_of(CORNERS[None]))


BAD_PINS = [
    ({12: (0, 0)}, "frames from 0 to 11, got 12"),
    ({-1: (0, 0)}, "frames from 0 to 11, got -1"),
    ({"a": (0, 0)}, "frames from 0 to 11, got 'a'"),
    ({0: (0, np.nan)}, r"pins\[0\] must be two finite numbers"),
    ({0: (1, 2, 3)}, r"pins\[0\] must be two finite numbers"),
    ({0: "ab"}, r"pins\[0\] must be two finite numbers"),
    ({0: (0, 0), 5: (1e9, 0)}, "pins lie 1e\\+09 apart"),
    ({0: (0, 0), 11: (0, 0)}, "pinned at one place"),
    ({i: (i, 0) for i in range(12)}, "on one line"),
]


@pytest.mark.parametrize(("pins", "message"), BAD_PINS)
def test_pins_that_cannot_be_are_refused(pins: dict[int, tuple[float, float]], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        SignalModel().fit(wandering(), pins=pins)


def test_pinned_frames_lie_where_they_were_pinned() -> None:
    pins = {0: (0.0, 0.0), 3: (1.0, 0.5), 7: (-0.5, 2.0)}
    model = SignalModel(k=14, l=12, m=11).fit(wandering(), pins=pins)
    for frame, place in pins.items():
        assert np.array_equal(model.positions_[frame], place)
    assert model.report_["paper"]["rms_percent"] < 1e-9


def test_a_few_pins_on_one_line_are_fine() -> None:
    model = SignalModel(k=14, l=12, m=11).fit(wandering(), pins={0: (0, 0), 1: (1, 0), 2: (2, 0)})
    assert model.report_["paper"]["rms_percent"] < 1e-9


def test_a_failed_fit_leaves_the_model_as_it_was() -> None:
    model = SignalModel().fit(swinging())
    before, report = model.sample(), model.report_
    model.m = 99
    with pytest.raises(ValueError, match="m must be from 0 to 11"):
        model.fit(wandering())
    assert model.report_ is report and np.array_equal(model.sample(), before)


def test_a_fit_that_is_cancelled_leaves_the_model_as_it_was() -> None:
    model = SignalModel().fit(swinging())
    before, seen = model.sample(), list[str]()

    def cancel(done: int, total: int, stage: str) -> None:
        seen.append(stage)
        if stage == "measuring errors":
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        model.fit(wandering(), progress=cancel)
    assert np.array_equal(model.sample(), before)
    assert [s for s in ("encode", "shape", "layout", "pose", "time") if s not in seen] == []


def test_a_model_that_was_not_fitted_says_so() -> None:
    for use in (lambda m: m(0.0), lambda m: m.sample(), lambda m: m.clip(), lambda m: m.pose_at((0, 0))):
        with pytest.raises(ValueError, match="no signals yet"):
            use(SignalModel())


def test_more_modes_than_the_clip_has_are_told() -> None:
    model = SignalModel(k=12, l=10, m=9).fit(repeating())
    assert model.report_["m"] == 4
    assert any("m 9 was asked for; the frames span 4 dimensions" in w for w in model.report_["warnings"])
