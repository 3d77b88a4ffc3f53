"""`tempose rig export`: a rig for any animation package."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tempose.cli.console import note, writing
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


def export(rig_file: RigOrModel, out: Out) -> None:  # numpydoc ignore=PR01
    """Write the skeleton and its motion, to be edited in Blender, Maya or any other package."""
    from tempose.rigging.export import export_rig

    if out.suffix.lower() not in RIG_ENDINGS:
        raise ValueError(f"{out}: a rig is written as {', '.join(RIG_ENDINGS)}, got {out.suffix!r}")
    check_folder(out)
    rig = load_rig(rig_file)
    with writing(out):
        export_rig(rig, out)
    note(f"wrote {out}: {rig.skin.skeleton.n_joints} joints, {rig.motion.n_frames} frames")
