"""The options of `tempose transfer`, one name each."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Source = Annotated[
    str,
    typer.Argument(metavar="SOURCE", help="The motion: BVH, AMC, GLB, or a moving mesh with --pairs."),
]
Target = Annotated[str, typer.Argument(metavar="TARGET", help="The mesh to move, at rest.")]
Out = Annotated[
    Path, typer.Option("-o", "--out", metavar="OUT", help="Where the moving target goes, as for convert.")
]
PairsFile = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="What moves what: JSON or TOML pairs, .cons or .yml markers, MakeHuman .mhw weights; "
        "without it, the skin weights in TARGET, else a skeleton placed inside it.",
    ),
]
Embed = Annotated[
    bool, typer.Option("--embed", help="Place a skeleton inside TARGET although it has skin weights.")
]
SourceRest = Annotated[
    str | None,
    typer.Option(
        metavar="FILE|FRAME", help="Reference pose of the source: a file, or a frame of it, 0-based."
    ),
]
Mapping = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="JSON: source joint to body part, where names do not tell."),
]
Contacts = Annotated[
    bool, typer.Option("--contacts/--no-contacts", help="Hold feet still while they touch the ground.")
]
ContactFrames = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="JSON: foot to its contacts [first frame, first after it], instead of found ones.",
    ),
]
Ground = Annotated[
    str | None,
    typer.Option(metavar="HEIGHT|none", help="Plane, in metres, to stand on; nothing sinks into it."),
]
Adjust = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="JSON or TOML: parts moved or turned at a frame, smoothly in and out."),
]
Volume = Annotated[
    float, typer.Option(metavar="W", min=0, help="Hold the volume at bends; 1 holds most of it.")
]
Twist = Annotated[
    bool,
    typer.Option("--twist/--no-twist", help="Spread the twist of hands, arms and thighs along the limb."),
]
Lead = Annotated[
    float,
    typer.Option(
        metavar="W",
        min=0,
        max=1,
        help="Turn limbs further, so that their surface follows the bone; 1 exactly, at more stretch.",
    ),
]
Singular = Annotated[
    str,
    typer.Option(
        metavar="reference|path|none",
        help="Where limbs turn by half a turn: take a frame before as reference, or lay paths over the skin.",
    ),
]
Measure = Annotated[
    bool, typer.Option("--measure/--no-measure", help="Measure the result; takes longer than making it.")
]
Start = Annotated[int, typer.Option(metavar="FRAME", help="First frame of the source, 0-based.")]
Stop = Annotated[int | None, typer.Option(metavar="FRAME", help="First frame left out.")]
Step = Annotated[int, typer.Option(metavar="N", help="Use every N-th frame, at the same speed.")]
SourceClip = Annotated[
    str | None, typer.Option(metavar="NAME", help="Which animation of SOURCE, where it holds several.")
]
SourceUp = Annotated[str | None, typer.Option(metavar="x|y|z", help="Up axis of SOURCE.")]
SourceUnit = Annotated[str | None, typer.Option(metavar="UNIT", help="Unit of SOURCE.")]
SourceFps = Annotated[float | None, typer.Option(metavar="F", help="Rate of SOURCE.")]
TargetUp = Annotated[str | None, typer.Option(metavar="x|y|z", help="Up axis of TARGET.")]
TargetUnit = Annotated[str | None, typer.Option(metavar="UNIT", help="Unit of TARGET.")]
ReportFile = Annotated[
    Path | None, typer.Option(metavar="R.json", help="Write measures, seconds and warnings.")
]
SavePairs = Annotated[Path | None, typer.Option(metavar="PAIRS.json", help="Write the pairs that were used.")]
