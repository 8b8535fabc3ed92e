"""Limits of simulations, and of what is kept of them: `TimeOptions` has all."""

from __future__ import annotations

from fcm.frozen import Frozen


class SimulationOptions(Frozen):
    """The exact motion.

    max_transitions: of contacts in one cycle, at most; with more they chatter.
    """

    max_transitions: int = 200_000


class SettlingOptions(Frozen):
    """Whether a transient has settled.

    cycles: whose amplitudes are compared with those of as many before. min_change: relative change that is
    none. min_amplitude: part of the greatest amplitude; smaller ones are not judged. tolerance: relative
    change of the amplitudes that is still to come, up to which the motion is periodic.
    """

    cycles: int = 10
    min_change: float = 1e-9
    min_amplitude: float = 1e-6
    tolerance: float = 1e-3


class HistoryOptions(Frozen):
    """What is kept of a schedule.

    max_samples, min_samples: of a cycle, at most and at least. max_displacements: that are sampled, of all
    curves; 32 MB before compression. max_transitions: kept with their times; all are counted. max_letters: of
    a sequence of states in a summary.
    """

    max_samples: int = 64
    min_samples: int = 8
    max_displacements: int = 4_000_000
    max_transitions: int = 1_000_000
    max_letters: int = 40


class TransitionOptions(Frozen):
    """How the transitions of contacts are found in a motion.

    rounding: of a state after a step, relative to its terms. depth: an exit that is passed by less, relative
    to its size, is not. grazing: rate of an exit where it is passed, relative to its terms; with less the
    instant does not move. max_passes: until a combination of states agrees with itself. max_steps: in one
    segment. max_blocks: of steps until signals are looked at. max_halvings: of a step in which an exit is
    sought. negligible_power: of a series, over what it adds up to; the last of its powers that are less are
    left out. first_doublings: steps of a segment's first look, as a power of two, for many are short.
    max_order: of the derivatives of an exit that may tell which combination follows.
    """

    rounding: float = 3e-14
    depth: float = 1e-13
    grazing: float = 1e-12
    max_passes: int = 100
    max_steps: float = 2e8
    max_blocks: int = 50_000
    max_halvings: int = 50
    negligible_power: float = 1e-20
    first_doublings: int = 2
    max_order: int = 7


class FlowOptions(Frozen):
    """The flows of a scene, each of one combination of contact states.

    min_count: that are kept at least. max_bytes: memory of those that are kept otherwise. dense_size:
    components of the state from which on matrices are multiplied by BLAS. taylor_size: components up to which
    Taylor coefficients are kept. few_rows: derivatives that are sooner moved one by one. max_step_angle: of
    the highest harmonic of the forces in a step [rad]: one, and rounding. transitions: how they are found.
    """

    min_count: int = 8
    max_bytes: float = 2.0**30
    dense_size: int = 32
    taylor_size: int = 256
    few_rows: int = 4
    max_step_angle: float = 1.0 + 1e-12
    transitions: TransitionOptions = TransitionOptions()


class TimeOptions(Frozen):
    """All of the package, by what they are for: see the class of each field."""

    simulation: SimulationOptions = SimulationOptions()
    settling: SettlingOptions = SettlingOptions()
    history: HistoryOptions = HistoryOptions()
    flows: FlowOptions = FlowOptions()


TIME = TimeOptions()  # where nothing else is said
