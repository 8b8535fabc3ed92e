"""The steady motion at given frequencies, visited by a slow upward and then a slow downward sweep.

Between two frequencies the periodic solution is continued in steps as short as it takes to stay on its
branch, while it is stable. Where it is lost the motion is simulated from there, just beyond, until it is
steady again. So it jumps where a slow sweep of the structure itself does, and to the same motion.
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
    """The motion at one frequency of a sweep, and what the next one continues from."""

    number: int  # in the order of the sweeps, from 0
    sample: OrbitRecord | None  # the motion, if it was steady
    state: State
    went_on: bool  # whether the sample is a periodic solution that is continued
    jumps: tuple[Jump, ...]  # on the way to it
    irregular: tuple[str, ...]  # all until then
    refused: tuple[tuple[str, str], ...]


STATES = (StepRecord, OrbitRecord, State, Measure, SteadyMotion)  # what is saved consists of these


class SteppedSweep:
    """Sweeps of one scene by steps of the frequency.

    What they have found is there whenever they are interrupted, as by `poll`.
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
        self._state = State.rest(scene)  # the motion, where there is none
        self._sample: OrbitRecord | None = None  # what is steady now

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
        """Note the motion at a frequency that was visited, if it is steady."""
        if self._sample is not None:
            self.points.append(self._sample)
            self.sweep.append(sweep)

    def _go_on(self, saved: Sequence[Any], visits: Sequence[tuple[str, float]]) -> int:
        """Go on where an interrupted run was; returns the number of visits that it has made."""
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
        """Sentence on frequencies that have no steady motion, or none that can be computed, else ''."""
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
        """Begin where there is nothing to continue: a stable periodic solution, or the motion from rest."""
        try:
            orbit = solution_at(self.scene, omega, self.poll)
        except CycleError as error:
            self.refused[frequency_text(self.scene, omega)] = str(error)
            return
        except SimulationError:  # none near harmonic balance, nor near the motion from rest
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
        """The motion beyond the end of a branch at the frequency of the end itself, or as near as it goes.

        It is the one before where there was no jump: where the period doubles, or a corner was in the way.
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
        """Follow the periodic solution to a frequency, or as near as it is stable."""
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
        """Go to the stable periodic solution of the same branch at a frequency nearby, if there is one."""
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
        """Bring a motion of several periods towards a frequency, by steps in which it changes little.

        Returned is the last steady motion: the one there, or where such a motion ends. It ends at a jump,
        which is noted, where the period is one, or where no motion is steady a step further.
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
        """Simulate the way from one frequency to another: a leap may end in another motion than a sweep."""
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
            with suppress(SimulationError):  # resonant but for rounding: no motion is determined
                self._continue_with(first_point(self.problem, orbit, self.poll))
