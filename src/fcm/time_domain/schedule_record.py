"""Simulate a schedule cycle by cycle, and keep only the reported quantities of each cycle."""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Phase, Scene
from fcm.time_domain.cycle import Cycle
from fcm.time_domain.cycle_measures import measure
from fcm.time_domain.energy import Energy, energy
from fcm.time_domain.equations_of_motion import LETTERS, EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.options import TIME, TimeOptions
from fcm.time_domain.schedule_plan import Plan
from fcm.time_domain.simulation import Progress, cycles_from
from fcm.time_domain.state import State
from fcm.time_domain.trajectory import Motion, dof_rows

NOT_REACHED = -1  # state of a contact at an instant that was not simulated
INTERRUPTED = "interrupted"
NOT_BEGUN = "interrupted before it was simulated"

ByteArray = npt.NDArray[np.int8]


class PhaseResult(Frozen):
    """Result of one phase of a schedule; displacements are those of its last whole cycle."""

    frequency: float  # [rad/s]
    cycles: float  # number of simulated cycles
    amplitude: FloatArray  # (dof,) half the peak-to-peak
    mean: FloatArray  # (dof,) time average
    states: tuple[str, ...]  # (contact,) state sequences
    transitions: int  # in the whole phase
    unsettled: float  # estimated relative change of the amplitudes still to come; nan if unknown
    energy: Energy

    @property
    def settled(self) -> bool:
        """Whether the motion is shown to have become periodic."""
        return self.unsettled <= TIME.settling.tolerance


@dataclass
class ScheduleRecord:
    """The simulated schedule of one curve; parts that were not reached are NaN or -1."""

    parameters: dict[str, float]
    amplitude: FloatArray  # (cycle, dof) half the peak-to-peak
    mean: FloatArray  # (cycle, dof)
    greatest: FloatArray  # (cycle, dof)
    least: FloatArray  # (cycle, dof)
    displacement: FloatArray  # (instant, dof)
    state: ByteArray  # (instant, contact) index into LETTERS
    transition_time: FloatArray  # (transition,) [s]
    transition_contact: npt.NDArray[np.int16]  # (transition,)
    transition_state: ByteArray  # (transition,) index into LETTERS of the new state
    phases: list[PhaseResult]
    end: State  # from which another schedule can continue
    reason: str  # why it is incomplete, or ''
    seconds: float
    interrupted: bool = False  # whether an interruption cut it short or prevented it

    @property
    def complete(self) -> bool:
        """Whether the schedule was simulated to its end."""
        return not self.reason

    @property
    def cycles(self) -> float:
        """Number of simulated cycles."""
        return sum(phase.cycles for phase in self.phases)

    @property
    def energy(self) -> Energy:
        """The energy balance of the whole schedule."""
        return total([phase.energy for phase in self.phases])


class CompletedPhase(Frozen):
    """Results of a whole phase and the state at its end, from which the schedule can continue."""

    measures: FloatArray  # (4, cycle, dof) amplitude, mean, greatest and least displacement
    displacement: FloatArray  # (instant, dof)
    state: ByteArray  # (instant, contact)
    transitions: tuple[FloatArray, npt.NDArray[np.int16], ByteArray]  # times [s], contacts, states
    letters: str  # states of all contacts at the end
    count: int  # number of all transitions
    states: tuple[str, ...]  # (contact,) state sequences in the last whole cycle
    energy: Energy
    end: State


def record(
    scene: Scene,
    plan: Plan | None = None,
    progress: Progress | None = None,
    passed: Sequence[CompletedPhase] = (),
    save: Callable[[CompletedPhase], None] | None = None,
    options: TimeOptions = TIME,
) -> ScheduleRecord:
    """Simulate the schedule of a scene, and keep the reported quantities.

    The record is incomplete, with a reason, after an interruption, if contacts chatter without end, or if
    static loads are not held. It continues after the phases in `passed`, with an identical record; `save` is
    called for every further phase but the last.

    Examples
    --------
    >>> import fcm
    >>> done = record(fcm.load_scene("yang1998-jump"))
    >>> [round(float(phase.amplitude[0]), 2) for phase in done.phases], done.complete
    ([14.72, 1.73, 1.75], True)
    """
    begin = time.perf_counter()
    plan = plan or Plan(scene.schedule, len(scene.modal.dofs))
    recorder, reason, interrupted = _Recorder(scene, plan, options), "", False
    try:
        recorder.end = State.start(scene)
        for one in passed:
            recorder.take(one)
        for number, phase in list(enumerate(scene.schedule))[len(passed) :]:
            for cycle, end in cycles_from(
                EquationsOfMotion(scene, phase.frequency, options.flows), phase.cycles, recorder.end, options
            ):
                recorder.add(number, cycle, end)
                if progress is not None:
                    progress(recorder.done / plan.phase.size, f"phase {number + 1}, cycle {recorder.done}")
            if save is not None and recorder.done < plan.phase.size:
                save(recorder.passed())
    except KeyboardInterrupt:
        reason, interrupted = INTERRUPTED, True
    except SimulationError as error:
        reason = str(error)
    made = recorder.record(reason, interrupted)
    made.seconds = time.perf_counter() - begin
    return made


def unfinished(scene: Scene, plan: Plan) -> ScheduleRecord:
    """The record of a curve that was not simulated."""
    return _Recorder(scene, plan).record(NOT_BEGUN, True)


def total(parts: Sequence[Energy]) -> Energy:
    """Energy balance of successive motions together."""
    work, slip, damping, stored = (sum((part[i] for part in parts), 0.0) for i in range(4))
    turnover = sum((part.turnover - abs(part.stored) for part in parts), abs(stored))
    return Energy(work, slip, damping, stored, turnover)


@dataclass
class _Tally:
    """Running totals of a phase."""

    first: int  # number of its first cycle
    kept: int  # number of transitions before it that are kept with their times
    energy: Energy = field(default_factory=lambda: total([]))
    transitions: int = 0
    states: tuple[str, ...] | None = None  # of each contact in the last whole cycle


class _Transitions:
    """Counts all changes of contact states, and keeps the times of the first `max_transitions`."""

    def __init__(self, options: TimeOptions) -> None:
        self.options = options
        self.times, self.contacts, self.states = array("d"), array("h"), array("b")
        self.letters = ""  # the present states

    def count(self, cycle: Cycle, start: float) -> int:
        """Number of transitions of a cycle that begins at a time [s]."""
        found = 0
        for begun, after in zip(np.asarray(cycle.segments.start).tolist(), cycle.letters, strict=True):
            for j, (before, letter) in enumerate(zip(self.letters, after, strict=False)):
                if before == letter:
                    continue
                found += 1
                if len(self.times) < self.options.history.max_transitions:
                    self.times.append(start + begun)
                    self.contacts.append(j)
                    self.states.append(LETTERS.index(letter))
            self.letters = after
        return found


class _Recorder:
    def __init__(self, scene: Scene, plan: Plan, options: TimeOptions = TIME) -> None:
        self.options = options
        dofs, contacts = len(scene.modal.dofs), len(scene.contacts)
        self.scene, self.plan, self.end, self.done = scene, plan, State.unloaded(scene), 0
        self.measures = np.full((4, plan.phase.size, dofs), np.nan)
        self.displacement = np.full((plan.instants, dofs), np.nan)
        self.state = np.full((plan.instants, contacts), NOT_REACHED, dtype=np.int8)
        self.transitions = _Transitions(options)
        self.tallies: list[_Tally] = []

    def add(self, phase: int, cycle: Cycle, end: State) -> None:
        """Keeps the reported quantities of the next cycle; none of them if measuring it is interrupted."""
        found = measure(cycle)
        balance = energy(Motion(self.scene, (cycle,), end))
        self._sample(cycle)
        if phase == len(self.tallies):
            self.tallies.append(_Tally(self.done, len(self.transitions.times)))
        tally = self.tallies[phase]
        tally.transitions += self.transitions.count(cycle, float(self.plan.start[self.done]))
        tally.energy = total([tally.energy, balance])
        if self.plan.part[self.done] == 1.0 or tally.states is None:
            tally.states = cycle.states
        self.measures[:, self.done] = found.amplitude, found.mean, found.greatest, found.least
        self.end, self.done = end, self.done + 1

    def passed(self) -> CompletedPhase:
        """The last phase as a `CompletedPhase`; it has to be whole, and not the last of the schedule."""
        tally, found = self.tallies[-1], self.transitions
        cycles, instants = slice(tally.first, self.done), self._instants(tally.first, self.done)
        times, contacts, states = (
            values[tally.kept :] for values in (found.times, found.contacts, found.states)
        )
        return CompletedPhase(
            self.measures[:, cycles].copy(), self.displacement[instants].copy(), self.state[instants].copy(),
            (np.array(times), np.array(contacts, dtype=np.int16), np.array(states, dtype=np.int8)),
            found.letters, tally.transitions, tally.states or (), tally.energy, self.end,
        )  # fmt: skip

    def take(self, passed: CompletedPhase) -> None:
        """Takes over a phase that was simulated before."""
        found, first = self.transitions, self.done
        tally = _Tally(first, len(found.times), passed.energy, passed.count, passed.states)
        self.tallies.append(tally)
        self.end, self.done = passed.end, first + passed.measures.shape[1]
        self.measures[:, first : self.done] = passed.measures
        instants = self._instants(first, self.done)
        self.displacement[instants], self.state[instants] = passed.displacement, passed.state
        times, contacts, states = passed.transitions
        found.times.extend(times.tolist())
        found.contacts.extend(contacts.tolist())
        found.states.extend(states.tolist())
        found.letters = passed.letters

    def _instants(self, first: int, end: int) -> slice:
        """Slice of the instants of the cycles from `first` to before `end`, at most the last cycle."""
        return slice(int(self.plan.first[first]), int(self.plan.first[end]))

    def _sample(self, cycle: Cycle) -> None:
        first, count = int(self.plan.first[self.done]), int(self.plan.sampled[self.done])
        times = cycle.system.period / self.plan.samples * np.arange(count, dtype=np.float64)
        if self.done + 1 == self.plan.phase.size:
            times = np.append(times, cycle.duration)
        if times.size == 0:
            return
        chosen = slice(first, first + times.size)
        self.displacement[chosen] = cycle.values(dof_rows(cycle.system), times)
        segment = np.searchsorted(np.asarray(cycle.segments.start)[1:], times, side="right")
        self.state[chosen] = np.asarray(cycle.segments.states)[segment]

    def record(self, reason: str, interrupted: bool) -> ScheduleRecord:
        amplitude, mean, greatest, least = self.measures
        found = self.transitions
        if self.done < self.plan.phase.size:  # it may have been interrupted within a cycle
            self.displacement[self.plan.first[self.done] :] = np.nan
            self.state[self.plan.first[self.done] :] = NOT_REACHED
        return ScheduleRecord(
            self.scene.parameters, amplitude, mean, greatest, least, self.displacement, self.state,
            np.array(found.times), np.array(found.contacts, dtype=np.int16),
            np.array(found.states, dtype=np.int8),
            self._phases(), self.end, reason, 0.0, interrupted,
        )  # fmt: skip

    def _phases(self) -> list[PhaseResult]:
        bounds = [*(tally.first for tally in self.tallies), self.done]
        return [
            self._phase(phase, tally, slice(tally.first, bounds[number + 1]))
            for number, (phase, tally) in enumerate(zip(self.scene.schedule, self.tallies, strict=False))
            if tally.states is not None  # otherwise it was interrupted in its first cycle
        ]

    def _phase(self, phase: Phase, tally: _Tally, cycles: slice) -> PhaseResult:
        part = self.plan.part[cycles]
        whole = max(int((part == 1.0).sum()), 1)
        amplitude, mean = (values[cycles][:whole] for values in self.measures[:2])
        return PhaseResult(
            phase.frequency, float(part.sum()), amplitude[-1], mean[-1], tally.states or (),
            tally.transitions, unsettled(amplitude, self.options), tally.energy,
        )  # fmt: skip


def unsettled(amplitude: FloatArray, options: TimeOptions = TIME) -> float:
    """Estimated relative change of amplitudes still to come, extrapolated from the recent decay.

    d_1 and d_2 are the ranges of the amplitude over the last `SettlingOptions.cycles` cycles and over as many
    before. The remainder of a transient that decays geometrically is d_1 rho / (1 - rho), rho = d_1 / d_2.

    Parameters
    ----------
    amplitude : (cycle, dof)
        Amplitudes of successive whole cycles.

    Returns
    -------
    float
        The greatest over the dofs; nan for fewer than 2 `cycles` + 1 cycles, inf if one does not decay.

    Examples
    --------
    >>> import numpy as np
    >>> decay = 1.0 + 0.5 * 0.9 ** np.arange(60.0)[:, None]
    >>> bool(np.isclose(unsettled(decay), 1.0 - 1.0 / decay[-1, 0]))
    True
    >>> unsettled(np.arange(60.0)[:, None])
    inf
    """
    if amplitude.shape[0] < 2 * options.settling.cycles + 1:
        return float("nan")
    size = np.abs(amplitude[-1])
    size = np.maximum(size, options.settling.min_amplitude * size.max(initial=0.0))
    size = np.where(size > 0.0, size, 1.0)
    later = np.ptp(amplitude[-options.settling.cycles - 1 :], axis=0) / size
    earlier = np.ptp(amplitude[-2 * options.settling.cycles - 1 : -options.settling.cycles], axis=0) / size
    decays = earlier > later
    left = np.where(decays, later**2 / np.where(decays, earlier - later, 1.0), np.inf)
    return float(np.where(later <= options.settling.min_change, later, left).max(initial=0.0))
