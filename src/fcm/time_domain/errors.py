"""The exceptions of the time simulation."""

from __future__ import annotations


class SimulationError(ValueError):
    """The motion cannot be computed as asked; the message says why and what to try."""


class CycleError(SimulationError):
    """A cycle cannot be followed to its end."""
