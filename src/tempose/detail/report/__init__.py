"""What a fit says of itself."""

from tempose.detail.report.heldout import HeldOut, held_out
from tempose.detail.report.report import fit_report

__all__ = ["HeldOut", "fit_report", "held_out"]
