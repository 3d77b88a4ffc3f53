"""Small line charts as SVG text: curves over time for reports, readable in light and dark."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import Any

import numpy as np

from tempose.render.chart_scale import nice_ticks, pen_path, value_range
from tempose.typing import FloatArray

_COLORS = ("#4650c8", "#b92f52", "#176f40", "#a64e00", "#0a6f94", "#7a6300")
_DASHES = ("", "7 3", "2 3", "9 3 2 3", "4 2", "1 2")
_LEFT, _RIGHT, _TOP, _BOTTOM = 58.0, 12.0, 26.0, 34.0


def line_chart(
    series: Mapping[str, Any],
    x: Any = None,
    *,
    title: str = "",
    x_label: str = "",
    y_label: str = "",
    limits: Mapping[str, float] | None = None,
    size: tuple[int, int] = (540, 200),
    y_range: tuple[float, float] | None = None,
    standalone: bool = False,
) -> str:
    """Draw curves over a common axis.

    Parameters
    ----------
    series : mapping of str to (T,) array_like
        Name to values; NaN leaves a gap. Curves differ in colour and in dash.
    x : (T,) array_like, optional
        Places, ascending, such as seconds; else 0, 1, 2...
    title, x_label, y_label : str
        Words; with units.
    limits : mapping of str to float, optional
        Name to value of level lines, such as a tolerance.
    size : (int, int), default (540, 200)
        Width and height, pixels.
    y_range : (float, float), optional
        Least and greatest value shown; else what the curves and limits need.
    standalone : bool, default False
        Whether the text must be a file of its own; inside HTML it takes the colours of the page.

    Returns
    -------
    str
        An ``<svg>`` element; all words are escaped.

    Raises
    ------
    ValueError
        If the lengths differ or nothing is finite in `x`.
    """
    curves = {str(name): np.asarray(y, dtype=np.float64) for name, y in series.items()}
    at = _places(curves, x)
    levels = {str(name): float(value) for name, value in (limits or {}).items()}
    low, high = value_range([*curves.values(), np.array(list(levels.values()))], y_range)
    x0, x1 = (float(at[0]), float(at[-1])) if len(at) else (0.0, 1.0)
    x1 = x1 if x1 > x0 else x0 + 1.0
    width, height = size

    def px(v: Any) -> Any:
        return _LEFT + (np.asarray(v) - x0) / (x1 - x0) * (width - _LEFT - _RIGHT)

    def py(v: Any) -> Any:
        return height - _BOTTOM - (np.asarray(v) - low) / (high - low) * (height - _TOP - _BOTTOM)

    parts = [_axes(px, py, (x0, x1), (low, high), size), _words(title, x_label, y_label, curves, size)]
    for name, value in levels.items():
        right, y = width - _RIGHT, float(py(value))
        parts.append(
            f'<line class="limit" x1="{_LEFT}" x2="{right}" y1="{y:.1f}" y2="{y:.1f}"/>'
            f'<text class="limit-name" x="{right}" y="{y - 3:.1f}" text-anchor="end">{escape(name)}</text>'
        )
    for k, (name, y) in enumerate(curves.items()):
        path = pen_path(px(at), py(np.clip(y, low, high)), width)
        parts.append(
            f'<path class="curve" d="{path}" style="{_stroke(k)}"><title>{escape(name)}</title></path>'
        )
    label = escape(title or ", ".join(curves) or "chart")
    names = ' xmlns="http://www.w3.org/2000/svg"' if standalone else ""
    return (
        f'<svg{names} class="chart" role="img" aria-label="{label}" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}">{_style() if standalone else ""}{"".join(parts)}</svg>'
    )


def chart_style() -> str:
    """Return the CSS rules of charts, for a page that holds them.

    Returns
    -------
    str
        Rules; colours come from the variables ``--text-2``, ``--text-3``, ``--line``, ``--warning`` and
        ``--s0`` to ``--s5``.
    """
    return (
        ".chart text{font:11px Inter,system-ui,sans-serif;fill:var(--text-3,#5d6573)}"
        ".chart .title{font-weight:500;font-size:12px;fill:var(--text-2,#434a56)}"
        ".chart .grid{stroke:var(--line,#d5d9e0);stroke-width:1}"
        ".chart .curve{fill:none;stroke-width:1.6;stroke-linejoin:round}"
        ".chart .limit{stroke:var(--warning,#7d5f00);stroke-width:1;stroke-dasharray:2 3}"
        ".chart .limit-name{fill:var(--warning,#7d5f00);paint-order:stroke;stroke:var(--app,#f6f7f9);"
        "stroke-width:3px}"
    )


def _style() -> str:
    return f"<style>{chart_style()}</style>"


def _places(curves: Mapping[str, FloatArray], x: Any) -> FloatArray:
    lengths = {len(y) if y.ndim == 1 else -1 for y in curves.values()}
    if x is None:
        at = np.arange(max(lengths, default=0), dtype=np.float64)
    else:
        at = np.asarray(x, dtype=np.float64)
    if at.ndim != 1 or any(n != len(at) for n in lengths):
        shapes = ", ".join(f"{name!r} {y.shape}" for name, y in curves.items())
        raise ValueError(f"series and x must have one length, got x {at.shape} and {shapes}")
    if not np.isfinite(at).all() or (np.diff(at) <= 0).any():
        raise ValueError("x must be finite and ascending")
    return at


def _axes(px: Any, py: Any, xs: tuple[float, float], ys: tuple[float, float], size: tuple[int, int]) -> str:
    width, height = size
    bottom = height - _BOTTOM
    out: list[str] = []
    for v in nice_ticks(*ys, max(int((height - _TOP - _BOTTOM) / 36), 2)):
        out.append(
            f'<line class="grid" x1="{_LEFT}" x2="{width - _RIGHT}" y1="{py(v):.1f}" y2="{py(v):.1f}"/>'
        )
        out.append(f'<text x="{_LEFT - 6}" y="{py(v) + 4:.1f}" text-anchor="end">{_number(v)}</text>')
    for v in nice_ticks(*xs, max(int((width - _LEFT - _RIGHT) / 80), 2)):
        out.append(f'<line class="grid" x1="{px(v):.1f}" x2="{px(v):.1f}" y1="{bottom}" y2="{bottom + 4}"/>')
        out.append(f'<text x="{px(v):.1f}" y="{bottom + 15}" text-anchor="middle">{_number(v)}</text>')
    return "".join(out)


def _words(
    title: str, x_label: str, y_label: str, curves: Mapping[str, FloatArray], size: tuple[int, int]
) -> str:
    width, height = size
    heading = " · ".join(w for w in (title, y_label) if w)
    out = [f'<text class="title" x="0" y="13">{escape(heading)}</text>'] if heading else []
    if x_label:
        out.append(f'<text x="{width - _RIGHT}" y="{height - 4}" text-anchor="end">{escape(x_label)}</text>')
    x = width - _RIGHT
    for k, name in reversed(list(enumerate(curves)) if len(curves) > 1 else []):
        out.append(f'<text x="{x:.0f}" y="13" text-anchor="end">{escape(name)}</text>')
        x -= 6.6 * len(name) + 8
        out.append(f'<line x1="{x - 22:.0f}" x2="{x:.0f}" y1="9" y2="9" style="{_stroke(k)}"/>')
        x -= 34
    return "".join(out)


def _stroke(k: int) -> str:
    k %= len(_COLORS)
    dash = f";stroke-dasharray:{_DASHES[k]}" if _DASHES[k] else ""
    return f"stroke:var(--s{k},{_COLORS[k]});stroke-width:1.6{dash}"


def _number(v: float) -> str:
    return f"{v:.6g}"
