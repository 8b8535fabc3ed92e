r"""Minimax over two or three numbers: descent of the greatest peak, with exact derivatives of all peaks.

With the peaks A_i(q), each followed along straight lines in the numbers q, the problem

    minimise t  subject to  A_i(q) <= t,  bounds on q

is smooth, even at kinks where peaks are equal. Its derivatives are those of the extended system of each peak.
It is solved by sequential quadratic programming. At its solution the response is traced anew. If peaks that
were not followed are higher there than the greatest at the start, the step is halved until they are lower.
The next step follows the peaks found there.

Where a contact sticks throughout, its coefficient of friction has no effect, and the descent no direction. So
the least peak is then sought along the whole range of each single number; by trials if not all peaks can be
followed. If this finds a lower peak, the descent begins again from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from fcm.continuation.follow import Progress
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.scene.draft import Number
from fcm.tracking.extended_system import Condition, Kind
from fcm.tracking.kept_steps import KeptSteps
from fcm.tracking.lowest_peak import LowestPeakSearch
from fcm.tracking.nonsmooth_continuation import follow_special_point, land
from fcm.tracking.options import DESCENT, DescentOptions
from fcm.tracking.parameter_line import ParameterLine
from fcm.tracking.peak_envelope import INCOMPLETE, EnvelopeMinimum, PieceHeight, Target
from fcm.tracking.start_points import SpecialPoints, special_points
from fcm.tracking.tracked_point import Ending, TrackedPoint, TrackingSetup
from fcm.tracking.trials import by_trials

Member = tuple[Condition, int, FloatArray]  # the tracked condition, the degree of freedom, z = (x, omega)


class LineMinimum(NamedTuple):
    """The least peak over the range of one number (scaled), and whether all higher peaks were followed."""

    q: FloatArray
    value: float
    all_followed: bool
    flat: tuple[float, float] | None = None  # scaled values of the number between which the peak is constant


class LeftRangeError(Exception):
    """A peak has left the range of frequencies."""


class PeakEnvelope:
    """Peaks of a response at numbers q (number,), scaled to 0 and 1 at their bounds."""

    responses = 0  # number of responses traced so far

    def __init__(
        self,
        system: System,
        numbers: Sequence[Number],
        bounds: FloatArray,
        targets: Sequence[Target],
        options: DescentOptions = DESCENT,
        steps: KeptSteps | None = None,
    ) -> None:
        self.steps = steps or KeptSteps()
        self.system, self.numbers, self.targets, self.options = system, tuple(numbers), targets, options
        self.low, self.width = bounds[:, 0], bounds[:, 1] - bounds[:, 0]
        self.lowest: tuple[FloatArray, float, Member] | None = None  # of all responses traced so far

    def line(self, q: FloatArray, direction: FloatArray) -> ParameterLine:
        """The line from q along a direction (both scaled)."""
        return ParameterLine(self.numbers, self.low + q * self.width, direction * self.width)

    def setup(self, q: FloatArray, direction: FloatArray) -> TrackingSetup:
        """The tracking setup on the line from q to q + direction."""
        return TrackingSetup(
            self.system,
            self.line(q, direction),
            (0.0, 1.0),
            (),
            self.system.scene.max_step,
            options=self.options.search.tracking,
        )

    def peaks(self, q: FloatArray) -> list[Member]:
        """Trace the response at q; return its special points that count for the targets."""
        ends = [Condition(Kind.END, omega=w) for w in self.system.scene.frequency_range]
        here = self.system.with_scene(self.line(q, np.zeros(q.size)).scene(self.system.scene, 0.0))
        setup, found = self.setup(q, np.zeros(q.size)), []
        for target in self.targets:
            conditions = [Condition(Kind.PEAK, target.dof), *(ends if target.ends else [])]
            special = self.steps(
                f"{self.system.harmonics} {target} at {q.tolist()}",
                SpecialPoints,
                partial(special_points, here, conditions, self.options.search.tracking),
            )
            for condition, z in special.points:
                if (point := land(setup, condition, np.append(z, 0.0))) is not None:
                    found.append((condition, target.dof, point))
        return [(condition, dof, point.z[:-1]) for condition, dof, point in found]

    def traced(self, q: FloatArray) -> tuple[float, list[Member]]:
        """The greatest height of the response at q (infinite without a peak), and all members there."""
        heights = [(self.height(member, q)[0], member) for member in self.peaks(q)]
        value, top = max(heights, key=lambda one: one[0], default=(np.inf, None))
        self.responses += 1
        if top is not None and (self.lowest is None or value < self.lowest[1]):
            self.lowest = q, value, top
        return value, [member for _, member in heights]

    def least_traced(self) -> tuple[FloatArray, EnvelopeMinimum] | None:
        """The least peak of the responses traced so far, and its numbers; None if none has a peak."""
        if self.lowest is None:
            return None
        q, value, (_, dof, z) = self.lowest
        top = PieceHeight(value, 0.0, np.append(z, np.nan), dof)
        return self.low + q * self.width, EnvelopeMinimum(np.nan, value, (top,), INCOMPLETE)

    def moved(self, member: Member, q: FloatArray, to: FloatArray) -> Member | None:
        """Follow a member of the envelope from q to other numbers; None if it ends before.

        Raises
        ------
        LeftRangeError
            If its frequency leaves the traced range.
        """
        condition, dof, z = member
        if np.array_equal(q, to):
            return member
        setup = self.setup(q, to - q)
        start = land(setup, condition, np.append(z, 0.0))
        if start is None:
            return None
        tracked_points, ending = follow_special_point(setup, condition, start, True)
        last = tracked_points[-1] if tracked_points else start
        if ending is Ending.RANGE:
            raise LeftRangeError
        whole = ending is Ending.SPAN and abs(last.z[-1] - 1.0) < self.options.height_tolerance
        return (condition, dof, last.z[:-1]) if whole else None

    def height(self, member: Member, q: FloatArray) -> tuple[float, FloatArray]:
        """Height of a member of the envelope, with its derivatives by q."""
        condition, dof, z = member
        slopes, value = np.empty(q.size), 0.0
        for k, direction in enumerate(np.eye(q.size)):
            setup = self.setup(q, direction)
            point = land(setup, condition, np.append(z, 0.0)) or TrackedPoint(
                np.append(z, 0.0), np.zeros(z.size + 1)
            )
            problem = setup.tracked(point.corner or condition)
            problem.evaluate_scale(point.z)
            problem.evaluate(point.z)
            jacobian = np.asarray(problem.jacobian)
            rate = np.linalg.solve(jacobian[:, :-1], -jacobian[:, -1])
            value, slopes[k] = problem.amplitude_along(point.z, np.append(rate, 1.0), dof)
        return value, slopes


def descend(
    valley: PeakEnvelope, near: FloatArray | None = None, progress: Progress | None = None
) -> tuple[FloatArray, EnvelopeMinimum] | None:
    """Find the optimum: the values of the numbers, and the least peak there; None if there is no peak.

    near: numbers from which the descent starts, such as the optimum with fewer harmonics.
    """
    show = progress or (lambda _share: None)
    show(0.0)
    starts, rounds = _starts(valley, near), valley.options.max_rounds
    found = []
    for i, q in enumerate(starts):
        show(0.5 * i / len(starts))
        found.append(downhill(valley, q))
    if not found:
        return None
    q, value, members = min(found, key=lambda one: one[1])
    flat: tuple[tuple[int, float, float], ...] = ()
    for i in range(rounds):
        show(0.5 + 0.5 * i / rounds)
        lines = [_along(valley, q, k) for k in range(q.size)]
        followed, lowest = all(line.all_followed for line in lines), min(lines, key=lambda line: line.value)
        if not lowest.value < value * (1.0 - valley.options.min_improvement):
            flat = _flat_at(valley, q, value, lines)
            break
        again = downhill(valley, lowest.q)
        if not again[1] < value:
            break
        q, value, members = again
    active = []
    for member in members:
        height, _ = valley.height(member, q)
        if height >= value * (1.0 - valley.options.kink_tolerance):
            active.append(PieceHeight(height, 0.0, np.append(member[2], np.nan), member[1]))
    edge = bool(((q < valley.options.bound_tolerance) | (q > 1.0 - valley.options.bound_tolerance)).any())
    kind = "trials" if not followed else "kink" if len(active) > 1 else "bound" if edge else "smooth"
    if len(flat) == q.size:
        kind = "flat"
    return valley.low + q * valley.width, EnvelopeMinimum(np.nan, value, tuple(active), kind, flat=flat)


def _flat_at(
    valley: PeakEnvelope, q: FloatArray, value: float, lines: Sequence[LineMinimum]
) -> tuple[tuple[int, float, float], ...]:
    """The numbers on which the least peak at q does not depend, with the range of each."""
    found = []
    for k, line in enumerate(lines):
        same = abs(line.value - value) <= valley.options.height_tolerance * value
        if same and line.flat is not None and line.flat[0] <= q[k] <= line.flat[1]:
            low, high = (float(valley.low[k] + end * valley.width[k]) for end in line.flat)
            found.append((k, low, high))
    return tuple(found)


def _starts(valley: PeakEnvelope, near: FloatArray | None) -> list[FloatArray]:
    """Numbers from which a descent starts: near, or the lowest of a coarse grid."""
    if near is not None:
        return [np.clip((near - valley.low) / valley.width, 0.0, 1.0)]
    grid = map(np.array, product(valley.options.grid, repeat=len(valley.numbers)))
    tried = [(valley.traced(q)[0], tuple(q)) for q in grid]
    return [np.array(q) for value, q in sorted(tried)[: valley.options.starts] if value < np.inf]


def _along(valley: PeakEnvelope, q: FloatArray, k: int) -> LineMinimum:
    """The least peak over the range of number k, with the others fixed at q."""
    origin, direction = np.array(q), np.eye(q.size)[k]
    origin[k] = 0.0
    line, options = valley.line(origin, direction), valley.options.search
    steps = valley.steps.of(f"from {origin.tolist()} along {k}")
    search = LowestPeakSearch(valley.system, line, (0.0, 1.0), valley.targets, options, steps)
    found = search.run()
    best = found.best if found.checked else by_trials(search)
    if best is None:
        return LineMinimum(q, np.inf, found.checked)
    flat = next(((low, high) for _, low, high in best.flat), None)
    return LineMinimum(origin + best.s * direction, best.value, found.checked, flat)


def downhill(valley: PeakEnvelope, q: FloatArray) -> tuple[FloatArray, float, list[Member]]:
    """Descend from q until neither a full step nor repeated halvings of it find a lower greatest peak.

    Where the response has no peak at q, this ends there.
    """
    value, members = valley.traced(q)
    if not members:
        return q, value, members
    for _ in range(valley.options.max_rounds):
        end = _minimax(valley, q, members, value)
        for _ in range(valley.options.max_halvings):
            there = valley.traced(end)
            lower = there[0] < value * (1.0 - valley.options.height_tolerance)
            if lower or there[0] <= value * (1.0 + valley.options.height_tolerance):
                break
            end = 0.5 * (q + end)
        if not lower:
            break
        q, (value, members) = end, there
    return q, value, members


def _minimax(valley: PeakEnvelope, q: FloatArray, members: list[Member], unit: float) -> FloatArray:
    """Solve the minimax problem for some members; return the numbers at which their greatest is least."""
    memory: dict[bytes, tuple[FloatArray, FloatArray]] = {}
    here: tuple[FloatArray, list[Member | None]] = (q, list(members))

    def heights(to: FloatArray) -> tuple[FloatArray, FloatArray]:
        nonlocal here
        to = np.clip(to, 0.0, 1.0)
        if to.tobytes() not in memory:
            try:
                followed = [None if one is None else valley.moved(one, here[0], to) for one in here[1]]
            except LeftRangeError:
                memory[to.tobytes()] = (
                    np.full(len(members), valley.options.out_of_range_height),
                    np.zeros((len(members), q.size)),
                )
                return memory[to.tobytes()]
            rows = [(0.0, np.zeros(q.size)) if one is None else valley.height(one, to) for one in followed]
            values, slopes = zip(*rows, strict=True)
            memory[to.tobytes()] = np.array(values) / unit, np.array(slopes) / unit
            if None not in followed:
                here = (to, followed)
        return memory[to.tobytes()]

    found = minimize(
        lambda x: x[-1],
        np.append(q, 1.0),
        jac=lambda x: np.eye(x.size)[-1],
        bounds=[*((0.0, 1.0) for _ in q), (None, None)],
        constraints={
            "type": "ineq",
            "fun": lambda x: x[-1] - heights(x[:-1])[0],
            "jac": lambda x: np.column_stack((-heights(x[:-1])[1], np.ones(len(members)))),
        },
        method="SLSQP",
        options={"ftol": valley.options.min_change, "maxiter": valley.options.max_iterations},
    )
    chosen: FloatArray = np.clip(found.x[:-1], 0.0, 1.0)
    return np.where(np.abs(chosen - chosen.round()) < valley.options.value_rounding, chosen.round(), chosen)
