"""`tempose rig fit`: a mesh or a clip gets a skeleton."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Literal, cast

from tempose.cli import rig_options as given
from tempose.cli import signals_options as reading_options
from tempose.cli.console import note, progress_bar, tell, writing
from tempose.cli.options import Clip, Group, Json, Start, Step, Stop, Topology
from tempose.cli.report import make_report, write_report
from tempose.cli.rig_files import check_kept_out, check_skeleton, load_body, load_skeleton
from tempose.cli.signals_files import check_folder
from tempose.cli.signals_options import merged_options

if TYPE_CHECKING:
    from tempose.clips import Mesh, MeshClip
    from tempose.rigging import Rig

_BLENDING = ("linear", "dual-quaternion")


def fit(  # numpydoc ignore=PR01
    body_file: given.Body,
    out: given.OutRig,
    skeleton: given.SkeletonOption = "human",
    bones: given.Bones = None,
    frame: given.BindFrame = None,
    blending: given.Blending = "linear",
    report: given.ReportFile = None,
    plot: given.RigPlot = None,
    start: Start = None,
    stop: Stop = None,
    step: Step = None,
    up: reading_options.InputUp = None,
    unit: reading_options.InputUnit = None,
    fps: reading_options.InputFps = None,
    group: Group = None,
    clip: Clip = None,
    topology: Topology = None,
    json: Json = False,
) -> None:
    """Find a skeleton for a mesh or a clip, bind the mesh to it, and follow the clip with it."""
    began = time.perf_counter()
    options = merged_options(locals(), "body_file", "out", "report", "plot", "json", "began")
    check_kept_out(out, "rig")
    for path in (report, plot):
        if path is not None:
            check_folder(path)
    check_fit(skeleton, bones, frame, blending)
    check_skeleton(skeleton)
    body = load_body(body_file, up=up, unit=unit, fps=fps, group=group, clip=clip, topology=topology)
    body = trimmed(body, start, stop, step)
    bring = load_skeleton(skeleton, body)
    loaded = time.perf_counter()
    rig = fitted(body, body_file, bring, bones=bones, frame=frame, blending=blending)
    done = time.perf_counter()
    with writing(out):
        rig.save(out)
    found: dict[str, Any] = {**rig.report}
    found["seconds"] = {"load": loaded - began, **found.get("seconds", {"fit": done - loaded})}
    full = make_report("rig fit", {"clip": body_file, "out": str(out)}, options, found, began)
    if report is not None:
        write_report(report, full)
    if plot is not None:
        _plot(rig, body, plot)
    tell(full, rig_rows(full, rig), json)


def check_fit(skeleton: str, bones: int | None, frame: int | None, blending: str) -> None:
    """Refuse options before a long clip is read.

    Parameters
    ----------
    skeleton : str
        What --skeleton was given.
    bones, frame : int or None
        What --bones and --frame were given.
    blending : str
        What --blending was given.

    Raises
    ------
    ValueError
        If one is out of range, or --bones is not for this skeleton.
    """
    if blending not in _BLENDING:
        raise ValueError(f"--blending must be one of {', '.join(_BLENDING)}, got {blending!r}")
    if bones is not None and skeleton != "auto":
        raise ValueError(f"--bones is for --skeleton auto, got --skeleton {skeleton}")
    if bones is not None and bones < 2:
        raise ValueError(f"--bones must be 2 or more, got {bones}")
    if frame is not None and frame < 0:
        raise ValueError(f"--frame must be 0 or more, got {frame}")


def trimmed(body: Mesh | MeshClip, start: int | None, stop: int | None, step: int | None) -> Mesh | MeshClip:
    """Keep some frames of a clip.

    Parameters
    ----------
    body : Mesh or MeshClip
        What was loaded.
    start, stop, step : int or None
        As the options say.

    Returns
    -------
    Mesh or MeshClip
        What is left.

    Raises
    ------
    ValueError
        If frames are chosen of a still mesh.
    """
    from tempose.clips import MeshClip
    from tempose.clips.resample import select_frames

    if (start, stop, step) == (None, None, None):
        return body
    if not isinstance(body, MeshClip):
        raise ValueError("--start, --stop and --step choose frames of a clip, got a still mesh")
    return select_frames(body, start or 0, stop, 1 if step is None else step)


def fitted(body: Mesh | MeshClip, name: str, skeleton: Any, **options: Any) -> Rig:
    """Fit a rig with a progress bar; errors name the file.

    Parameters
    ----------
    body : Mesh or MeshClip
        What to rig.
    name : str
        Its file.
    skeleton : str, SkinnedMesh or Skeleton
        As `tempose.rigging.fit_rig` takes it.
    **options
        Of `tempose.rigging.fit_rig`.

    Returns
    -------
    Rig
        The rig.

    Raises
    ------
    ValueError
        If there is no skeleton to be found.
    """
    from tempose.rigging import fit_rig

    blending = cast('Literal["linear", "dual-quaternion"]', options.pop("blending", "linear"))
    anything: Any = body
    with progress_bar() as progress:
        try:
            return fit_rig(anything, skeleton, blending=blending, progress=progress, **options)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from None


def _plot(rig: Rig, body: Mesh | MeshClip, folder: Any) -> None:
    from tempose.clips import MeshClip
    from tempose.rigging.pictures import plot_rig

    with progress_bar() as progress, writing(folder):
        clip = body if isinstance(body, MeshClip) else None
        written = plot_rig(rig, folder, clip, progress=progress)
    note(f"wrote {len(written)} pictures into {folder}")


def rig_rows(report: dict[str, Any], rig: Rig) -> list[tuple[str, str]]:
    """Return what a person wants to read of a rig.

    Parameters
    ----------
    report : dict
        Of the fit.
    rig : Rig
        The rig.

    Returns
    -------
    list of (str, str)
        Name and value.
    """
    names, errors = rig.skin.skeleton.names, report["errors"]
    shown = ", ".join(names[:24]) + (f" and {len(names) - 24} more" if len(names) > 24 else "")
    rows = [("joints", f"{len(names)}: {shown}"), ("blending", rig.blending)]
    if errors:
        rows += [
            ("frames", str(rig.motion.n_frames)),
            ("skin alone is off by", f"{errors['rms_percent']:.3g} % of the diagonal (rms)"),
            ("  99 % of the vertices by less than", f"{errors['p99_percent']:.3g} %"),
        ]
    rows.append(("seconds", f"{report['seconds']['total']:.1f}"))
    return rows
