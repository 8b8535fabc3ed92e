"""Curves of exact periodic solutions: followed through a range, or visited by sweeps."""

from fcm.simulate.branch import Branch, trace_orbits
from fcm.simulate.exact import trace_exact
from fcm.simulate.sample import Sample

__all__ = ["Branch", "Sample", "trace_exact", "trace_orbits"]
