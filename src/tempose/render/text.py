"""Words on pictures, by the font that comes with Pillow."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from tempose.render.colors import Picture
from tempose.typing import FloatArray


def pillow() -> Any:
    """Import Pillow.

    Returns
    -------
    namespace
        Its modules ``Image``, ``ImageDraw`` and ``ImageFont``.

    Raises
    ------
    ImportError
        If it is not installed; the message says how to.
    """
    try:
        from PIL import Image, ImageDraw, ImageFont
    except ImportError:
        raise ImportError('pictures need Pillow; install it with: pip install "tempose[render]"') from None
    return SimpleNamespace(Image=Image, ImageDraw=ImageDraw, ImageFont=ImageFont)


def text_size(text: str, height: int) -> tuple[int, int]:
    """Measure a line of text.

    Parameters
    ----------
    text : str
        One line.
    height : int
        Font size, pixels.

    Returns
    -------
    (int, int)
        Width and height, pixels.
    """
    box = font_of(height).getbbox(text)
    return int(np.ceil(box[2])), int(np.ceil(height * 1.25))


def draw_text(
    picture: Picture,
    text: str,
    at: tuple[int, int],
    height: int,
    color: FloatArray,
    anchor: str = "la",
) -> None:
    """Write a line of text into a picture.

    Parameters
    ----------
    picture : (height, width, 3) uint8
        Written.
    text : str
        One line.
    at : (int, int)
        x and y of the anchor, pixels.
    height : int
        Font size, pixels.
    color : (3,) float
        sRGB, 0 to 1.
    anchor : str, default "la"
        Pillow's two letters: left, middle, right; ascender, middle, baseline.
    """
    PIL = pillow()
    image = PIL.Image.fromarray(np.ascontiguousarray(picture))
    ink = tuple(int(round(255 * c)) for c in color)
    PIL.ImageDraw.Draw(image).text(at, text, fill=ink, font=font_of(height), anchor=anchor)
    picture[:] = np.asarray(image)


def font_of(height: int) -> Any:
    """Return the font of a size.

    Parameters
    ----------
    height : int
        Font size, pixels.

    Returns
    -------
    ImageFont
        Of Pillow.
    """
    return pillow().ImageFont.load_default(size=height)
