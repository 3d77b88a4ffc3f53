"""The text of a BVH file taken apart: joints with their channels, and rows of numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from tempose.formats._input import read_bytes
from tempose.formats._numbers import NumberError, parse_floats
from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray

_CHANNELS = {f"{axis}{kind}" for axis in "xyz" for kind in ("position", "rotation")}
_SANE = 1e12


@dataclass
class BvhJoint:
    """One joint of the hierarchy."""

    name: str
    parent: int
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    channels: tuple[str, ...] = ()
    tip: tuple[float, float, float] | None = None


@dataclass
class BvhText:
    """What the file says, nothing interpreted."""

    joints: list[BvhJoint] = field(default_factory=list[BvhJoint])
    motion: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    frame_time: str = ""
    notes: list[str] = field(default_factory=list[str])


def parse_bvh(path: Path) -> BvhText:
    """Read and take apart a BVH file."""
    data = read_bytes(path, "BVH motion capture", b"HIERARCHY")
    text = data.decode("utf-8-sig", errors="replace")
    lines = text.splitlines()
    start = next((i for i, line in enumerate(lines) if line.split()[:1] == ["MOTION"]), len(lines))
    result = BvhText(joints=_hierarchy(path, lines[:start]))
    if start == len(lines):
        raise FormatError(
            f"{path}: expected a line MOTION after the hierarchy, found the end at line {start}"
        )
    _motion(path, lines, start + 1, result)
    return result


def _statements(lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    for number, line in enumerate(lines, 1):
        for part in line.replace("{", "\n{\n").replace("}", "\n}\n").split("\n"):
            if words := part.split():
                yield number, words


def _hierarchy(path: Path, lines: list[str]) -> list[BvhJoint]:
    statements = _statements(lines)
    number, words = next(statements, (1, ["nothing"]))
    if words[0].upper() != "HIERARCHY":
        raise FormatError(
            f"{path}, line {number}: a BVH file starts with HIERARCHY, found {' '.join(words)[:40]!r}"
        )
    joints: list[BvhJoint] = []
    # one entry an open brace: index of the joint, or None inside an End Site
    stack: list[int | None] = []
    pending: int | None = None
    opens = False
    for number, words in statements:
        word = words[0].upper()
        where = f"{path}, line {number}"
        if opens != (word == "{"):
            raise FormatError(f"{where}: expected {'{' if opens else 'a statement'}, found {words[0][:40]!r}")
        opens = False
        if word == "{":
            stack.append(pending)
        elif word == "}":
            if not stack:
                raise FormatError(f"{where}: found a closing brace that nothing opened")
            stack.pop()
        elif word in ("ROOT", "JOINT", "END"):
            pending, opens = _open(where, words, joints, stack), True
        elif not stack:
            raise FormatError(f"{where}: expected ROOT, JOINT or a brace, found {words[0][:40]!r}")
        else:
            owner = stack[-1] if stack[-1] is not None else stack[-2]
            assert owner is not None
            _attribute(where, words, joints[owner], tip=stack[-1] is None)
    if stack or opens:
        raise FormatError(
            f"{path}, line {len(lines)}: expected a closing brace, found the end of the hierarchy"
        )
    if not joints:
        raise FormatError(f"{path}: expected a ROOT joint in the hierarchy, found none")
    return joints


def _open(where: str, words: list[str], joints: list[BvhJoint], stack: list[int | None]) -> int | None:
    word = words[0].upper()
    if word == "ROOT" and (stack or joints):
        raise FormatError(
            f"{where}: expected one ROOT, found a second; split the file, a clip is one skeleton"
        )
    if word != "ROOT" and (not stack or stack[-1] is None):
        raise FormatError(f"{where}: expected {words[0]} inside a joint, found it outside")
    if word == "END":
        return None
    parent = -1 if word == "ROOT" else stack[-1]
    assert parent is not None
    joints.append(BvhJoint(" ".join(words[1:]) or f"joint{len(joints)}", parent))
    return len(joints) - 1


def _attribute(where: str, words: list[str], joint: BvhJoint, *, tip: bool) -> None:
    word = words[0].upper()
    if word == "OFFSET":
        try:
            x, y, z = (float(w) for w in words[1:4])
        except ValueError:
            x = y = z = math.nan
        if not all(abs(v) < _SANE for v in (x, y, z)):
            raise FormatError(f"{where}: expected OFFSET and three numbers, found {' '.join(words)[:60]!r}")
        if not tip:
            joint.offset = (x, y, z)
        elif joint.tip is None:
            joint.tip = (x, y, z)
    elif word == "CHANNELS" and not tip:
        channels = tuple(w.lower() for w in words[2:])
        if not _CHANNELS.issuperset(channels) or len(set(channels)) < len(channels):
            raise FormatError(
                f"{where}: expected distinct channels such as Xposition or Zrotation, "
                f"found {' '.join(words[2:])[:60]!r}"
            )
        if words[1:2] != [str(len(channels))]:
            raise FormatError(
                f"{where}: expected CHANNELS {len(channels)}, found {' '.join(words[:2])[:40]!r}"
            )
        joint.channels = channels
    else:
        raise FormatError(
            f"{where}: expected OFFSET, CHANNELS, JOINT, End Site or a brace, found {words[0][:40]!r}"
        )


def _motion(path: Path, lines: list[str], start: int, result: BvhText) -> None:
    header: dict[str, tuple[int, str]] = {}
    while start < len(lines) and (not lines[start].strip() or lines[start].lstrip()[:1] in "Ff"):
        key, _, value = lines[start].partition(":")
        if key.strip():
            header[" ".join(key.lower().split())] = (start + 1, value.strip())
        start += 1
    line, count = header.get("frames", (start, ""))
    if not count.isdecimal() or int(count) == 0:
        found = count[:40] or "nothing"
        raise FormatError(f"{path}, line {line}: expected 'Frames:' and a count above 0, found {found!r}")
    line, result.frame_time = header.get("frame time", (start, ""))
    try:
        good = math.isfinite(float(result.frame_time))
    except ValueError:
        good = False
    if not good:
        found = result.frame_time[:40] or "nothing"
        raise FormatError(f"{path}, line {line}: expected 'Frame Time:' and seconds, found {found!r}")
    result.motion = _rows(path, lines, start, result, int(count))


def _rows(path: Path, lines: list[str], start: int, result: BvhText, count: int) -> FloatArray:
    width = sum(len(joint.channels) for joint in result.joints)
    if width == 0:
        raise FormatError(f"{path}: expected CHANNELS in the hierarchy, found none: nothing moves")
    numbers = [i + 1 for i in range(start, len(lines)) if lines[i].strip()]
    if len(numbers) > count:
        result.notes.append(
            f"The header says {count} frames, the file has {len(numbers)}: the rest is left out."
        )
        numbers = numbers[:count]
    try:
        values = parse_floats(" ".join([lines[i - 1] for i in numbers]).encode())
    except NumberError:
        values = np.zeros(0)
    if len(numbers) == count and values.size == count * width and (np.abs(values) < _SANE).all():
        return values.reshape(count, width)
    _complain(path, [(i, lines[i - 1].split()) for i in numbers], width)
    raise FormatError(
        f"{path}, line {len(lines)}: expected {count} frames as 'Frames:' says, found {len(numbers)}; "
        "the file is cut short"
    )


def _complain(path: Path, rows: list[tuple[int, list[str]]], width: int) -> None:
    for number, row in rows:
        for k, word in enumerate(row):
            if not _is_number(word):
                raise FormatError(
                    f"{path}, line {number}: expected a number as value {k + 1}, found {word[:40]!r}"
                )
        if len(row) != width:
            raise FormatError(
                f"{path}, line {number}: expected {width} values (one a channel), found {len(row)}"
            )


def _is_number(word: str) -> bool:
    try:
        return "_" not in word and abs(float(word)) < _SANE
    except ValueError:
        return False
