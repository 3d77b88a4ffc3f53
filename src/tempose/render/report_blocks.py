"""What a report is made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias


@dataclass(frozen=True)
class Paragraph:
    """Running text; blank lines part paragraphs."""

    text: str
    """Plain text."""


@dataclass(frozen=True)
class Cell:
    """A value with a judgement."""

    value: Any
    """Text or number."""
    state: str = ""
    """``"good"``, ``"warning"``, ``"error"`` or nothing; shown by a sign as well as by colour."""


@dataclass(frozen=True)
class Table:
    """Rows of values."""

    header: Sequence[str]
    """Names of the columns, with units."""
    rows: Sequence[Sequence[Any]]
    """Text, numbers (four digits are shown), `Cell` or None."""
    caption: str = ""
    """A line under the table."""


@dataclass(frozen=True)
class Numbers:
    """A few figures, large."""

    items: Mapping[str, Any]
    """Name to text, number or `Cell`."""


@dataclass(frozen=True, eq=False)
class Figure:
    """A picture or a film."""

    source: Any
    """(height, width, 3) uint8, or a path of a .png, .jpg, .gif or .mp4 file."""
    caption: str = ""
    """A line under it; also its description for those who cannot see it."""
    dark: Any = None
    """The same picture for readers who prefer dark pages."""


@dataclass(frozen=True)
class Chart:
    """Drawings side by side."""

    svg: str | Sequence[str]
    """From `tempose.render.line_chart`: trusted, not escaped."""
    caption: str = ""
    """A line under them."""


Block: TypeAlias = Paragraph | Table | Numbers | Figure | Chart
"""What a section is made of; plain text stands for a `Paragraph`."""


@dataclass(frozen=True)
class Section:
    """A heading and what stands under it."""

    title: str
    """Heading."""
    blocks: Sequence[Block | str] = field(default_factory=tuple)
    """In order."""
