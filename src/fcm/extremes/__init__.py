"""Stiff and extreme cases: a catalogue of bundled scenes, each measured and judged by stated criteria."""

from fcm.extremes.row import Row, catalogue, measured
from fcm.extremes.verdict import faults

__all__ = ["Row", "catalogue", "faults", "measured"]
