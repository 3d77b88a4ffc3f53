"""`tempose rig export`: a rig for any animation package."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tempose.cli.console import note, progress_bar, writing
from tempose.cli.options import UnitOption, Up
from tempose.cli.rig_files import RIG_ENDINGS, load_rig
from tempose.cli.signals_files import check_folder

RigOrModel = Annotated[
    Path, typer.Argument(metavar="RIG", help="What `tempose rig fit` or `tempose detail fit` wrote.")
]
Out = Annotated[
    Path,
    typer.Option(
        "-o",
        "--out",
        metavar="OUT",
        help="OUT.bvh takes the skeleton and its motion; OUT.glb and OUT.usda the skinned mesh as well.",
    ),
]


def export(
    rig_file: RigOrModel, out: Out, up: Up = None, unit: UnitOption = None
) -> None:  # numpydoc ignore=PR01
    """Write the skeleton and its motion, to be edited in Blender, Maya or any other package."""
    from tempose.rigging.export import export_rig

    if out.suffix.lower() not in RIG_ENDINGS:
        raise ValueError(f"{out}: a rig is written as {', '.join(RIG_ENDINGS)}, got {out.suffix!r}")
    check_folder(out)
    rig = load_rig(rig_file)
    with progress_bar() as progress, writing(out):
        written = export_rig(rig, out, up=up, unit=unit, progress=progress)
    for warning in written.warnings:
        note(f"note: {warning}")
    note(f"wrote {out}: {rig.skin.skeleton.n_joints} joints, {written.frames} frames")
