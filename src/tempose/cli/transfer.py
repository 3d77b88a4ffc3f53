"""`tempose transfer`: a still scan moves as a motion-capture clip does."""

from __future__ import annotations

import time
from typing import Any

import tempose
from tempose.cli import transfer_options as given
from tempose.cli.console import progress_bar, tell, writing
from tempose.cli.options import Group, Json, check_out
from tempose.cli.report import make_report, write_report
from tempose.cli.transfer_contacts import load_contacts, parse_ground
from tempose.cli.transfer_frames import releasing, room_for_frames
from tempose.cli.transfer_inputs import load_mapping, load_motion, load_pairs, load_rest, load_target

LEAD = 0.6
"""As `tempose.transfer.transfer_motion` has it; stated again so that ``--help`` need not load the library."""


def transfer(  # numpydoc ignore=PR01
    source: given.Source,
    target: given.Target,
    out: given.Out,
    pairs: given.PairsFile = None,
    embed: given.Embed = False,
    source_rest: given.SourceRest = None,
    mapping: given.Mapping = None,
    contacts: given.Contacts = True,
    contact_frames: given.ContactFrames = None,
    ground: given.Ground = None,
    adjust: given.Adjust = None,
    volume: given.Volume = 0.0,
    twist: given.Twist = True,
    lead: given.Lead = LEAD,
    singular: given.Singular = "reference",
    start: given.Start = 0,
    stop: given.Stop = None,
    step: given.Step = 1,
    clip: given.SourceClip = None,
    group: Group = None,
    source_up: given.SourceUp = None,
    source_unit: given.SourceUnit = None,
    source_fps: given.SourceFps = None,
    target_up: given.TargetUp = None,
    target_unit: given.TargetUnit = None,
    report: given.ReportFile = None,
    save_pairs: given.SavePairs = None,
    measure: given.Measure = True,
    json: Json = False,
) -> None:
    """Move a still mesh as a motion-capture clip, or another mesh, moves."""
    began = time.perf_counter()
    apart = ("source", "target", "out", "report", "json", "began", "apart")
    options = {name: value for name, value in locals().items() if name not in apart}
    check_out(out)
    if embed and pairs is not None:
        raise ValueError(f"{pairs}: --embed finds pairs itself; leave one of --embed and --pairs out")
    listed = load_pairs(pairs)
    motion = load_motion(source, listed, up=source_up, unit=source_unit, fps=source_fps, clip=clip)
    goal = load_target(target, pairs, group, up=target_up, unit=target_unit)
    settings: dict[str, Any] = {"mapping": load_mapping(mapping), "volume": volume}
    settings |= {"contacts": load_contacts(contact_frames, contacts), "ground": parse_ground(ground)}
    settings |= {"embed": embed, "twist": twist, "lead": lead, "singular": singular, "measure": measure}
    if adjust is not None:
        settings["adjustments"] = tempose.transfer.load_adjustments(adjust)
    settings |= load_rest(source_rest, motion)
    loaded = time.perf_counter()
    trimmed = _trimmed(motion, start, stop, step)
    with room_for_frames(trimmed.n_frames, _n_vertices(goal), out) as scratch:
        with progress_bar() as progress:
            result = tempose.transfer.transfer_motion(
                trimmed, goal, listed, scratch=scratch, progress=progress, **settings
            )
        moved = time.perf_counter()
        with progress_bar() as progress, writing(out):
            tempose.save(out, result.clip, progress=releasing(progress, result.clip))
        saved = time.perf_counter()
    if save_pairs is not None:
        with writing(save_pairs):
            tempose.transfer.save_pairs(save_pairs, result.pairs, source, target)
    stages = {"load": loaded - began, **result.report["seconds"], "save": saved - moved}
    inputs = {"source": source, "target": target, "out": str(out)}
    full = make_report("transfer", inputs, options, result.report | {"seconds": stages}, began)
    if report is not None:
        write_report(report, full)
    tell(full, [*summary_rows(full), ("seconds", f"{full['seconds']['total']:.1f}")], json)


def _trimmed(motion: Any, start: int, stop: int | None, step: int) -> Any:
    from tempose.clips.resample import select_frames

    return motion if (start, stop, step) == (0, None, 1) else select_frames(motion, start, stop, step)


def _n_vertices(target: Any) -> int:
    return len(getattr(target, "mesh", target).vertices)


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
    if report.get("embedding"):
        penalty = report["embedding"]["penalty"]
        rows.append(("skeleton placed inside", f"penalty {penalty:.2f}, doubtful above 1"))
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
    if report.get("adjustments"):
        rows.append(("adjustments", adjustments_line(report["adjustments"])))
    return rows


def adjustments_line(found: dict[str, Any]) -> str:
    """Say in one line what became of the adjustments.

    Parameters
    ----------
    found : dict
        ``adjustments`` of a report.

    Returns
    -------
    str
        How many there were, frames changed, how many missed their place.
    """
    missed = f", {len(found['unmet'])} out of reach" if found["unmet"] else ""
    return f"{found['count']}, {found['frames_changed']} frames changed{missed}"
