"""Arms and legs by the names of their joints: where one word means two joints, the others decide."""

from __future__ import annotations

from tempose.kinematics._joint_tree import JointTree

ARM = ("clavicle", "upper_arm", "forearm", "hand")
LEG = ("thigh", "shin", "foot", "toes")


def arm_roles(tree: JointTree, side: str) -> dict[str, int]:
    """Clavicle to hand; ``shoulder`` is the clavicle where something else is the upper arm."""
    found: dict[str, int] = {}
    explicit = {part: tree.of(side, part) for part in ARM}
    upper = explicit["upper_arm"] or ([] if not explicit["forearm"] else tree.of(side, "arm"))
    chain = tree.of(side, "arm")
    if not upper and not explicit["forearm"]:
        # nameless links of one arm: upper arm, forearm, hand in order
        upper, explicit["forearm"] = chain[:1], chain[1:2]
        explicit["hand"] = explicit["hand"] or chain[2:3]
    elif not explicit["forearm"]:
        explicit["forearm"] = chain
    shoulders = tree.of(side, "shoulder")
    if upper:
        explicit["clavicle"] = sorted(explicit["clavicle"] + shoulders, key=lambda j: len(tree.up[j]))
    explicit["upper_arm"] = upper or shoulders
    return _chain(tree, side, ARM, explicit, found)


def leg_roles(tree: JointTree, side: str) -> dict[str, int]:
    """Thigh to toes; ``leg`` is the shin below a thigh, else the thigh above a shin."""
    explicit = {part: tree.of(side, part) for part in LEG}
    chain = tree.of(side, "leg")
    if not explicit["thigh"] and not explicit["shin"] and len(chain) > 1:
        explicit["thigh"], explicit["shin"] = chain[:1], chain[1:2]
        explicit["foot"] = explicit["foot"] or chain[2:3]
        explicit["toes"] = explicit["toes"] or chain[3:4]
    elif not explicit["shin"]:
        explicit["shin"] = chain
    elif not explicit["thigh"]:
        explicit["thigh"] = chain
    explicit["thigh"] = explicit["thigh"] or tree.of(side, "hip_joint")
    explicit["toes"] = explicit["toes"] or explicit["foot"][1:]
    return _chain(tree, side, LEG, explicit, {})


def _chain(
    tree: JointTree,
    side: str,
    parts: tuple[str, ...],
    candidates: dict[str, list[int]],
    found: dict[str, int],
) -> dict[str, int]:
    above: int | None = None
    for part in parts:
        joint = tree.first(tree.below(candidates[part], above))
        if joint is not None:
            found[f"{side}_{part}"] = above = joint
    return found
