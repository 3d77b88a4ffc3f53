"""Posed frames with detail, fast enough to be live."""

from tempose.detail.posing.poser import DetailPoser
from tempose.detail.posing.skin import BlockSkin

__all__ = ["BlockSkin", "DetailPoser"]
