"""`tempose transfer`: a still scan moves as a motion-capture clip does."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

import tempose
from tempose.cli.console import note, progress_bar, show_json, show_table, writing
from tempose.cli.options import Group, Json, check_out
from tempose.cli.report import make_report, write_report
from tempose.cli.transfer_inputs import load_mapping, load_motion, load_pairs, load_rest, load_target


def transfer(  # numpydoc ignore=PR01
    source: Annotated[
        str,
        typer.Argument(metavar="SOURCE", help="The motion: BVH, AMC, GLB, or a moving mesh with --pairs."),
    ],
    target: Annotated[str, typer.Argument(metavar="TARGET", help="The mesh to move, at rest.")],
    out: Annotated[
        Path, typer.Option("-o", "--out", metavar="OUT", help="Where the moving target goes, as for convert.")
    ],
    pairs: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="What moves what: JSON or TOML pairs, .cons or .yml markers, MakeHuman .mhw weights; "
            "without it, the skin weights in TARGET.",
        ),
    ] = None,
    source_rest: Annotated[
        str | None,
        typer.Option(
            metavar="FILE|FRAME", help="Reference pose of the source: a file, or a frame of it, 0-based."
        ),
    ] = None,
    mapping: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="JSON: source joint to body part, where names do not tell."),
    ] = None,
    contacts: Annotated[
        bool, typer.Option("--contacts/--no-contacts", help="Hold feet still while they touch the ground.")
    ] = True,
    volume: Annotated[
        float, typer.Option(metavar="W", min=0, help="Hold the volume at bends; 1 holds most of it.")
    ] = 0.0,
    start: Annotated[int, typer.Option(metavar="FRAME", help="First frame of the source, 0-based.")] = 0,
    stop: Annotated[int | None, typer.Option(metavar="FRAME", help="First frame left out.")] = None,
    step: Annotated[int, typer.Option(metavar="N", help="Use every N-th frame, at the same speed.")] = 1,
    clip: Annotated[
        str | None, typer.Option(metavar="NAME", help="Which animation of SOURCE, where it holds several.")
    ] = None,
    group: Group = None,
    source_up: Annotated[str | None, typer.Option(metavar="x|y|z", help="Up axis of SOURCE.")] = None,
    source_unit: Annotated[str | None, typer.Option(metavar="UNIT", help="Unit of SOURCE.")] = None,
    source_fps: Annotated[float | None, typer.Option(metavar="F", help="Rate of SOURCE.")] = None,
    target_up: Annotated[str | None, typer.Option(metavar="x|y|z", help="Up axis of TARGET.")] = None,
    target_unit: Annotated[str | None, typer.Option(metavar="UNIT", help="Unit of TARGET.")] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="R.json", help="Write measures, seconds and warnings.")
    ] = None,
    save_pairs: Annotated[
        Path | None, typer.Option(metavar="PAIRS.json", help="Write the pairs that were used.")
    ] = None,
    json: Json = False,
) -> None:
    """Move a still mesh as a motion-capture clip, or another mesh, moves."""
    began = time.perf_counter()
    options = {
        k: v for k, v in locals().items() if k not in ("source", "target", "out", "report", "json", "began")
    }
    check_out(out)
    listed = load_pairs(pairs)
    motion = load_motion(source, listed, up=source_up, unit=source_unit, fps=source_fps, clip=clip)
    goal = load_target(target, pairs, group, up=target_up, unit=target_unit)
    rest = load_rest(source_rest, motion)
    loaded = time.perf_counter() - began
    with progress_bar() as progress:
        result = tempose.transfer.transfer_motion(
            _trimmed(motion, start, stop, step),
            goal,
            listed,
            mapping=load_mapping(mapping),
            volume=volume,
            contacts=contacts,
            progress=progress,
            **rest,
        )
    saving = time.perf_counter()
    with progress_bar() as progress, writing(out):
        tempose.save(out, result.clip, progress=progress)
    if save_pairs is not None:
        with writing(save_pairs):
            tempose.transfer.save_pairs(save_pairs, result.pairs, source, target)
    found = result.report | {
        "seconds": {"load": loaded, **result.report["seconds"], "save": time.perf_counter() - saving}
    }
    full = make_report(
        "transfer", {"source": source, "target": target, "out": str(out)}, options, found, began
    )
    if report is not None:
        write_report(report, full)
    _tell(full, json)


def _trimmed(motion: Any, start: int, stop: int | None, step: int) -> Any:
    from tempose.clips.resample import select_frames

    return motion if (start, stop, step) == (0, None, 1) else select_frames(motion, start, stop, step)


def _tell(report: dict[str, Any], json: bool) -> None:
    for warning in report["warnings"]:
        note(f"note: {warning}")
    if json:
        show_json(report)
        return
    show_table([*summary_rows(report), ("seconds", f"{report['seconds']['total']:.1f}")])
    note(f"wrote {report['inputs']['out']}")


def summary_rows(report: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the measures of a transfer that a person wants to read.

    Parameters
    ----------
    report : dict
        Of a transfer.

    Returns
    -------
    list of (str, str)
        Name and value.
    """
    rows: list[tuple[str, str]] = []
    if report.get("bone_direction_deg"):
        angles = report["bone_direction_deg"]
        rows.append(("bone directions off by", f"{angles['mean']:.1f} deg mean, {angles['max']:.1f} at most"))
    if report.get("edge_ratio"):
        low, high = report["edge_ratio"]
        rows.append(("edge lengths, of those at rest", f"{low:.2f} to {high:.2f} (1st to 99th percentile)"))
        rows.append(
            (
                "flipped, folded triangles",
                f"{report['flipped_percent']:.3f} %, {report['folded_percent']:.3f} %",
            )
        )
    if report.get("volume_worst") is not None:
        rows.append(("volume, worst frame", f"{report['volume_worst']:+.1f} %"))
    if report.get("skate") is not None:
        rows.append(
            (
                "feet slide",
                f"{report['skate']:.1f} % of the height a second (source {report['source_skate']:.1f})",
            )
        )
    return rows
