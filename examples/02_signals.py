"""A clip as a curve: a gallop is looped, slowed down, and reshaped by moving one point of its curve.

Put your own clip in place of the built-in one::

    clip = tempose.formats.load_clip("cloth.npz")
"""

from pathlib import Path

import tempose
from tempose.samples import sample_clip
from tempose.signals.loops import find_loops
from tempose.signals.pictures import plot_signals

OUT = Path("out")


def main() -> None:
    clip = sample_clip("animal", "gallop", triangles=4_000, duration=1.5, fps=24.0)

    # placement: where the animal is, apart from its shape, so that a looped gallop gallops on
    model = tempose.SignalModel(placement=True).fit(clip)
    print(f"frames are off by {model.report_['errors']['rms_percent']:.2f} % of the diagonal")

    signals = model.signals_
    stride = find_loops(signals.coordinates(signals.times), fps=signals.fps)[0]
    print(f"frames {stride.start} to {stride.stop} are a loop ({stride.grade})")
    edited = model.edited(
        [
            {"op": "close_loop", "from": stride.start, "to": stride.stop},
            {"op": "loop", "from": 0, "to": stride.period, "times": 3},
            {"op": "speed", "from": stride.period, "to": 2 * stride.period, "factor": 0.4},
        ]
    )

    OUT.mkdir(exist_ok=True)
    edited.save(OUT / "gallop.tempose")
    tempose.save(OUT / "gallop.glb", edited.clip(fps=60.0))
    plot_signals(edited, OUT, formats=("png",), grid=False)
    print(f"wrote {edited.signals_.duration:.1f} s of gallop to {OUT / 'gallop.glb'}, and pictures")


if __name__ == "__main__":
    main()
