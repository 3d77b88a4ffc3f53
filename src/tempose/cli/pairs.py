"""`tempose pairs`: which faces of a target belong to which joint of a source, found without a click."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli import transfer_options as given
from tempose.cli.console import note, show_json, show_table, writing
from tempose.cli.options import Group, Json
from tempose.cli.pairs_tools import Check, Mirror, look_over
from tempose.cli.transfer_inputs import load_mapping, load_motion, load_target

if TYPE_CHECKING:
    from tempose.clips import Mesh, SkeletonClip
    from tempose.transfer import Pairs

Weights = Annotated[
    Path | None, typer.Option(metavar="FILE", help="MakeHuman weights (.mhw) of TARGET, to take pairs from.")
]
OutPairs = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="PAIRS.json", help="Write the pairs, for transfer --pairs."),
]
Preview = Annotated[
    Path | None, typer.Option(metavar="OUT.png", help="Draw the target with its marks and bones.")
]


def pairs(  # numpydoc ignore=PR01
    source: given.Source,
    target: given.Target,
    out: OutPairs = None,
    preview: Preview = None,
    embed: given.Embed = False,
    weights: Weights = None,
    mapping: given.Mapping = None,
    group: Group = None,
    clip: given.SourceClip = None,
    source_up: given.SourceUp = None,
    source_unit: given.SourceUnit = None,
    target_up: given.TargetUp = None,
    target_unit: given.TargetUnit = None,
    check: Check = None,
    mirror: Mirror = None,
    json: Json = False,
) -> None:
    """Find which faces of a still mesh belong to which joint of a motion, without a click."""
    _check_names(out, preview, weights)
    if embed and weights is not None:
        raise ValueError(f"{weights}: --embed leaves weights alone; leave one of --embed and --weights out")
    if check is not None or mirror is not None:
        about = {"source_options": {"up": source_up, "unit": source_unit, "clip": clip}}
        about |= {"target_options": {"up": target_up, "unit": target_unit}}
        look_over(source, target, check, mirror, out, json, mapping=mapping, group=group, **about)
        return
    motion = load_motion(source, None, up=source_up, unit=source_unit, clip=clip)
    if not isinstance(motion, tempose.SkeletonClip):
        raise ValueError(
            f"{source}: is a moving mesh; pairs are found for a skeleton's motion, between two meshes "
            "they are picked"
        )
    goal = load_target(target, weights, group, up=target_up, unit=target_unit)
    began = time.perf_counter()
    matched = tempose.transfer.match(motion, goal, None, load_mapping(mapping), embed)
    found: dict[str, Any] = {"command": "pairs", "inputs": {"source": source, "target": target}}
    found |= {"joints": _faces_per_joint(motion, matched.pairs), "origin": matched.pairs.origin}
    found |= matched.facts | {"warnings": list(matched.warnings), "seconds": time.perf_counter() - began}
    if out is not None:
        with writing(out):
            tempose.transfer.save_pairs(out, matched.listed, source, target)
    if preview is not None:
        with writing(preview):
            tempose.render.save_png(_picture(matched.mesh, matched.pairs), preview)
    _tell(found, out, preview, json)


def _check_names(out: Path | None, preview: Path | None, weights: Path | None) -> None:
    for path, suffix in ((out, ".json"), (preview, ".png"), (weights, ".mhw")):
        if path is not None and path.suffix.lower() != suffix:
            raise ValueError(f"{path}: expected a name that ends in {suffix}")
    for path in (out, preview):
        if path is not None and not path.parent.is_dir():
            raise FileNotFoundError(
                f"{path.parent}: no such folder to write {path.name!r} in; create it first"
            )


def _faces_per_joint(motion: SkeletonClip, found: Pairs) -> dict[str, dict[str, Any]]:
    parts = dict(zip(found.source, found.parts)) if found.parts else {}
    count = {name: 0 for name in motion.skeleton.names}
    for name in found.source:
        count[str(name)] += 1
    return {name: {"part": parts.get(name, ""), "faces": faces} for name, faces in count.items()}


def _picture(mesh: Mesh, found: Pairs) -> Any:
    import numpy as np

    mesh, bones = _towards_us(mesh, found)
    look: dict[str, Any] = {
        "cell": 480,
        "segments": bones[None] if len(bones) else None,
        "face_colors": tempose.transfer.mark_colors(found, len(mesh.faces)),
        "workers": 1,
    }
    views = [tempose.render.contact_sheet(mesh, 1, (view,), **look) for view in ("front", "back", "side")]
    return np.concatenate(views, axis=1)


def _towards_us(mesh: Mesh, found: Pairs) -> tuple[Mesh, Any]:
    """Turn target and bones so that the body's left is on +X, whichever way it faces."""
    import numpy as np

    from tempose.rotations import rotate
    from tempose.transfer.bodies.facing import heading, yaw

    bones = tempose.transfer.bone_segments(found)
    parts = np.array(found.parts or [""] * len(found))
    centres = mesh.vertices[mesh.faces[found.target]].mean(axis=1)
    left, right = (centres[np.char.startswith(parts, side)] for side in ("left_", "right_"))
    if len(left) == 0 or len(right) == 0:
        return mesh, bones
    turn = yaw(np.pi / 2 - heading(left.mean(axis=0) - right.mean(axis=0)))
    return mesh.with_vertices(rotate(turn, mesh.vertices)), rotate(turn, bones)


def _tell(found: dict[str, Any], out: Path | None, preview: Path | None, json: bool) -> None:
    for warning in found["warnings"]:
        note(f"note: {warning}")
    if json:
        show_json(found)
    else:
        marked = {name: row for name, row in found["joints"].items() if row["faces"]}
        rows = [(name, row["part"], str(row["faces"])) for name, row in marked.items()]
        show_table(
            [*rows, ("", "all", str(sum(row["faces"] for row in marked.values())))],
            ("joint", "part", "faces"),
        )
        bare = [name for name, row in found["joints"].items() if not row["faces"]]
        if bare:
            note(f"joints without faces, which move nothing: {', '.join(bare)}")
        note(_trust(found))
    for path in (out, preview):
        if path is not None:
            note(f"wrote {path}")


def _trust(found: dict[str, Any]) -> str:
    placed = found.get("embedding")
    if placed is None:
        return f"pairs from {found['origin']}"
    return (
        f"pairs from {found['origin']}: confidence {placed['confidence']:.2f} "
        f"(penalty {placed['penalty']:.2f}, doubtful above 1), up {placed['up']}"
    )
