"""The page that `tempose demo` leaves behind."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import tempose
from tempose.cli.demo_detail import detail_section
from tempose.cli.demo_signals import signals_section

if TYPE_CHECKING:
    from tempose.render import Section, Table

HEADER = (
    "transfer",
    "frames",
    "triangles",
    "off deg",
    "worst",
    "edges p1",
    "p99",
    "flipped %",
    "volume %",
    "skate",
    "source's",
    "seconds",
)
"""Short, so that the table fits a terminal; `LEGEND` says what they mean."""

LEGEND = (
    "off: angle between the bones of the source and of the result, mean and worst. edges: length over that "
    "at rest, 1st and 99th percentile, without head, hands and feet. flipped: triangles that face the wrong "
    "way. volume: of the worst frame against rest. skate: how fast feet in contact slide, percent of the "
    "height a second, of the result and of the source."
)

_INTRO = """\
Nothing here was downloaded: characters and motions are made by formulas. Each motion was performed by a
skeleton of other proportions than the character that it moves. The character's skin weights only say which
triangles belong to which limb; its motion is found by spreading the rotations of marked triangles over its
surface and gluing the torn surface again.

Bone directions tell whether the pose is right, edge lengths and volume whether the surface suffered,
sliding feet whether it stands on the ground."""


def table_row(name: str, report: dict[str, Any]) -> list[Any]:
    """Return the measures of one transfer in the order of `HEADER`.

    Parameters
    ----------
    name : str
        What was moved how.
    report : dict
        Of the transfer.

    Returns
    -------
    list
        A value a column; None where a measure does not apply.
    """
    angles = report.get("bone_direction_deg") or {}
    low, high = report.get("edge_ratio") or (None, None)
    return [
        name,
        report["frames"],
        report["triangles"],
        angles.get("mean"),
        angles.get("max"),
        low,
        high,
        report.get("flipped_percent"),
        report.get("volume_worst"),
        report.get("skate"),
        report.get("source_skate"),
        report["seconds"]["total"],
    ]


def write_page(
    folder: Path,
    reports: Sequence[dict[str, Any]],
    signals: dict[str, Any] | None = None,
    detail: dict[str, Any] | None = None,
) -> None:
    """Write ``report.html``, which opens without a network.

    Parameters
    ----------
    folder : Path
        Where the pictures of the demo lie.
    reports : sequence of dict
        Of the transfers, in the order in which they are shown.
    signals : dict, optional
        Of the clip that became a curve.
    detail : dict, optional
        Of the skirt that follows a skeleton.
    """
    render = tempose.render
    sections = [render.Section("Overview", [_INTRO, _table(reports)])] if reports else []
    sections += [_section(folder, report) for report in reports]
    if signals is not None:
        sections.append(signals_section(folder, signals))
    if detail is not None:
        sections.append(detail_section(folder, detail))
    render.html_report(
        "Tempose demo",
        sections,
        folder / "report.html",
        subtitle=f"motion for meshes, clips as curves, a skirt that follows; Tempose {tempose.__version__}",
    )


def _table(reports: Sequence[dict[str, Any]]) -> Table:
    rows = [table_row(report["title"], report) for report in reports]
    return tempose.render.Table(
        HEADER, rows, "Without head, hands and feet, which move rigidly and would flatter."
    )


def _section(folder: Path, report: dict[str, Any]) -> Section:
    render = tempose.render
    name, blocks = report["name"], [report["about"]]
    film = folder / f"{name}.mp4"
    shown: list[Any] = [render.Figure(film, "Source, and what it moves.")] if film.is_file() else []
    shown.append(
        render.Figure(folder / f"{name}.png", "The skeleton that performed, above; the character, below.")
    )
    if report.get("volume"):
        seconds = [t / report["fps"] for t in range(len(report["volume"]))]
        curve = render.line_chart(
            {"volume": report["volume"]}, seconds, x_label="seconds", y_label="percent", limits={"rest": 0.0}
        )
        shown.append(render.Chart(curve, "Change of volume against rest."))
    warnings = [f"Note: {warning}." for warning in report["warnings"]]
    return render.Section(report["title"], [*blocks, *shown, *warnings])
