"""As many harmonics as an accuracy takes, and those that it takes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fcm.continuation.follow import Progress
from fcm.harmonic.cost import AGAIN
from fcm.harmonic.crest import RIVAL
from fcm.harmonic.error import Errors, errors_along
from fcm.harmonic.foreseen import NOTHING, UNKNOWN, needed
from fcm.harmonic.nearby import with_a_window
from fcm.harmonic.outline import Outline, enough, foreseen_whole, near, outlined, with_more
from fcm.harmonic.start import few_of
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

ROUNDS = 8  # of tracing, estimating, choosing


@dataclass(frozen=True)
class Accurate(Outline):
    """A response, its errors, and whether they are below what was asked for.

    errors (path,) belong to the branches' paths, too; peak (dof,) is the relative error of the greatest
    amplitude over all of them; worst the greatest of these and of the errors of the folds, NaN where one
    cannot be told, and told the greatest of those that can.
    """

    errors: tuple[Errors, ...]
    peak: FloatArray
    worst: float
    told: float
    reached: bool

    @property
    def folds(self) -> FloatArray:
        """Errors of all folds, branch after branch."""
        return np.concatenate([np.empty(0), *(one.fold for one in self.errors)])


def accurate(system: System, accuracy: float, progress: Progress | None = None) -> Accurate:
    """The response of a scene (of one curve) with the harmonics that an accuracy takes; system has one.

    Traced first with one harmonic; as long as a peak of a degree of freedom, or a fold, may be further from
    its true place than the accuracy (relative), the harmonics are added that it takes, as far as that can be
    foreseen, and all is traced again: from what the branches before, and their stable peaks, lead to with
    more. Only with what is foreseen to be enough the level of the forces is followed, which may lead to
    branches that fewer harmonics do not have, and for which it is not. Then errors are estimated point by
    point. What would take longer, with all before it, than anyone waits is not begun, see `PATIENCE`, and
    what does take longer is given up.
    Whether the branches are complete is another question, see their status.
    """
    found, further, begun, sure = outlined(system, progress), tuple[int, ...](), False, None
    for _ in range(ROUNDS - 1):
        found, ahead = foreseen_whole(found, accuracy)
        if found.further:
            break
        more, sure = ahead.harmonics, None
        if enough(ahead, accuracy):
            sure = judged(found, accuracy)
            if sure.reached or (sure.told <= accuracy and not np.isnan(sure.peak).any()):
                # folds that cannot be told do not come to be by more harmonics, but windows do
                more = with_a_window(found.system, found.traced.found)
                if more == found.system.harmonics:
                    return sure
            else:
                more = enlarged(sure, accuracy)
        then, further, begun = with_more(found, ahead, more, accuracy, progress)
        if then is None:
            break
        found, sure = then, None
    found = found.whole()
    if found.further:
        further, begun = found.further, found.begun
    return replace(sure or judged(found, accuracy), further=further, begun=begun)


def finer(found: Accurate, harmonics: tuple[int, ...], accuracy: float) -> Accurate | None:
    """The response traced again with more harmonics; None where no solution is found, or that takes longer
    than is worth it."""
    if found.seconds_with(harmonics) > AGAIN:
        return None
    beside = near(found, harmonics)
    then = outlined(found.system.with_harmonics(harmonics), None, found.traced.found, beside)
    return judged(then, accuracy) if then.shown else None


def given(system: System, progress: Progress | None = None) -> Accurate:
    """The response with the harmonics that a system has.

    Traced with one of them first, then with those that tell how far the level of all is to be followed, then
    with half: what is beside its stable peaks with more is a start, too, as the level of the forces may not
    lead to it. A branch that is isolated with three harmonics may hang together with the others with one.
    """
    counts = sorted({1, few_of(system), max(len(system.harmonics) // 2, few_of(system))})
    if not system.scene.contacts:
        return estimated(system, np.inf, progress)
    before: Outline | None = None
    for count in counts:
        if count < len(system.harmonics):
            before = _after(before, system.with_harmonics(system.harmonics[:count]))
    return judged(_after(before, system, progress), np.inf)


def _after(before: Outline | None, system: System, progress: Progress | None = None) -> Outline:
    """The response of a system, after that with fewer harmonics."""
    if before is None:
        return outlined(system, progress)
    return outlined(system, progress, before.traced.found, near(before, system.harmonics))


def judged(outline: Outline, accuracy: float, known: tuple[Errors, ...] = ()) -> Accurate:
    """A response with its errors, of which those of its first branches may be known."""
    system, response, shown = outline.system, outline.traced, outline.shown
    paths = response.branches.paths
    rest = list(zip(paths, shown, strict=True))[len(known) :]
    errors = (*known, *(errors_along(system, path, one) for path, one in rest))
    if not paths:
        none = np.full(len(system.scene.modal.dofs), np.nan)
        return Accurate(system, response, shown, outline.seconds, errors, none, np.nan, np.nan, False)
    heights = np.array([one.amplitude.max(axis=0) for one in shown])
    height, peak = heights.max(axis=0), _peaks(heights, errors)
    matter = peak[height > NOTHING * height.max()]
    every = np.concatenate((matter, *(one.fold for one in errors)))
    worst, told = float(every.max(initial=0.0)), float(every[np.isfinite(every)].max(initial=0.0))
    return Accurate(system, response, shown, outline.seconds, errors, peak, worst, told, worst <= accuracy)


def estimated(system: System, accuracy: float, progress: Progress | None = None) -> Accurate:
    """The response of a system, with its errors."""
    return judged(outlined(system, progress), accuracy)


def _peaks(heights: FloatArray, errors: tuple[Errors, ...]) -> FloatArray:
    """Relative error of the greatest of heights (path, dof) of each degree of freedom.

    Another path may be the highest of the corrected ones; unknown where that of one nearly as high is.
    """
    which, d = heights.argmax(axis=0), np.arange(heights.shape[1])
    now = heights[which, d]
    peak = np.array([one.peak for one in errors])[which, d]
    corrected = np.array([one.height for one in errors])
    greatest = np.where(np.isnan(corrected), 0.0, corrected).max(axis=0)
    other = greatest > corrected[which, d]
    peak = np.where(other, np.abs(greatest - now) / np.where(now > 0.0, now, 1.0), peak)
    unknown = (np.isnan(corrected) & (heights > RIVAL * now)).any(axis=0)
    return np.where(unknown, np.nan, peak)


def enlarged(found: Accurate, accuracy: float, seconds: float = np.inf) -> tuple[int, ...]:
    """The harmonics of a response and those that would do most, until the others do less than the accuracy.

    What harmonics do is more than they are, because they change the others: by how much is told by the
    error now. No more are added than can be followed in some seconds.
    """
    share = np.max([one.share for one in found.errors], axis=0, initial=0.0)
    total, has = share.sum(), found.system.harmonics
    if not total > 0.0:
        return has
    gain = found.worst / total if np.isfinite(found.worst) else UNKNOWN
    more = sorted(set(needed(share, has, gain, accuracy)) - set(has), key=lambda h: -share[h - 1])
    while more and found.seconds_with((*has, *more)) > seconds:
        more.pop()
    return tuple(sorted((*has, *more)))
