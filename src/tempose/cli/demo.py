"""`tempose demo`: the methods on built-in characters, with pictures, tables and a page."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import note, progress_bar, show_table, writing
from tempose.cli.demo_cases import CASES, Case, make_target
from tempose.cli.demo_detail import HEADER as DETAIL_HEADER
from tempose.cli.demo_detail import NAME as DETAIL
from tempose.cli.demo_detail import detail_row, run_detail
from tempose.cli.demo_page import HEADER, table_row, write_page
from tempose.cli.demo_signals import HEADER as SIGNALS_HEADER
from tempose.cli.demo_signals import NAME as SIGNALS
from tempose.cli.demo_signals import run_signals, signals_row
from tempose.cli.report import make_report, write_report

if TYPE_CHECKING:
    from tempose.transfer import TransferResult
    from tempose.typing import Progress

_CELL = 200
_MOMENTS = 7
_FILM = (280, 340)
_FILMED = 48
"""Frames of a clip that its film shows, every second one."""


def demo(  # numpydoc ignore=PR01
    out: Annotated[
        Path, typer.Option("-o", "--out", metavar="DIR", help="Folder for pictures, clips and report.html.")
    ] = Path("demo"),
    only: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help=f"Only one of {', '.join(c.name for c in CASES)}, {SIGNALS}, {DETAIL}."
        ),
    ] = None,
) -> None:
    """Show what Tempose does, on built-in characters; takes a few minutes and no network."""
    cases = [case for case in CASES if only in (None, case.name)]
    if not cases and only not in (SIGNALS, DETAIL):
        known = ", ".join([*(case.name for case in CASES), SIGNALS, DETAIL])
        raise ValueError(f"--only must be one of {known}, got {only!r}")
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    reports: list[dict[str, Any]] = []
    curve: dict[str, Any] | None = None
    learned: dict[str, Any] | None = None
    count = len(cases) + (only in (None, SIGNALS)) + (only in (None, DETAIL))
    for i, case in enumerate(cases):
        note(f"{i + 1} of {count}: {case.title.lower()} onto the {case.target}")
        with progress_bar() as progress, writing(out):
            reports.append(_run(case, out, progress))
    if only in (None, SIGNALS):
        note(f"{len(cases) + 1} of {count}: a gallop as a curve, edited")
        with progress_bar() as progress, writing(out):
            curve = run_signals(out, progress)
    if only in (None, DETAIL):
        note(f"{count} of {count}: a skeleton, and a skirt that follows it")
        with progress_bar() as progress, writing(out):
            learned = run_detail(out, progress)
    with writing(out):
        write_page(out, reports, curve, learned)
    found: dict[str, Any] = {"transfers": reports} | ({} if curve is None else {"signals": curve})
    found |= {} if learned is None else {"detail": learned}
    write_report(out / "report.json", make_report("demo", {}, {"only": only}, found, began))
    _show(reports, curve, learned)
    note(f"{time.perf_counter() - began:.0f} s; open {out / 'report.html'}")


def _run(case: Case, folder: Path, progress: Progress) -> dict[str, Any]:
    progress(0, 0, "making the character")
    motion, target = case.motion(), make_target(case.target)
    result = tempose.transfer.transfer_motion(motion, target, progress=progress)
    tempose.save(folder / f"{case.name}.glb", result.clip, progress=progress)
    _draw(case, result, folder, progress)
    return {
        "name": case.name,
        "title": case.title,
        "about": case.about,
        "frames": result.clip.n_frames,
        "fps": result.clip.fps,
        "triangles": len(result.clip.faces),
        **result.report,
    }


def _draw(case: Case, result: TransferResult, folder: Path, progress: Progress) -> None:
    from tempose.clips.resample import select_frames

    shown = [result.clip] if result.source is None else [result.source, result.clip]
    names = ["source", "character"][-len(shown) :]
    look: dict[str, Any] = {"names": names, "cell": _CELL, "frames": _MOMENTS}
    tempose.render.render(shown, folder / f"{case.name}.png", progress=progress, **look)
    if case.film:
        fewer = [select_frames(clip, stop=min(_FILMED, clip.n_frames), step=2) for clip in shown]
        tempose.render.render(fewer, folder / f"{case.name}.mp4", progress=progress, size=_FILM)


def _show(
    reports: list[dict[str, Any]], curve: dict[str, Any] | None, learned: dict[str, Any] | None
) -> None:
    rows = [[_text(value) for value in table_row(report["title"], report)] for report in reports]
    if rows:
        show_table(rows, HEADER, numbers=True)
    if curve is not None:
        show_table([[_text(value) for value in signals_row(curve)]], SIGNALS_HEADER, numbers=True)
    if learned is not None:
        show_table([[_text(value) for value in detail_row(learned)]], DETAIL_HEADER, numbers=True)


def _text(value: Any) -> str:
    if value is None:
        return "-"
    # what is below a thousandth is rounding, not news
    return f"{round(value, 3):.3g}" if isinstance(value, float) else str(value)
