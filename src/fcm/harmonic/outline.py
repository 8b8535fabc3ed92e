"""A balance's response whose errors are not known, and that with more harmonics, as long as nobody waits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from fcm.continuation.follow import Progress
from fcm.harmonic.beside import beside
from fcm.harmonic.cost import PATIENCE, seconds_of
from fcm.harmonic.error import Reported, reported
from fcm.harmonic.foreseen import LOW, Foreseen, foreseen
from fcm.harmonic.start import Found
from fcm.harmonic.system import System
from fcm.harmonic.trace import Traced, traced
from fcm.harmonic.work import TooLongError
from fcm.scene.model import FloatArray

ROUNDS = 8  # of tracing, estimating, choosing
DOUBTFUL = 3.0  # seconds that rounds may take of which nothing tells that they bring the accuracy nearer


@dataclass(frozen=True)
class Outline:
    """A response whose errors are not known yet; shown (path,) belongs to the branches' paths.

    seconds: about what following its levels and branches took. further: the harmonics that would do more but
    take too long, if any, and whether that was seen only when they had been begun.
    """

    system: System
    traced: Traced
    shown: tuple[Reported, ...]
    seconds: float
    further: tuple[int, ...] = field(default=(), kw_only=True)
    begun: bool = field(default=False, kw_only=True)

    def seconds_with(self, harmonics: tuple[int, ...]) -> float:
        """About what following its levels and branches with other harmonics takes."""
        few, many = len(self.system.harmonics), len(harmonics)
        if not self.seconds:  # nothing was to be followed
            return 0.0
        grown = seconds_of(self.system, 1, many) / seconds_of(self.system, 1, few)
        return self.seconds * grown * many / few

    def within(self, seconds: float, more: tuple[int, ...]) -> tuple[int, ...]:
        """More harmonics without the highest of those that are new, until following them takes no longer.

        The lowest stay: a branch of one harmonic may be of no motion at all.
        """
        least = {*self.system.harmonics, *range(1, LOW + 1)}
        while self.seconds_with(more) > seconds and not least.issuperset(more):
            highest = max(set(more) - least)
            more = tuple(h for h in more if h != highest)
        return more

    def ahead(self, accuracy: float) -> Foreseen:
        """What more harmonics would do, and those that an accuracy takes."""
        paths = self.traced.branches.paths
        if not paths:
            return Foreseen(0.0, True, self.system.harmonics)
        return foreseen(self.system, paths, [one.amplitude for one in self.shown], accuracy)


def outlined(
    system: System,
    progress: Progress | None = None,
    fewer: tuple[Found, ...] = (),
    near: Sequence[FloatArray] = (),
) -> Outline:
    """The response of a system; fewer and near as of `traced`."""
    before = system.work.seconds
    response = traced(system, progress, fewer, near)
    shown = tuple(reported(system, path) for path in response.branches.paths)
    return Outline(system, response, shown, system.work.seconds - before)


def foretold(system: System, accuracy: float) -> Outline:
    """The response with the harmonics that are foreseen to be enough for an accuracy; system has one.

    As `accurate`, but no error is estimated: for motions that are not of the balance it is a guess alone.
    """
    found, further, begun = outlined(system), tuple[int, ...](), False
    for _ in range(ROUNDS - 1):
        ahead = found.ahead(accuracy)
        if ahead.told and ahead.change <= accuracy:
            break
        then, further, begun = with_more(found, ahead, ahead.harmonics, accuracy, None)
        if then is None:
            break
        found = then
    return replace(found, further=further, begun=begun)


def with_more(
    found: Outline, ahead: Foreseen, more: tuple[int, ...], accuracy: float, progress: Progress | None
) -> tuple[Outline | None, tuple[int, ...], bool]:
    """The response with more harmonics; if there is none, those that take too long, and whether they had
    been begun."""
    work = found.system.work
    blind = not ahead.told and ahead.change <= accuracy  # what is told of is no reason for more
    if blind:
        more = found.within(DOUBTFUL - work.seconds, more)
    if more == found.system.harmonics:
        return None, ahead.harmonics if blind and ahead.harmonics != more else (), False
    if work.seconds + found.seconds_with(more) > PATIENCE:
        return None, more, False
    system, stable = found.system.with_harmonics(more), near(found, more)
    try:
        with work.up_to(PATIENCE):
            then = outlined(system, progress, found.traced.found, stable)
    except TooLongError:
        return None, more, True
    # where no solution was found the one of fewer harmonics, which says its error, stays
    return (then if then.shown else None), (), False


def near(before: Outline, harmonics: tuple[int, ...]) -> list[FloatArray]:
    """Solutions with more harmonics beside the stable peaks of a response."""
    shown = [one.amplitude for one in before.shown]
    return beside(before.system, before.traced.branches.paths, shown, harmonics)
