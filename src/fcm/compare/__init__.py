"""Run a scene by every method: error against run time, and contributions to the error."""

from fcm.compare.comparison import Comparison, IncomparableError, compare, contributions
from fcm.compare.errors import MEASURES, Reference, Shown

__all__ = ["MEASURES", "Comparison", "IncomparableError", "Reference", "Shown", "compare", "contributions"]
