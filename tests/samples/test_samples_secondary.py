"""Flesh and cloth obey the oscillator they are made of, forget nothing, and rest when the body rests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.kinematics.skinning import bake
from tempose.rotations import conjugate, rotate
from tempose.samples.gores import swing_gores
from tempose.samples.motion_curves import about
from tempose.samples.oscillators import acceleration, oscillate, oscillator_step
from tempose.samples.secondary import FLESH, secondary_motion
from tempose.samples.skeletons import human_skeleton
from tempose.samples.skirt import measure_skirt
from tempose.samples.skirt_legs import CLEARANCE, least_angles, leg_beads
from tempose.samples.walk import walk

HUMAN = human_skeleton()
HIPS = rest_transforms(HUMAN)[1][0]


def rings(
    top: tuple[float, float], bottom: tuple[float, float], x: float, z: float, n: int = 32
) -> np.ndarray:
    """Points on a cone between two circles (height, radius) round an upright axis."""
    s, angle = np.linspace(0, 1, 20)[:, None], 2 * np.pi * np.arange(n) / n
    y, r = top[0] + s * (bottom[0] - top[0]), top[1] + s * (bottom[1] - top[1])
    return np.stack([x + r * np.sin(angle), y + 0 * angle, z + r * np.cos(angle)], axis=-1).reshape(-1, 3)


@pytest.fixture(scope="module")
def body() -> tuple[SkinnedMesh, dict[str, np.ndarray]]:
    """Two legs, a skirt and a belly: points are enough, nothing here looks at faces."""
    positions = rest_transforms(HUMAN)[1]
    points, joints = [], []
    for side, sign in (("left", 1), ("right", -1)):
        for name, top, bottom in (
            ("thigh", (0.91, 0.085), (0.5, 0.06)),
            ("shin", (0.49, 0.058), (0.09, 0.04)),
        ):
            joint = HUMAN.index(f"{side}_{name}")
            points.append(rings(top, bottom, sign * 0.1, positions[joint, 2]))
            joints.append(joint)
    points += [rings((1.07, 0.15), (0.56, 0.3), 0.0, 0.0, 64), rings((1.2, 0.14), (1.08, 0.14), 0.0, 0.0)]
    joints += [0, HUMAN.index("spine")]
    owner = np.repeat(joints, [len(p) for p in points])
    weights = (owner[:, None] == np.arange(HUMAN.n_joints)).astype(float)
    V = np.concatenate(points)
    skirt, belly = (np.zeros(len(V)) for _ in range(2))
    start = len(V) - len(points[-1]) - len(points[-2])
    skirt[start : start + len(points[-2])] = np.clip((1.07 - points[-2][:, 1]) / 0.05, 0, 1)
    belly[start + len(points[-2]) :] = np.clip(points[-1][:, 2] / 0.14, 0, 1)
    return SkinnedMesh(Mesh(V, np.zeros((0, 3), int)), HUMAN, weights), {"skirt": skirt, "belly": belly}


def still(root: np.ndarray, fps: float = 60.0) -> SkeletonClip:
    """Body in its rest pose, carried along by its root."""
    rotations = np.tile([1.0, 0, 0, 0], (len(root), HUMAN.n_joints, 1))
    return SkeletonClip(HUMAN, rotations, HIPS + root, fps)


def displacement(body, clip: SkeletonClip, **options) -> np.ndarray:
    skin, soft = body
    V = bake(skin, clip)
    return secondary_motion(skin, clip, V, soft, **options) - V


@pytest.mark.parametrize("damping", [0.0, 0.15, 1.0, 1.7])
def test_step_response_is_the_closed_form(damping: float) -> None:
    fps, frequency = 24.0, 3.0
    t, w = np.arange(60) / fps, 2 * np.pi * frequency
    u = oscillate(np.ones((60, 2)), frequency, damping, fps)
    root = np.sqrt(complex(damping**2 - 1)) if damping != 1 else 0.0
    if root == 0:
        expected = (1 - (1 + w * t) * np.exp(-w * t)) / w**2
    else:
        decay = np.exp(-damping * w * t) * (np.cosh(w * root * t) + damping / root * np.sinh(w * root * t))
        expected = (1 - decay.real) / w**2
    assert_allclose(u, np.stack([expected, expected], axis=1), atol=1e-13)


def test_ramp_of_force_is_followed_exactly() -> None:
    # u = (t - 2 z / w) / w^2 + free oscillation; without damping t / w^2 - sin(w t) / w^3
    t, w = np.arange(50) / 30.0, 2 * np.pi * 2.0
    assert_allclose(oscillate(t, 2.0, 0.0, 30.0), t / w**2 - np.sin(w * t) / w**3, atol=1e-14)


def test_coupled_step_keeps_energy_and_agrees_with_modes(rng: np.random.Generator) -> None:
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    squares = np.array([4.0, 9.0, 25.0])
    K = Q @ np.diag(squares) @ Q.T
    step = oscillator_step(K, np.zeros((3, 3)), 0.1)
    u, v = rng.normal(size=(2, 3))
    state = np.concatenate([u, v, np.zeros(6)])
    u1, v1 = np.split(step @ state, 2)
    assert_allclose(v1 @ v1 + u1 @ K @ u1, v @ v + u @ K @ u)
    w = np.sqrt(squares)
    assert_allclose(Q.T @ u1, np.cos(0.1 * w) * (Q.T @ u) + np.sin(0.1 * w) / w * (Q.T @ v))


def test_acceleration_of_a_cubic_is_exact() -> None:
    t = np.arange(10) / 25.0
    assert_allclose(acceleration(np.stack([t**3, 2 * t**2], axis=1), 25.0)[:, 0], 6 * t, atol=1e-9)
    assert_allclose(acceleration(np.stack([t**3, 2 * t**2], axis=1), 25.0)[:, 1], 4.0)


@pytest.mark.parametrize("velocity", [0.0, 2.0])
def test_nothing_moves_on_a_body_that_rests_or_glides(body, velocity: float) -> None:
    root = np.arange(50)[:, None] / 60.0 * np.array([0.0, 0.0, velocity])
    assert np.abs(displacement(body, still(root))).max() < 1e-9


def test_flesh_of_a_shaken_body_is_the_response_of_the_oscillator(body) -> None:
    t = np.arange(90) / 60.0
    root = np.outer(0.004 * np.sin(9 * t), [0.0, 1.0, 0.0])
    belly = body[1]["belly"]
    flesh = FLESH["belly"]
    u = oscillate(-acceleration(root[:, 1], 60.0), flesh.frequency, flesh.damping, 60.0)
    full = u / np.sqrt(1 + (u / flesh.limit) ** 2)
    got = displacement(body, still(root))[:, belly > 0]
    assert_allclose(got[..., 1], np.outer(full, belly[belly > 0]), atol=1e-9)
    assert_allclose(got[..., [0, 2]], 0.0, atol=1e-9)


def test_flesh_equals_a_mass_on_a_spring_at_every_vertex(body) -> None:
    # the slow twin: each skinned vertex drives its own oscillator
    skin, soft = body
    clip = walk(HUMAN, duration=1.0, fps=60.0)
    inside = soft["belly"] > 0
    flesh = FLESH["belly"]
    u = oscillate(-acceleration(bake(skin, clip)[:, inside], 60.0), flesh.frequency, flesh.damping, 60.0)
    u = u / np.sqrt(1 + np.sum(u**2, axis=-1, keepdims=True) / flesh.limit**2)
    got = displacement(body, clip)[:, inside]
    assert_allclose(got, soft["belly"][inside, None] * u, atol=1e-9)
    assert np.abs(got).max() > 0.005


@pytest.mark.parametrize("region", ["belly", "skirt"])
def test_same_pose_with_another_past_is_displaced_otherwise(body, region: str) -> None:
    clip = walk(HUMAN, duration=1.6, fps=60.0)
    late = SkeletonClip(HUMAN, clip.rotations[40:], clip.root_position[40:], 60.0)
    whole, part = (displacement(body, c)[:, body[1][region] > 0.5] for c in (clip, late))
    assert np.abs(whole[44:50] - part[4:10]).max() > 0.002
    # while the past alike gives the same, whatever comes after
    early = SkeletonClip(HUMAN, clip.rotations[:60], clip.root_position[:60], 60.0)
    assert_allclose(displacement(body, early)[:50, body[1][region] > 0.5], whole[:50], atol=2e-3)


def test_displacement_grows_with_the_scale_and_repeats(body) -> None:
    clip = walk(HUMAN, duration=0.8, fps=60.0)
    one, again, half = (displacement(body, clip, scale=s) for s in (1.0, 1.0, 0.5))
    assert np.array_equal(one, again)
    assert_allclose(half, 0.5 * one, atol=1e-12)
    assert np.abs(displacement(body, clip, scale=0.0)).max() == 0.0


def test_vertices_outside_the_masks_stay(body) -> None:
    moved = displacement(body, walk(HUMAN, duration=0.5, fps=60.0))
    free = (body[1]["skirt"] == 0) & (body[1]["belly"] == 0)
    assert np.abs(moved[:, free]).max() == 0.0


def test_result_hardly_depends_on_the_frame_rate(body) -> None:
    coarse, fine = (displacement(body, walk(HUMAN, duration=1.5, fps=fps)) for fps in (60.0, 240.0))
    for region in ("belly", "skirt"):
        inside = body[1][region] > 0.5
        a, b = coarse[:, inside], fine[::4, inside]
        assert np.sqrt(np.mean((a - b) ** 2) / np.mean(b**2)) < 0.05


def test_skirt_swings_late_and_more_towards_the_hem(body) -> None:
    # the body starts forwards: the skirt stays behind, then comes back and overshoots
    t = np.arange(180) / 60.0
    z = 0.5 * np.clip(t - 0.2, 0.0, 0.5) ** 2 * 4.0 + np.clip(t - 0.7, 0.0, None) * 2.0
    moved = displacement(body, still(np.outer(z, [0.0, 0.0, 1.0])))
    skirt = np.flatnonzero(body[1]["skirt"] > 0)
    height = body[0].mesh.vertices[skirt, 1]
    hem, middle = skirt[height < 0.6], skirt[(height > 0.8) & (height < 0.84)]
    back = moved[:, hem, 2].mean(axis=1)
    assert back[25:45].min() < -0.05
    assert back[45:120].max() > 0.01
    assert np.abs(moved[:, hem]).max() > 1.5 * np.abs(moved[:, middle]).max()
    assert np.abs(back[-10:]).max() < 0.2 * np.abs(back).max()


def test_gores_follow_a_leg_and_swing_back_when_it_leaves() -> None:
    t = np.arange(240) / 120.0
    least = np.where(t < 1.0, 0.4 * np.sin(np.pi * np.clip(t, 0, 1)) ** 2, -1.0)
    least = np.tile(np.minimum(least, 0.5 - 3 * np.clip(t - 0.5, 0, None))[:, None], 36)
    angles = swing_gores(np.zeros((240, 36)), 120.0, least)
    assert (least - angles).max() < 0.03
    assert angles[60].min() > 0.38 and angles[:60].max() < 0.45
    assert angles[60:].min() < -0.05
    assert np.abs(angles[-1]).max() < 0.15


def test_least_angle_is_that_of_the_tangent_to_a_raised_leg(body) -> None:
    skin, soft = body
    wide = measure_skirt(skin.mesh.vertices[soft["skirt"] > 0] - HIPS)
    ring = replace(wide, slope=wide.slope + 1.0)
    clip = still(np.zeros((1, 3)))
    rotations = np.array(clip.rotations)
    rotations[0, HUMAN.index("left_thigh")] = about("x", -1.0)
    clip = SkeletonClip(HUMAN, rotations, clip.root_position)
    angle = least_angles(skin, clip, ring)[0]
    beads, radii = leg_beads(skin, rotations, clip.root_position)
    touched = 0
    for k, direction in enumerate(ring.azimuth):
        p = beads[0] - ring.centre
        out = p[:, 0] * np.sin(direction) + p[:, 2] * np.cos(direction) - ring.waist[k]
        aside = p[:, 0] * np.cos(direction) - p[:, 2] * np.sin(direction)
        r = radii + CLEARANCE
        near = (np.abs(aside) < r) & (np.hypot(out, p[:, 1]) < ring.length[k])
        # distance of each ball's section from the gore's line, positive outside the skirt
        gap = out * np.cos(angle[k]) + p[:, 1] * np.sin(angle[k]) + np.sqrt(np.maximum(r**2 - aside**2, 0))
        if near.any():
            assert gap[near].max() < 1e-9
            touched += gap[near].max() > -1e-9
    assert touched > 8
    assert angle.max() > 0.7


def test_legs_stay_inside_the_skirt(body) -> None:
    skin, soft = body
    clip = walk(HUMAN, duration=2.0, fps=60.0)
    inside = soft["skirt"] > 0
    world = secondary_motion(skin, clip, bake(skin, clip), soft)[:, inside]
    shape = measure_skirt(skin.mesh.vertices[inside] - HIPS)
    beads, radii = leg_beads(skin, clip.rotations, clip.root_position)
    turn, place = forward_kinematics(HUMAN, clip.rotations, clip.root_position)
    local = rotate(conjugate(turn[:, :1]), world - place[:, :1]) - shape.centre
    azimuth, radius = np.arctan2(local[..., 0], local[..., 2]), np.hypot(local[..., 0], local[..., 2])
    p = beads - shape.centre
    worst = 0.0
    for t in range(0, len(local), 10):
        for q, r in zip(p[t], radii):
            if -q[1] > 0.5:
                continue
            # the cloth at the height of the ball and in its direction
            near = np.abs(local[t, :, 1] - q[1]) < 0.03
            turned = np.abs((azimuth[t] - np.arctan2(q[0], q[2]) + np.pi) % (2 * np.pi) - np.pi) < 0.15
            if (near & turned).any():
                worst = max(worst, float(np.hypot(q[0], q[2]) + r - radius[t, near & turned].mean()))
    assert worst < 0.02


@pytest.mark.parametrize("values", [np.full(3, 0.5), np.array(2.0)])
def test_bad_masks_are_refused(body, values: np.ndarray) -> None:
    skin, soft = body
    mask = values if values.ndim else np.full(len(soft["belly"]), float(values))
    clip = still(np.zeros((5, 3)))
    with pytest.raises(ValueError, match=r"soft\['belly'\] must"):
        secondary_motion(skin, clip, bake(skin, clip), {"belly": mask})
