"""Follow the reference beside stretches of a curve in whose normal planes it has no point nearby.

Where a corner or a pair of folds has moved, Newton's method in the normal plane diverges. It converges on
both sides of the stretch, and the reference is followed from one side to the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from fcm.accuracy.budget import Budget
from fcm.accuracy.options import PairOptions
from fcm.accuracy.reference_pieces import lengths
from fcm.branches.force_level import solutions
from fcm.branches.options import LEVEL_CURVE
from fcm.continuation import Events, Mark, Path, Status
from fcm.continuation.follow import Follower
from fcm.frozen import Frozen
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.reported_quantities import ReportedQuantities, reported_quantities
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.work_budget import WorkLimitError
from fcm.model.scene import FloatArray


class BudgetSpentError(Exception):
    """Raised when following the reference would exceed its budget."""


class ReferencePiece(Frozen):
    """A piece of the reference followed from one end of a stretch; `reached_end`: whether up to the other."""

    path: Path
    quantities: ReportedQuantities
    reached_end: bool

    @property
    def whole(self) -> bool:
        """Whether the piece ends at an end of the reference or of the stretch, not interrupted or stalled."""
        return self.path.status not in (Status.INTERRUPTED, Status.STALLED)

    @cached_property
    def arc(self) -> FloatArray:
        """Arc lengths (point,) along the piece."""
        return lengths(self.path)

    def passes(self, frequency: FloatArray) -> bool:
        """Whether the piece shares frequencies with the range of the given ones.

        A piece that shares none leads away from the stretch.
        """
        there = self.path.parameter
        return bool(there.min() < frequency.max() and there.max() > frequency.min())


class StretchEnd(Frozen):
    """A point of the reference at an end of a stretch; `rises`: whether the frequency rises there."""

    number: int
    z: FloatArray
    amplitude: FloatArray
    rises: bool


class StretchFollower:
    """Follows the reference `between` two points of a curve, as long as the budget allows."""

    def __init__(
        self,
        fewer: System,
        finer: System,
        prolongation: Prolongation,
        curve: Path,
        options: PairOptions,
        budget: Budget,
    ) -> None:
        self.fewer = fewer.harmonics
        self.finer, self.prolongation, self.curve, self.options = finer, prolongation, curve, options
        many = len(finer.scene.contacts) >= options.many_contacts
        self.following = options.following_of_many if many else options.following
        self.each = seconds_of(finer, 1, len(finer.harmonics))
        self.budget, self.evaluations = budget, 0

    def between(self, first: int, last: int, found: FloatArray) -> list[ReferencePiece]:
        """Pieces of the reference between points first and last of the curve, which may lie beyond its ends.

        The result is one piece that joins both, or a piece from each, as far as it stays near the stretch and
        the work allows. found (point, unknown + 1) is the reference where it was found; NaN elsewhere.
        """
        if self.budget.seconds <= 0.0:
            return []
        tries, count = self.options.end_tries, len(self.curve.z)
        before = (
            self._end(range(first, max(first - tries, -1), -1), found)
            if first >= 0
            else self._same_frequency(0)
        )
        behind = self._end(range(last, min(last + tries, count)), found) if last < count else None
        pieces = self._from_ends(before, behind)
        own = self.curve.parameter[max(first, 0) : last + 1]
        if first < 0 and before is None and not _any_passes(pieces, own):
            pieces += self._towards(own, found)
        if first < 0 and before is None and not _any_passes(pieces, own):
            before = self._nearest_passed(0, True)  # the level costs more than following from an end
            pieces += self._from_ends(before, None)
        if before is None and behind is None and not _any_passes(pieces, own):
            pieces += self._from_ends(None, self._same_parity(last - 1))
        return pieces

    def _from_ends(self, before: StretchEnd | None, behind: StretchEnd | None) -> list[ReferencePiece]:
        """Pieces followed from the ends of a stretch: one that joins both, or one from each existing end."""
        span, pieces = self._span(before, behind), list[ReferencePiece]()
        for begin, end in ((before, behind), (behind, before)):
            if begin is None or not span[0] < span[1]:
                continue
            if self.budget.seconds <= 0.0:
                break
            piece = self._followed(begin, end, span, begin.rises == (begin is before))
            if piece.reached_end:
                return [piece]
            pieces += [piece] if len(piece.path.z) > 1 else []
        return pieces

    def _towards(self, frequency: FloatArray, found: FloatArray) -> list[ReferencePiece]:
        """Follow a piece towards a stretch's frequencies from the found motion nearest to them.

        Empty if a found motion already lies within these frequencies.
        """
        known = found[np.isfinite(found[:, -1])]
        low, high = float(frequency.min()), float(frequency.max())
        off = np.maximum(low - known[:, -1], known[:, -1] - high)
        if not off.size or off.min() <= 0.0 or self.budget.seconds <= 0.0:
            return []
        begin = known[off.argmin()]
        span, rises = (min(low, begin[-1]), max(high, begin[-1])), bool(begin[-1] < low)
        piece = self.along(begin, None, span, rises)
        return [piece] if len(piece.path.z) > 1 else []

    def start(self, i: int, by_level: bool) -> FloatArray | None:
        """A motion of the reference at the frequency of point i; None if the work allowed finds none.

        It is found by Newton's method from that point, or by_level on the curve of the force level.
        """
        before = self.prolongation.newton.evaluations
        begin = self._nearest_passed(i, False) if by_level else self._same_frequency(i)
        new = int(self.prolongation.newton.evaluations - before)
        self.evaluations += new
        self.budget.seconds -= new * self.each
        return None if begin is None else begin.z

    def along(
        self, z: FloatArray, direction: FloatArray | None, span: tuple[float, float], forward: bool
    ) -> ReferencePiece:
        """The reference followed from a point, as far as it stays in a frequency span and the budget lasts.

        `direction` is the tangent at the point, if known.
        """
        path = self._path(z, direction, span, Events(), forward)
        return ReferencePiece(path, reported_quantities(self.finer, path), False)

    def _end(self, places: Iterable[int], found: FloatArray) -> StretchEnd | None:
        """The end of a stretch at the first of some points from which the reference is found, or None.

        The predictor starts from a known motion of the reference: with many contacts, the point alone may not
        be enough.
        """
        for i in places:
            if not 0 <= i < len(self.curve.z):
                continue
            if np.isfinite(found[i]).all():
                self.prolongation.predict_from(self.curve.z[i], found[i])
            if self.prolongation.find_normal(self.curve.z[i], self.curve.direction[i], True):
                return self._found(i)
        return None

    def _same_frequency(self, i: int) -> StretchEnd | None:
        """The reference's motion at the frequency of point i, by Newton's method; None if it diverges."""
        guess = self.finer.extended(self.curve.z[i], self.fewer)
        return self._found(i) if self.prolongation.find_at_frequency(guess, True) else None

    def _same_parity(self, i: int) -> StretchEnd | None:
        """The reference's motion at the frequency of point i.

        It comes from Newton's method, else from the curve of the force level, with the parity of the point.
        """
        return self._same_frequency(i) or self._nearest_passed(i, True)

    def _nearest_passed(self, i: int, same_parity: bool) -> StretchEnd | None:
        """The nearest motion at the frequency of point i on the curve of the force level, or None.

        With `same_parity`, only motions count whose number of real multipliers above 1 has the parity of the
        point.
        """
        prolongation, curve = self.prolongation, self.curve
        guess = self.finer.extended(curve.z[i], self.fewer)
        parity = curve.parity[i]
        known = self._passed(float(curve.z[i, -1]))
        for one in sorted(
            known, key=lambda one: float(np.linalg.norm((one - guess) / prolongation.newton.scale))
        ):
            if not prolongation.find_at_frequency(one, False):
                continue
            if (
                not same_parity
                or prolongation.newton.orientation * prolongation.newton.tangent[-1] * parity > 0.0
            ):
                return self._found(i)
        return None

    def _passed(self, omega: float) -> tuple[FloatArray, ...]:
        """The motions at level 1 on the curve of the force level at a frequency; empty beyond the budget."""
        work, before = self.finer.work, self.finer.work.seconds
        try:
            with work.limited_to(before + max(self.budget.seconds, 0.0)):
                return solutions(self.finer, omega, LEVEL_CURVE.clear_level).solutions
        except WorkLimitError:
            return ()
        finally:
            self.budget.seconds -= work.seconds - before

    def _found(self, i: int) -> StretchEnd:
        """The `StretchEnd` beside point i, from the motion that Newton's method found last."""
        newton = self.prolongation.newton
        rises = bool(newton.tangent[-1] * self.curve.direction[i, -1] > 0.0)
        return StretchEnd(i, np.array(newton.z), np.array(self.prolongation.found[1:]), rises)

    def _span(self, before: StretchEnd | None, behind: StretchEnd | None) -> tuple[float, float]:
        """Frequency range in which a stretch is followed, with a margin, as folds may have moved."""
        ends = [end for end in (before, behind) if end]
        first = before.number if before else 0
        last = behind.number if behind else len(self.curve.z) - 1
        inside = np.append(self.curve.parameter[first : last + 1], [end.z[-1] for end in ends])
        low, high = float(inside.min()), float(inside.max())
        reach = self.options.span_margin * (high - low)
        lowest, highest = self.finer.scene.frequency_range
        return max(low - reach, min(lowest, low)), min(high + reach, max(highest, high))

    def _followed(
        self, begin: StretchEnd, end: StretchEnd | None, span: tuple[float, float], forward: bool
    ) -> ReferencePiece:
        """The reference followed from one end of a stretch to the other, or within the span."""
        if end is None:
            path = self._path(begin.z, None, span, Events(), forward)
            return ReferencePiece(path, reported_quantities(self.finer, path), False)
        events = Events((float(end.z[-1]),), last=int(Mark.USER_POINT))
        path, reached = self._path(begin.z, None, span, events, forward), False
        while path.status is Status.EVENT:
            reached = self._is_at(path, end)
            if reached or self.budget.seconds <= 0.0:
                break
            further = self._path(path.z[-1], path.direction[-1], span, events, forward)
            path = path.then(further) if len(further.z) else replace(path, status=further.status)
        if path.status is Status.EVENT and not reached:
            path = replace(path, status=Status.INTERRUPTED)
        return ReferencePiece(path, reported_quantities(self.finer, path), reached)

    def _is_at(self, path: Path, end: StretchEnd) -> bool:
        """Whether a path ends at a given end of the stretch, not at another motion of that frequency."""
        last = slice(len(path.z) - 1, len(path.z))
        amplitude = reported_quantities(self.finer, _part(path, last)).amplitude[0]
        off = np.abs(amplitude - end.amplitude).max(initial=0.0)
        return bool(off < self.options.end_tolerance * end.amplitude.max())

    def _path(
        self,
        start: FloatArray,
        direction: FloatArray | None,
        span: tuple[float, float],
        events: Events,
        forward: bool,
    ) -> Path:
        """The path of the reference from a point, as far as the budget allows."""
        balance, stepper, known = self.finer.reset_balance(), self.finer.shared_stepper, 0

        def pay() -> None:
            nonlocal known
            new, known = stepper.newton.evaluations - known, stepper.newton.evaluations
            self.evaluations += new
            self.budget.seconds -= new * self.each

        def pay_as_far_as_it_lasts(_: float) -> None:
            pay()
            if self.budget.seconds < 0.0:
                raise BudgetSpentError

        follower = Follower(balance, span, events, self.following, pay_as_far_as_it_lasts, stepper)
        with self.finer.exclusive_balance():
            stepper.newton.poll = self.finer.work.poll
            try:
                if not follower.begin(start, forward, direction):
                    return follower.path(Status.STALLED)
                return follower.run(None)
            except BudgetSpentError:
                return follower.path(Status.INTERRUPTED)
            finally:
                stepper.newton.poll = None
                pay()


def _any_passes(pieces: Sequence[ReferencePiece], frequency: FloatArray) -> bool:
    """Whether any whole piece passes frequencies of a stretch."""
    return any(piece.whole and piece.passes(frequency) for piece in pieces)


def _part(path: Path, rows: slice) -> Path:
    """The path restricted to some of its points."""
    return Path(
        path.z[rows], path.direction[rows], path.mark[rows], path.orientation[rows],
        path.status, path.evaluations,
    )  # fmt: skip
