"""Ways to lay out a long clip beside each other, and what splitting off the placement saves."""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.spatial.distance import cdist

from long_clip import open_long_clip, write_long_clip
from real_bodies import DATA
from results_page import line, table
from tempose.formats import load_clip
from tempose.linalg.pca import GramPCA
from tempose.linalg.streamed_pca import streamed_pca
from tempose.signals.placement import split_placement
from tempose.signals.pose import PoseLayout, find_bad_transitions
from tempose.signals.pose.layout import congruence
from tempose.signals.time.fit import fit_time_signal
from tempose.signals.windows import Cover, cover, fit_windowed_pose, long_layout
from tempose.typing import FloatArray

LAYOUTS = ("all frames at once", "key frames", "windows aligned")
PERCENT = (1.0, 0.5, 0.2)


def in_windows(X: FloatArray, windows: Cover) -> FloatArray:
    """Scale each window for itself, align it to the one before where they overlap, and blend there."""
    P = np.zeros((len(X), 2))
    for i in range(len(windows)):
        frames = np.arange(len(X))[windows.frames(i)]
        shared = frames[: windows.frames(i - 1).stop - frames[0]] if i else frames[:0]
        here = PoseLayout(cdist(X[frames], X[frames])).solve().positions
        if i:
            here = congruence(here[: len(shared)], P[shared])(here)
        w = windows(shared.astype(float))[1][:, None]
        here[: len(shared)] = (1 - w) * P[shared] + w * here[: len(shared)]
        P[frames] = here
    return P


def laid_out(X: FloatArray, windows: Cover, how: str) -> FloatArray:
    if how == LAYOUTS[0]:
        return PoseLayout(cdist(X, X)).solve().positions
    return long_layout(X, min(300, len(X) // 3)).positions if how == LAYOUTS[1] else in_windows(X, windows)


def layout_row(name: str, X: FloatArray, window: int, how: str) -> str:
    windows = cover(len(X), window, window // 5)
    laid_out(X[: 2 * window], cover(2 * window, window, window // 5), how)  # nothing left to compile
    start = time.process_time()
    P = laid_out(X, windows, how)
    seconds = time.process_time() - start
    D, d = cdist(X, X), cdist(P, P)
    step = np.median(np.linalg.norm(np.diff(X, axis=0), axis=1))
    far = (D < step) & (np.abs(np.subtract.outer(np.arange(len(X)), np.arange(len(X)))) > len(X) // 3)
    again = np.median(d[far]) / np.median(np.linalg.norm(np.diff(P, axis=0), axis=1)) if far.any() else np.nan
    pose, f = fit_windowed_pose(P, X, windows), fit_time_signal(P, len(X) + 2)
    bad = int(find_bad_transitions(pose, f, X).bad.sum())
    stress = np.sqrt(np.square(D - d).sum() / np.square(D).sum())
    return line(
        name,
        how,
        f"{stress:.4f}",
        "none" if np.isnan(again) else f"{again:.2f}",
        f"{bad} of {len(X) - 1}",
        f"{1000 * seconds:.0f}",
    )


def layouts() -> list[str]:
    """Rows of layouts: someone who walks, runs and stands; the crane, placement split off."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "long.npy"
        n = write_long_clip(path, 1250, 1000)
        clip = open_long_clip(path, 1250, 1000)
        bodies = split_placement(clip.vertices, clip.rest)[1].reshape(1250, 3 * n)
        walk = streamed_pca(lambda: [bodies], 3 * n, 12).coordinates
    V = np.asarray(load_clip(str(DATA / "vlasic-crane")).vertices, dtype=float)
    crane = GramPCA(split_placement(V)[1].reshape(len(V), -1)).coordinates(20)
    rows = [layout_row("walk, run, stand", walk, 300, how) for how in LAYOUTS]
    rows += [layout_row("crane", crane, 60, how) for how in LAYOUTS]
    columns = ("clip", "layout", "stress", "repeats apart, steps", "bad transitions", "ms")
    return table(columns, rows)


def modes() -> list[str]:
    """Rows of how many modes a tolerance takes with the placement inside the shape and split off."""
    rows: list[str] = []
    for name, last in (("vlasic-crane", None), ("horse-gallop", 24)):
        clip = load_clip(str(DATA / name))
        V = np.asarray(clip.vertices[:last], dtype=float)
        for what, W in (("in the shape", V), ("split off", split_placement(V, clip.rest)[1])):
            s = GramPCA(W.reshape(len(W), -1)).singular_values
            left = np.sqrt(np.append(np.cumsum(np.square(s)[::-1])[::-1], 0) / (W.shape[0] * W.shape[1]))
            needed = [int(np.argmax(100 * left / clip.mesh.diagonal <= limit)) for limit in PERCENT]
            rows.append(line(f"{name}, {len(V)} frames", what, *needed))
    return table(("clip", "placement", *(f"m for {p:g} %" for p in PERCENT)), rows)
