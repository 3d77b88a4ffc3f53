"""The text of an ASF file (Acclaim skeleton) taken apart: bones, their axes, who hangs on whom."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from tempose.formats._input import read_bytes
from tempose.formats.conventions import FormatError
from tempose.rotations import IDENTITY, from_euler_degrees
from tempose.typing import FloatArray

_SANE = 1e12
_DOF = {"tx", "ty", "tz", "rx", "ry", "rz", "l"}


@dataclass
class AsfBone:
    """One bone; the root is a bone of no length."""

    name: str
    vector: FloatArray = field(default_factory=lambda: np.zeros(3))
    """(3,) from where the bone starts to where its children do, in the axes of the world."""
    basis: FloatArray = field(default_factory=lambda: IDENTITY)
    """(4,) wxyz, the axes about which its degrees of freedom turn."""
    dof: tuple[str, ...] = ()
    line: int = 0


@dataclass
class AsfText:
    """What the file says; bones stand in depth-first order, the root first."""

    bones: list[AsfBone]
    parents: list[int]
    root_position: tuple[float, ...] = (0.0, 0.0, 0.0)
    length: float | None = None
    degrees: float = 1.0


_Line = tuple[int, list[str]]


def parse_asf(path: Path) -> AsfText:
    """Read and take apart an ASF file."""
    sections = _sections(path)
    for needed in ("bonedata", "hierarchy"):
        if needed not in sections:
            raise FormatError(f"{path}: expected a section :{needed}, found {_listed(sections)}")
    units = {words[0].lower(): (line, words[1:]) for line, words in sections.get("units", [])}
    degrees = 1.0
    if units.get("angle", (0, ["deg"]))[1][:1] in (["rad"], ["radians"]):
        degrees = 180.0 / np.pi
    length = None
    if "length" in units:
        (length,) = numbers(f"{path}, line {units['length'][0]}", units["length"][1], 1)
    root, position = _root(path, sections.get("root", []), degrees)
    bones = [root, *_bones(path, sections["bonedata"], degrees)]
    bones, parents = _ordered(path, bones, sections["hierarchy"])
    return AsfText(bones, parents, position, length if length and length > 0 else None, degrees)


def numbers(where: str, words: list[str], count: int) -> tuple[float, ...]:
    """Exactly `count` finite numbers, or an error that says where."""
    try:
        values = tuple(float(word) for word in words)
    except ValueError:
        values = ()
    if len(values) != count or not all(abs(v) < _SANE for v in values):
        found = " ".join(words)[:60]
        raise FormatError(f"{where}: expected {count} number{'s' * (count != 1)}, found {found!r}")
    return values


def _listed(sections: dict[str, list[_Line]]) -> str:
    return ", ".join(f":{name}"[:20] for name in list(sections)[:8]) or "no section at all"


def _sections(path: Path) -> dict[str, list[_Line]]:
    text = read_bytes(path, "an Acclaim skeleton (ASF)").decode("utf-8-sig", errors="replace")
    sections: dict[str, list[_Line]] = {}
    current: list[_Line] = []
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0].startswith(":"):
            current = sections.setdefault(words[0][1:].lower(), [])
        else:
            current.append((number, words))
    return sections


def _root(path: Path, lines: list[_Line], degrees: float) -> tuple[AsfBone, tuple[float, ...]]:
    root = AsfBone("root", dof=("tx", "ty", "tz", "rx", "ry", "rz"))
    position, orientation, order = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), "xyz"
    for number, words in lines:
        where, key = f"{path}, line {number}", words[0].lower()
        if key == "order":
            root.dof = _dof(where, words[1:])
        elif key == "axis":
            order = _order(where, words[1:])
        elif key == "position":
            position = numbers(where, words[1:], 3)
        elif key == "orientation":
            orientation = numbers(where, words[1:], 3)
    root.basis = basis_rotation(np.array(orientation) * degrees, order)
    return root, position


def basis_rotation(angles: FloatArray, order: str) -> FloatArray:
    """Rotation by angles in degrees about fixed axes, first letter first, as ASF means them."""
    return from_euler_degrees(angles[..., ::-1], order[::-1])


def _dof(where: str, words: list[str]) -> tuple[str, ...]:
    dof = tuple(word.lower() for word in words)
    if not _DOF.issuperset(dof) or len(set(dof)) < len(dof):
        raise FormatError(f"{where}: expected distinct degrees of freedom out of tx..rz, found {dof!r}"[:200])
    return dof


def _order(where: str, words: list[str]) -> str:
    order = "".join(words).lower()
    if sorted(order) != ["x", "y", "z"]:
        raise FormatError(f"{where}: expected an axis order such as XYZ, found {order[:40]!r}")
    return order


def _bones(path: Path, lines: list[_Line], degrees: float) -> list[AsfBone]:
    bones: list[AsfBone] = []
    open_at: int | None = None
    direction, length = (0.0, 0.0, 0.0), 0.0
    for number, words in lines:
        where, key = f"{path}, line {number}", words[0].lower()
        if (key == "begin") == (open_at is not None):
            raise FormatError(f"{where}: expected {'end' if open_at else 'begin'}, found {words[0][:40]!r}")
        if key == "begin":
            open_at = number
            bones.append(AsfBone("", line=number))
            direction, length = (0.0, 0.0, 0.0), 0.0
        elif key == "end":
            open_at = None
            bones[-1].vector = np.array(direction) * length
        elif key == "name":
            bones[-1].name = " ".join(words[1:])
        elif key == "direction":
            direction = numbers(where, words[1:], 3)
        elif key == "length":
            (length,) = numbers(where, words[1:], 1)
        elif key == "axis":
            order = _order(where, words[4:])
            bones[-1].basis = basis_rotation(np.array(numbers(where, words[1:4], 3)) * degrees, order)
        elif key == "dof":
            bones[-1].dof = _dof(where, words[1:])
        elif not re.match(r"\(|limits|id|bodymass|cofmass", key):
            raise FormatError(f"{where}: expected a property of a bone or end, found {words[0][:40]!r}")
    if open_at is not None:
        raise FormatError(f"{path}, line {open_at}: expected an end to this bone, found the end of :bonedata")
    return bones


def _ordered(path: Path, bones: list[AsfBone], lines: list[_Line]) -> tuple[list[AsfBone], list[int]]:
    by_name = {bone.name: bone for bone in bones}
    for bone in bones:
        if not bone.name or by_name[bone.name] is not bone:
            raise FormatError(
                f"{path}, line {bone.line}: expected a name of its own, found {bone.name[:40]!r}"
            )
    children: dict[str, list[str]] = {}
    placed = {"root"}
    for number, words in lines:
        if words[0].lower() in ("begin", "end"):
            continue
        for name in words:
            if name not in by_name:
                raise FormatError(f"{path}, line {number}: expected a bone of :bonedata, found {name[:40]!r}")
        for name in words[1:]:
            if name in placed:
                raise FormatError(
                    f"{path}, line {number}: expected one parent a bone, found a second of {name!r}"
                )
            placed.add(name)
        children.setdefault(words[0], []).extend(words[1:])
    order, parents = _depth_first(children)
    if lost := [name for name in by_name if name not in set(order)]:
        raise FormatError(f"{path}: expected every bone under root in :hierarchy, found {lost[0]!r} outside")
    return [by_name[name] for name in order], parents


def _depth_first(children: dict[str, list[str]]) -> tuple[list[str], list[int]]:
    order: list[str] = []
    parents: list[int] = []
    stack = [("root", -1)]
    while stack:
        name, parent = stack.pop()
        stack += [(child, len(order)) for child in reversed(children.get(name, []))]
        order.append(name)
        parents.append(parent)
    return order, parents
