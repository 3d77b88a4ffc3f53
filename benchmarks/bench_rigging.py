"""Rigging: poses from moments against Gauss-Newton on the vertices, skinning, cost by size, decomposition."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import rigging_decomposition
from meshes import bumpy_body
from tempose.clips import Skeleton, SkeletonClip, SkinnedMesh
from tempose.kinematics import (
    SkinKernel,
    bone_transforms,
    dual_quaternion_skinning,
    forward_kinematics,
    linear_blend_skinning,
)
from tempose.render.charts import line_chart
from tempose.rigging.pose_fit import fit_poses
from tempose.rigging.pose_fit.fit import fit_moments
from tempose.rigging.pose_fit.moments import SkinMoments
from tempose.rigging.skeletons.human import human_skin
from tempose.rotations import from_rotation_vector, multiply, to_matrix
from tempose.samples import human_character

FRAMES = 64
GALLERY = Path(__file__).resolve().parents[1] / "docs" / "gallery"


def interleaved(tasks: dict[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """Least processor seconds of each task, run in turn; one thread, so other work only adds a little."""
    for task in tasks.values():
        task()
    times: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(rounds):
        for name, task in tasks.items():
            start = time.process_time()
            task()
            times[name].append(time.process_time() - start)
    return {name: min(values) for name, values in times.items()}


def motion_of(skeleton: Skeleton, frames: int, size: float = 0.35) -> SkeletonClip:
    """A smooth motion of all joints, some of it fast."""
    rng = np.random.default_rng(0)
    J = skeleton.n_joints
    t = np.arange(frames)[:, None, None] / 30
    phase, rate = rng.uniform(0, 2 * np.pi, (J, 3)), rng.uniform(0.5, 2.0, (J, 3))
    turn = size * np.sin(2 * np.pi * rate * t + phase)
    assert skeleton.rest_rotations is not None
    root = skeleton.offsets[0] + 0.5 * np.sin(t[:, 0] * np.array([1.0, 2, 3]))
    return SkeletonClip(skeleton, multiply(skeleton.rest_rotations, from_rotation_vector(turn)), root)


def loose_frames(skin: SkinnedMesh, frames: int) -> np.ndarray:
    """Frames that a skin cannot reach: its own, and a smooth wave of 2 % of the height on them."""
    motion = motion_of(skin.skeleton, frames)
    V = linear_blend_skinning(skin, motion.rotations, motion.root_position)
    wave = np.sin(
        9 * skin.mesh.vertices[:, [1, 2, 0]] / skin.mesh.height + np.arange(frames)[:, None, None] / 5
    )
    return (V + 0.02 * skin.mesh.height * wave).astype(np.float32)


def stacked_skin(vertices: int, joints: int) -> SkinnedMesh:
    """An uneven body with a chain of joints along its height, four weights a vertex."""
    mesh = bumpy_body(2 * vertices)
    y = np.linspace(-0.85, 0.85, joints)
    offsets = np.zeros((joints, 3))
    offsets[0, 1], offsets[1:, 1] = y[0], np.diff(y)
    tree = Skeleton(tuple(f"joint{j}" for j in range(joints)), np.arange(-1, joints - 1), offsets)
    near = np.exp(-0.5 * ((mesh.vertices[:, 1:2] - y) / (y[1] - y[0])) ** 2)
    near[near < np.sort(near, axis=1)[:, -4:-3]] = 0
    return SkinnedMesh(mesh, tree, near / near.sum(axis=1, keepdims=True))


def plain_pose(skin: SkinnedMesh, Y: np.ndarray, start: SkeletonClip, steps: int = 4) -> np.ndarray:
    """Gauss-Newton of one frame as one writes it first: derivatives of all vertices, normal equations."""
    tree, J = skin.skeleton, skin.skeleton.n_joints
    pose, root = start.rotations[0].copy(), start.root_position[0].copy()
    below = np.eye(J)
    for j in range(J - 1, 0, -1):
        below[tree.parents[j]] += below[j]
    for _ in range(steps):
        turns, shifts = bone_transforms(tree, pose, root)
        each = np.einsum("jab,nb->nja", to_matrix(turns), skin.mesh.vertices) + shifts
        world, q = forward_kinematics(tree, pose, root)
        left = np.einsum("nj,nja->na", skin.weights, each) - Y
        D = np.zeros((len(Y), 3, 3 * J + 3))
        for j in range(J):
            held = skin.weights * below[j]
            arm = np.einsum("nk,nka->na", held, each) - held.sum(axis=1, keepdims=True) * q[j]
            D[:, :, 3 * j : 3 * j + 3] = np.cross(np.eye(3), arm[:, None]).transpose(0, 2, 1)
        D[:, :, 3 * J :] = np.eye(3)
        D = D.reshape(-1, 3 * J + 3)
        step = -np.linalg.solve(D.T @ D + 1e-9 * np.eye(D.shape[1]), D.T @ left.ravel())
        for j in range(J):
            axis = multiply(
                world[j] * np.array([1.0, -1, -1, -1]), np.concatenate([[0], step[3 * j : 3 * j + 3]])
            )
            pose[j] = multiply(pose[j], from_rotation_vector(multiply(axis, world[j])[1:]))
        root = root + step[3 * J :]
    return pose


def pose_rows(skin: SkinnedMesh) -> list[dict[str, Any]]:
    V = loose_frames(skin, FRAMES)
    start = motion_of(skin.skeleton, 1)
    made = SkinMoments(skin)
    seen = made.frames(V)
    tasks: dict[str, Callable[[], Any]] = {
        "plain": lambda: plain_pose(skin, V[1], start),
        "frame": lambda: fit_poses(skin, V),
        "moments": lambda: made.frames(V),
        "descent": lambda: fit_moments(made, seen),
        "dual quaternions": lambda: fit_poses(skin, V[:4], blending="dual-quaternion"),
    }
    seconds = interleaved(tasks, 6)
    for name, count in (("frame", FRAMES), ("moments", FRAMES), ("descent", FRAMES), ("dual quaternions", 4)):
        seconds[name] /= count
    near, exact = fit_poses(skin, V), fit_poses(skin, V, tolerance=1e-13, steps=100)
    drift = np.sqrt((near.errors**2).mean() / (exact.errors**2).mean()) - 1
    size = f"{len(V[0])} vertices, {skin.skeleton.n_joints} joints"
    what = {
        "plain": f"one frame, 4 Gauss-Newton steps on the vertices in numpy, {size}",
        "frame": f"pose fit, whole call, a frame of {FRAMES}, {size}",
        "moments": "of it: moments of the vertices",
        "descent": f"of it: starts and {near.iterations.mean():.1f} Newton steps",
        "dual quaternions": "pose fit of a dual-quaternion skin, a frame",
    }
    rows = [
        {
            "name": f"rigging/poses/{name}",
            "what": text,
            "seconds": seconds[name],
            "value": f"{1000 * seconds[name]:.2f} ms, 1/{seconds['plain'] / seconds[name]:.0f}",
            "ratio": seconds[name] / seconds["plain"],
            "against": "plain Gauss-Newton",
            "goal": (1.5, 0.6) if name == "frame" else None,
        }
        for name, text in what.items()
    ]
    found = {"name": "rigging/poses/drift", "what": "rms above that of descents to the end, part"}
    return [*rows, found | {"value": f"{drift:.1e}", "goal": (1e-3, None)}]


def skinning_rows(skin: SkinnedMesh) -> list[dict[str, Any]]:
    motion = motion_of(skin.skeleton, FRAMES)
    pose, root = motion.rotations, motion.root_position
    exact, thin = SkinKernel(skin), SkinKernel(skin, least_weight=1e-5)
    matrices = exact.matrices(*(part[0] for part in bone_transforms(skin.skeleton, pose, root)))
    out = np.zeros_like(skin.mesh.vertices, dtype=np.float32)
    tasks: dict[str, Callable[[], Any]] = {
        "numpy": lambda: linear_blend_skinning(skin, pose[:1], root[:1]),
        "one": lambda: [exact.pose(matrices, out) for _ in range(20)],
        "one, thin": lambda: [thin.pose(matrices, out) for _ in range(20)],
        "batch": lambda: linear_blend_skinning(skin, pose, root),
        "dual quaternions": lambda: dual_quaternion_skinning(skin, pose[:8], root[:8]),
    }
    seconds = interleaved(tasks, 20)
    for name in ("one", "one, thin"):
        seconds[name] /= 20
    seconds["batch"] /= FRAMES
    seconds["dual quaternions"] /= 8
    size = f"{len(out)} vertices, {skin.skeleton.n_joints} joints"
    what = {
        "numpy": f"linear blend skinning, one frame in numpy, {size}",
        "one": "one frame, kernel, single precision, all weights",
        "one, thin": "one frame, kernel, weights from 1e-5 on",
        "batch": f"a frame of a batch of {FRAMES}, double precision",
        "dual quaternions": "a frame of dual quaternions, double precision",
    }
    return [
        {
            "name": f"rigging/skinning/{name}",
            "what": text,
            "seconds": seconds[name],
            "ratio": seconds[name] / seconds["numpy"],
            "against": "numpy, one frame",
        }
        for name, text in what.items()
    ]


def cost_rows() -> list[dict[str, Any]]:
    """Milliseconds a frame by vertices, joints and frames; three charts in docs/gallery."""
    cases = {
        "vertices": [(n, 18, FRAMES) for n in (1_000, 5_000, 10_000, 20_000, 50_000)],
        "joints": [(10_000, J, FRAMES) for J in (6, 18, 36, 72)],
        "frames": [(10_000, 18, T) for T in (8, 32, 128, 256)],
    }
    rows: list[dict[str, Any]] = []
    for axis, sizes in cases.items():
        whole: list[float] = []
        descent: list[float] = []
        for n, J, T in sizes:
            a, b = _cost(n, J, T)
            whole.append(1000 * a)
            descent.append(1000 * b)
        x = [dict(zip(("vertices", "joints", "frames"), size))[axis] for size in sizes]
        chart = line_chart(
            {"whole": whole, "without moments": descent},
            x,
            title=f"Pose fit: milliseconds a frame by {axis}",
            x_label=axis,
            y_label="ms",
            y_range=(0.0, 1.1 * max(whole)),
            standalone=True,
        )
        (GALLERY / f"rigging-cost-{axis}.svg").write_text(chart, encoding="utf-8")
        value = ", ".join(f"{k}: {ms:.2f} ms" for k, ms in zip(x, whole))
        rows.append({"name": f"rigging/cost/{axis}", "what": f"pose fit, a frame, by {axis}", "value": value})
    return rows


def _cost(n: int, J: int, T: int) -> tuple[float, float]:
    skin = stacked_skin(n, J)
    V = loose_frames(skin, T)
    made = SkinMoments(skin)
    seen = made.frames(V)
    tasks = {"whole": lambda: fit_poses(skin, V), "descent": lambda: fit_moments(made, seen)}
    seconds = interleaved(tasks, 3)
    return seconds["whole"] / T, seconds["descent"] / T


def run() -> list[dict[str, Any]]:
    skin = human_skin(human_character(20_000).skin.mesh).skin
    return [*pose_rows(skin), *skinning_rows(skin), *cost_rows(), *rigging_decomposition.rows()]


if __name__ == "__main__":
    start = time.perf_counter()
    for row in run():
        print(row)
    print(time.perf_counter() - start)
