"""A clip as a continuous function of time: signals of time, pose and shape.

`SignalModel` fits a clip, as in [1]_; edits are functions from signals to signals.

References
----------
.. [1] Cashman and Hormann, "A continuous, editable representation for deforming mesh sequences with separate
   signals for time, pose and shape", Computer Graphics Forum 31, 2012.
"""

from tempose.signals.model import SignalModel
from tempose.signals.signals import Signals

__all__ = ["SignalModel", "Signals"]
