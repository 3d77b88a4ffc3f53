"""Frozen data stays frozen, and each field is checked: what is refused, what is accepted."""

from __future__ import annotations

import copy
import pickle
from dataclasses import FrozenInstanceError, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tempose.clips import MarkerClip, Mesh, MeshClip, Skeleton, SkeletonClip, SkinnedMesh, Source

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])
IDENTITY = np.array([1.0, 0, 0, 0])


def mesh(**changed: Any) -> Mesh:
    given: dict[str, Any] = {
        "vertices": SQUARE,
        "faces": FACES,
        "uv": np.zeros((5, 2)),
        "uv_faces": np.array([[0, 1, 2], [0, 2, 4]]),
        "colors": np.ones((4, 3)),
        "groups": {"lower": [0], "both": [0, 1]},
        "polygons": [4],
        "name": "square",
        "source": Source(path="a.obj", up="z"),
    }
    return Mesh(**(given | changed))


def mesh_clip(**changed: Any) -> MeshClip:
    given: dict[str, Any] = {"vertices": np.zeros((3, 4, 3), dtype=np.float32), "mesh": mesh(), "fps": 24}
    return MeshClip(**(given | changed))


def skeleton(**changed: Any) -> Skeleton:
    given: dict[str, Any] = {
        "names": ("root", "arm", "hand"),
        "parents": [-1, 0, 1],
        "offsets": np.eye(3),
        "rest_rotations": np.tile(IDENTITY, (3, 1)),
        "tips": [[np.nan] * 3, [np.nan] * 3, [0, 1, 0]],
    }
    return Skeleton(**(given | changed))


def skeleton_clip(**changed: Any) -> SkeletonClip:
    given: dict[str, Any] = {
        "skeleton": skeleton(),
        "rotations": np.tile(IDENTITY, (5, 3, 1)),
        "root_position": np.arange(15.0).reshape(5, 3),
        "fps": 120,
    }
    return SkeletonClip(**(given | changed))


def skinned_mesh(**changed: Any) -> SkinnedMesh:
    given: dict[str, Any] = {
        "mesh": mesh(),
        "skeleton": skeleton(),
        "weights": [[1, 0, 0], [0.5, 0.5, 0], [0, 0.25, 0.75], [0, 0, 0]],
    }
    return SkinnedMesh(**(given | changed))


def marker_clip(**changed: Any) -> MarkerClip:
    positions = np.zeros((3, 2, 3))
    positions[1, 1] = np.nan
    given: dict[str, Any] = {"labels": ("a", "b"), "positions": positions, "fps": 100}
    return MarkerClip(**(given | changed))


MAKERS = [mesh, mesh_clip, skeleton, skeleton_clip, skinned_mesh, marker_clip]
makers = pytest.mark.parametrize("make", MAKERS, ids=lambda make: make.__name__)


def arrays(data: Any) -> list[np.ndarray]:
    values = [getattr(data, field.name) for field in fields(data)]
    values += list(data.groups.values()) if isinstance(data, Mesh) else []
    return [value for value in values if isinstance(value, np.ndarray)]


@makers
def test_arrays_are_read_only_and_fields_cannot_be_set(make) -> None:
    data = make()
    assert arrays(data)
    for array in arrays(data):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    for field in fields(data):
        with pytest.raises(FrozenInstanceError):
            setattr(data, field.name, None)


def test_groups_are_read_only() -> None:
    with pytest.raises(TypeError):
        mesh().groups["new"] = np.zeros(0)  # type: ignore[index]


@makers
@pytest.mark.parametrize("via", [copy.copy, copy.deepcopy, lambda d: pickle.loads(pickle.dumps(d)), replace])
def test_copies_hold_the_same_and_are_frozen_too(make, via) -> None:
    data, other = make(), via(make())
    assert type(other) is type(data)
    for mine, theirs in zip(arrays(data), arrays(other), strict=True):
        assert_array_equal(theirs, mine, strict=True)
        assert not theirs.flags.writeable
    for field in fields(data):
        if isinstance(getattr(data, field.name), str | float | tuple | Source):
            assert getattr(other, field.name) == getattr(data, field.name)


def refused(make, message: str, **changed: Any) -> None:
    make()
    with pytest.raises(ValueError, match=message):
        make(**changed)


def nan_at(array: np.ndarray, *index: int) -> np.ndarray:
    array = np.array(array, dtype=float)
    array[index] = np.nan
    return array


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"vertices": SQUARE[:, :2]}, r"vertices must have shape \(n, 3\), got \(4, 2\)"),
        ({"vertices": nan_at(SQUARE, 2, 1)}, r"vertices must be finite, got nan at index \(2, 1\)"),
        ({"faces": [[0, 1, 4], [0, 1, 2]]}, "faces must hold indices from 0 and below 4, got 4"),
        ({"faces": [[0.0, 1.0, 2.0]]}, "faces must hold integers"),
        ({"uv": np.zeros((5, 3))}, r"uv must have shape \(k, 2\), got \(5, 3\)"),
        ({"uv_faces": None}, r"uv must have shape \(4, 2\), got \(5, 2\)"),
        ({"uv": None}, "uv_faces needs uv, got None"),
        ({"uv_faces": [[0, 1, 5], [0, 1, 2]]}, "uv_faces must hold indices from 0 and below 5, got 5"),
        ({"uv_faces": [[0, 1, 2]]}, r"uv_faces must have shape \(2, 3\), got \(1, 3\)"),
        ({"colors": np.ones((5, 3))}, r"colors must have shape \(4, 3\), got \(5, 3\)"),
        ({"groups": {"arm": [2]}}, r"groups\['arm'\] must hold indices from 0 and below 2, got 2"),
        ({"polygons": [3]}, "polygons must be corner counts >= 3 that fan into 2 triangles, got 1"),
        ({"polygons": [2, 4]}, "polygons must be corner counts >= 3"),
    ],
)
def test_a_mesh_is_checked(changed: dict[str, Any], message: str) -> None:
    refused(mesh, message, **changed)


@pytest.mark.parametrize(
    "changed",
    [
        {"uv": None, "uv_faces": None},
        {"uv": np.zeros((4, 2)), "uv_faces": None},
        {"polygons": [3, 3]},
        {"groups": {}},
        {"groups": {"none": []}},
        {"colors": None},
    ],
)
def test_a_mesh_may_lack_or_vary_its_attributes(changed: dict[str, Any]) -> None:
    mesh(**changed)


def test_a_mesh_has_integer_faces_in_32_bit_and_double_vertices() -> None:
    data = mesh(vertices=SQUARE.astype(np.float32), faces=FACES.astype(np.int64))
    assert data.vertices.dtype == np.float64
    assert data.faces.dtype == data.groups["both"].dtype == np.int32


def test_size_of_a_mesh() -> None:
    assert mesh().height == 2
    assert mesh().diagonal == pytest.approx(np.sqrt(5))
    nothing = Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int))
    assert (nothing.height, nothing.diagonal) == (0, 0)


def test_other_vertices_share_everything_else() -> None:
    data = mesh()
    moved = data.with_vertices(SQUARE + 1)
    assert_array_equal(moved.vertices, SQUARE + 1)
    assert np.shares_memory(moved.faces, data.faces)
    assert moved.name == "square" and moved.source == data.source and list(moved.groups) == ["lower", "both"]
    with pytest.raises(ValueError, match="faces must hold indices"):
        data.with_vertices(SQUARE[:3])


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"vertices": np.zeros((3, 5, 3))}, r"vertices must have shape \(T, 4, 3\), got \(3, 5, 3\)"),
        ({"vertices": np.zeros((4, 3))}, r"vertices must have shape \(T, 4, 3\), got \(4, 3\)"),
        ({"vertices": nan_at(np.zeros((3, 4, 3)), 2, 0, 0)}, "vertices must be finite, .* in frame 2"),
        ({"fps": 0}, "fps must be positive, got 0"),
        ({"fps": np.nan}, "fps must be positive, got nan"),
        ({"fps": np.inf}, "fps must be positive, got inf"),
        ({"fps": -30}, "fps must be positive, got -30"),
    ],
)
def test_a_mesh_clip_is_checked(changed: dict[str, Any], message: str) -> None:
    refused(mesh_clip, message, **changed)


@pytest.mark.parametrize(("T", "seconds"), [(0, 0), (1, 0), (2, 1 / 24), (49, 2)])
def test_times_of_a_mesh_clip(T: int, seconds: float) -> None:
    clip = mesh_clip(vertices=np.zeros((T, 4, 3)))
    assert clip.n_frames == len(clip.times) == T
    assert clip.duration == pytest.approx(seconds)
    if T:
        assert (clip.times[0], clip.times[-1]) == (0, pytest.approx(seconds))


def test_a_mesh_clip_is_float32_over_one_mesh() -> None:
    clip = mesh_clip(vertices=np.zeros((3, 4, 3)))
    assert clip.vertices.dtype == np.float32
    assert clip.faces is clip.mesh.faces and clip.rest is clip.mesh.vertices and clip.name == "square"


def test_a_memory_map_stays_on_disk(tmp_path: Path) -> None:
    np.save(tmp_path / "V.npy", np.ones((3, 4, 3), dtype=np.float32))
    clip = mesh_clip(vertices=np.load(tmp_path / "V.npy", mmap_mode="r"))
    assert isinstance(clip.vertices, np.memmap)
    assert not clip.vertices.flags.writeable


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"names": ()}, "names must hold at least one joint"),
        ({"names": ("root", "arm", "arm")}, "names must be distinct, got 'arm' twice"),
        ({"parents": [-1, 0]}, r"parents must be integers of shape \(3,\), got int64 of shape \(2,\)"),
        ({"parents": [-1, 0.5, 1]}, r"parents must be integers of shape \(3,\), got float64"),
        ({"parents": [0, 0, 1]}, "parents must come before their children, with joint 0 the only root"),
        ({"parents": [-1, -1, 1]}, "joint 0 the only root"),
        ({"parents": [-1, 2, 0]}, "parents must come before their children"),
        ({"parents": [-1, 0, 2]}, "parents must come before their children"),
        ({"offsets": np.eye(3)[:2]}, r"offsets must have shape \(3, 3\), got \(2, 3\)"),
        ({"offsets": nan_at(np.eye(3), 0, 0)}, "offsets must be finite"),
        ({"rest_rotations": np.tile(IDENTITY, (2, 1))}, r"rest_rotations must have shape \(3, 4\)"),
        (
            {"rest_rotations": np.array([IDENTITY, 2 * IDENTITY, IDENTITY])},
            "rest_rotations must be unit quaternions, got norm 2 at joint 'arm'",
        ),
        ({"tips": np.zeros((2, 3))}, r"tips must have shape \(3, 3\), got \(2, 3\)"),
        ({"tips": np.full((3, 3), np.inf)}, r"tips must be finite or NaN \(unknown\), found infinity"),
    ],
)
def test_a_skeleton_is_checked(changed: dict[str, Any], message: str) -> None:
    refused(skeleton, message, **changed)


def test_a_skeleton_fills_in_what_is_not_given() -> None:
    bare = Skeleton(("root",), [-1], [[0, 0, 0]])  # type: ignore[arg-type]
    assert_array_equal(bare.rest_rotations, [IDENTITY])
    assert np.isnan(bare.tips).all()  # type: ignore[arg-type]
    assert bare.n_joints == 1


def test_joints_are_found_by_name_and_by_parent() -> None:
    tree = skeleton(names=("root", "left", "right"), parents=[-1, 0, 0])
    assert tree.index("right") == 2
    assert_array_equal(tree.children(0), [1, 2])
    assert_array_equal(tree.children(2), [])
    with pytest.raises(ValueError, match="no joint named 'tail'; the skeleton has root, left, right"):
        tree.index("tail")


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"rotations": np.tile(IDENTITY, (5, 2, 1))},
            r"rotations must have shape \(T, 3, 4\), got \(5, 2, 4\)",
        ),
        (
            {"rotations": np.zeros((5, 3, 4))},
            "rotations must be unit quaternions, got norm 0 at frame 0, joint 'root'",
        ),
        ({"rotations": nan_at(np.tile(IDENTITY, (5, 3, 1)), 1, 1, 1)}, "rotations must be finite"),
        ({"root_position": np.zeros((4, 3))}, r"root_position must have shape \(5, 3\), got \(4, 3\)"),
        ({"root_position": np.full((5, 3), np.inf)}, "root_position must be finite"),
        ({"fps": 0}, "fps must be positive, got 0"),
    ],
)
def test_a_skeleton_clip_is_checked(changed: dict[str, Any], message: str) -> None:
    refused(skeleton_clip, message, **changed)


def test_the_worst_quaternion_is_named() -> None:
    rotations = np.tile(IDENTITY, (5, 3, 1))
    rotations[2, 1] *= 1.01
    rotations[3, 2] *= 1.1
    refused(skeleton_clip, "got norm 1.1 at frame 3, joint 'hand'", rotations=rotations)
    rotations = np.tile(IDENTITY, (5, 3, 1)) * (1 + 5e-4)
    assert_array_equal(skeleton_clip(rotations=rotations).rotations, rotations)


@pytest.mark.parametrize(
    ("index", "kept", "fps"),
    [
        (slice(1, 3), [1, 2], 120),
        (slice(None, None, 2), [0, 2, 4], 60),
        (slice(None, None, -1), [4, 3, 2, 1, 0], 120),
        (slice(9, None), [], 120),
        (np.array([4, 0]), [4, 0], 120),
    ],
)
def test_frames_of_a_skeleton_clip(index, kept: list[int], fps: float) -> None:
    part = skeleton_clip(name="walk", source=Source(path="a.bvh")).frames(index)
    assert_array_equal(part.root_position[:, 0], 3.0 * np.array(kept))
    assert (part.fps, part.name, part.source.path, part.n_frames) == (fps, "walk", "a.bvh", len(kept))
    assert_array_equal(part.times, np.arange(len(kept)) / fps)


@pytest.mark.parametrize(
    ("weights", "message"),
    [
        (np.ones((3, 3)) / 3, r"weights must have shape \(4, 3\), got \(3, 3\)"),
        (np.full((4, 3), 0.5), "weights must be >= 0 and sum to 1 .*, got sum 1.5 at vertex 0"),
        ([[1, 0, 0]] * 3 + [[2, -1, 0]], "weights must be >= 0 and sum to 1 .* at vertex 3"),
        (np.full((4, 3), np.nan), "weights must be finite"),
    ],
)
def test_a_skinned_mesh_is_checked(weights, message: str) -> None:
    refused(skinned_mesh, message, weights=weights)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"labels": ("a",)}, r"positions must have shape \(T, 1, 3\), got \(3, 2, 3\)"),
        ({"positions": np.full((3, 2, 3), np.inf)}, "positions must be finite or NaN"),
        ({"positions": np.zeros((3, 2))}, r"positions must have shape \(T, 2, 3\)"),
        ({"fps": -1}, "fps must be positive, got -1"),
    ],
)
def test_a_marker_clip_is_checked(changed: dict[str, Any], message: str) -> None:
    refused(marker_clip, message, **changed)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"up": "Y"}, "up must be 'x', 'y' or 'z', got 'Y'"),
        ({"unit": 0}, "unit must be a positive number of metres, got 0"),
        ({"unit": np.nan}, "unit must be a positive number"),
        ({"fps": 0}, "fps must be positive, got 0"),
    ],
)
def test_a_source_is_checked(changed: dict[str, Any], message: str) -> None:
    refused(Source, message, **changed)


@pytest.mark.parametrize("T", [0, 1])
def test_empty_clips_and_clips_of_one_frame_are_clips(T: int) -> None:
    assert mesh_clip(vertices=np.zeros((T, 4, 3))).n_frames == T
    assert marker_clip(positions=np.zeros((T, 2, 3))).positions.shape == (T, 2, 3)
    clip = skeleton_clip(rotations=np.tile(IDENTITY, (T, 3, 1)), root_position=np.zeros((T, 3)))
    assert len(clip.times) == clip.n_frames == T
