"""Frozen data as named arrays and a tree of plain values, and back: what a model file holds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from tempose.typing import FloatArray


class ValueTree(ABC):
    """How the values of one sort of model are taken apart and put together.

    Arrays, sequences, numbers, text, None and the dataclasses that `label` knows; nothing else is ever made
    from a file.
    """

    @abstractmethod
    def label(self, kind: type[Any]) -> dict[str, str] | None:
        """Say how a file names a dataclass.

        Parameters
        ----------
        kind : type
            A dataclass.

        Returns
        -------
        dict or None
            Words for `kind_of`; None if a file may not hold it.
        """

    @abstractmethod
    def kind_of(self, tree: Mapping[str, Any]) -> type[Any]:
        """Find the dataclass that a file names.

        Parameters
        ----------
        tree : mapping
            With the words that `label` gave.

        Returns
        -------
        type
            The dataclass.

        Raises
        ------
        ValueError
            If a file may not hold it.
        """

    def to_arrays(self, value: Any, name: str, arrays: dict[str, FloatArray]) -> Any:
        """Take a value apart.

        Parameters
        ----------
        value : object
            What the tree knows. Fields that a class makes itself (``init=False``) are left out.
        name : str
            What its arrays are called, or their names begin with.
        arrays : dict of str to ndarray
            Filled with the arrays found.

        Returns
        -------
        object
            What JSON can hold: the value without its arrays.

        Raises
        ------
        TypeError
            If a value is of another kind.
        """
        if value is None or isinstance(value, str | bool | int | float):
            return value
        if isinstance(value, np.ndarray):
            arrays[name] = value
            return {"array": name}
        if isinstance(value, tuple | list):
            return [self.to_arrays(v, f"{name}.{i}", arrays) for i, v in enumerate(value)]
        label = self.label(type(value)) if is_dataclass(value) else None
        if label is None:
            raise TypeError(f"{name}: a {type(value).__name__} cannot be saved")
        parts = {
            f.name: self.to_arrays(getattr(value, f.name), f"{name}.{f.name}", arrays)
            for f in fields(value)  # type: ignore[arg-type]
            if f.init
        }
        return {**label, "fields": parts}

    def from_arrays(self, tree: Any, arrays: Mapping[str, FloatArray]) -> Any:
        """Put a value together again.

        Parameters
        ----------
        tree : object
            As `to_arrays` returned it.
        arrays : mapping of str to ndarray
            The arrays it filled in.

        Returns
        -------
        object
            The same value; lists have become tuples.

        Raises
        ------
        ValueError
            If the tree names what does not exist, or the parts do not fit.
        """
        if isinstance(tree, list):
            return tuple(self.from_arrays(part, arrays) for part in tree)
        if not isinstance(tree, dict):
            return tree
        if "array" in tree:
            return arrays[tree["array"]]
        return self.kind_of(tree)(**{k: self.from_arrays(v, arrays) for k, v in tree["fields"].items()})
