"""A JSON object that knows where it stands, so that every complaint names file and place."""

from __future__ import annotations

from typing import Any

import numpy as np

from tempose.formats.conventions import FormatError
from tempose.typing import FloatArray


class Item:
    """One JSON object of a glTF file; every field is checked when it is asked for.

    Parameters
    ----------
    file : str
        Name of the file, for messages.
    place : str
        Where in the file, such as ``"accessors[3]"``; empty for the top.
    fields : object
        The parsed value; must be a JSON object.
    """

    __slots__ = ("fields", "file", "place")

    def __init__(self, file: str, place: str, fields: Any) -> None:
        self.file, self.place = file, place
        if not isinstance(fields, dict):
            raise self.error(f"expected a JSON object, found {_shown(fields)}")
        self.fields: dict[str, Any] = fields

    def error(self, text: str, key: str = "") -> FormatError:
        """Make the error for something wrong here.

        Parameters
        ----------
        text : str
            What was expected and what was found.
        key : str, optional
            Field that is wrong.

        Returns
        -------
        FormatError
            To be raised.
        """
        place = ".".join(part for part in (self.place, key) if part)
        return FormatError(f"{self.file}: {place}: {text}" if place else f"{self.file}: {text}")

    def has(self, key: str) -> bool:
        """Whether a field is there and not null.

        Parameters
        ----------
        key : str
            Name of the field.

        Returns
        -------
        bool
            True if it holds something.
        """
        return self.fields.get(key) is not None

    def integer(self, key: str, default: int | None = None, low: int = 0, limit: int | None = None) -> int:
        """Return a whole number.

        Parameters
        ----------
        key : str
            Name of the field.
        default : int, optional
            Value if the field is missing; without one the field is required.
        low : int, default 0
            Smallest allowed value.
        limit : int, optional
            Values must be below it.

        Returns
        -------
        int
            The value.
        """
        value = self.fields.get(key)
        if value is None and default is not None:
            return default
        return self._whole(value, key, low, limit)

    def integers(self, key: str, limit: int | None = None) -> list[int]:
        """Return a list of whole numbers from 0.

        Parameters
        ----------
        key : str
            Name of the field; a missing one is an empty list.
        limit : int, optional
            Values must be below it.

        Returns
        -------
        list of int
            The values.
        """
        return [self._whole(v, f"{key}[{i}]", 0, limit) for i, v in enumerate(self._list(key))]

    def _whole(self, value: Any, key: str, low: int, limit: int | None) -> int:
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        bad = not isinstance(value, int) or isinstance(value, bool) or value < low
        if bad or (limit is not None and value >= limit):
            upper = "" if limit is None else f" and below {limit}"
            raise self.error(f"expected a whole number from {low}{upper}, found {_shown(value)}", key)
        return int(value)

    def text(self, key: str, default: str = "") -> str:
        """Return a string.

        Parameters
        ----------
        key : str
            Name of the field.
        default : str, optional
            Value if the field is missing.

        Returns
        -------
        str
            The value.
        """
        value = self.fields.get(key)
        if value is not None and not isinstance(value, str):
            raise self.error(f"expected a string, found {_shown(value)}", key)
        return default if value is None else value

    def numbers(self, key: str, length: int | None = None) -> FloatArray | None:
        """Return finite numbers.

        Parameters
        ----------
        key : str
            Name of the field.
        length : int, optional
            How many there must be.

        Returns
        -------
        (length,) ndarray of float64 or None
            None if the field is missing.
        """
        if not self.has(key):
            return None
        values = self._list(key)
        for i, v in enumerate(values):
            fine = isinstance(v, (int, float)) and not isinstance(v, bool)
            # beyond float32 nothing in the format can be meant; squares would overflow
            if not fine or not abs(v) < 3.5e38:
                raise self.error(f"expected a finite number, found {_shown(v)}", f"{key}[{i}]")
        if length is not None and len(values) != length:
            raise self.error(f"expected {length} numbers, found {len(values)}", key)
        return np.array(values, dtype=np.float64)

    def child(self, key: str) -> Item:
        """Return an object inside this one; a missing one is empty.

        Parameters
        ----------
        key : str
            Name of the field.

        Returns
        -------
        Item
            The inner object.
        """
        value = self.fields.get(key)
        place = f"{self.place}.{key}" if self.place else key
        return Item(self.file, place, {} if value is None else value)

    def items(self, key: str) -> list[Item]:
        """Return a list of objects; a missing one is empty.

        Parameters
        ----------
        key : str
            Name of the field.

        Returns
        -------
        list of Item
            The inner objects.
        """
        prefix = f"{self.place}." if self.place else ""
        return [Item(self.file, f"{prefix}{key}[{i}]", v) for i, v in enumerate(self._list(key))]

    def _list(self, key: str) -> list[Any]:
        value = self.fields.get(key)
        if value is None:
            return []
        if not isinstance(value, list):
            raise self.error(f"expected a list, found {_shown(value)}", key)
        return value


def _shown(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, int) and abs(value) > 10**30:
        return "a huge number"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
