"""Adjustments as a layer on a finished transfer, which keeps what lies beneath."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from tempose.transfer.adjustments.adjust import adjust_frames
from tempose.transfer.adjustments.adjustment import Adjustment
from tempose.transfer.frames import make_frames, release
from tempose.transfer.quality.measuring import add_measures
from tempose.transfer.result import TransferResult
from tempose.typing import Progress, silent


def adjust(
    result: TransferResult,
    adjustments: Sequence[Adjustment],
    *,
    measure: bool = True,
    scratch: str | os.PathLike[str] | None = None,
    progress: Progress = silent,
) -> TransferResult:
    """Layer key-framed adjustments on a transfer.

    Parameters
    ----------
    result : TransferResult
        From `transfer_motion` or from here. It stays as it is.
    adjustments : sequence of Adjustment
        What shall be different, on top of what `result` already holds.
    measure : bool, default True
        Whether the report's measures are taken anew; otherwise they remain those of `base`.
    scratch : path-like, optional
        Folder for the frames, as for `transfer_motion`.
    progress : Progress
        Called with frames done.

    Returns
    -------
    TransferResult
        ``adjustments`` holds all of them, ``base`` the result without any: to undo the last, adjust ``base``
        by all but that one. Frames outside the windows are bit by bit those of ``base``. The report's
        ``adjustments`` names each key and by how much it was missed; `result` itself if there are none.

    Raises
    ------
    ValueError
        If `result` kept nothing to work on, a part or frame does not exist, or adjustments contradict each
        other.
    """
    if not adjustments:
        return result
    base = result if result.base is None else result.base
    if base.job is None:
        raise ValueError("result must come from transfer_motion, which keeps what adjustments need (job)")
    began = time.perf_counter()
    clip, listed = base.clip, (*result.adjustments, *adjustments)
    V = make_frames(clip.n_frames, len(clip.rest), scratch)
    for t in range(clip.n_frames):
        V[t] = clip.vertices[t]
        release(V)
    job, found = adjust_frames(base.job, V, listed, clip.fps, progress)
    report: dict[str, Any] = dict(base.report) | {"warnings": list(base.report.get("warnings", []))}
    seconds = dict(report.get("seconds", {})) | {"adjustments": time.perf_counter() - began}
    if measure:
        began = time.perf_counter()
        progress(len(V), len(V), "measures")
        add_measures(report, job, V, clip.fps)
        seconds["measures"] = seconds.get("measures", 0.0) + time.perf_counter() - began
    report["adjustments"] = found
    report["warnings"] = list(dict.fromkeys([*report["warnings"], *map(_miss, found["unmet"])]))
    seconds["total"] = sum(s for name, s in seconds.items() if name != "total")
    report["seconds"] = seconds
    moved = replace(clip, vertices=V)
    release(V)
    return replace(base, clip=moved, report=report, job=job, base=base, adjustments=listed)


def _miss(entry: dict[str, Any]) -> str:
    return (
        f"the adjustment of {entry['part']!r} at frame {entry['frame']} misses its place by "
        f"{100 * entry['distance_m']:.2g} cm: out of reach, or another adjustment pulls it away"
    )
