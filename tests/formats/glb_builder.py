"""Small glTF files for tests, put together by hand so that every byte is known."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

CODES = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


class Builder:
    """Collects JSON and bytes; every list of the JSON is open to the test."""

    def __init__(self) -> None:
        self.data = b""
        self.json: dict[str, Any] = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [],
            "meshes": [],
            "accessors": [],
            "bufferViews": [],
        }

    def view(self, raw: bytes, **more: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(raw), **more}
        self.json["bufferViews"].append(view)
        self.data += raw
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values: Any, kind: str = "VEC3", dtype: str = "f4", **more: Any) -> int:
        array = np.asarray(values, dtype=f"<{dtype}")
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[kind]
        entry = {
            "bufferView": self.view(array.tobytes()),
            "componentType": CODES[dtype],
            "count": array.size // width,
            "type": kind,
            **more,
        }
        self.json["accessors"].append(entry)
        return len(self.json["accessors"]) - 1

    def mesh(self, V: Any = TRIANGLE, F: Any = None, mode: int = 4, **more: Any) -> int:
        primitive: dict[str, Any] = {"attributes": {"POSITION": self.accessor(V)}, "mode": mode}
        if F is not None:
            primitive["indices"] = self.accessor(F, "SCALAR", "u2")
        self.json["meshes"].append({"primitives": [primitive], **more})
        return len(self.json["meshes"]) - 1

    def attribute(self, mesh: int, name: str, values: Any, kind: str, dtype: str = "f4", **more: Any) -> None:
        index = self.accessor(values, kind, dtype, **more)
        self.json["meshes"][mesh]["primitives"][0]["attributes"][name] = index

    def node(self, **fields: Any) -> int:
        self.json["nodes"].append(fields)
        return len(self.json["nodes"]) - 1

    def animate(self, *channels: tuple[int, str, Any, Any, str], name: str | None = None) -> None:
        """Add an animation of (node, path, times, values, interpolation)."""
        entry: dict[str, Any] = {"channels": [], "samplers": []}
        if name is not None:
            entry["name"] = name
        kinds = {"rotation": "VEC4", "weights": "SCALAR"}
        for node, path, times, values, mode in channels:
            sampler = {
                "input": self.accessor(times, "SCALAR"),
                "output": self.accessor(values, kinds.get(path, "VEC3")),
                "interpolation": mode,
            }
            entry["samplers"].append(sampler)
            target = {"node": node, "path": path}
            entry["channels"].append({"sampler": len(entry["samplers"]) - 1, "target": target})
        self.json.setdefault("animations", []).append(entry)

    def bytes(self) -> bytes:
        document = {"buffers": [{"byteLength": len(self.data)}], **self.json}
        return pack(json.dumps(document).encode(), self.data)

    def save(self, path: Path) -> Path:
        path.write_bytes(self.bytes())
        return path


def pack(text: bytes, data: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    )
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def turn(axis: Any, angle: float) -> list[float]:
    """Quaternion xyzw, as glTF stores it."""
    unit = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    return [*(np.sin(angle / 2) * unit).tolist(), float(np.cos(angle / 2))]


def arm(rng: np.random.Generator, n: int = 12) -> tuple[Builder, dict[str, Any]]:
    """A skin of three joints under a turned and scaled armature, bound in another pose than it stands in.

    Returns the builder and what went into it, for a slow twin.
    """
    b = Builder()
    V = rng.normal(size=(n, 3)).astype(np.float32)
    mesh = b.mesh(V, np.arange(n), name="skin")
    joints = rng.integers(0, 3, (n, 4))
    weights = rng.random((n, 4)).astype(np.float32)
    weights /= weights.sum(axis=1, keepdims=True)
    b.attribute(mesh, "JOINTS_0", joints, "VEC4", "u1")
    b.attribute(mesh, "WEIGHTS_0", weights, "VEC4")
    b.node(name="armature", children=[1, 4], rotation=turn([1, 0, 0], -np.pi / 2), scale=[0.5] * 3)
    b.node(name="upper", children=[2], translation=[0, 0, 1], rotation=turn([1, 2, 0], 0.3))
    b.node(name="lower", children=[3], translation=[0.0, 1, 0], rotation=turn([0, 1, 1], 0.6))
    b.node(translation=[0.0, 1, 0.5])
    b.node(name="body", mesh=mesh, skin=0, translation=[9, 9, 9])
    inverse_bind = np.tile(np.eye(4), (3, 1, 1))
    inverse_bind[:, :3, 3] = [[0, 0, -1], [0, -1, -1], [0, -2, -1.5]]
    matrices = b.accessor(inverse_bind.transpose(0, 2, 1), "MAT4")
    b.json["skins"] = [{"joints": [1, 2, 3], "inverseBindMatrices": matrices}]
    times = np.arange(5) / 24
    key = [turn(rng.normal(size=3), a) for a in (0.1, 0.5, 1.2, 2.0, 2.5)]
    path = rng.normal(size=(5, 3))
    b.animate((1, "rotation", times, key, "LINEAR"), (1, "translation", times, path, "LINEAR"), name="wave")
    return b, {
        "V": V,
        "joints": joints,
        "weights": weights,
        "inverse_bind": inverse_bind,
        "key": key,
        "path": path,
    }
