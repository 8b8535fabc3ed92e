"""Events within a step: roots of functions along it, each found on the curve itself.

A sign change between two points is located by the secant through the last two points (`SignChange`). It is
located by bisection if the secant leaves the bracket, or if three evaluations have not halved the bracket.
Bisection also locates a jump of a function that may jump: in a much narrower bracket a smooth function
differs by much less. Steps end at values of the parameter where the curve may have a narrow peak that no
point elsewhere shows (`Landing`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation.extremum_search import ExtremumSearch, Sample
from fcm.continuation.options import SIGN_CHANGE, EventOptions, SignChangeOptions
from fcm.continuation.path import FloatArray, Mark
from fcm.continuation.problem import Point
from fcm.continuation.step_control import Stepper
from fcm.frozen import Frozen

if cython.compiled:
    from cython.cimports.fcm.continuation.predictor import dot
else:
    from fcm.continuation.predictor import dot


@cython.cclass
class SignChange:
    """A bracket, low to high, of a sign change; evaluations at `at` make it narrower.

    width: that of the bracket; secant: the point to which the secant leads.
    """

    def __init__(
        self,
        low: cython.double,
        high: cython.double,
        before: cython.double,
        after: cython.double,
        may_jump: cython.bint = False,
        options: SignChangeOptions = SIGN_CHANGE,
    ) -> None:
        self.low, self.high, self.may_jump = low, high, may_jump
        self.jump_width, self.jump_difference = options.jump_width, options.jump_difference
        self.halving_interval = options.halving_interval
        self.before, self.after = before, after  # the values at low and high
        # the last two points and their values
        self.last, self.last_value, self.now, self.now_value = low, before, high, after
        self.first_width, self.first_difference = high - low, fabs(after - before)
        self.evaluations, self.width_in_turn = 0, high - low
        self.choose_next()

    @cython.cfunc
    @cython.exceptval(check=False)
    def choose_next(self) -> cython.void:
        """Choose the point `at` of the next evaluation, by the secant or by bisection."""
        self.width, self.secant = self.high - self.low, self.low
        if self.now_value != self.last_value:
            rise: cython.double = self.now_value - self.last_value
            self.secant = self.now - self.now_value * (self.now - self.last) / rise
        slow: cython.bint = (
            self.evaluations % self.halving_interval == self.halving_interval - 1
            and self.width > 0.5 * self.width_in_turn
        )
        halved: cython.bint = slow or self.seems_discontinuous() or not self.low < self.secant < self.high
        self.at = 0.5 * (self.low + self.high) if halved else self.secant

    @cython.cfunc
    @cython.exceptval(check=False)
    def seems_discontinuous(self) -> cython.bint:
        """Whether the function seems to jump within the bracket, if it may."""
        difference: cython.double = fabs(self.after - self.before)
        near: cython.bint = self.width < self.jump_width * self.first_width
        return self.may_jump and near and difference > self.jump_difference * self.first_difference

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def converged(self, fine: cython.double, after_next: cython.bint = False) -> cython.bint:
        """Whether the next evaluation, or the one after_next, would move the secant by at most `fine`.

        The step after next is shorter than the next by at least the ratio of the next to the last.
        """
        way: cython.double = fabs(self.secant - self.now)
        if way <= fine or self.width <= fine:
            return True
        return after_next and way * way <= fine * fabs(self.now - self.last)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def update(self, at: cython.double, value: cython.double) -> cython.int:
        """Replace one side of the bracket by `at`, where the function has the given value."""
        if self.evaluations % self.halving_interval == self.halving_interval - 1:
            self.width_in_turn = self.width
        self.evaluations += 1
        self.last, self.last_value, self.now, self.now_value = self.now, self.now_value, at, value
        if (value > 0.0) != (self.before > 0.0):
            self.high, self.after = at, value
        else:
            self.low, self.before = at, value
        self.choose_next()
        return 0


@cython.cclass
class Landing:
    """Values of the parameter, with widths, at which steps end.

    `value` (k, 2): each value and its width; `shortened`: whether the step was cut to end at one.
    """

    def __init__(self, values: Sequence[tuple[float, float]]) -> None:
        self.value, self.shortened = np.array(values, dtype=np.float64).reshape(-1, 2), False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def limit_step(self, stepper: Stepper, step: cython.double) -> cython.double:
        """The step, or the length at which the tangent reaches the first value."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = stepper.problem.unknowns
        way: cython.double
        unit: cython.double = stepper.here.tangent[n] * stepper.newton.scale[n]
        first: cython.double = step
        for k in range(self.value.shape[0]):
            way = self.value[k, 0] - stepper.here.z[n]
            nearer: cython.bint = (
                way * unit > 0.0 and fabs(way) > stepper.options.events.landing_tolerance * self.value[k, 1]
            )
            if nearer and fabs(way) < first * fabs(unit):
                first = way / unit
        self.shortened = stepper.options.step.min_step < first < step
        return first if self.shortened else step

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def first_crossed(self, stepper: Stepper, step: cython.double) -> cython.double:
        """Length at which the step crosses its first value; 0 if it crosses none."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = stepper.problem.unknowns
        way: cython.double
        gone: cython.double = stepper.there.z[n] - stepper.here.z[n]
        first: cython.double = step
        for k in range(self.value.shape[0]):
            way = self.value[k, 0] - stepper.here.z[n]
            within: cython.bint = way * gone > 0.0 and fabs(way) < fabs(gone)
            if (
                within
                and min(fabs(way), fabs(gone - way))
                > stepper.options.events.landing_tolerance * self.value[k, 1]
            ):
                first = min(first, step * way / gone)
        return first if stepper.options.step.min_step < first < step else 0.0


class End(NamedTuple):
    """A function of z (n + 1,) that ends the curve where it becomes negative.

    It may jump. The curve ends at the zero, or before it by no more than the length `within`.
    """

    value: Callable[[FloatArray], float]
    within: float = 0.0


class Events(Frozen):
    """Points that a curve is to have besides its folds, corners, peaks, branch points and ends.

    Attributes
    ----------
    values : sequence of float
        Each is an event, marked `Mark.USER_POINT`, wherever the curve passes it.
    narrow : sequence of (float, float)
        Values with a width, at which the curve may have a peak that no point farther away shows. Steps end
        there where the width is less than the longest step.
    ends : sequence of End
        The curve ends at the first of these, with the status EVENT.
    last : int
        Bits of `Mark`: the curve ends at the first event with any of them, with the status EVENT.
    """

    values: Sequence[float] = ()
    narrow: Sequence[tuple[float, float]] = ()
    ends: Sequence[End] = ()
    last: int = 0

    def within(self, length: float) -> list[tuple[float, float]]:
        """The values of `narrow` whose width is less than a length."""
        return [one for one in self.narrow if one[1] < length]


NO_EVENTS = Events()  # no events besides those of every curve
NOT_FOUND = cython.declare(cython.double, -1.0)  # stands for a root that was not found
MARGIN = cython.declare(cython.int, 0)  # the kinds of `TestFunction`
FOLD = cython.declare(cython.int, 1)
PEAK = cython.declare(cython.int, 2)
USER_POINT = cython.declare(cython.int, 3)


@cython.cclass
class TestFunction:
    """A function along a step whose change of sign is an event.

    It is a margin k, the growth of the parameter or of an output k, or the parameter less a value.
    """

    def __init__(self, kind: int, k: int = 0, value: float = 0.0) -> None:
        self.kind, self.k, self.value = kind, k, value


@cython.cfunc
def value(stepper: Stepper, point: Point, function: TestFunction) -> cython.double:
    """Value of a test function at a point of the step.

    A margin that the point does not have counts as unchanged.
    """
    k: cython.Py_ssize_t = function.k
    if function.kind == MARGIN:
        margin: cython.double = (
            stepper.here.margin[k] if point is stepper.here else stepper.here.margin_at(k, point)
        )
        return margin if margin != 0.0 else stepper.here.margin[k]
    if function.kind == USER_POINT:
        return point.z[point.z.shape[0] - 1] - function.value
    return point.tangent[point.tangent.shape[0] - 1] if function.kind == FOLD else point.growth[k]


@cython.cfunc
def root_within(stepper: Stepper, function: TestFunction) -> cython.double:
    """Length at which a test function changes sign between here and there."""
    before: cython.double = value(stepper, stepper.here, function)
    return root(stepper, function, 0.0, stepper.step, before, value(stepper, stepper.there, function))


@cython.cfunc
def root(
    stepper: Stepper,
    function: TestFunction,
    low: cython.double,
    high: cython.double,
    before: cython.double,
    after: cython.double,
) -> cython.double:
    """Length at which a test function changes sign between the lengths low and high.

    before, after: its values there. If the curve cannot be found in between, the root of a PEAK is the upper
    end of the bracket; any other root is NOT_FOUND. A margin may then belong to another part of a curve that
    goes back in the corner. For a fold see `bracketed_fold`.
    """
    at: cython.double
    now: cython.double
    count: cython.int
    turning: cython.bint = function.kind == FOLD or function.kind == PEAK
    sides: SignChange = SignChange(low, high, before, after)
    for count in range(stepper.options.events.max_evaluations):  # noqa: B007
        if sides.converged(stepper.options.events.tolerance * stepper.step, function.kind == MARGIN):
            return min(max(sides.secant, sides.low), sides.high)
        at = sides.at
        if not stepper.find_between(at, function.kind == MARGIN, False):
            return sides.high if function.kind == PEAK else NOT_FOUND
        if function.kind == FOLD and stepper.newton.moved > stepper.step:
            return NOT_FOUND
        if turning and not stepper.sharpen(False, function.kind == PEAK):
            return NOT_FOUND if function.kind == FOLD else sides.high
        now = value(stepper, stepper.between, function)
        if now == 0.0:
            return at
        sides.update(at, now)
    return sides.high


class Event(NamedTuple):
    """A point of the curve within a step."""

    length: float  # from the beginning of the step
    mark: int  # a `Mark`
    z: FloatArray
    direction: FloatArray
    orientation: float


def event_at_point(stepper: Stepper, length: float, mark: int, point: Point) -> Event:
    """The event with a mark at a point of the stepper, at a length from here."""
    direction = np.asarray(stepper.newton.scale) * np.asarray(point.tangent)
    return Event(length, mark, np.array(point.z), direction, point.orientation)


def event_at_sample(stepper: Stepper, poll: Sample, mark: int) -> Event:
    """The event with a mark at a sample of an extremum search."""
    scale = np.asarray(stepper.newton.scale)
    return Event(poll.at, mark, scale * poll.z, scale * poll.tangent, poll.orientation)


def first_margin(stepper: Stepper) -> float:
    """Length at which a margin first changes sign within the step; NOT_FOUND if the curve is not found there.

    If many margins change sign, most have not done so yet where another one does; their roots are not
    computed.
    """
    last, first = stepper.there, stepper.step
    for k in _changing(stepper):
        if stepper.here.margin[k] * stepper.here.margin_at(k, last) < 0.0:
            first = min(first, root_within(stepper, TestFunction(MARGIN, k)))
            if first == NOT_FOUND:
                break
            last = stepper.between
    return first


def _changing(stepper: Stepper) -> list[int]:
    """Margins that change sign within the step, ordered by the place that linear interpolation gives."""
    places = {}
    for k in range(stepper.problem.margins):
        before, after = stepper.here.margin[k], stepper.here.margin_at(k, stepper.there)
        if before * after < 0.0:
            places[k] = before / (before - after)
    return sorted(places, key=lambda k: places[k])


@cython.cfunc
@cython.exceptval(-1, check=False)
def without_events(stepper: Stepper, values: cython.double[::1], greatest: cython.double[::1]) -> cython.bint:
    """Whether the step has no fold, no peak that matters, and crosses no given value of the parameter."""
    n: cython.Py_ssize_t = stepper.problem.unknowns
    k: cython.Py_ssize_t
    here: Point = stepper.here
    there: Point = stepper.there
    for k in range(values.shape[0]):
        if (values[k] - here.z[n]) * (values[k] - there.z[n]) < 0.0:
            return False
    if here.tangent[n] * there.tangent[n] < 0.0:
        return False
    for k in range(stepper.problem.outputs):
        if has_peak(here, there, k, greatest[k], stepper.options.events):
            return False
    return True


@cython.cfunc
@cython.exceptval(-1, check=False)
def has_peak(
    here: Point, there: Point, k: cython.Py_ssize_t, greatest: cython.double, options: EventOptions
) -> cython.bint:
    """Whether an output has a peak that matters between two points."""
    size: cython.double = max(here.output[k], there.output[k])
    least: cython.double = options.min_growth * size
    if not (here.growth[k] > least and there.growth[k] < -least):
        return False
    return size >= options.peak_threshold * greatest


@cython.cfunc
@cython.exceptval(-1, check=False)
def may_exceed(stepper: Stepper, k: cython.Py_ssize_t, greatest: cython.double) -> cython.bint:
    """Whether a peak of an output within the step may exceed the greatest so far, by the slopes at its ends.

    Points are costly if a problem is labelled or has many unknowns. On a curve with many loops most peaks are
    lower than an earlier one.
    """
    here: Point = stepper.here
    there: Point = stepper.there
    slope: cython.double = max(here.growth[k], -there.growth[k] / stepper.clipped_cosine())
    return max(here.output[k], there.output[k]) + stepper.step * slope >= greatest


@cython.cfunc
@cython.exceptval(-1, check=False)
def closes_curve(stepper: Stepper, first: cython.double[::1], head: cython.double[::1]) -> cython.bint:
    """Whether the step passes the point where the curve began, in the direction of the curve there."""
    i: cython.Py_ssize_t
    before: cython.double = 0.0
    after: cython.double = 0.0
    far: cython.double = 0.0
    farther: cython.double = 0.0
    for i in range(first.shape[0]):
        one: cython.double = (stepper.here.z[i] - first[i]) / stepper.newton.scale[i]
        other: cython.double = (stepper.there.z[i] - first[i]) / stepper.newton.scale[i]
        far += one * one
        farther += other * other
        before += one * head[i]
        after += other * head[i]
    if sqrt(min(far, farther)) > stepper.step:
        return False
    return before < 0.0 <= after and dot(stepper.here.tangent, head) > stepper.options.events.closing_cosine


def events_within(stepper: Stepper, limit: float, values: list[float], greatest: FloatArray) -> list[Event]:
    """Folds, peaks and given values of the parameter up to a length `limit` of the step, in order."""
    n: cython.Py_ssize_t = stepper.problem.unknowns
    k: cython.Py_ssize_t
    most: cython.double[::1] = greatest
    here: Point = stepper.here
    there: Point = stepper.there
    events = []
    many: cython.bint = stepper.problem.unknowns >= stepper.problem.costly_size
    costly: cython.bint = stepper.problem.labelled or many  # what lies between helps
    folds: cython.bint = here.tangent[n] * there.tangent[n] < 0.0
    peaks = [
        k for k in range(stepper.problem.outputs) if has_peak(here, there, k, most[k], stepper.options.events)
    ]
    looks = ExtremumSearch(stepper) if costly and (folds or peaks) else None
    if folds:
        events += located_root(stepper, FOLD, 0, limit, Mark.FOLD, looks)
    fold = events[0] if events else None
    for value in values:
        events += user_point_crossings(stepper, value, fold)
    for k in peaks:
        if not costly or may_exceed(stepper, k, most[k]):
            events += located_root(stepper, PEAK, k, limit, Mark.PEAK, looks)
    # several outputs may be greatest at the same point
    distinct = {(event.length, event.mark): event for event in events if event.length <= limit}
    return sorted(distinct.values(), key=lambda event: event.length)


def located_root(
    stepper: Stepper, kind: int, k: int, limit: float, mark: int, looks: ExtremumSearch | None
) -> list[Event]:
    """The event at the root of a function along the step, as a list; empty without one up to `limit`."""
    if looks is not None:
        poll = looks.extreme(None if kind == FOLD else k)
        return [event_at_sample(stepper, poll, mark)] if poll.at <= limit else []
    at = root_within(stepper, TestFunction(kind, k))
    if at == NOT_FOUND:
        event = bracketed_fold(stepper)
        return [event] if event.length <= limit else []
    if at > limit or not stepper.find_between(at, False, False):
        return []
    return [event_at_point(stepper, at, mark, stepper.between)]


class _Side(NamedTuple):
    """A point beside a fold: length from the beginning of the step, scaled z and tangent."""

    at: float
    z: FloatArray
    tangent: FloatArray


def bracketed_fold(stepper: Stepper) -> Event:
    """A fold that is not a regular point of the curve, interpolated between points on both sides.

    The error is of the third power of their distance."""
    scale = np.array(stepper.newton.scale)
    low, high = (
        _Side(at, np.array(point.z) / scale, np.array(point.tangent))
        for at, point in ((0.0, stepper.here), (stepper.step, stepper.there))
    )
    for _ in range(stepper.options.events.max_evaluations):
        width = high.at - low.at
        if width < stepper.options.events.fold_bracket:
            break
        middle = low.at + width * low.tangent[-1] / (low.tangent[-1] - high.tangent[-1])
        nearer = low.at, high.at
        for at in (middle - 0.1 * width, middle + 0.1 * width):
            if not (low.at < at < high.at and stepper.find_between(at, False, False)):
                continue
            if stepper.newton.moved < stepper.step and stepper.sharpen(False, False):
                side = _Side(at, np.array(stepper.between.z) / scale, np.array(stepper.between.tangent))
                low, high = (side, high) if side.tangent[-1] * low.tangent[-1] > 0.0 else (low, side)
        if (low.at, high.at) == nearer:
            break
    part = low.tangent[-1] / (low.tangent[-1] - high.tangent[-1])
    turn, length = high.tangent - low.tangent, float(np.linalg.norm(high.z - low.z))
    z = low.z + length * part * (low.tangent + 0.5 * part * turn)
    at = low.at + part * (high.at - low.at)
    tangent = low.tangent + part * turn
    here = stepper.here
    return Event(at, Mark.FOLD, scale * z, scale * tangent, here.orientation)


def user_point_crossings(stepper: Stepper, value: float, fold: Event | None) -> list[Event]:
    """Events where the parameter crosses a value: one, or one on either side of a fold.

    Next to a fold the equations have two solutions with this value close together. Newton's method may find
    either or none, so there the crossing is located along the step.
    """
    n: cython.Py_ssize_t = stepper.problem.unknowns
    begin: float = stepper.here.z[n] - value
    end: float = stepper.there.z[n] - value
    if fold is not None:
        top = float(fold.z[n]) - value
        return user_point_crossing(stepper, value, 0.0, fold.length, begin, top) + user_point_crossing(
            stepper, value, fold.length, stepper.step, top, end
        )
    if (
        begin * end < 0.0
        and stepper.find_at_parameter(value)
        and 0.0 <= stepper.length(stepper.between) <= stepper.step
    ):
        return [event_at_point(stepper, stepper.length(stepper.between), Mark.USER_POINT, stepper.between)]
    return user_point_crossing(stepper, value, 0.0, stepper.step, begin, end)


def user_point_crossing(
    stepper: Stepper, value: float, low: float, high: float, before: float, after: float
) -> list[Event]:
    """The event where the parameter crosses a value between the lengths low and high, as a list or empty.

    before, after: the parameter minus the value at low and high.
    """
    if not before * after < 0.0:
        return []
    at = root(stepper, TestFunction(USER_POINT, 0, value), low, high, before, after)
    if at == NOT_FOUND or not stepper.find_between(at, False, False):
        return []
    stepper.between.z[stepper.problem.unknowns] = value
    return [event_at_point(stepper, at, Mark.USER_POINT, stepper.between)]


def first_end(stepper: Stepper, ends: Sequence[End]) -> tuple[int, float] | None:
    """The first end function that becomes negative within the step, and the length there; None if none does.

    At that length no end function is negative yet; NaN counts as negative.
    """

    def least(point: Point) -> float:
        values = [end.value(np.array(point.z)) for end in ends]
        return -1.0 if np.isnan(values).any() else min(values)

    def first(z: FloatArray) -> int:
        return int(np.argmin([end.value(z) for end in ends]))

    after = least(stepper.there)
    if after >= 0.0:
        return None
    before, which = least(stepper.here), first(np.array(stepper.there.z))
    sides, at = SignChange(0.0, stepper.step, before, after, True), 0.0
    for _ in range(stepper.options.events.max_evaluations if before > 0.0 else 0):
        if sides.width <= max(stepper.options.events.tolerance * stepper.step, ends[which].within):
            break
        known = stepper.find_between(sides.at, False, False)
        now = least(stepper.between) if known else after
        if now >= 0.0:
            at = sides.at
        elif known:
            which = first(np.array(stepper.between.z))
        sides.update(sides.at, now)
    return which, at
