"""The exceptions of the time simulation."""

from __future__ import annotations


class SimulationError(ValueError):
    """Raised when the motion cannot be computed as asked; the message says why and what to try."""


class CycleError(SimulationError):
    """Raised when a cycle cannot be followed to its end."""
