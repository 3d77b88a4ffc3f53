"""Clips from scratch: poses placed by hand in the plane and a drawn curve."""

from tempose.signals.design.design import design
from tempose.signals.design.files import load_design

__all__ = ["design", "load_design"]
