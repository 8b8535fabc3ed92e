"""Limits of simulations, and of what is kept of them: `TimeOptions` has all."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SimulationOptions:
    """The exact motion.

    transitions: of contacts in one cycle, at most; with more they chatter.
    """

    transitions: int = 200_000


@dataclass(frozen=True)
class SettlingOptions:
    """Whether a transient has settled.

    cycles: whose amplitudes are compared with those of as many before. rounding: relative change that is
    none. least: part of the greatest amplitude; smaller ones are not judged. settled: relative change of the
    amplitudes that is still to come, up to which the motion is periodic.
    """

    cycles: int = 10
    rounding: float = 1e-9
    least: float = 1e-6
    settled: float = 1e-3


@dataclass(frozen=True)
class HistoryOptions:
    """What is kept of a schedule.

    samples, fewest: of a cycle, at most and at least. displacements: that are sampled, of all curves; 32 MB
    before compression. transitions: kept with their times; all are counted. letters: of a sequence of states
    in a summary.
    """

    samples: int = 64
    fewest: int = 8
    displacements: int = 4_000_000
    transitions: int = 1_000_000
    letters: int = 40


@dataclass(frozen=True)
class FlowOptions:
    """The flows of a scene that are kept, each of one sequence of contact states.

    min_count: that are kept at least. max_bytes: memory of those that are kept otherwise.
    """

    min_count: int = 8
    max_bytes: float = 2.0**30


@dataclass(frozen=True)
class TimeOptions:
    """All of the package, by what they are for: see the class of each field."""

    simulation: SimulationOptions = SimulationOptions()
    settling: SettlingOptions = SettlingOptions()
    history: HistoryOptions = HistoryOptions()
    flows: FlowOptions = FlowOptions()


TIME = TimeOptions()  # where nothing else is said
