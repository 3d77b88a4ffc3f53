"""The built-in four-legged animal: a pony, as a tree of blended solids."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tempose.clips import Skeleton
from tempose.kinematics import rest_transforms
from tempose.samples.animal_body import barrel, head, neck, tail
from tempose.samples.animal_legs import fore_leg, hind_leg
from tempose.samples.parts import Node, Part, ease, sided
from tempose.samples.sculpture import Sculpture
from tempose.samples.skeletons import WITHERS, animal_skeleton
from tempose.samples.uv_charts import ChartRule
from tempose.typing import FloatArray

SPINE = ("hips", "spine_1", "spine_2", "spine_3", "chest", "neck_1", "neck_2", "head")
TAIL = ("hips", "tail_1", "tail_2", "tail_3", "tail_4")


# half the width of the bend at each joint, in heights at the withers
_SOFTNESS = {
    "hips": 0.08, "spine_1": 0.08, "spine_2": 0.08, "spine_3": 0.08, "chest": 0.08,
    "neck_1": 0.09, "neck_2": 0.08, "head": 0.05, "ear": 0.02,
    "tail_1": 0.03, "tail_2": 0.045, "tail_3": 0.06, "tail_4": 0.06,
    "fore_scapula": 0.08, "fore_upper": 0.08, "fore_lower": 0.06, "fore_cannon": 0.035, "fore_hoof": 0.03,
    "hind_thigh": 0.10, "hind_shin": 0.08, "hind_cannon": 0.045, "hind_hoof": 0.03,
}  # fmt: skip


def sculpt_animal() -> Sculpture:
    """Sculpt the animal.

    Returns
    -------
    Sculpture
        Solids, joints, bends and soft regions.
    """
    skeleton = animal_skeleton()
    softness = {name: WITHERS * width for name, width in sided(_SOFTNESS).items()}
    return Sculpture(
        "animal",
        tuple(_nodes()),
        tuple(_parts(skeleton)),
        skeleton,
        softness,
        {},
        {"belly": ("trunk", _belly)},
        _charts(),
    )


def _parts(skeleton: Skeleton) -> list[Part]:
    positions = rest_transforms(skeleton)[1] / WITHERS
    assert skeleton.tips is not None
    ends = positions + np.nan_to_num(skeleton.tips) / WITHERS
    index = skeleton.index
    tail_joints = np.array([*(positions[index(name)] for name in TAIL[1:]), ends[index("tail_4")]])
    left = fore_leg() + hind_leg()
    parts = barrel() + neck((0, 0.780, 0.300), (0, 1.165, 0.675))
    parts += head(positions[index("head")] + (0, 0.035, -0.010), ends[index("head")])
    parts += tail(tail_joints) + left + [part.mirrored() for part in left]
    return [part.scaled(WITHERS) for part in parts]


def _charts() -> dict[str, ChartRule]:
    """Left and right halves; the outsides and insides of the legs."""
    left = (1.0, 0.0, 0.0)
    charts = {name: ChartRule(left, middle=True) for name in ("trunk", "head", "tail")}
    return charts | {
        f"{side}_{leg}": ChartRule(left) for side in ("left", "right") for leg in ("fore", "hind")
    }


def _belly(V: FloatArray) -> FloatArray:
    """Soft below, between fore and hind legs."""
    _, y, z = V.T / WITHERS
    away = ((z + 0.03) / 0.26) ** 2
    return np.maximum(1.0 - away, 0.0) ** 2 * ease((0.74 - y) / 0.16)


def _nodes() -> list[Node]:
    nodes = [
        Node("trunk", "", 0.0, SPINE, "trunk", web=0.01),
        Node("head", "trunk", 0.035, SPINE, "head"),
        Node("tail", "trunk", 0.025, TAIL, "tail"),
    ]
    for side in ("left", "right"):
        fore = tuple(f"{side}_fore_{name}" for name in ("scapula", "upper", "lower", "cannon", "hoof"))
        hind = tuple(f"{side}_hind_{name}" for name in ("thigh", "shin", "cannon", "hoof"))
        nodes += [
            Node(f"{side}_ear", "head", 0.010, ("head", f"{side}_ear"), "head"),
            Node(f"{side}_fore", "trunk", 0.06, ("chest", *fore), f"{side}_fore"),
            Node(f"{side}_hind", "trunk", 0.06, ("hips", *hind), f"{side}_hind"),
        ]
    return [replace(node, blend=node.blend * WITHERS, web=node.web * WITHERS) for node in nodes]
