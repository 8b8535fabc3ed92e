"""Exact motion in time, without a time step: flows, transitions, measures, energy, schedules."""

from fcm.motion.cycle import Cycle
from fcm.motion.energy import Energy, energy
from fcm.motion.errors import SimulationError
from fcm.motion.histories import Histories, histories
from fcm.motion.measure import Measure
from fcm.motion.motion import History, Motion, Transition
from fcm.motion.run import simulate, simulate_phases, simulate_schedule
from fcm.motion.state import State

__all__ = [
    "Cycle",
    "Energy",
    "Histories",
    "History",
    "Measure",
    "Motion",
    "SimulationError",
    "State",
    "Transition",
    "energy",
    "histories",
    "simulate",
    "simulate_phases",
    "simulate_schedule",
]
