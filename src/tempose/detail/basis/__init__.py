"""Residuals in few modes, in whole steps: what a model file holds and posing reads."""

from tempose.detail.basis.modes import DetailBasis, compress

__all__ = ["DetailBasis", "compress"]
