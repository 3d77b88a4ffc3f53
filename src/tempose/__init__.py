"""Take hold of mesh animations."""

from tempose._version import __version__

__all__ = ["__version__"]
