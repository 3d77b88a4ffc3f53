"""Motion onto a still mesh: a walk made by formula moves the built-in human.

Put your own files in place of the built-in ones::

    motion = tempose.formats.load_skeleton_clip("walk.bvh")
    target = tempose.formats.load_skin("character.glb")
"""

from pathlib import Path

import tempose
from tempose.samples import CHARACTERS, MOTIONS, human_skeleton
from tempose.transfer import transfer_motion

OUT = Path("out")


def main() -> None:
    motion = MOTIONS["human"]["walk"](human_skeleton(), duration=2.0, fps=30.0)
    target = CHARACTERS["human"](10_000)

    result = transfer_motion(motion, target)

    OUT.mkdir(exist_ok=True)
    tempose.save(OUT / "walk.glb", result.clip)
    tempose.render.render(result.clip, OUT / "walk.png", frames=6)
    print(f"bone directions off by {result.report['bone_direction_deg']['mean']:.1f} degrees")
    print(f"wrote {OUT / 'walk.glb'} and {OUT / 'walk.png'}")


if __name__ == "__main__":
    main()
