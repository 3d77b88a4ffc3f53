"""ASF and AMC (Acclaim): a skeleton and its motion in two files."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from tempose.clips import Skeleton, SkeletonClip
from tempose.formats._asf_text import AsfText, basis_rotation, parse_asf
from tempose.formats._input import read_bytes, unreadable
from tempose.formats._motion_clip import Found, to_clip
from tempose.formats.conventions import FormatError
from tempose.rotations import conjugate, multiply
from tempose.typing import FloatArray

_INCH = 0.0254
_CAPTURE_RATE = 120.0


def read_amc(
    path: str | os.PathLike[str],
    *,
    asf: str | os.PathLike[str] | None = None,
    up: str | None = None,
    unit: float | None = None,
    fps: float | None = None,
) -> SkeletonClip:
    """Read a motion in AMC with its skeleton in ASF.

    Parameters
    ----------
    path : path-like
        The ``.amc`` file.
    asf : path-like, optional
        The skeleton; if not given, ``02.asf`` is found beside ``02_03.amc``, or the only one in the folder.
    up : str, optional
        Up axis of the file; guessed from where the feet are if not given.
    unit : float, optional
        Metres per unit; if not given, 0.0254 over the ``length`` that the ASF states.
    fps : float, optional
        Frames per second; AMC states none, 120 is guessed.

    Returns
    -------
    SkeletonClip
        T frames; every bone is a joint where it starts, and rest is the identity in axes that are those
        of the world.

    Raises
    ------
    FormatError
        If a file is not what it should be or the two do not fit; the message names the line.

    Notes
    -----
    A bone turns by ``C M C^-1``: M the angles of the frame, C the ``axis`` of the bone, both about fixed
    axes in the order listed.
    """
    path = Path(path)
    asf_path = _find_asf(path) if asf is None else Path(asf)
    bones = parse_asf(asf_path)
    motion, degrees, notes = _parse_amc(path, asf_path, bones)
    rotations, root = _turns(bones, motion, degrees, notes)
    if unit is None and bones.length is not None:
        unit = _INCH / bones.length
    found = Found(str(path), "amc", None, tuple(notes))
    skeleton = _skeleton(bones)
    return to_clip(skeleton, rotations, root, found, up=up, unit=unit, fps=fps, usual_fps=_CAPTURE_RATE)


def _turns(
    text: AsfText, motion: FloatArray, degrees: float, notes: list[str]
) -> tuple[FloatArray, FloatArray]:
    """Local rotations (T, J, 4) and root positions (T, 3) in the axes of the file."""
    rotations = np.tile([1.0, 0, 0, 0], (len(motion), len(text.bones), 1))
    root = np.tile(text.root_position, (len(motion), 1))
    start = 0
    for j, bone in enumerate(text.bones):
        values = dict(zip(bone.dof, motion[:, start : start + len(bone.dof)].T))
        start += len(bone.dof)
        order = "".join(name[1] for name in bone.dof if name[0] == "r")
        if order:
            angles = np.column_stack([values[f"r{axis}"] for axis in order]) * degrees
            turn = basis_rotation(angles, order)
            rotations[:, j] = multiply(multiply(bone.basis, turn), conjugate(bone.basis))
        for k, name in enumerate(("tx", "ty", "tz")):
            if j == 0 and name in values:
                root[:, k] = values[name]
        if j > 0 and any(np.any(values[name]) for name in values if name[0] in "tl"):
            notes.append(f"Bone {bone.name!r} changes its place or length: left out.")
    return rotations, root


def _find_asf(path: Path) -> Path:
    if path.suffix.lower() == ".asf":
        raise FormatError(
            f"{path}: an .asf file is a skeleton without motion; give the .amc file that moves it"
        )
    try:
        files = sorted(path.parent.iterdir())
    except OSError as error:
        raise FormatError(unreadable(path, error)) from None
    if not path.exists():
        raise FormatError(f"{path}: no such file")
    beside = {p.name.lower(): p for p in files if p.suffix.lower() == ".asf"}
    parts = path.stem.lower().split("_")
    for k in range(len(parts), 0, -1):
        name = "_".join(parts[:k]) + ".asf"
        if name in beside:
            return beside[name]
    if len(beside) == 1:
        return next(iter(beside.values()))
    found = ", ".join(p.name for p in beside.values()) or "no .asf file at all"
    raise FormatError(
        f"{path}: expected {parts[0]}.asf beside it, found {found}; pass asf, the skeleton file"
    )


def _skeleton(text: AsfText) -> Skeleton:
    bones, parents = text.bones, np.array(text.parents)
    # a bone's joint stands where it starts: its parent's vector away from its parent's joint
    offsets = np.array([bones[p].vector if p >= 0 else text.root_position for p in parents])
    tips = np.array([bone.vector for bone in bones])
    tips[parents[1:]] = np.nan
    return Skeleton(tuple(bone.name for bone in bones), parents, offsets, tips=tips)


def _parse_amc(path: Path, asf_path: Path, text: AsfText) -> tuple[FloatArray, float, list[str]]:
    """Values (T, sum of dof) in the order of the bones, degrees per unit of angle, notes."""
    data = read_bytes(path, "an Acclaim motion (AMC)")
    lines = data.decode("utf-8-sig", errors="replace").splitlines()
    degrees = text.degrees
    frames: list[dict[str, list[float]]] = []
    starts: list[int] = []
    width = {bone.name: len(bone.dof) for bone in text.bones}
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words[0][0] == "#":
            continue
        if words[0][0] == ":":
            degrees = {":degrees": 1.0, ":radians": 180 / np.pi}.get(words[0].lower(), degrees)
        elif len(words) == 1 and words[0].isdecimal():
            frames.append({})
            starts.append(number)
        else:
            if not frames:
                raise FormatError(
                    f"{path}, line {number}: expected a frame number, found {line.strip()[:40]!r}"
                )
            if fault := _bone_line(words, frames[-1], width, asf_path):
                raise FormatError(f"{path}, line {number}: {fault}")
    if not frames:
        raise FormatError(f"{path}: expected frames, found none in {len(lines)} lines")
    motion, notes = _table(path, text, frames, starts)
    return motion, degrees, notes


def _bone_line(
    words: list[str], frame: dict[str, list[float]], width: dict[str, int], asf_path: Path
) -> str | None:
    name = words[0]
    if name not in width:
        return f"expected a bone of {asf_path.name}, found {name[:40]!r}"
    if name in frame:
        return f"expected each bone once a frame, found {name!r} again"
    try:
        values = list(map(float, words[1:]))
    except ValueError:
        values = []
    if len(values) != width[name]:
        return f"expected {width[name]} values for {name!r}, found {' '.join(words[1:])[:60]!r}"
    frame[name] = values
    return None


def _table(
    path: Path, text: AsfText, frames: list[dict[str, list[float]]], starts: list[int]
) -> tuple[FloatArray, list[str]]:
    moving = [bone for bone in text.bones if bone.dof]
    names = [bone.name for bone in moving if bone.name in frames[0]]
    for t, frame in enumerate(frames):
        if lost := [name for name in names if name not in frame]:
            raise FormatError(
                f"{path}, line {starts[t]}: expected {len(names)} bones in this frame, found {len(frame)}, "
                f"{lost[0]!r} is missing; the file may be cut short"
            )
    absent = [bone.name for bone in moving if bone.name not in frames[0]]
    notes = [f"Bones without motion: {', '.join(absent)}."] if absent else []
    still = {bone.name: [0.0] * len(bone.dof) for bone in moving}
    rows = [[v for bone in moving for v in frame.get(bone.name, still[bone.name])] for frame in frames]
    motion = np.array(rows)
    wrong = ~(np.abs(motion) < 1e12)
    if wrong.any():
        t, k = (int(i) for i in np.argwhere(wrong)[0])
        owner = [bone.name for bone in moving for _ in bone.dof][k]
        raise FormatError(
            f"{path}, line {starts[t]}: expected finite numbers here, found {motion[t, k]} for {owner!r}"
        )
    return motion, notes
