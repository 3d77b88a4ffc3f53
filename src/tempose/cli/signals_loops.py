"""`tempose signals loops`: where a clip could be played round and round."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import tempose
from tempose.cli.console import note, progress_bar, show_json, show_table
from tempose.cli.options import Clip, Group, Json
from tempose.cli.signals_files import load_signals
from tempose.cli.signals_options import InputFps, InputUnit, InputUp

if TYPE_CHECKING:
    from tempose.signals.loops import Loop
    from tempose.typing import FloatArray

LoopInput = Annotated[
    str, typer.Argument(metavar="CLIP|MODEL", help="A moving mesh, or what `tempose signals fit` wrote.")
]
Most = Annotated[int, typer.Option(metavar="N", min=1, help="How many are listed.")]
Shortest = Annotated[
    int | None,
    typer.Option(
        metavar="FRAMES",
        min=2,
        help="Shorter loops are not looked for; a quarter of a second if nothing is said.",
        show_default=False,
    ),
]


def loops(  # numpydoc ignore=PR01
    file: LoopInput,
    most: Most = 8,
    shortest: Shortest = None,
    up: InputUp = None,
    unit: InputUnit = None,
    fps: InputFps = None,
    group: Group = None,
    clip: Clip = None,
    json: Json = False,
) -> None:
    """Find parts that can be played round and round, the best first."""
    from tempose.signals.loops import find_loops
    from tempose.signals.time.period import find_period

    reading: dict[str, Any] = {"up": up, "unit": unit, "fps": fps, "group": group, "clip": clip}
    X, rate = _coordinates(file, reading)
    found, period = find_loops(X, shortest, most, fps=rate), find_period(X)
    ticks = None if period is None else period.ticks
    if json:
        show_json({"period": ticks, "fps": rate, "loops": [_facts(loop) for loop in found]})
        return
    if found:
        rows = [_row(loop, rate) for loop in found]
        show_table(rows, ("from", "to", "frames", "seconds", "jump, steps", "change of speed", ""))
        entry = f'{{"op": "close_loop", "from": {found[0].start}, "to": {found[0].stop}}}'
        if found[0].grade == "needs a transition":
            note(f"none comes back smoothly; {entry} makes the best of the first")
        else:
            note(f"to keep the first, as an entry of an edit list: {entry}")
    else:
        least = "a quarter of a second" if shortest is None else f"{shortest} frames"
        note(f"no loop of {least} or more: the clip never comes near a pose it has been in")
    if not found or found[0].grade == "needs a transition":
        _advise_placement(file)
    if ticks is not None:
        note(f"the clip repeats every {ticks:.4g} frames ({ticks / rate:.3g} s)")


def _coordinates(file: str, reading: dict[str, Any]) -> tuple[FloatArray, float]:
    if Path(file).suffix.lower() == ".tempose":
        signals = load_signals(Path(file)).signals_
        return signals.coordinates(signals.times), signals.fps
    from tempose.signals.loops.of_clip import clip_coordinates, travels

    with progress_bar() as progress:
        source = tempose.formats.load_clip(file, progress=progress, **reading)
    note(tempose.formats.describe(source))
    placement = travels(source)
    if placement:
        note("the body travels: where it stands and which way it faces is left out of the comparison")
    try:
        with progress_bar() as progress:
            return clip_coordinates(source, placement, progress), source.fps
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from None


def _advise_placement(file: str) -> None:
    if Path(file).suffix.lower() == ".tempose" and load_signals(Path(file)).signals_.placement is None:
        note("where the body stands was compared, too; if it travels, fit with --placement")


def _facts(loop: Loop) -> dict[str, Any]:
    facts: dict[str, Any] = {"from": loop.start, "to": loop.stop, "frames": loop.period}
    return facts | {"distance": loop.distance, "velocity": loop.velocity, "grade": loop.grade}


def _row(loop: Loop, fps: float) -> list[str]:
    numbers = (f"{loop.period / fps:.3g}", f"{loop.distance:.3f}", f"{loop.velocity:.2f}")
    return [str(loop.start), str(loop.stop), str(loop.period), *numbers, loop.grade]
