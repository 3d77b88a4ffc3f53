"""A rig as a file: the same to the last bit, and nothing else is taken for one."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from rig_bodies import human_skin, random_rig

from tempose.clips import SkinnedMesh, Source
from tempose.models import load_model, save_model
from tempose.rigging import Rig


def full_rig() -> Rig:
    skin = human_skin()
    mesh = replace(
        skin.mesh,
        groups={"b": np.array([3, 5]), "a": np.array([1])},
        colors=np.full((len(skin.mesh.vertices), 3), 0.25),
        name="Ann",
        source=Source("ann.obj", "obj", "z", 0.01, guessed=("unit",), notes=("two shells",)),
    )
    rig = random_rig(SkinnedMesh(mesh, skin.skeleton, skin.weights))
    motion = replace(rig.motion, name="walk", source=Source("walk.bvh", "bvh"))
    return Rig(
        rig.skin, motion, "dual-quaternion", {"errors": {"rms": 0.1}, "warnings": ["a"], "list": [1, 2]}
    )


def same(a: Any, b: Any) -> None:
    """Compare frozen data field by field."""
    assert type(a) is type(b)
    for field in fields(a):
        one, other = getattr(a, field.name), getattr(b, field.name)
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype
            assert_array_equal(one, other)
        elif field.name == "groups":
            assert list(one) == list(other)
            for name in one:
                assert_array_equal(one[name], other[name])
        elif hasattr(one, "__dataclass_fields__"):
            same(one, other)
        else:
            assert one == other


def test_a_rig_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    rig = full_rig()
    back = Rig.load(rig.save(tmp_path / "rig.tempose"))
    same(rig.skin, back.skin)
    same(rig.motion, back.motion)
    assert back.blending == "dual-quaternion" and dict(back.report) == dict(rig.report)
    assert_array_equal(back.vertices(), rig.vertices())


def test_a_motion_of_other_bone_lengths_keeps_them(tmp_path: Path) -> None:
    rig = full_rig()
    longer = replace(rig.motion.skeleton, offsets=1.5 * rig.motion.skeleton.offsets)
    rig = replace(rig, motion=replace(rig.motion, skeleton=longer))
    back = Rig.load(rig.save(tmp_path / "rig.tempose"))
    assert_array_equal(back.motion.skeleton.offsets, longer.offsets)
    assert_array_equal(back.vertices(), rig.vertices())


def test_zeros_among_the_weights_cost_nothing(tmp_path: Path) -> None:
    rig = random_rig(human_skin(), 1)
    path = rig.save(tmp_path / "rig.tempose")
    dense = rig.skin.weights.nbytes
    assert path.stat().st_size < 0.7 * dense + rig.skin.mesh.vertices.nbytes + rig.skin.mesh.faces.nbytes


def test_missing_broken_and_foreign_files_are_refused(tmp_path: Path) -> None:
    path = full_rig().save(tmp_path / "rig.tempose")
    with pytest.raises(FileNotFoundError, match="no such file"):
        Rig.load(tmp_path / "none.tempose")
    (tmp_path / "cut.tempose").write_bytes(path.read_bytes()[:-100])
    with pytest.raises(ValueError, match="cut short"):
        Rig.load(tmp_path / "cut.tempose")
    other = save_model(tmp_path / "other.tempose", "signals", {"x": np.zeros(3)}, {})
    with pytest.raises(ValueError, match="kind 'signals', expected 'rig'"):
        Rig.load(other)


@pytest.mark.parametrize(
    ("name", "change", "message"),
    [
        ("weights/counts", lambda a: a + 1, "weights/counts must sum to"),
        ("weights/joints", lambda a: a + 100, "below 21"),
        ("weights/values", lambda a: 2 * a, "sum to 1"),
        ("mesh/faces", lambda a: a + 10**6, "faces must hold indices"),
        ("motion/rotations", lambda a: 3 * a, "unit quaternions"),
        ("skeleton/parents", lambda a: a * 0, "parents must come before"),
        ("mesh/vertices", None, "mesh/vertices"),
    ],
)
def test_parts_that_do_not_fit_are_refused(name: str, change: Any, message: str, tmp_path: Path) -> None:
    path = full_rig().save(tmp_path / "rig.tempose")
    arrays, header = load_model(path, "rig")
    if change is None:
        del arrays[name]
    else:
        arrays[name] = change(arrays[name])
    broken = save_model(tmp_path / "broken.tempose", "rig", arrays, header)
    with pytest.raises(ValueError, match=f"broken.tempose: a rig whose parts do not fit together.*{message}"):
        Rig.load(broken)
