"""Which joint plays which part: one vocabulary for all human skeletons."""

from __future__ import annotations

import difflib
from collections.abc import Mapping

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics._joint_tree import JointTree
from tempose.kinematics._limbs import ARM, LEG, arm_roles, leg_roles
from tempose.kinematics.joint_names import read_names
from tempose.typing import IntArray

TRUNK = ("hips", "spine", "chest", "neck", "head")
ROLES = TRUNK + tuple(f"{side}_{part}" for side in ("left", "right") for part in ARM + LEG)
"""Every role, from the hips outwards."""


def find_roles(skeleton: Skeleton, mapping: Mapping[str, str] | None = None) -> dict[str, int]:
    """Find the joints that play the parts of a human body.

    Parameters
    ----------
    skeleton : Skeleton
        Joints of any maker.
    mapping : mapping of str to str, optional
        Joint name to role, as the user states it; wins over every guess.

    Returns
    -------
    dict of str to int
        Role to the joint at which that bone starts: ``left_upper_arm`` is the shoulder, ``left_forearm``
        the elbow, ``left_thigh`` the hip joint. A role that no joint plays is missing; a skeleton without
        the limbs of a human gives only what `mapping` says.

    Raises
    ------
    ValueError
        If `mapping` names an unknown joint or role, or one role twice; the message lists the known ones.

    Notes
    -----
    Limbs are known by their names, the trunk by what it connects: the chest is the last joint below the
    neck, the spine the first above the hips, whatever their names. A single joint between them is the spine.
    """
    stated = _stated(skeleton, mapping or {})
    tree = JointTree(skeleton)
    roles: dict[str, int] = {}
    for side in ("left", "right"):
        roles |= arm_roles(tree, side) | leg_roles(tree, side)
    if any(f"{side}_{part}" in roles for side in ("left", "right") for part in ("thigh", "upper_arm")):
        roles |= _trunk(tree, roles)
    else:
        roles = {}
    taken = set(stated.values())
    roles = {role: j for role, j in roles.items() if j not in taken} | stated
    return {role: roles[role] for role in ROLES if role in roles}


def bones_of_role(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[str, IntArray]:
    """Gather the joints that move with each role.

    Parameters
    ----------
    skeleton : Skeleton
        J joints.
    roles : mapping of str to int
        From `find_roles`.

    Returns
    -------
    dict of str to (k,) ndarray of int
        Every joint goes to the nearest role at or above it in the tree: fingers to the hand, the jaw to the
        head. Toes beside the toe that has the role join it. What lies above all roles goes to the hips;
        without hips it is left out.
    """
    own = {j: role for role, j in roles.items()}
    role_of: list[str | None] = []
    for j, (parent, (side, part)) in enumerate(zip(skeleton.parents, read_names(skeleton.names))):
        role = role_of[parent] if parent >= 0 else ("hips" if "hips" in roles else None)
        if part == "toes" and role == f"{side}_foot" and f"{side}_toes" in roles:
            role = f"{side}_toes"
        role_of.append(own.get(j, role))
    return {
        role: np.array([j for j, r in enumerate(role_of) if r == role], dtype=np.int32)
        for role in ROLES
        if role in roles
    }


def _stated(skeleton: Skeleton, mapping: Mapping[str, str]) -> dict[str, int]:
    stated: dict[str, int] = {}
    for name, role in mapping.items():
        if name not in skeleton.names:
            close = difflib.get_close_matches(name, skeleton.names, n=5, cutoff=0.3) or skeleton.names
            raise ValueError(f"mapping names a joint {name!r}; the skeleton has {', '.join(close)}")
        if role not in ROLES:
            raise ValueError(f"mapping gives {name!r} the role {role!r}; roles are {', '.join(ROLES)}")
        if role in stated:
            other = skeleton.names[stated[role]]
            raise ValueError(
                f"mapping gives the role {role!r} to {other!r} and to {name!r}; one joint a role"
            )
        stated[role] = skeleton.index(name)
    return stated


def _trunk(tree: JointTree, limbs: dict[str, int]) -> dict[str, int]:
    thighs = [limbs[role] for role in ("left_thigh", "right_thigh") if role in limbs]
    arms = [limbs[role] for role in ("left_clavicle", "right_clavicle") if role in limbs]
    arms = arms or [limbs[role] for role in ("left_upper_arm", "right_upper_arm") if role in limbs]
    neck, head = tree.first(tree.of("", "neck")), tree.first(tree.of("", "head"))
    if neck is None and head is None and arms:
        # Rigify counts its spine on through neck and head
        above = tree.below(tree.of("", "spine"), tree.common(arms))
        neck, head = (above[0], above[-1]) if len(above) > 1 else (None, None)
    top = neck if neck is not None else tree.common([*arms, *([] if head is None else [head])])
    hips = _hips(tree, thighs, top)
    found = {"hips": hips, "neck": neck, "head": head}
    if hips is not None and top is not None:
        fork = tree.common([hips, top])
        # from the neck down to where the legs branch off, the ends left out
        path = [j for j in tree.up[top] if fork is not None and fork in tree.up[j][1:] and j != neck]
        if len(path) > 1:
            found["spine"], found["chest"] = path[-1], path[0]
        elif path:
            found["spine"] = path[0]
    return {role: j for role, j in found.items() if j is not None and j not in limbs.values()}


def _hips(tree: JointTree, thighs: list[int], top: int | None) -> int | None:
    named = tree.of("", "hips")
    legs = tree.common(thighs)
    if legs is None:
        return tree.first(named)
    body = tree.common([legs, *([] if top is None else [top])])
    # by name, nearest to where legs and trunk meet: there, above, else between there and the legs
    assert body is not None
    between = [j for j in reversed(tree.up[legs]) if body in tree.up[j][1:]]
    return next((j for j in [*tree.up[body], *between] if j in named), body)
