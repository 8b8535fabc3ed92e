"""``--only peaks``: of exact curves the peaks, folds and jumps alone, sought near those of the balance."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fcm.continuation import Mark
from fcm.motion.errors import SimulationError
from fcm.orbit.branch import shown
from fcm.orbit.harmonic import state_of
from fcm.orbit.located import Guess, located
from fcm.orbit.problem import OrbitProblem
from fcm.orbit.sample import Sample
from fcm.orbit.start import near_balance
from fcm.reduction.put_back import unknowns
from fcm.response.orbit_curve import curve_of_points
from fcm.response.trace import ACCURACY, Wanted, traced_curve
from fcm.results.jumps import Jump
from fcm.results.result import Curve
from fcm.run import Report
from fcm.scene.model import Scene

HIGH = 0.9  # of the greatest amplitude of a degree of freedom: peaks of the balance that may be the highest
NEAR = 0.05  # of the frequency of a jump of the balance: the exact fold that belongs to it


def peaks_alone(scene: Scene, report: Report) -> Curve:
    """The curve of a scene with its peaks, folds and jumps alone; not complete if one was not found."""
    balanced = traced_curve(scene, Wanted(None, ACCURACY))
    problem, known, missing = OrbitProblem(scene), list[Sample](), list[str]()
    guesses = list(_guesses(scene, balanced))
    for number, guess in enumerate(guesses):
        report(number / len(guesses), f"{number} of {len(guesses)} peaks and folds")
        if located(problem, guess, known) is None:
            what = "fold" if guess.dof is None else f"peak of {scene.modal.dofs[guess.dof]}"
            missing.append(f"no exact {what} was found near {shown(scene, guess.frequency)}")
    points = sorted(known, key=lambda one: one.frequency)
    reason = "; ".join(dict.fromkeys(missing)) or balanced.reason
    curve = curve_of_points(scene, points, reason)
    curve.folds = [one.frequency for one in points if one.mark & Mark.FOLD]
    if curve.orbits is not None:
        curve.orbits.span, curve.orbits.periods = scene.frequency_range, problem.periods
        curve.orbits.jumps = list(_jumps(scene, balanced, points))
    return curve


def _guesses(scene: Scene, curve: Curve) -> Iterator[Guess]:
    """Places of the balance at which it has peaks, of which one may be the highest, and folds."""
    if not curve.points:
        return
    for dof in range(curve.amplitude.shape[1]):
        for k in _summits(curve, dof):
            yield _guess(scene, curve, k, dof)
    for fold in curve.folds:
        for at in np.flatnonzero(curve.frequency == fold):
            yield _guess(scene, curve, int(at), None)


def _summits(curve: Curve, dof: int) -> list[int]:
    """Points that are higher than their neighbours, and nearly as high as the highest."""
    a = np.where(np.isfinite(curve.amplitude[:, dof]), curve.amplitude[:, dof], -np.inf)
    padded = np.concatenate(([-np.inf], a, [-np.inf]))
    tops = (a >= padded[:-2]) & (a >= padded[2:]) & (a >= HIGH * a.max()) & (a > 0.0)
    return [int(k) for k in np.flatnonzero(tops)]


def _guess(scene: Scene, curve: Curve, k: int, dof: int | None) -> Guess:
    there = np.flatnonzero(np.isfinite(curve.frequency))
    beside = min((int(i) for i in (k - 1, k + 1) if i in there), default=k)
    z = unknowns(curve, scene, np.array([k, beside]), curve.harmonics)
    one, other = (state_of(scene, curve.harmonics, row) for row in z)
    return Guess(float(curve.frequency[k]), one, (float(curve.frequency[beside]), other), dof)


def _jumps(scene: Scene, balanced: Curve, points: list[Sample]) -> Iterator[Jump]:
    """The jumps of the balance at the exact folds that belong to them."""
    folds = [one for one in points if one.mark & Mark.FOLD and one.stable]
    for jump in balanced.jumps():
        near = [one for one in folds if abs(one.frequency - jump.frequency) < NEAR * jump.frequency]
        if not near:
            continue
        fold = min(near, key=lambda one: float(np.abs(one.measure.amplitude - jump.before).max()))
        before = fold.measure.amplitude
        yield Jump(jump.sweep, fold.frequency, before, _landed(scene, fold, jump.after))


def _landed(scene: Scene, fold: Sample, wanted: np.ndarray) -> np.ndarray:
    """The amplitude of the other stable motion at a fold, the nearest to the one of the balance."""
    try:
        found = [one.measure.amplitude for one in near_balance(scene, fold.frequency) if one.stable]
    except SimulationError:
        found = []
    size = fold.measure.amplitude.max()
    others = [one for one in found if np.abs(one - fold.measure.amplitude).max() > 1e-3 * size]
    if not others or not np.isfinite(wanted).all():
        return np.full_like(fold.measure.amplitude, np.nan)
    return min(others, key=lambda one: float(np.abs(one - wanted).max()))
