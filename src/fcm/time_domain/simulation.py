"""Simulate from a state: at one frequency, or through the phases of the scene's schedule."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fcm.model.scene import FloatArray, InTime, Phase, Scene, in_time
from fcm.quoting import quoted
from fcm.time_domain.contact_states import Codes
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.equations_of_motion import LETTERS, EquationsOfMotion
from fcm.time_domain.errors import CycleError, SimulationError
from fcm.time_domain.integrator import March
from fcm.time_domain.options import TIME, TimeOptions
from fcm.time_domain.segments import Segments
from fcm.time_domain.state import State, entered, entry, leave, set_angle
from fcm.time_domain.stop_reason import Stopped
from fcm.time_domain.trajectory import Motion
from fcm.units import spoken

Progress = Callable[[float, str], None]


def simulate(
    scene: Scene, frequency: float, cycles: float, state: State | None = None, options: TimeOptions = TIME
) -> Motion:
    """The exact motion of a scene at one frequency.

    Between transitions of its contacts (stick, positive and negative slip, separation; sections 3.1 and
    3.2) the structure is linear and its motion known in closed form; the transitions (9)-(16) are roots
    of that motion, found to rounding. There is no time step.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`; with its own contacts, not those of its sweep.
    frequency : float
        Of the external forces [rad/s].
    cycles : float
        Periods of the force to simulate; need not be whole.
    state : State, optional
        The state at the start; by default rest.
    options : TimeOptions, optional
        Limits of the simulation.

    Returns
    -------
    Motion

    Raises
    ------
    SimulationError
        If the frequency, the cycles or the state are invalid, if the contacts chatter without end, or if the
        exact motion of the scene is not computed (`fcm.model.scene.in_time`).

    Examples
    --------
    >>> import fcm
    >>> motion = simulate(fcm.load_scene("yang1998-n5"), 1.3, 100)
    >>> motion.cycles[-1].states
    ('SPEN',)
    >>> motion.measures()[-1].amplitude.round(4)  # u, v: half the peak-to-peak
    array([7.1681, 7.1663])
    """
    return simulate_phases(scene, [Phase(frequency, cycles)], state, options=options)


def simulate_schedule(
    scene: Scene, state: State | None = None, progress: Progress | None = None, options: TimeOptions = TIME
) -> Motion:
    """The exact motion of a scene through its schedule, each phase continuing the last.

    The state continues, and so does the phase angle of the forces: it does not jump when the frequency does.
    By default the motion begins with the scene's [start], or at rest if it has none.

    Raises
    ------
    SimulationError
        As for `simulate`, and if the scene has no schedule.
    """
    if not scene.schedule:
        raise SimulationError("the scene has no [[schedule]]; give it one, or simulate one frequency")
    return simulate_phases(scene, scene.schedule, state or State.start(scene), progress, options)


def simulate_phases(
    scene: Scene,
    phases: Sequence[Phase],
    state: State | None = None,
    progress: Progress | None = None,
    options: TimeOptions = TIME,
) -> Motion:
    """The exact motion through phases, each continuing the last; see `simulate_schedule`."""
    if (whether := in_time(scene)) is not InTime.COMPUTED:
        raise SimulationError(f"{scene.name}: an exact motion is computed, but {whether.value}")
    state = State.rest(scene) if state is None else state
    total = sum(phase.cycles for phase in phases)
    done: list[Cycle] = []
    for phase in phases:
        if not (np.isfinite(phase.cycles) and phase.cycles > 0.0):
            raise SimulationError(f"a phase has {phase.cycles:g} cycles; it needs more than none")
        for cycle, end in cycles_from(
            EquationsOfMotion(scene, phase.frequency, options.flows), phase.cycles, state, options
        ):
            start = done[-1].start + done[-1].duration if done else 0.0
            done.append(replace(cycle, start=start))
            state = end
            if progress is not None:
                progress(len(done) / total, f"cycle {len(done)}")
    return Motion(scene, tuple(done), state)


def cycles_from(
    system: EquationsOfMotion, cycles: float, state: State, options: TimeOptions = TIME
) -> Iterator[tuple[Cycle, State]]:
    """Yields the cycles from a state on, each with the state at its end; the last may be incomplete."""
    y, states = entry(system, state)
    for k in range(int(np.ceil(cycles))):
        part = min(1.0, cycles - k)
        set_angle(system, y, state.angle)
        segments, y, states = march(system, y, states, part * system.period, options)
        angle = (state.angle + 2.0 * np.pi * (part % 1.0)) % (2.0 * np.pi)
        cycle = Cycle(system, k * system.period, part * system.period, state.angle, segments)
        yield cycle, leave(system, y, angle)


def march(
    system: EquationsOfMotion, y: FloatArray, states: Codes, duration: float, options: TimeOptions = TIME
) -> tuple[Segments, FloatArray, Codes]:
    """Segments of the motion over a duration [s], with the state vector and states at its end."""
    march = system.march()
    march.begins(y, states, duration, options.simulation.max_transitions)
    segments = _marched(system, march, options)
    return segments, np.array(march.y)[0], np.array(march.states)[0]


def march_from(
    system: EquationsOfMotion, x: FloatArray, duration: float, options: TimeOptions = TIME
) -> tuple[Segments, FloatArray]:
    """Segments from x = (q, q', f) on, with the forces' angle 0 at the start; state vector at their end."""
    march = entered(system, x)
    march.lasts(duration, options.simulation.max_transitions)
    segments = _marched(system, march, options)
    return segments, np.array(march.y)[0]


def _at(system: EquationsOfMotion) -> str:
    return spoken(system.omega, system.scene.frequency_unit)


def _marched(system: EquationsOfMotion, march: March, options: TimeOptions = TIME) -> Segments:
    """Runs a march to its end, makes missing flows, and returns its segments.

    Raises CycleError for chatter, undecidable states or too long a cycle.
    """
    while (stopped := march.go()) != Stopped.DONE:
        if stopped == Stopped.MISSING:
            system.make(np.asarray(march.states)[0])
        elif stopped == Stopped.FULL and len(march.segments) > options.simulation.max_transitions:
            raise CycleError(
                f"more than {options.simulation.max_transitions} transitions in one cycle at {_at(system)}: "
                "the contacts chatter; give the modes more damping, or the contacts less stiffness"
            )
        elif stopped == Stopped.UNDECIDED:
            letters = "".join(LETTERS[code] for code in np.asarray(march.states)[0])
            raise CycleError(
                f"the contacts' states cannot be distinguished at {_at(system)}, now {quoted(letters)}; "
                "change a parameter of the contacts slightly"
            )
        elif stopped == Stopped.LONG:
            raise CycleError(
                f"a cycle at {_at(system)} lasts {march.duration * march.rate():.1g} radians of the "
                "fastest motion. Give the contacts less stiffness, leave the highest modes out, or raise the "
                "frequency"
            )
    segments: Segments = march.segments.trim()
    return segments
