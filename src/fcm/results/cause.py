"""Why a curve is not complete, as what programs decide by; the reason in words is for people alone."""

from __future__ import annotations

from enum import Enum


class Cause(Enum):
    """Reason for which a curve is incomplete."""

    CALCULATION = "the calculation could not be completed"
    INTERRUPTED = "the run was interrupted"
    DEFECT = "fcm failed"
