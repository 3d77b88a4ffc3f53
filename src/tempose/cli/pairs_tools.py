"""`tempose pairs --check` and `--mirror`: a list made by hand is looked over and completed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import note, show_json, show_table, writing
from tempose.cli.transfer_inputs import load_mapping, load_motion, load_target

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip, Skeleton, SkeletonClip
    from tempose.transfer import Finding, Pairs

Check = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="Look over these pairs instead of finding some; ends with 1 if one is wrong."
    ),
]
Mirror = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE", help="Add the other side of these pairs; write them with -o, and look them over."
    ),
]


def look_over(
    source: str,
    target: str,
    check: Path | None,
    mirror: Path | None,
    out: Path | None,
    json: bool,
    *,
    mapping: Path | None,
    group: str | None,
    source_options: dict[str, Any],
    target_options: dict[str, Any],
) -> None:
    """Check a list of pairs, after adding its other side if that is asked for.

    Parameters
    ----------
    source, target : str
        Files between which the pairs are.
    check, mirror : Path or None
        The list; one of them.
    out : Path or None
        Where mirrored pairs are written.
    json : bool
        Whether to print JSON.
    mapping : Path or None
        Joint names.
    group : str or None
        Keep only this group of faces of the target.
    source_options, target_options : dict
        As for `tempose.load`.

    Raises
    ------
    ValueError
        If both lists are given, or the pairs do not fit.
    """
    path = check or mirror
    if path is None or (check is not None and mirror is not None):
        raise ValueError("give --check FILE or --mirror FILE, not both: mirrored pairs are checked anyway")
    if mirror is None and out is not None:
        raise ValueError(f"{out}: --check writes nothing; leave -o out, or use --mirror")
    listed = tempose.transfer.load_pairs(path)
    motion = load_motion(source, listed, **source_options)
    goal = load_target(target, None, group, **target_options)
    mesh = goal if isinstance(goal, tempose.Mesh) else goal.mesh
    report: dict[str, Any] = {"command": "pairs", "inputs": {"source": source, "target": target}}
    start = motion.skeleton if isinstance(motion, tempose.SkeletonClip) else motion.mesh
    if mirror is not None:
        listed, report["mirrored"] = _mirrored(listed, mesh, start)
        if out is not None:
            with writing(out):
                tempose.transfer.save_pairs(out, listed, source, target)
            note(f"wrote {out}")
    found = _findings(listed, mesh, motion, start, load_mapping(mapping))
    _tell(report | {"pairs": len(listed)}, found, json)
    if any(finding.severity == "error" for finding in found):
        raise typer.Exit(1)


def _mirrored(listed: Pairs, mesh: Mesh, start: Mesh | Skeleton) -> tuple[Pairs, int]:
    made = tempose.transfer.mirror_pairs(listed, mesh, start)
    for warning in made.warnings:
        note(f"note: {warning}")
    note(f"{made.added} pairs added to {len(listed)}")
    return made.pairs, made.added


def _findings(
    listed: Pairs,
    mesh: Mesh,
    motion: SkeletonClip | MeshClip,
    start: Mesh | Skeleton,
    mapping: dict[str, str] | None,
) -> tuple[Finding, ...]:
    # a target that lies is stood up first, as it will be for the transfer
    matched = tempose.transfer.match(motion, mesh, listed, mapping)
    return tempose.transfer.check_coverage(matched.pairs, matched.mesh, start)


def _tell(report: dict[str, Any], found: tuple[Finding, ...], json: bool) -> None:
    if json:
        show_json(report | {"findings": [finding.as_dict() for finding in found]})
        return
    if not found:
        note(f"nothing to say about {report['pairs']} pairs")
        return
    rows = [(f.severity, f.place, f.message, f.advice) for f in found]
    show_table(rows, ("", "where", "what", "what to do"))
