"""Draw docs/gallery/readme.png: the walk of `tempose demo`, source above, character below.

Usage: python tools/readme_picture.py
"""

from __future__ import annotations

from pathlib import Path

import tempose
from tempose.cli.demo_cases import CASES, make_target

OUT = Path(__file__).resolve().parents[1] / "docs" / "gallery" / "readme.png"


def main() -> None:
    """Transfer the walk and draw seven moments of it."""
    case = CASES[0]
    result = tempose.transfer.transfer_motion(case.motion(), make_target(case.target), measure=False)
    assert result.source is not None
    OUT.parent.mkdir(exist_ok=True)
    picture = tempose.render.contact_sheet(
        [result.source, result.clip],
        frames=[4, 10, 16, 22, 28, 34, 40],
        views=[(0.9, 0.12)],
        cell=(150, 230),
        names=["motion", "scan"],
        elevation=None,
    )
    tempose.render.save_png(picture, OUT)


if __name__ == "__main__":
    main()
