"""The built-in human: a mannequin of 1.75 m in a skirt, as a tree of blended solids."""

from __future__ import annotations

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.samples.human_body import arm, leg, skirt, torso
from tempose.samples.human_extremities import foot, hand, head
from tempose.samples.parts import Node, Part, ease, sided
from tempose.samples.sculpture import Sculpture
from tempose.samples.skeletons import human_skeleton
from tempose.samples.uv_charts import ChartRule
from tempose.typing import FloatArray

FINGERS = ("thumb", "index", "middle", "ring", "little")


# half the width of the bend at each joint, metres
_SOFTNESS = {
    "hips": 0.06, "spine": 0.06, "chest": 0.07, "neck": 0.045, "head": 0.04,
    "clavicle": 0.06, "upper_arm": 0.065, "forearm": 0.045, "hand": 0.030,
    "thigh": 0.080, "shin": 0.060, "foot": 0.040, "toes": 0.025,
}  # fmt: skip


def sculpt_human(coarse: bool = False) -> Sculpture:
    """Sculpt the human.

    Parameters
    ----------
    coarse : bool, default False
        For few triangles: mittens, one solid for the toes, a skirt that is nearly filled.

    Returns
    -------
    Sculpture
        Solids, joints, bends and soft regions.
    """
    skeleton = human_skeleton()
    return Sculpture(
        "human",
        tuple(_nodes(coarse)),
        tuple(_parts(skeleton, coarse)),
        skeleton,
        sided(_SOFTNESS),
        {"skirt": _skirt_weights},
        {"belly": ("trunk", _belly), "skirt": ("skirt", _skirt)},
        _charts(),
    )


def _parts(skeleton: Skeleton, coarse: bool) -> list[Part]:
    positions = rest_transforms(skeleton)[1]
    assert skeleton.tips is not None
    ends = positions + np.nan_to_num(skeleton.tips)
    p = {name: positions[j] for j, name in enumerate(skeleton.names)}
    end = {name: ends[j] for j, name in enumerate(skeleton.names)}
    left = arm(p["left_upper_arm"], p["left_forearm"], p["left_hand"])
    left += hand(p["left_hand"], end["left_hand"], coarse)
    left += leg(p["left_thigh"], p["left_shin"], p["left_foot"])
    left += foot(p["left_foot"], p["left_toes"], coarse)
    return torso() + head(end["head"]) + skirt(coarse) + left + [part.mirrored() for part in left]


def _charts() -> dict[str, ChartRule]:
    """Front and back of everything; the backs of the hands, palms, soles; the skirt inside and outside."""
    front = (0.0, 0.0, 1.0)
    charts = {"torso": ChartRule(front), "head": ChartRule(front), "skirt": ChartRule(front, hollow=True)}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        charts |= {
            f"{side}_arm": ChartRule(front),
            f"{side}_hand": ChartRule((sign, 1.0, 0.0)),
            f"{side}_leg": ChartRule(front),
            f"{side}_foot": ChartRule((0.0, 1.0, 0.0)),
        }
    return charts


def _skirt_weights(V: FloatArray) -> FloatArray:
    """Cloth follows the hips at the waist and the nearer thigh towards the hem."""
    skeleton = human_skeleton()
    weights = np.zeros((len(V), skeleton.n_joints))
    thighs = 0.9 * ease((0.98 - V[:, 1]) / 0.30)
    left = ease(0.5 + V[:, 0] / 0.26)
    weights[:, skeleton.index("hips")] = 1.0 - thighs
    weights[:, skeleton.index("left_thigh")] = thighs * left
    weights[:, skeleton.index("right_thigh")] = thighs * (1.0 - left)
    return weights


def _skirt(V: FloatArray) -> FloatArray:
    return ease((1.045 - V[:, 1]) / 0.06)


def _belly(V: FloatArray) -> FloatArray:
    """Soft in front of the waist, above the belt."""
    x, y, z = V.T
    away = (x / 0.13) ** 2 + ((y - 1.15) / 0.10) ** 2
    return np.maximum(1.0 - away, 0.0) ** 2 * ease(z / 0.06)


def _nodes(coarse: bool) -> list[Node]:
    spine = ("hips", "spine", "chest", "neck", "head")
    nodes = [
        Node("trunk", "", 0.0, spine, "torso", web=0.010),
        Node("head", "trunk", 0.02, spine, "head"),
        Node("skirt", "trunk", 0.008, ("hips",), "skirt"),
    ]
    for side in ("left", "right"):
        arm_chain = tuple(f"{side}_{name}" for name in ("clavicle", "upper_arm", "forearm", "hand"))
        leg_chain = tuple(f"{side}_{name}" for name in ("thigh", "shin", "foot", "toes"))
        nodes += [
            Node(f"{side}_arm", "trunk", 0.060, ("chest", *arm_chain), f"{side}_arm"),
            Node(f"{side}_hand", f"{side}_arm", 0.02, ("chest", *arm_chain), f"{side}_hand", web=0.008),
            Node(f"{side}_leg", "trunk", 0.03, ("hips", *leg_chain), f"{side}_leg"),
            Node(f"{side}_foot", f"{side}_leg", 0.040, ("hips", *leg_chain), f"{side}_foot"),
        ]
        nodes += [
            Node(f"{side}_{name}", f"{side}_hand", 0.010, ("chest", *arm_chain), f"{side}_hand")
            for name in FINGERS
            if name == "thumb" or not coarse
        ]
    return nodes
