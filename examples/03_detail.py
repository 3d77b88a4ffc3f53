"""A skirt that follows a skeleton: learned from a slow and a fast walk, posed by one between.

Put your own clip in place of the built-in ones, with a skeleton found in it::

    clip = tempose.formats.load_clip("dancer.npz")
    rig = tempose.rigging.fit_rig(clip)  # "human"; or fit_rig(clip, "auto") for anything else
    model = tempose.DetailModel().fit(clip, rig)
"""

from pathlib import Path
from typing import Any

import tempose
from tempose.detail.pictures import skin_clip
from tempose.rigging import Rig
from tempose.samples import MOTIONS, human_character, sample_clip

OUT = Path("out")
TRIANGLES = 4_000
LONG: dict[str, Any] = {"duration": 1.6, "fps": 30.0}


def main() -> None:
    body = human_character(TRIANGLES)
    clips = [sample_clip("human", "walk", triangles=TRIANGLES, speed=v, **LONG) for v in (0.9, 1.5)]
    motions = [MOTIONS["human"]["walk"](body.skin.skeleton, speed=v, **LONG) for v in (0.9, 1.5)]

    # the motions of these clips are known; without them fit finds the skeleton's motion in the frames
    model = tempose.DetailModel("gp").fit(clips, Rig(body.skin, motions[0]), motions)
    for name, row in model.report_["heldout"].items():
        print(f"{name:>8}: frames left out are off by {row['rms_percent']:.2f} % of the diagonal")

    between = MOTIONS["human"]["walk"](body.skin.skeleton, speed=1.2, **LONG)
    walk = model.pose(between)
    stiff = model.pose(between, damp=0.2)
    taller = model.pose(between, proportions={"thigh": 1.15, "shin": 1.15})

    OUT.mkdir(exist_ok=True)
    model.save(OUT / "skirt.tempose")
    tempose.save(OUT / "walk.glb", walk)
    sheet = tempose.render.contact_sheet(
        [skin_clip(model.rig_, between), walk, stiff, taller],
        5,
        ("three-quarter",),
        cell=200,
        track=True,
        names=["skin alone", "with detail", "detail damped", "longer legs"],
    )
    tempose.render.save_png(sheet, OUT / "walk.png")
    print(f"wrote a walk at a new speed to {OUT / 'walk.glb'}, and a picture")


if __name__ == "__main__":
    main()
