"""What frozen data has in common: copies and pickles are built anew, so that they are frozen too."""

from __future__ import annotations

from dataclasses import fields
from types import MappingProxyType
from typing import Any


class Frozen:
    """Base of the frozen dataclasses that hold read-only arrays."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the fields and check them again on the way back.

        Returns
        -------
        tuple
            The class and the values of its fields, in order.
        """
        values = (getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]
        return type(self), tuple(dict(v) if isinstance(v, MappingProxyType) else v for v in values)
