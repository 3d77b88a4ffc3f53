"""Without pairs and weights a body moves by the skeleton placed inside it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation
from transfer_bodies import clip_of, human_body, t_pose
from transfer_zoo import tube

from tempose.clips import Mesh, Skeleton, SkeletonClip, SkinnedMesh, Source
from tempose.embedding import Embedding, embed_dressed, embed_skin
from tempose.kinematics import rest_transforms
from tempose.samples.walk import walk
from tempose.transfer import (
    TransferResult,
    load_pairs,
    save_pairs,
    transfer_motion,
)
from tempose.transfer.pairing import embedded_pairs


@lru_cache
def walking() -> SkeletonClip:
    return walk(t_pose(), duration=0.6, fps=20.0)


@lru_cache
def embedded() -> tuple[SkinnedMesh, Embedding]:
    return embed_skin(human_body().mesh)


@lru_cache
def walked() -> TransferResult:
    return transfer_motion(walking(), human_body().mesh)


def placed(result: TransferResult) -> np.ndarray:
    V = np.asarray(result.clip.vertices, dtype=np.float64)
    return V - V.mean(axis=(0, 1)) * [1, 0, 1]


def test_a_bare_mesh_walks_as_well_as_one_with_weights() -> None:
    bare, skinned = walked().report, transfer_motion(walking(), human_body()).report
    assert bare["bone_direction_deg"]["mean"] < skinned["bone_direction_deg"]["mean"] + 2
    assert bare["flipped_percent"] == 0 and bare["quaternion_norm_min"] > 0.85
    assert bare["warnings"] == []
    assert bare["pairs"]["origin"] == "a skeleton placed inside the target"
    assert bare["embedding"]["penalty"] < 1 and not bare["embedding"]["doubtful"]
    assert "embedding" not in skinned


def test_joints_are_found_near_the_true_ones() -> None:
    skeleton, joints = human_body().skeleton, walked().pairs.joints
    true = rest_transforms(skeleton)[1]
    limbs = [n for n in joints if n.split("_")[-1] in ("arm", "forearm", "hand", "thigh", "shin", "foot")]
    assert len(limbs) == 12
    away = [np.linalg.norm(joints[name] - true[skeleton.index(name)]) for name in limbs]
    assert np.median(away) < 0.03 * human_body().mesh.height
    assert max(away) < 0.07 * human_body().mesh.height


def test_every_part_of_the_body_is_marked() -> None:
    """Pelvis and ribs too, which to heat are short bones between strong neighbours."""
    pairs = walked().pairs
    assert set(pairs.source) == set(walking().skeleton.names)
    assert all(list(pairs.source).count(name) >= 4 for name in ("hips", "spine", "chest"))
    skin = embedded_pairs._slab_trunk(embedded()[0])
    assert_allclose(skin.weights.sum(axis=1), 1, atol=1e-9)
    assert skin.weights.min() >= 0
    hips = skin.weights[:, skin.skeleton.index("hips")]
    height = human_body().mesh.vertices[hips > 0.5][:, 1]
    joints = rest_transforms(skin.skeleton)[1][:, 1]
    assert height.min() > joints[skin.skeleton.index("left_shin")]
    assert height.max() < joints[skin.skeleton.index("chest")]


def test_skin_weights_are_left_alone_on_request() -> None:
    asked = transfer_motion(walking(), human_body(), embed=True, measure=False)
    assert_array_equal(asked.clip.vertices, walked().clip.vertices)


@pytest.mark.parametrize(
    ("euler", "unit", "up"),
    [
        ((90, 0, 30), 100.0, "z"),
        ((180, 35, 0), 1.0, "y"),
        pytest.param((0, 90, 0), 1.0, "y", marks=pytest.mark.slow),
        pytest.param((0, 0, -90), 0.01, "x", marks=pytest.mark.slow),
    ],
)
def test_axes_heading_and_size_of_the_target_do_not_matter(
    euler: tuple[float, float, float], unit: float, up: str
) -> None:
    R = Rotation.from_euler("xyz", euler, degrees=True).as_matrix()
    mesh = human_body().mesh
    other = Mesh(unit * mesh.vertices @ R.T, mesh.faces, source=Source(guessed=("up", "unit")))
    result = transfer_motion(walking(), other, measure=False)
    assert result.clip.source.up == up
    size = result.clip.mesh.height / mesh.height
    # the body is sampled by another grid, so its joints are found a little elsewhere
    apart = np.linalg.norm(placed(result) / size - placed(walked()), axis=2)
    assert np.sqrt((apart**2).mean()) < 0.02 * mesh.height


def test_pairs_come_back_from_a_file_as_they_were(tmp_path) -> None:
    save_pairs(tmp_path / "pairs.json", walked().pairs)
    again = transfer_motion(walking(), human_body().mesh, load_pairs(tmp_path / "pairs.json"), measure=False)
    assert_array_equal(again.clip.vertices, walked().clip.vertices)


def skirted(body: Mesh) -> Mesh:
    """The body and a closed bell round its legs, which makes them one."""
    angle = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    bell = ((0.95, 0.0), (0.95, 0.2), (0.6, 0.3), (0.25, 0.4), (0.05, 0.45), (0.05, 0.0))
    rings = [np.c_[r * np.sin(angle), np.full(24, y), r * np.cos(angle)] for y, r in bell]
    k, after = np.arange(24), (np.arange(24) + 1) % 24
    F = [np.c_[k, 24 + k, after] + 24 * r for r in range(5)]
    F += [np.c_[after, 24 + k, 24 + after] + 24 * r for r in range(5)]
    n = len(body.vertices)
    return Mesh(np.concatenate([body.vertices, *rings]), np.concatenate([body.faces, n + np.concatenate(F)]))


@pytest.mark.slow
def test_a_skirt_does_not_hide_the_body_beneath() -> None:
    dressed = skirted(human_body().mesh)
    assert embed_skin(dressed)[1].doubtful
    skin, embedding = embed_dressed(dressed)
    assert not embedding.doubtful
    assert_allclose(embedding.joints, embedded()[1].joints, rtol=0, atol=1e-9)
    assert_allclose(skin.weights.sum(axis=1), 1, atol=1e-9)
    assert len(skin.weights) == len(dressed.vertices)


@pytest.mark.slow
def test_what_is_no_human_is_refused_by_its_measure() -> None:
    with pytest.raises(ValueError, match=r"does not look human: .* penalty \d") as caught:
        transfer_motion(walking(), tube())
    assert "--pairs" in str(caught.value) and "\n" not in str(caught.value)


def test_a_source_that_is_no_human_is_refused() -> None:
    odd = Skeleton(("a", "b"), [-1, 0], [[0, 0, 0], [0, 1.0, 0]])
    with pytest.raises(ValueError, match=r"human's skeleton; of the source's joints \(a, b\) 0 are known"):
        transfer_motion(clip_of(odd, {}, 2), human_body().mesh)


def test_doubt_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    skin, embedding = embedded()
    doubtful = replace(embedding, penalty=1.3, reasons=("hands not found",))
    monkeypatch.setattr(embedded_pairs, "embed_dressed", lambda mesh: (skin, doubtful))
    report = transfer_motion(walking(), human_body().mesh, measure=False).report
    assert "hands not found" in report["warnings"][0] and "--pairs" in report["warnings"][0]
    assert report["embedding"]["doubtful"] and report["embedding"]["reasons"] == ["hands not found"]
    monkeypatch.setattr(embedded_pairs, "embed_dressed", lambda mesh: (skin, replace(doubtful, penalty=3.0)))
    with pytest.raises(ValueError, match=r"penalty 3\.0.*hands not found"):
        transfer_motion(walking(), human_body().mesh)


def test_a_skin_whose_joints_have_no_names_is_looked_into() -> None:
    body = human_body()
    s = body.skeleton
    blank = tuple(f"joint_{k}" for k in range(s.n_joints))
    odd = SkinnedMesh(
        body.mesh, Skeleton(blank, s.parents, s.offsets, s.rest_rotations, s.tips), body.weights
    )
    result = transfer_motion(walking(), odd, measure=False)
    assert_array_equal(result.clip.vertices, walked().clip.vertices)
    assert "not known by their names" in result.report["warnings"][0]
