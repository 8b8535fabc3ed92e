"""The steady motion at given frequencies, visited by a slow upward and then a slow downward sweep.

Between two frequencies the stable periodic orbit is continued, in steps short enough to stay on its branch.
Where it ends or becomes unstable, the motion is simulated from there, slightly beyond, until it is steady
again. So it jumps at the same frequency and to the same motion as a slow sweep of the structure.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from itertools import takewhile
from typing import Any

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.response.options import SENTENCES, STEPPED
from fcm.results.jumps import Jump
from fcm.run import Report
from fcm.shooting.initial_orbits import first_point, solution_at
from fcm.shooting.orbit_record import OrbitRecord, recorded_point, recorded_steady
from fcm.shooting.periodic_orbit import Poll, never_interrupt, shoot
from fcm.shooting.problem import OrbitProblem, correct_at_frequency
from fcm.shooting.steady_state import SteadyMotion, steady
from fcm.shooting.trace import frequency_text
from fcm.time_domain.cycle_measures import Measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import CycleError, SimulationError
from fcm.time_domain.simulation import cycles_from
from fcm.time_domain.state import State


class StepRecord(Frozen):
    """The motion at one frequency of a sweep, and the data from which the next step continues."""

    number: int  # in the order of the sweeps, from 0
    sample: OrbitRecord | None  # the motion, if it was steady
    state: State
    went_on: bool  # whether the sample is a periodic solution that is continued
    jumps: tuple[Jump, ...]  # jumps in this step
    irregular: tuple[str, ...]  # frequencies without steady motion so far
    refused: tuple[tuple[str, str], ...]  # frequencies without a computed cycle so far, with the reasons


STATES = (StepRecord, OrbitRecord, State, Measure, SteadyMotion)  # classes of saved data


class SteppedSweep:
    """Sweeps of one scene by steps of the frequency.

    Their results so far stay available after an interruption, as by `poll`.
    """

    def __init__(self, scene: Scene, poll: Poll = never_interrupt) -> None:
        self.scene, self.problem, self.poll = scene, OrbitProblem(scene), poll
        self.newton = Newton(self.problem)
        self.points: list[OrbitRecord] = []
        self.sweep: list[str] = []
        self.jumps: list[Jump] = []
        self.irregular: dict[str, None] = {}  # frequencies without steady motion, in order
        self.refused: dict[str, str] = {}  # frequencies at which no cycle can be computed, and why
        self._here: OrbitRecord | None = None  # the periodic solution that is continued
        self._state = State.rest(scene)  # the state of the present motion
        self._sample: OrbitRecord | None = None  # the present motion, if it is steady

    def run(self, frequencies: Sequence[float], report: Report | None = None) -> None:
        """Visit increasing frequencies [rad/s] upwards, then downwards; every visit is saved."""
        ways = (("up", omega) for omega in frequencies), (("down", omega) for omega in reversed(frequencies))
        visits = [pair for way in ways for pair in way]
        report = report or Report(lambda _fraction, _text: None)
        done = self._go_on(report.saved, visits)
        for number, (sweep, omega) in enumerate(visits[done:], done):
            jumps = len(self.jumps)
            report.begins(f"{sweep}, {frequency_text(self.scene, omega)}")
            self._step_to(omega, sweep)
            self._note(sweep)
            known = tuple(self.irregular), tuple(self.refused.items())
            went_on = self._here is not None
            new = tuple(self.jumps[jumps:])
            report.save(StepRecord(number, self._sample, self._state, went_on, new, *known))
            report((number + 1) / len(visits), f"{sweep}, {frequency_text(self.scene, omega)}")

    def _note(self, sweep: str) -> None:
        """Append the motion at the visited frequency, if it is steady."""
        if self._sample is not None:
            self.points.append(self._sample)
            self.sweep.append(sweep)

    def _go_on(self, saved: Sequence[Any], visits: Sequence[tuple[str, float]]) -> int:
        """Restore the results of an interrupted run; return the number of visits that it has made."""
        by_number = {visit.number: visit for visit in saved if isinstance(visit, StepRecord)}
        made = [by_number[number] for number in takewhile(by_number.__contains__, range(len(visits)))]
        for visit, (sweep, _) in zip(made, visits, strict=False):
            self._sample, self._state = visit.sample, visit.state
            self.jumps += visit.jumps
            self.irregular, self.refused = dict.fromkeys(visit.irregular), dict(visit.refused)
            self._note(sweep)
        if made and made[-1].went_on:
            self._here = self._sample
        return len(made)

    @property
    def reason(self) -> str:
        """Sentence on frequencies without a steady motion, or without a computed cycle; else ''."""
        refused = next(iter(self.refused.values()), "")
        if not self.irregular:
            return refused
        first = list(self.irregular)[: SENTENCES.max_frequencies]
        more = (
            f" and {len(self.irregular) - SENTENCES.max_frequencies} more"
            if len(self.irregular) > SENTENCES.max_frequencies
            else ""
        )
        cycles = sum(self.problem.options.steady.cycles)
        restless = f"at {', '.join(first)}{more} the motion does not become steady within {cycles} cycles"
        return f"{restless}; {refused}" if refused else restless

    def _step_to(self, omega: float, sweep: str) -> None:
        """Bring the motion to a frequency by one step of the sweep."""
        while self._here is not None and not self._continue(omega):
            lost, before = float(self._here.z[-1]), self._sample
            self._settle(self._here.state, lost + STEPPED.overshoot * (omega - lost))
            after = self._sample
            if after is None:
                self._settle(self._state, omega)
            self._note_jump(sweep, lost, before, after or self._sample)
        if self._sample is None:
            self._begin(omega)
        elif self._sample.frequency != omega:
            here = self._follow(self._sample, omega, sweep)
            if self._here is not None:
                self._step_to(omega, sweep)
                return
            if here.frequency != omega:
                self._simulate_sweep(here.frequency, omega)
                self._settle(self._state, omega)
        if self._sample is None and frequency_text(self.scene, omega) not in self.refused:
            self.irregular[frequency_text(self.scene, omega)] = None

    def _begin(self, omega: float) -> None:
        """Begin without a motion to continue: find a stable periodic solution, or simulate from rest."""
        try:
            orbit = solution_at(self.scene, omega, self.poll)
        except CycleError as error:
            self.refused[frequency_text(self.scene, omega)] = str(error)
            return
        except SimulationError:  # no solution near harmonic balance, nor near the motion from rest
            return
        try:
            z = first_point(self.problem, orbit, self.poll)
        except SimulationError as error:  # the motion is not determined, or not with this start
            self.refused[frequency_text(self.scene, omega)] = str(error)
            return
        if not (orbit.stable and self._continue_with(z)):
            self._settle(State.rest(self.scene), omega)

    def _continue_with(self, z: FloatArray) -> bool:
        """Continue with a periodic solution near z at its frequency, if it is stable."""
        if not correct_at_frequency(self.newton, z):
            return False
        direction = np.asarray(self.newton.tangent) * np.asarray(self.newton.scale)
        sample = recorded_point(self.problem, np.array(self.newton.z), direction)
        if sample.stable:
            self._here, self._sample, self._state = sample, sample, sample.state
        return sample.stable

    def _note_jump(
        self, sweep: str, at: float, before: OrbitRecord | None, after: OrbitRecord | None
    ) -> None:
        """Note a jump at a frequency, with no amplitude after it where that motion begins only beyond."""
        if before is not None and after is not None:
            there = self._brought_back(after, at)
            doubles = before.repeats > 1 == there.repeats and there.frequency != at
            if not doubles and self._change(before, there) > STEPPED.min_jump:
                amplitude, repeats = there.measure.amplitude, there.repeats
                if abs(there.frequency - at) > STEPPED.min_step_of_periods * at:
                    amplitude, repeats = np.full_like(amplitude, np.nan), 0
                self.jumps.append(
                    Jump(sweep, at, before.measure.amplitude, amplitude, (before.repeats, repeats))
                )

    def _brought_back(self, after: OrbitRecord, at: float) -> OrbitRecord:
        """Bring the motion found beyond the end of a branch back to the frequency of the end, if possible.

        Without a jump it is then the motion before: so at a period doubling, or if a corner stopped the
        steps.
        """
        kept = self._here, self._sample, self._state
        if after.steady is None:
            self._here = self._sample = after
            self._continue(at)
        else:
            self._settle(after.state, at)
        there = self._sample or after
        self._here, self._sample, self._state = kept
        return there

    def _continue(self, omega: float) -> bool:
        """Follow the stable periodic solution towards a frequency; return whether it reaches it."""
        assert self._here is not None
        step = omega - float(self._here.z[-1])
        smallest = STEPPED.min_step * abs(step)
        while (left := omega - float(self._here.z[-1])) != 0.0:
            self.poll()
            if self._step_along_branch(omega if abs(step) >= abs(left) else omega - left + step):
                step *= 2.0
                continue
            step *= 0.25
            if abs(step) < smallest:
                return False
        return True

    def _step_along_branch(self, omega: float) -> bool:
        """Step to the stable periodic solution of the same branch at a near frequency; return success."""
        here = self._here
        assert here is not None
        self.problem.evaluate_scale(here.z)
        scale = np.array(self.problem.scale)
        rate = here.direction[-1]
        way = here.direction * ((omega - here.z[-1]) / rate) if rate else np.full(here.z.size, np.inf)
        length = float(np.linalg.norm(way / scale))  # of arc
        if not length <= STEPPED.max_distance:
            return False
        guess = here.z + way
        guess[-1] = omega
        if not correct_at_frequency(self.newton, guess, length):
            return False
        astray = float(np.linalg.norm((np.asarray(self.newton.z) - guess) / scale))
        return astray <= max(STEPPED.max_deviation * length, STEPPED.min_deviation) and self._continue_with(
            np.array(self.newton.z)
        )

    def _follow(self, here: OrbitRecord, omega: float, sweep: str) -> OrbitRecord:
        """Follow a motion of several periods towards a frequency, in steps in which it changes little.

        Return the last steady motion, at the frequency or at the end of such motions. The end is where the
        motion has period one, or where no motion is steady one step further. Jumps are recorded.
        """
        step, least = math.inf, STEPPED.min_step_of_periods * omega
        while here.repeats > 1 and here.frequency != omega:
            left = omega - here.frequency
            step = min(step, abs(left))
            to = omega if step == abs(left) else here.frequency + math.copysign(step, left)
            self._state = here.state
            self._simulate_sweep(here.frequency, to)
            self._settle(self._state, to)
            after = self._sample
            if after is None:
                self._sample, self._state = here, here.state
                break
            changes = after.repeats != here.repeats or self._change(here, after) > STEPPED.max_change
            if changes and step > least:
                step = max(0.25 * step, least)
                continue
            if changes:
                self._note_jump(sweep, here.frequency, here, after)
            here, step = after, 2.0 * step
        return here

    @staticmethod
    def _change(before: OrbitRecord, after: OrbitRecord) -> float:
        """The greatest relative change of an amplitude."""
        old, new = before.measure.amplitude, after.measure.amplitude
        return float((np.abs(new - old) / np.maximum(np.maximum(new, old), np.finfo(float).tiny)).max())

    def _simulate_sweep(self, begin: float, omega: float) -> None:
        """Simulate a slow sweep between two frequencies; a sudden change might lead to a different motion."""
        count = int(np.ceil(abs(omega - begin) / (STEPPED.irregular_step * min(omega, begin))))
        for between in np.linspace(begin, omega, count + 1)[1:-1].tolist():
            for _, end in cycles_from(
                EquationsOfMotion(self.scene, between), STEPPED.irregular_cycles, self._state
            ):
                self.poll()
                self._state = end

    def _settle(self, state: State, omega: float) -> None:
        """Simulate from a state until the motion is steady."""
        self._here, self._sample, system = None, None, EquationsOfMotion(self.scene, omega)
        found = steady(system, state, self.poll)
        if isinstance(found, State):
            self._state = found
            return
        self._state = found.state
        if found.periods != 1:
            self._sample = recorded_steady(omega, found)
            return
        orbit = shoot(system, found.state, self.poll)
        if orbit is not None:
            with suppress(SimulationError):  # resonant but for rounding: the motion is not determined
                self._continue_with(first_point(self.problem, orbit, self.poll))
