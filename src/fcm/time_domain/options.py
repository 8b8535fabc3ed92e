"""Limits of simulations and of their records: `TimeOptions` has all of them."""

from __future__ import annotations

from fcm.frozen import Frozen


class SimulationOptions(Frozen):
    """Options on how the exact motion is simulated.

    Attributes
    ----------
    max_transitions : int
        Greatest number of transitions in one cycle; with more the contacts chatter, and the simulation stops.
    """

    max_transitions: int = 200_000


class SettlingOptions(Frozen):
    """Options on when a transient counts as settled.

    Attributes
    ----------
    cycles : int
        Number of cycles whose range of amplitudes is compared with that of as many cycles before.
    min_change : float
        Range of amplitudes, relative to the last one, up to which they no longer change.
    min_amplitude : float
        Amplitude relative to the greatest; changes of smaller amplitudes are relative to it.
    tolerance : float
        Estimated relative change of the amplitudes still to come, up to which the motion is periodic.
    """

    cycles: int = 10
    min_change: float = 1e-9
    min_amplitude: float = 1e-6
    tolerance: float = 1e-3


class HistoryOptions(Frozen):
    """Options on how much of a schedule is kept.

    Attributes
    ----------
    max_samples, min_samples : int
        Most and fewest samples of a cycle.
    max_displacements : int
        Most displacements that are sampled in all curves together; 32 MB before compression.
    max_transitions : int
        Most transitions that are kept with their times; all are counted.
    max_letters : int
        Most letters of a sequence of states in a summary.
    """

    max_samples: int = 64
    min_samples: int = 8
    max_displacements: int = 4_000_000
    max_transitions: int = 1_000_000
    max_letters: int = 40


class TransitionOptions(Frozen):
    """Options on how the transitions of contacts are located in a motion.

    Attributes
    ----------
    rounding : float
        Rounding error of a state after a step, relative to the sizes of its terms.
    depth : float
        Depth of an exit below zero, relative to its size, up to which it is not passed.
    grazing : float
        Rate of an exit at the transition, relative to its terms, up to which the instant does not vary with
        the state.
    max_passes : int
        Most combinations of states that are tried at one instant until one is consistent.
    max_steps : float
        Most steps in one segment; with more the motion is given up as too long.
    max_blocks : int
        Number of blocks of steps after which signals are handled.
    max_halvings : int
        Most bisections of a step in the search for an exit.
    negligible_power : float
        Size of a power in a series, relative to its sum, up to which it and the higher powers are omitted.
    first_doublings : int
        Steps in the first block of a segment, as a power of two: many segments are short.
    max_order : int
        Highest derivative of an exit that is used to decide which combination of states follows.
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
    """Options on the flows of a scene, one for each combination of contact states.

    Attributes
    ----------
    min_count : int
        Number of flows that are kept in any case.
    max_bytes : float
        [byte] Memory for flows that are kept in addition.
    dense_size : int
        Number of state components from which on BLAS multiplies matrices.
    taylor_size : int
        Number of state components up to which Taylor coefficients are stored.
    few_rows : int
        Number of derivatives below which they are propagated one by one.
    max_step_angle : float
        [rad] Greatest angle of the highest harmonic of the forces in a step: one, plus rounding.
    transitions : TransitionOptions
        Options on how transitions are located.
    """

    min_count: int = 8
    max_bytes: float = 2.0**30
    dense_size: int = 32
    taylor_size: int = 256
    few_rows: int = 4
    max_step_angle: float = 1.0 + 1e-12
    transitions: TransitionOptions = TransitionOptions()


class TimeOptions(Frozen):
    """All options of the time simulation, grouped by purpose; see the class of each field."""

    simulation: SimulationOptions = SimulationOptions()
    settling: SettlingOptions = SettlingOptions()
    history: HistoryOptions = HistoryOptions()
    flows: FlowOptions = FlowOptions()


TIME = TimeOptions()  # the defaults
