"""Key frames of a glTF animation and the values between them.

References
----------
.. [1] Khronos Group, "glTF 2.0 Specification" (ISO/IEC 12113:2022), section 3.11 and appendix C.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tempose.formats import glb_accessors as accessors
from tempose.formats.glb_container import Document
from tempose.formats.glb_json import Item
from tempose.formats.glb_nodes import Nodes
from tempose.rotations import normalise, slerp
from tempose.typing import FloatArray, IntArray

_WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}


@dataclass(frozen=True)
class Channel:
    """One animated property of one node."""

    node: int
    """Index of the node."""
    path: str
    """``"translation"``, ``"rotation"`` (wxyz), ``"scale"`` or ``"weights"``."""
    times: FloatArray
    """(k,) float64 seconds, never falling."""
    values: FloatArray
    """(k, width), or (k, 3, width) for a cubic spline: in-tangent, value, out-tangent."""
    interpolation: str
    """``"STEP"``, ``"LINEAR"`` or ``"CUBICSPLINE"``."""


def read_channels(doc: Document, animation: Item, nodes: Nodes) -> tuple[Channel, ...]:
    """Decode the channels of an animation; those with unknown targets are left out, as glTF asks.

    Parameters
    ----------
    doc : Document
        The file.
    animation : Item
        The animation.
    nodes : Nodes
        The node tree.

    Returns
    -------
    tuple of Channel
        One a property that moves.

    Raises
    ------
    FormatError
        If keys run backwards or keys and values do not match.
    """
    samplers = animation.items("samplers")
    channels: dict[tuple[int, str], Channel] = {}
    for item in animation.items("channels"):
        target = item.child("target")
        path = target.text("path")
        if not target.has("node") or path not in (*_WIDTHS, "weights"):
            continue
        node = target.integer("node", limit=len(nodes.items))
        sampler = samplers[item.integer("sampler", limit=len(samplers))]
        channels[node, path] = _channel(doc, sampler, node, path)
    return tuple(channels.values())


def _channel(doc: Document, sampler: Item, node: int, path: str) -> Channel:
    mode = sampler.text("interpolation", "LINEAR")
    if mode not in ("STEP", "LINEAR", "CUBICSPLINE"):
        raise sampler.error(f"expected STEP, LINEAR or CUBICSPLINE, found {mode!r}", "interpolation")
    count = len(doc.accessors)
    raw_times = accessors.floats(doc, sampler.integer("input", limit=count), "SCALAR")
    times = raw_times[:, 0].astype(np.float64)
    if (np.diff(times) < 0).any():
        k = int((np.diff(times) < 0).argmax())
        raise sampler.error(f"expected rising times, found {times[k + 1]:g} after {times[k]:g}", "input")
    kinds = {"rotation": "VEC4", "weights": "SCALAR"}
    output = sampler.integer("output", limit=count)
    raw = accessors.floats(doc, output, kinds.get(path, "VEC3")).astype(np.float64, copy=False)
    each = 3 if mode == "CUBICSPLINE" else 1
    width, rest = divmod(raw.size, len(times) * each)
    if rest or width == 0 or (path != "weights" and width != _WIDTHS[path]):
        raise sampler.error(
            f"expected {each} x {len(times)} values, one set a key, found {len(raw)}", "output"
        )
    values = raw.reshape((len(times), 3, width) if each == 3 else (len(times), width))
    if path == "rotation":
        values = values[..., [3, 0, 1, 2]]
        values = values if each == 3 else normalise(values)
    return Channel(node, path, times, values, mode)


def sample(channel: Channel, times: FloatArray, snap: float) -> FloatArray:
    """Values of a channel at given times; before the first key and after the last they stay.

    Parameters
    ----------
    channel : Channel
        Keys.
    times : (T,) float
        Seconds.
    snap : float
        Times within so many seconds of a key are meant to be that key: file times are float32.

    Returns
    -------
    (T, width) ndarray
        Values; rotations wxyz, unit.
    """
    keys = channel.times
    # the last key not after t + snap; with equal keys the later one counts
    k = np.clip(np.searchsorted(keys, times + snap, side="right") - 1, 0, len(keys) - 1)
    after = np.minimum(k + 1, len(keys) - 1)
    span = keys[after] - keys[k]
    elapsed = times - keys[k]
    u = np.where(elapsed > snap, elapsed / np.where(span > 0, span, 1.0), 0.0)
    u = np.where(span > 0, np.clip(u, 0.0, 1.0), 0.0)
    if channel.interpolation == "CUBICSPLINE":
        return _hermite(channel, k, after, u[:, None], span[:, None])
    p = channel.values[k]
    if channel.interpolation == "STEP":
        return p
    q = channel.values[after]
    if channel.path == "rotation":
        return slerp(p, q, u)
    return p + u[:, None] * (q - p)


def _hermite(channel: Channel, k: IntArray, after: IntArray, u: FloatArray, span: FloatArray) -> FloatArray:
    """Cubic spline between keys, appendix C.5."""
    p, out = channel.values[k, 1], channel.values[k, 2] * span
    q, into = channel.values[after, 1], channel.values[after, 0] * span
    u2, u3 = u * u, u * u * u
    value = (2 * u3 - 3 * u2 + 1) * p + (u3 - 2 * u2 + u) * out + (3 * u2 - 2 * u3) * q + (u3 - u2) * into
    return normalise(value) if channel.path == "rotation" else value
