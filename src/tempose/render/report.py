"""A report as one HTML file that opens anywhere: pictures inside, no network, light and dark."""

from __future__ import annotations

import base64
import os
from collections.abc import Sequence
from html import escape
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from tempose._files import atomic_path
from tempose.render.charts import chart_style
from tempose.render.report_blocks import Block, Cell, Chart, Figure, Numbers, Paragraph, Section, Table
from tempose.render.report_style import PAGE_STYLE
from tempose.render.text import pillow
from tempose.render.writers import as_picture

_TYPES = {".png": "image/png", ".jpg": "image/jpeg", ".gif": "image/gif", ".mp4": "video/mp4"}
_STATES = ("", "good", "warning", "error")


def html_report(
    title: str, sections: Sequence[Section], path: str | os.PathLike[str], *, subtitle: str = ""
) -> None:
    """Write a report.

    Parameters
    ----------
    title : str
        Heading of the page.
    sections : sequence of Section
        In order.
    path : path-like
        File to write or replace.
    subtitle : str
        A line under the title: what was run, when, with which version.

    Raises
    ------
    ValueError
        If a block is of no known kind, or a picture cannot be embedded.
    """
    text = report_text(title, sections, subtitle=subtitle)
    with atomic_path(path) as part:
        part.write_text(text, encoding="utf-8")


def report_text(title: str, sections: Sequence[Section], *, subtitle: str = "") -> str:
    """Return what `html_report` writes.

    Parameters
    ----------
    title : str
        Heading of the page.
    sections : sequence of Section
        In order.
    subtitle : str
        A line under the title.

    Returns
    -------
    str
        A whole HTML page.
    """
    links = "".join(f'<a href="#s{k}">{escape(s.title)}</a>' for k, s in enumerate(sections))
    body = "".join(
        f'<section id="s{k}"><h2>{escape(s.title)}</h2>{"".join(map(_block, s.blocks))}</section>'
        for k, s in enumerate(sections)
    )
    below = f'<p class="subtitle">{escape(subtitle)}</p>' if subtitle else ""
    menu = f"<nav>{links}</nav>" if len(sections) > 1 else ""
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        '<meta name="color-scheme" content="light dark">'
        f"<title>{escape(title)}</title><style>{PAGE_STYLE}{chart_style()}</style></head>\n"
        f"<body><header><h1>{escape(title)}</h1>{below}{menu}</header><main>{body}</main></body></html>\n"
    )


def _block(block: Block | str) -> str:
    if isinstance(block, (str, Paragraph)):
        text = block if isinstance(block, str) else block.text
        return "".join(f"<p>{escape(p.strip())}</p>" for p in text.split("\n\n") if p.strip())
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Numbers):
        tiles = "".join(
            f'<div class="tile {_state(v)}"><dt>{escape(str(k))}</dt><dd>{_value(v)}</dd></div>'
            for k, v in block.items.items()
        )
        return f'<dl class="tiles">{tiles}</dl>'
    if isinstance(block, Figure):
        return f"<figure>{_media(block)}{_caption(block.caption)}</figure>"
    if isinstance(block, Chart):
        drawings = [block.svg] if isinstance(block.svg, str) else block.svg
        return f'<figure><div class="charts">{"".join(drawings)}</div>{_caption(block.caption)}</figure>'
    raise ValueError(
        f"a section holds text, Paragraph, Table, Numbers, Figure or Chart, got {type(block).__name__}"
    )


def _table(table: Table) -> str:
    for row in table.rows:
        if len(row) != len(table.header):
            raise ValueError(f"each row must have {len(table.header)} values, got {len(row)}: {list(row)}")
    numeric = [any(_is_number(row[c]) for row in table.rows) for c in range(len(table.header))]
    cls = [' class="n"' if n else "" for n in numeric]
    head = "".join(f'<th scope="col"{c}>{escape(h)}</th>' for h, c in zip(table.header, cls))
    rows = "".join(
        "<tr>"
        + "".join(
            f'<td class="{"n" if n else ""} {_state(v)}">{_value(v)}</td>' for v, n in zip(row, numeric)
        )
        + "</tr>"
        for row in table.rows
    )
    body = f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
    return f'<figure><div class="wide">{body}</div>{_caption(table.caption)}</figure>'


def _is_number(value: Any) -> bool:
    value = value.value if isinstance(value, Cell) else value
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)


def _value(value: Any) -> str:
    if isinstance(value, Cell):
        sign = {"good": "✓ ", "warning": "! ", "error": "✗ "}.get(value.state, "")
        return f'<span aria-hidden="true">{sign}</span>{_value(value.value)}'
    if value is None:
        return "–"
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (float, np.floating)):
        return escape(f"{value:.4g}")
    return escape(str(value))


def _state(value: Any) -> str:
    state = value.state if isinstance(value, Cell) else ""
    if state not in _STATES:
        raise ValueError(f"state must be one of {_STATES}, got {state!r}")
    return state


def _media(figure: Figure) -> str:
    address, kind = _embedded(figure.source)
    words = escape(figure.caption, quote=True)
    if kind.startswith("video"):
        return f'<video controls loop muted playsinline aria-label="{words}" src="{address}"></video>'
    image = f'<img alt="{words}" src="{address}">'
    if figure.dark is None:
        return image
    dark = f'<source media="(prefers-color-scheme:dark)" srcset="{_embedded(figure.dark)[0]}">'
    return f"<picture>{dark}{image}</picture>"


def _embedded(source: Any) -> tuple[str, str]:
    if isinstance(source, (str, os.PathLike)):
        path = Path(source)
        kind = _TYPES.get(path.suffix.lower())
        if kind is None:
            raise ValueError(f"{path}: only {', '.join(_TYPES)} files can be put into a report")
        data = path.read_bytes()
    else:
        buffer, kind = BytesIO(), "image/png"
        pillow().Image.fromarray(as_picture(source, "Figure.source")).save(buffer, "PNG", optimize=True)
        data = buffer.getvalue()
    return f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}", kind


def _caption(text: str) -> str:
    return f"<figcaption>{escape(text)}</figcaption>" if text else ""
