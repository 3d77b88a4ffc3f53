"""Pairs to and from files: JSON or TOML of ours, ``.cons`` and YAML marker lists of others."""

from __future__ import annotations

import json
import os
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from tempose._files import atomic_path
from tempose.transfer.pairing.pairs import KINDS, Pairs

KEYS = ("kind", "source", "target", "pairs", "part", "joints", "ends", "how", "comment")


def load_pairs(path: str | os.PathLike[str]) -> Pairs:
    """Read pairs from a file.

    Parameters
    ----------
    path : path-like
        ``.json`` or ``.toml`` (ours), ``.cons`` (count, then ``source, target`` lines) or ``.yml`` with a
        list of ``source:target`` vertex markers. All 0-based.

    Returns
    -------
    Pairs
        The pairs, not yet held against a mesh.

    Raises
    ------
    ValueError
        If the file is no such list; the message names the file and the place.
    OSError
        If it cannot be opened.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise ValueError(f"{path}: expected a text file of pairs, found binary data") from None
    suffix = path.suffix.lower()
    readers = {
        ".json": _from_json,
        ".toml": _from_toml,
        ".cons": _from_cons,
        ".yml": _from_yaml,
        ".yaml": _from_yaml,
    }
    if suffix not in readers:
        raise ValueError(
            f"{path}: pairs are read from {', '.join(sorted(readers))} or .mhw files, got {suffix!r}"
        )
    try:
        return readers[suffix](text, str(path))
    except RecursionError:
        raise ValueError(f"{path}: brackets are nested too deep for a list of pairs") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def save_pairs(path: str | os.PathLike[str], pairs: Pairs, source: str = "", target: str = "") -> None:
    """Write pairs as JSON that a person can edit.

    Parameters
    ----------
    path : path-like
        Where to write.
    pairs : Pairs
        What to write.
    source, target : str
        Names of the two files, kept for the reader; those of `pairs` if not given.
    """
    sources = pairs.source if pairs.kind == "joints" else [int(i) for i in pairs.source]
    rows = [json.dumps([a, int(b)]) for a, b in zip(sources, pairs.target)]
    head: dict[str, Any] = {
        "kind": pairs.kind,
        "source": source or pairs.files[0],
        "target": target or pairs.files[1],
    }
    if pairs.comment:
        lines = pairs.comment.split("\n")
        head["comment"] = lines[0] if len(lines) == 1 else lines
    if pairs.parts:
        head["part"] = list(pairs.parts)
    if pairs.how:
        head["how"] = list(pairs.how)
    for key in ("joints", "ends"):
        places = getattr(pairs, key)
        if places:
            head[key] = {name: [float(x) for x in p] for name, p in places.items()}
    body = ",\n ".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in head.items())
    with atomic_path(path) as part:
        part.write_text("{" + body + ',\n "pairs": [\n  ' + ",\n  ".join(rows) + "\n ]}\n", encoding="utf-8")


def _from_json(text: str, path: str) -> Pairs:
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise ValueError(f"line {error.lineno} is not JSON: {error.msg}") from None
    return _from_table(data, path)


def _from_toml(text: str, path: str) -> Pairs:
    try:
        return _from_table(tomllib.loads(text), path)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"not TOML: {error}") from None


def _from_table(data: Any, path: str) -> Pairs:
    if not isinstance(data, dict):
        raise ValueError(f"expected an object with the keys {', '.join(KEYS)}, found {type(data).__name__}")
    unknown = sorted(set(data) - set(KEYS))
    if unknown:
        raise ValueError(f"unknown key {unknown[0]!r}; known are {', '.join(KEYS)}")
    kind, rows = data.get("kind"), data.get("pairs")
    if kind not in KINDS:
        raise ValueError(f"kind must be one of {', '.join(KINDS)}, found {kind!r}")
    if not isinstance(rows, list) or not rows:
        raise ValueError("pairs must be a list of [source, target], found none")
    for i, row in enumerate(rows):
        expected = str if kind == "joints" else int
        fits = (
            isinstance(row, list) and len(row) == 2 and isinstance(row[0], expected) and type(row[1]) is int
        )
        if not fits or row[1] < 0 or (kind != "joints" and (type(row[0]) is not int or row[0] < 0)):
            noun = "[joint name, face index]" if kind == "joints" else "[index, index] from 0"
            raise ValueError(f"pair {i} must be {noun}, found {str(row)[:60]}")
    part, how = _words(data, "part", "names"), _words(data, "how", "words")
    comment = data.get("comment", "")
    if not isinstance(comment, str):
        comment = "\n".join(_words(data, "comment", "lines"))
    joints, ends = data.get("joints", {}), data.get("ends", {})
    for name, places in (("joints", joints), ("ends", ends)):
        if not isinstance(places, dict):
            raise ValueError(f"{name} must be a table of joint names and positions, found {str(places)[:60]}")
    source = tuple(row[0] for row in rows) if kind == "joints" else np.array([row[0] for row in rows])
    return Pairs(
        kind,
        source,
        np.array([row[1] for row in rows]),
        part,
        joints,
        ends,
        origin=path,
        how=how,
        comment=comment,
        files=(_file_name(data, "source"), _file_name(data, "target")),
    )


def _words(data: dict[str, Any], key: str, noun: str) -> tuple[str, ...]:
    words = data.get(key, [])
    if not isinstance(words, list) or not all(isinstance(word, str) for word in words):
        raise ValueError(f"{key} must be a list of {noun}, found {str(words)[:60]}")
    return tuple(words)


def _file_name(data: dict[str, Any], key: str) -> str:
    name = data.get(key, "")
    if not isinstance(name, str):
        raise ValueError(f"{key} must be the name of a file, found {str(name)[:60]}")
    return name


def _from_cons(text: str, path: str) -> Pairs:
    lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), 1)]
    lines = [(number, line) for number, line in lines if line]
    if not lines or not re.fullmatch(r"[0-9]+", lines[0][1]):
        raise ValueError("line 1 must hold the number of pairs")
    rows: list[tuple[int, int]] = []
    for number, line in lines[1:]:
        match = re.fullmatch(r"([0-9]+)\s*[,\s]\s*([0-9]+)", line)
        if match is None:
            raise ValueError(f"line {number} must be 'source, target' from 0, found {line[:60]!r}")
        rows.append((int(match[1]), int(match[2])))
    if int(lines[0][1]) != len(rows):
        raise ValueError(f"line 1 announces {int(lines[0][1])} pairs, found {len(rows)}")
    return _vertices(rows, path)


def _from_yaml(text: str, path: str) -> Pairs:
    try:
        # BaseLoader keeps strings: YAML 1.1 would read 12:30 as a number in base 60
        data = yaml.load(text, Loader=yaml.BaseLoader)
    except yaml.YAMLError as error:
        raise ValueError(f"not YAML: {str(error).splitlines()[0]}") from None
    markers = data.get("markers") if isinstance(data, dict) else data
    if not isinstance(markers, list) or not markers:
        raise ValueError("expected a list under 'markers', found none")
    rows: list[tuple[int, int]] = []
    for i, entry in enumerate(markers):
        # only text is looked at: a list that refers to itself has no end when printed
        text = entry if isinstance(entry, str) else f"a {type(entry).__name__}"
        match = re.fullmatch(r"\s*([0-9]+)\s*[:, ]\s*([0-9]+)\s*", text)
        if match is None:
            raise ValueError(f"marker {i} must be 'source:target' from 0, found {text[:60]!r}")
        rows.append((int(match[1]), int(match[2])))
    return _vertices(rows, path)


def _vertices(rows: list[tuple[int, int]], path: str) -> Pairs:
    if not rows:
        raise ValueError("expected at least one pair, found none")
    largest = max(map(max, rows))
    if largest > np.iinfo(np.int32).max:
        raise ValueError(f"index {largest} is larger than any mesh")
    table = np.array(rows, dtype=np.int64)
    return Pairs("vertices", table[:, 0], table[:, 1], origin=path)
