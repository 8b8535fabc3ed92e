"""``--only peaks``: peaks, folds and jumps of exact curves, located near those of the balance.

If the two do not correspond one to one, or one harmonic is far from the motion, the whole curve is followed.
Its other points are then left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field

import numpy as np

from fcm.continuation import Mark
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.reduction.restore import unknowns
from fcm.response.coexisting_search import Search
from fcm.response.options import EXACT_CURVES, INPUT_LIMITS, ResponseOptions
from fcm.response.orbit_branches import OrbitBranches
from fcm.response.orbit_curve import curve_of_points, orbit_curve
from fcm.response.request import ONE_HARMONIC, Request
from fcm.response.trace import traced_curve
from fcm.results.jumps import FrequencySweep, Jump
from fcm.results.result import Curve
from fcm.run import Report
from fcm.shooting.harmonic_balance_state import state_of
from fcm.shooting.initial_orbits import near_balance
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.orbit_record import OrbitRecord
from fcm.shooting.peaks_and_folds import OrbitGuess, located
from fcm.shooting.periodic_orbit import Poll
from fcm.shooting.problem import OrbitProblem
from fcm.shooting.work_budget import UncertainFrequencies
from fcm.time_domain.errors import SimulationError


class PeaksOnly(Frozen):
    """The peaks, folds and jumps of a scene, by frequency, and the number of periods computed for them."""

    points: list[OrbitRecord]
    jumps: list[Jump] = field(default_factory=list)
    periods: int = 0  # number of periods computed
    uncertain: UncertainFrequencies = field(
        default_factory=UncertainFrequencies
    )  # of the balance that gave the guesses


def peaks_only(
    scene: Scene, known: list[OrbitRecord], report: Report, poll: Poll, shooting: ShootingOptions = SHOOTING
) -> PeaksOnly | None:
    """The peaks, folds and jumps of a scene; None if they do not correspond to those of the balance.

    known : points are added to it as they are found.
    """
    if not _one_harmonic_suffices(traced_curve(scene, ONE_HARMONIC, poll)):
        return None
    branches = ResponseOptions(others=shooting.balance.others)
    balanced = traced_curve(scene, Request(None, INPUT_LIMITS.accuracy, options=branches), poll)
    swept = balanced.swept()
    if not balanced.complete or swept.unknown or not _at_folds(swept, balanced):
        return None
    problem, folds = OrbitProblem(scene), dict[float, OrbitRecord]()
    guesses = list(_guesses(scene, balanced))
    for number, guess in enumerate(guesses):
        report(number / len(guesses), f"{number} of {len(guesses)} peaks and folds")
        poll()
        found = located(problem, guess, known)
        if found is None:
            return None
        if guess.dof is None:
            folds[guess.frequency] = found
    points = sorted(known, key=lambda one: one.frequency)
    if not _paired(folds, points):
        return None
    jumps = [_jump(scene, jump, folds.get(jump.frequency)) for jump in swept.jumps]
    there = [jump for jump in jumps if jump is not None]
    if len(there) < len(jumps):
        return None
    return PeaksOnly(
        points,
        there,
        problem.periods,
        UncertainFrequencies(balanced.uncertain_at, balanced.folds_uncertain_at),
    )


def peaks_curve(scene: Scene, alone: PeaksOnly, reason: str, search: Search) -> Curve:
    """The curve of peaks, folds and jumps; complete if reason is empty."""
    return _curve(scene, alone.points, FrequencySweep(alone.jumps, []), alone.periods, reason, search)


def peaks_of(groups: Sequence[OrbitBranches], reason: str, search: Search) -> Curve:
    """The curve of the peaks, folds and jumps of branches that were followed."""
    whole, problem = orbit_curve(groups, reason, Search.none()), groups[0].problem
    tops = {peak.frequency for peak in whole.peaks.values()}
    points = [one for group in groups for path in group.own for one in path]
    points = [one for one in points if one.mark & Mark.FOLD or one.frequency in tops]
    return _curve(problem.scene, points, whole.swept(), problem.periods, reason, search)


def _curve(
    scene: Scene, points: list[OrbitRecord], swept: FrequencySweep, periods: int, reason: str, search: Search
) -> Curve:
    curve = curve_of_points(scene, points, reason, search)
    curve.folds = [one.frequency for one in points if one.mark & Mark.FOLD]
    if curve.orbits is not None:
        curve.orbits.span, curve.orbits.periods = scene.frequency_range, periods
        curve.orbits.swept = swept
    return curve


def _one_harmonic_suffices(single: Curve) -> bool:
    """Whether one harmonic gives nearly the exact peaks, and all jumps are at folds.

    Otherwise a sufficient balance takes longer than the exact curve, which often has to be followed anyway.
    """
    near = all(peak.error <= EXACT_CURVES.max_peak_error for peak in single.peaks.values())
    swept = single.swept()
    told = bool(single.folds) or not swept.unknown  # with folds, more harmonics decide
    return single.complete and near and told and _at_folds(swept, single)


def _at_folds(swept: FrequencySweep, curve: Curve) -> bool:
    """Whether each jump is at a fold: other losses of stability are not located here."""
    return all(jump.frequency in curve.folds for jump in swept.jumps)


def _paired(folds: dict[float, OrbitRecord], points: list[OrbitRecord]) -> bool:
    """Whether the folds of the balance are exactly those found in the motion."""
    theirs = sorted(one.frequency for one in folds.values())
    own = sorted(one.frequency for one in points if one.mark & Mark.FOLD)
    return len(theirs) == len(own) and np.allclose(theirs, own, rtol=SHOOTING.peaks.peak_tolerance, atol=0.0)


def _guesses(scene: Scene, curve: Curve) -> Iterator[OrbitGuess]:
    """Yield guesses from the balance: at its nearly highest peaks, and at its folds."""
    if not curve.points:
        return
    for dof in range(curve.amplitude.shape[1]):
        for k in _peaks(curve, dof):
            yield _guess(scene, curve, k, dof)
    for fold in curve.folds:
        for at in np.flatnonzero(curve.frequency == fold):
            yield _guess(scene, curve, int(at), None)


def _peaks(curve: Curve, dof: int) -> list[int]:
    """Indices of points higher than their neighbours, and nearly as high as the highest."""
    a = np.where(np.isfinite(curve.amplitude[:, dof]), curve.amplitude[:, dof], -np.inf)
    padded = np.concatenate(([-np.inf], a, [-np.inf]))
    tops = (a >= padded[:-2]) & (a >= padded[2:]) & (a >= EXACT_CURVES.peak_threshold * a.max()) & (a > 0.0)
    return [int(k) for k in np.flatnonzero(tops)]


def _guess(scene: Scene, curve: Curve, k: int, dof: int | None) -> OrbitGuess:
    there = np.flatnonzero(np.isfinite(curve.frequency))
    neighbour = min((int(i) for i in (k - 1, k + 1) if i in there), default=k)
    z = unknowns(curve, scene, np.array([k, neighbour]), curve.harmonics)
    one, other = (state_of(scene, curve.harmonics, row) for row in z)
    return OrbitGuess(float(curve.frequency[k]), one, (float(curve.frequency[neighbour]), other), dof)


def _jump(scene: Scene, jump: Jump, fold: OrbitRecord | None) -> Jump | None:
    """The jump of the balance moved to its exact fold; None if there is no such jump."""
    if fold is None or not fold.stable:
        return None
    after = _landed(scene, fold, jump.after)
    return None if after is None else Jump(jump.sweep, fold.frequency, fold.measure.amplitude, after)


def _landed(scene: Scene, fold: OrbitRecord, wanted: FloatArray) -> FloatArray | None:
    """The amplitude of another stable motion at a fold, the one closest to wanted; None without any."""
    try:
        found = [one.measure.amplitude for one in near_balance(scene, fold.frequency) if one.stable]
    except SimulationError:
        found = []
    size = fold.measure.amplitude.max()
    others = [one for one in found if np.abs(one - fold.measure.amplitude).max() > 1e-3 * size]
    if not others or not np.isfinite(wanted).all():
        return None
    return min(others, key=lambda one: float(np.abs(one - wanted).max()))
