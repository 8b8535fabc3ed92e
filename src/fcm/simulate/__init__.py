"""Exact motion in time: simulation without a time step, schedules, periodic solutions."""

from fcm.simulate.branch import Branch, trace_orbits
from fcm.simulate.cycle import Cycle
from fcm.simulate.energy import Energy, energy
from fcm.simulate.errors import SimulationError
from fcm.simulate.exact import trace_exact
from fcm.simulate.harmonic import harmonic_state
from fcm.simulate.histories import Histories, histories
from fcm.simulate.measure import Measure
from fcm.simulate.motion import History, Motion, Transition
from fcm.simulate.periodic import Orbit, periodic
from fcm.simulate.run import simulate, simulate_phases, simulate_schedule
from fcm.simulate.sample import Sample
from fcm.simulate.state import State

__all__ = [
    "Branch",
    "Cycle",
    "Energy",
    "Histories",
    "History",
    "Measure",
    "Motion",
    "Orbit",
    "Sample",
    "SimulationError",
    "State",
    "Transition",
    "energy",
    "harmonic_state",
    "histories",
    "periodic",
    "simulate",
    "simulate_phases",
    "simulate_schedule",
    "trace_exact",
    "trace_orbits",
]
