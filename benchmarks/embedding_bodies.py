"""Human meshes with known joints for the embedding: rest poses, T-poses, strides, and hard versions."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np

from real_bodies import DATA, person
from tempose.clips import Mesh, SkeletonClip, SkinnedMesh
from tempose.formats import load_mesh, load_skeleton_clip, load_skin
from tempose.kinematics import forward_kinematics, rest_transforms
from tempose.kinematics.bone_axes import bone_axis
from tempose.kinematics.roles import find_roles
from tempose.rotations import conjugate, from_matrix, multiply, rotate, shortest_rotation, to_matrix

SIDES = ("left", "right")
LIMBS = tuple(f"{s}_{p}" for s in SIDES for p in ("upper_arm", "forearm", "hand", "thigh", "shin", "foot"))

Case = tuple[Mesh, dict[str, np.ndarray]]


@cache
def skin(name: str) -> SkinnedMesh:
    if name != "cesium":
        return person({"male": "human-male", "sample": "sample-human"}.get(name, name))
    return load_skin(DATA / "rigged-gltf" / "CesiumMan.glb")


@cache
def motion(name: str) -> SkeletonClip:
    return load_skeleton_clip(DATA / "mocap-cmu" / {"walk": "cmu_12_01_walk.bvh", "run": "02_03.amc"}[name])


def joints_of(who: SkinnedMesh, positions: np.ndarray) -> dict[str, np.ndarray]:
    return {role: positions[j] for role, j in roles_of(who).items()}


def roles_of(who: SkinnedMesh) -> dict[str, int]:
    if who.skeleton.names[0] != "joint_0":
        return find_roles(who.skeleton)
    # CesiumMan's joints have no names
    arm, leg = ("upper_arm", "forearm", "hand"), ("thigh", "shin", "foot", "toes")
    roles = {"hips": 0, "spine": 1, "neck": 3, "head": 4}
    for parts, first, side in ((arm, 5, "left"), (arm, 8, "right"), (leg, 11, "left"), (leg, 15, "right")):
        roles |= {f"{side}_{part}": first + i for i, part in enumerate(parts)}
    return roles


def rest(name: str) -> Case:
    who = skin(name)
    return who.mesh, joints_of(who, rest_transforms(who.skeleton)[1])


def aimed(name: str, wanted: dict[str, np.ndarray], turn: np.ndarray | None = None) -> Case:
    """Turn bones of the rest pose to given directions, root to leaf, everything below following."""
    who = skin(name)
    skeleton, roles = who.skeleton, roles_of(who)
    rotations, positions = rest_transforms(skeleton)
    axes = bone_axis(skeleton, positions, rotations, roles)
    role_of = {j: role for role, j in roles.items()}
    delta = np.zeros((skeleton.n_joints, 4))
    for j in range(skeleton.n_joints):
        above = skeleton.parents[j]
        delta[j] = delta[above] if above >= 0 else ([1.0, 0, 0, 0] if turn is None else turn)
        role = role_of.get(j, "")
        if role in wanted:
            delta[j] = multiply(shortest_rotation(rotate(delta[j], axes[role]), wanted[role]), delta[j])
    world = multiply(delta, rotations)
    local = np.array(world)
    for j in range(1, skeleton.n_joints):
        local[j] = multiply(conjugate(world[skeleton.parents[j]]), world[j])
    from tempose.kinematics import linear_blend_skinning

    V = linear_blend_skinning(who, local[None], skeleton.offsets[:1])[0]
    _, posed = forward_kinematics(skeleton, local, skeleton.offsets[0])
    return who.mesh.with_vertices(V), joints_of(who, posed)


def t_pose(name: str) -> Case:
    wanted: dict[str, np.ndarray] = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        wanted |= {f"{side}_{part}": np.array([sign, 0, 0]) for part in ("upper_arm", "forearm", "hand")}
    return aimed(name, wanted)


def frame(name: str, clip: str, t: int) -> Case:
    """The bone directions of a frame of motion capture, facing +Z."""
    moving = motion(clip)
    roles = find_roles(moving.skeleton)
    world, positions = forward_kinematics(moving.skeleton, moving.rotations[t], moving.root_position[t])
    axes = bone_axis(moving.skeleton, positions, world, roles)
    across = positions[roles["left_thigh"]] - positions[roles["right_thigh"]]
    yaw = np.arctan2(across[2], across[0])
    c, s = np.cos(yaw), np.sin(yaw)
    back = from_matrix(np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]))
    wanted = {role: rotate(back, axes[role]) for role in LIMBS if role in axes and "hand" not in role}
    return aimed(name, wanted)


def turned(case: Case, R: np.ndarray, scale: float = 1.0) -> Case:
    mesh, joints = case
    move: Callable[[np.ndarray], np.ndarray] = lambda p: scale * (p @ R.T) + 0.3  # noqa: E731
    return mesh.with_vertices(move(mesh.vertices)), {role: move(p) for role, p in joints.items()}


def yaw_matrix(degrees: float) -> np.ndarray:
    a = np.radians(degrees)
    return np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])


Z_UP = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
LYING = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])


def holed(case: Case, seed: int = 1, holes: int = 12) -> Case:
    """Cut round holes of 3 % of the height into the surface."""
    mesh, joints = case
    V, F = mesh.vertices, mesh.faces
    rng = np.random.default_rng(seed)
    centres = V[rng.integers(len(V), size=holes)]
    away = np.linalg.norm(V[F].mean(axis=1)[:, None] - centres, axis=2).min(axis=1)
    return Mesh(V, F[away > 0.03 * mesh.height]), joints


def noisy(case: Case, seed: int = 2) -> Case:
    """Mirror the body and shake its vertices by 0.2 % of the height."""
    mesh, joints = case
    mirror = np.array([-1.0, 1, 1])
    V = mesh.vertices * mirror
    V = V + np.random.default_rng(seed).normal(scale=0.002 * mesh.height, size=V.shape)
    swap = {"left": "right", "right": "left"}
    names = {r: "_".join([swap.get(r.split("_")[0], r.split("_")[0]), *r.split("_")[1:]]) for r in joints}
    return Mesh(V, mesh.faces[:, ::-1]), {names[role]: p * mirror for role, p in joints.items()}


CASES: dict[str, Callable[[], Case]] = {
    name: (lambda n=name: rest(n)) for name in ("makehuman", "male", "sample", "cesium")
}
for _name in ("makehuman", "male", "sample"):
    if _name != "male":
        CASES[f"{_name} T-pose"] = lambda n=_name: t_pose(n)
    for _clip, _frames in (("walk", (60, 110, 200)), ("run", (30, 60, 90))):
        for _t in _frames:
            CASES[f"{_name} {_clip} {_t}"] = lambda n=_name, c=_clip, t=_t: frame(n, c, t)
CASES |= {
    "makehuman 37°": lambda: turned(rest("makehuman"), yaw_matrix(37)),
    "makehuman Z up, 90°, cm": lambda: turned(rest("makehuman"), Z_UP @ yaw_matrix(90), 100.0),
    "makehuman lying": lambda: turned(rest("makehuman"), LYING),
    "makehuman upside down": lambda: turned(rest("makehuman"), np.diag([1.0, -1, -1])),
    "makehuman holes": lambda: holed(rest("makehuman")),
    "makehuman mirrored, noise": lambda: noisy(rest("makehuman")),
    "male 180°": lambda: turned(rest("male"), yaw_matrix(180)),
    "male walk 110, 37°, Z up": lambda: turned(frame("male", "walk", 110), Z_UP @ yaw_matrix(37)),
    "male mirrored, noise": lambda: noisy(rest("male")),
}


def others() -> dict[str, Mesh]:
    """Meshes that are no humans."""
    first = lambda folder: sorted((DATA / folder).glob("*.obj"))  # noqa: E731
    found = {f"horse pose {i}": load_mesh(path) for i, path in enumerate(first("horse-poses")[:4])}
    found |= {f"elephant {i}": load_mesh(path) for i, path in enumerate(first("elephant-poses")[:4])}
    found |= {f"gallop {i}": load_mesh(path) for i, path in enumerate(first("horse-gallop")[::16])}
    found["camel"] = load_mesh(DATA / "horse-camel-poses" / "camel_ref.obj")
    found["horse"] = load_mesh(DATA / "horse-camel-poses" / "horse_ref.obj")
    found["cheburashka"] = load_mesh(DATA / "cheburashka-lbs" / "cheburashka.obj")
    found["Fox"] = load_mesh(DATA / "rigged-gltf" / "Fox.glb")
    found["Mesh2Motion horse"] = load_mesh(DATA / "rigged-gltf" / "horse-animations.glb")
    return found


def crane(t: int) -> Mesh:
    return load_mesh(sorted((DATA / "vlasic-crane").glob("*.obj"))[t])


__all__ = ["CASES", "DATA", "Case", "crane", "others", "to_matrix"]
