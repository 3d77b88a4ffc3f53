"""Other proportions for a rig: longer or shorter, thicker or thinner bones, with the flesh along them."""

from tempose.rigging.proportions.change import change_proportions
from tempose.rigging.proportions.factors import Factor, read_factors
from tempose.rigging.proportions.stretch import stretch_field

__all__ = ["Factor", "change_proportions", "read_factors", "stretch_field"]
