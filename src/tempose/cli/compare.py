"""`tempose compare`: how far one clip is from another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import note, progress_bar, show_json, show_table
from tempose.cli.options import FromUnit, FromUp, Json

if TYPE_CHECKING:
    from tempose.clips import MeshClip

_MEANING = {
    "rms": "m, root mean square of vertex distances",
    "rms_percent": "% of the diagonal of A's rest pose",
    "p99_percent": "% of the diagonal, 99th percentile",
    "max_percent": "% of the diagonal, worst vertex",
    "e_rms": "per mille of half the diagonal (Kavan 2010)",
    "kg": "% of A's spread (Karni-Gotsman)",
    "frames": "",
    "vertices": "",
}


def compare(  # numpydoc ignore=PR01
    a: Annotated[str, typer.Argument(metavar="A", help="The true mesh or clip.")],
    b: Annotated[str, typer.Argument(metavar="B", help="The one to judge, with the same vertices.")],
    from_up: FromUp = None,
    from_unit: FromUnit = None,
    json: Json = False,
) -> None:
    """Measure how far B is from A, vertex by vertex and frame by frame."""
    first, second = (_load(path, from_up, from_unit) for path in (a, b))
    if first.vertices.shape != second.vertices.shape:
        raise ValueError(f"{b}: has {_size(second)}, expected those of {a}: {_size(first)}")
    if not (first.faces.shape == second.faces.shape and bool((first.faces == second.faces).all())):
        note("the faces differ; vertices are compared by their number")
    result = measure(first, second)
    if json:
        show_json(result)
    else:
        show_table([(k, f"{v:.6g}", _MEANING[k]) for k, v in result.items()])


def measure(first: MeshClip, second: MeshClip) -> dict[str, Any]:
    """Return the errors of one clip against another under the keys that reports use.

    Parameters
    ----------
    first, second : MeshClip
        The true clip and the one to judge, of one shape.

    Returns
    -------
    dict
        The errors, ``frames`` and ``vertices``.
    """
    errors = tempose.metrics.compare(first.vertices, second.vertices, first.mesh.diagonal)
    return {**errors.as_dict(), "frames": first.n_frames, "vertices": len(first.rest)}


def _load(path: str, up: str | None, unit: str | None) -> MeshClip:
    with progress_bar() as progress:
        clip = tempose.formats.load_clip(path, up=up, unit=unit, progress=progress)
    note(tempose.formats.describe(clip))
    return clip


def _size(clip: MeshClip) -> str:
    return f"{clip.n_frames} frames of {len(clip.rest)} vertices"
