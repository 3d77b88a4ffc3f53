"""Binary data of a GLB in the making: clips are big, so arrays are made one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from tempose.typing import FloatArray, IntArray, Progress

VERTEX_DATA, INDEX_DATA = 34962, 34963
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
_COMPONENTS = {"<f4": 5126, "<u4": 5125, "<u2": 5123}

AnyArray: TypeAlias = FloatArray | IntArray


@dataclass
class Buffer:
    """Accessors in order of writing; the data of each is made when its turn comes."""

    accessors: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    """JSON of the accessors."""
    views: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    """JSON of the buffer views, one an accessor."""
    makers: list[Callable[[], AnyArray]] = field(default_factory=list[Callable[[], AnyArray]])
    """What makes their arrays."""
    size: int = 0
    """Bytes so far."""

    def add(
        self,
        make: Callable[[], AnyArray],
        shape: tuple[int, int],
        target: int | None,
        bounds: bool = False,
        *,
        dtype: str | None = None,
    ) -> int:
        """Append float32 data, or uint32 for indices.

        Parameters
        ----------
        make : callable
            Makes the array; called when its bytes are wanted.
        shape : tuple of int
            Its shape, one row an element.
        target : int or None
            `VERTEX_DATA`, `INDEX_DATA`, or None for keys.
        bounds : bool, default False
            Whether to state the smallest and largest values, as glTF wants for positions and times.
        dtype : str, optional
            ``"<u2"`` for small whole numbers; rows must fill a multiple of four bytes.

        Returns
        -------
        int
            Index of the accessor.
        """
        dtype = dtype or ("<u4" if target == INDEX_DATA else "<f4")
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": _COMPONENTS[dtype],
            "count": shape[0],
            "type": _TYPES[shape[1]],
        }
        if bounds:
            values = make()
            accessor["min"], accessor["max"] = values.min(axis=0).tolist(), values.max(axis=0).tolist()
        length = int(dtype[-1]) * shape[0] * shape[1]
        view: dict[str, Any] = {"buffer": 0, "byteOffset": self.size, "byteLength": length}
        if target is not None:
            view["target"] = target
        self.accessors.append(accessor)
        self.views.append(view)
        self.makers.append(make)
        self.size += view["byteLength"]
        return len(self.accessors) - 1

    def pieces(self, progress: Progress) -> Iterator[bytes]:
        """Make the bytes of each accessor.

        Parameters
        ----------
        progress : Progress
            Called after each.

        Yields
        ------
        bytes
            In order.
        """
        for i, (make, accessor) in enumerate(zip(self.makers, self.accessors)):
            dtype = next(name for name, code in _COMPONENTS.items() if code == accessor["componentType"])
            yield np.ascontiguousarray(make(), dtype=dtype).tobytes()
            progress(i + 1, len(self.makers), "writing")
