"""Why a curve is incomplete, as a code for programs; the reason in words is for people only."""

from __future__ import annotations

from enum import Enum


class Cause(Enum):
    """Reason why a curve is incomplete."""

    CALCULATION = "the calculation could not be completed"
    INTERRUPTED = "the run was interrupted"
    DEFECT = "fcm failed"
