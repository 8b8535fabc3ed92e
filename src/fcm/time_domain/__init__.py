"""Exact motion in time, without a time step: flows, transitions, measures, energy, schedules."""

from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import Measure
from fcm.time_domain.energy import Energy, energy
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.histories import Histories, histories
from fcm.time_domain.simulation import simulate, simulate_phases, simulate_schedule
from fcm.time_domain.state import State
from fcm.time_domain.trajectory import History, Motion, Transition

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
