"""The options of `tempose rig` and `tempose detail`, one name each."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Body = Annotated[
    str,
    typer.Argument(
        metavar="CLIP|MESH", help="A moving mesh or a still one: file, folder of frames, glob, name.####.obj."
    ),
]
OutRig = Annotated[
    Path, typer.Option("-o", "--out", metavar="RIG", help="Where the rig goes, by custom NAME.tempose.")
]
SkeletonOption = Annotated[
    str,
    typer.Option(
        "--skeleton",
        metavar="human|auto|FILE",
        help="human puts 18 joints inside a person; auto finds bones from the motion of anything; a FILE "
        "brings its own: a skin (GLB, USD), a BVH skeleton that stands inside the mesh, a rig.",
    ),
]
Bones = Annotated[
    int | None,
    typer.Option(metavar="N", help="For --skeleton auto: how many bones; else as many as the motion needs."),
]
BindFrame = Annotated[
    int | None,
    typer.Option(
        "--frame",
        metavar="FRAME",
        help="Which frame becomes the bind pose, 0-based; else one in which the body is read surely.",
    ),
]
Blending = Annotated[
    str,
    typer.Option(metavar="linear|dual-quaternion", help="How weights blend the turns of joints."),
]
ReportFile = Annotated[
    Path | None, typer.Option("--report", metavar="R.json", help="Write errors, seconds and warnings.")
]
RigPlot = Annotated[
    Path | None,
    typer.Option("--plot", metavar="FOLDER", help="Write pictures: skeleton in the mesh, weights, errors."),
]
Clips = Annotated[
    list[str],
    typer.Argument(metavar="CLIP...", help="Moving meshes with the same vertices; all are learned from."),
]
RigFile = Annotated[
    Path | None,
    typer.Option("--rig", metavar="RIG", help="What `tempose rig fit` wrote; else a human rig is made."),
]
OutModel = Annotated[
    Path, typer.Option("-o", "--out", metavar="MODEL", help="Where the model goes, by custom NAME.tempose.")
]
Learner = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="How detail is learned; auto takes what predicts parts left out best. Else mean, nearest, "
        "ridge, gp, regional-gp, gplvm or gplvm-paper.",
    ),
]
Basis = Annotated[
    str,
    typer.Option(
        metavar="blended|root|world",
        help="In which axes detail is learned; world is the paper's, and turns badly.",
    ),
]
Resolution = Annotated[
    float | None,
    typer.Option(
        metavar="PERCENT",
        help="Learn on so many percent of the vertices, 5 to 100: smaller files. All without it.",
    ),
]
DetailPlot = Annotated[
    Path | None,
    typer.Option(
        "--plot",
        metavar="FOLDER",
        help="Write pictures: latent space, errors of every frame, variance, sheets.",
    ),
]
ModelFile = Annotated[
    Path,
    typer.Argument(
        metavar="MODEL", help="What `tempose detail fit` wrote; or a rig, whose skin alone is posed."
    ),
]
Motion = Annotated[
    str | None,
    typer.Argument(
        metavar="MOTION",
        help="Motion of the skeleton, as exported and edited or of another clip: BVH, GLB, USD, or a rig. "
        "Without it, the motion that was learned from.",
    ),
]
Mapping = Annotated[
    Path | None,
    typer.Option(
        "--map",
        metavar="MAPPING.json",
        help='Joints with odd names: {"LeftForeArm": "left_forearm"}, theirs to ours.',
    ),
]
MissingRest = Annotated[
    bool,
    typer.Option(
        "--missing-rest", help="Joints of the rig that MOTION does not move stay at rest; else an error."
    ),
]
Strength = Annotated[
    list[str] | None,
    typer.Option(
        metavar="S|JOINT=S",
        help="How much of the detail: 0 none, 1 as learned, more exaggerates; or by joint. Repeatable.",
    ),
]
Damp = Annotated[
    float | None,
    typer.Option(metavar="SECONDS", help="Smooth detail over time; the body is not smoothed."),
]
Mask = Annotated[
    str | None,
    typer.Option(
        metavar="FILE|JOINTS",
        help="Where detail is added: joints between commas, or .npy or .json with a number for each vertex.",
    ),
]
Proportions = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE.json",
        help='Other proportions: {"left_shin": 1.2, "spine": {"length": 1, "thickness": 0.8}}.',
    ),
]
