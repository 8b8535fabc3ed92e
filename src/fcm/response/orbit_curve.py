"""Periodic solutions as a curve of a response: arrays over its points, peaks, folds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray
from fcm.continuation import Mark
from fcm.model.scene import Scene
from fcm.reduction.constant_state_contacts import (
    NotKeptError,
    lost_by,
    whole_contact_loads,
    whole_state,
    whole_states,
)
from fcm.response.coexisting_search import Search
from fcm.response.coexisting_stuck import coexisting_stuck
from fcm.response.curve_batches import lost_curve
from fcm.response.friction_extent import FrictionExtent, friction_extent
from fcm.response.options import SENTENCES
from fcm.response.orbit_branches import OrbitBranches
from fcm.response.stepped_sweep import SteppedSweep
from fcm.response.undetermined_traction import undetermined
from fcm.results.contact_maxima import greatest_of
from fcm.results.jumps import FrequencySweep
from fcm.results.orbits import Orbits, Stuck
from fcm.results.peak import Peak, stability_at_top
from fcm.results.result import Curve
from fcm.shooting.orbit_record import OrbitRecord
from fcm.shooting.period_doubling import bifurcations, flip, flips


def orbit_curve(groups: Sequence[OrbitBranches], reason: str, search: Search) -> Curve:
    """The curve of all points of branches, separated by points of NaN; complete if reason is empty.

    search : search for other motions at their frequencies.

    Raises
    ------
    NotKeptError
        If a held contact would change its state.
    """
    points, folds, scene = list[OrbitRecord | None](), list[float](), groups[0].problem.scene
    changes = list[tuple[str, float]]()
    kept = list[FloatArray]()
    for group in groups:
        for found in group.points:
            folds += [point.frequency for point in found if point.mark & Mark.FOLD]
            changes += [(kind.value, flip(found, k).frequency) for k, kind in bifurcations(found)]
            whole = found
            if scene.held:
                kept += [_kept(scene, found)]
                whole = [_of_whole(scene, one) for one in found]
            points += [None, *whole] if points else whole
    least = np.min(kept, axis=0) if kept else _kept(scene, [])
    if lost := lost_by(least).tolist():  # before the search for other motions
        raise NotKeptError(tuple(lost), reason)
    curve = replace(_curve(scene.whole(), points, reason, search), folds=folds, bifurcations=changes)
    curve.mirrored = sum(group.mirrored for group in groups)
    if curve.orbits is not None:
        curve.orbits.periods = sum(group.problem.periods for group in groups)
        last = groups[-1].points
        curve.orbits.doubles = [flip(found, k).frequency for found in last for k in flips(found)]
        if scene.held:
            curve.orbits.held = least
    return curve


def _of_whole(scene: Scene, point: OrbitRecord) -> OrbitRecord:
    """The record with the held contacts included."""
    states, contact_loads = (
        whole_states(scene, point.states),
        whole_contact_loads(scene, point.contact_loads, point.held[:, 1:]),
    )
    return replace(point, state=whole_state(scene, point.state), states=states, contact_loads=contact_loads)


def _kept(scene: Scene, points: Sequence[OrbitRecord]) -> FloatArray:
    """Least distance (contact, 2) of each held contact from its slip limit or gap; nan for others."""
    kept = np.full((len(scene.contacts) + len(scene.held), 2), np.nan)
    if not points:
        return kept
    least = np.min([point.held[:, 0] for point in points], axis=0, initial=1.0)
    for one, room in zip(scene.held, least, strict=True):
        kept[one.place, int(one.open)] = room
    return kept


def curve_of_points(scene: Scene, points: Sequence[OrbitRecord], reason: str, search: Search) -> Curve:
    """A curve of separate points, with a point of NaN between each two."""
    apart = [one for point in points for one in (None, point)]
    return _curve(scene, apart[1:], reason, search)


def visited_curve(
    scene: Scene, visitor: SteppedSweep, others: Sequence[OrbitRecord], reason: str, search: Search
) -> Curve:
    """The curve of the steady points of the sweeps in order, then others; complete if reason is empty."""
    curve = _curve(scene, [*visitor.points, *others], reason, search, everywhere=True)
    if curve.orbits is not None:
        curve.orbits.sweep = np.array(visitor.sweep + [""] * len(others), dtype="<U4")
        curve.orbits.swept = FrequencySweep(visitor.jumps, [])
    return curve


def _curve(
    scene: Scene, points: Sequence[OrbitRecord | None], reason: str, search: Search, everywhere: bool = False
) -> Curve:
    empty = lost_curve(scene, reason)
    frequency = _numbers(points, "frequency")
    amplitude = _rows(points, "amplitude", empty)
    rows = _told_points(amplitude, everywhere)
    others = friction_extent(scene, points, amplitude, rows, search)
    regime = _regimes(points, len(scene.contacts))
    stuck = coexisting_stuck(scene, [] if search.over else rows, frequency, regime, others)
    told = everywhere | np.isfinite(others.whole)
    # for an irregular motion neither multipliers nor the long-term range of amplitudes are known
    error = np.array([np.nan if p is None or p.repeats == 0 else 0.0 for p in points])
    stable = error + [p is not None and p.stable for p in points]
    of_top = np.full_like(error, np.nan) if everywhere else error  # the greatest visited point is no peak
    at_top = stability_at_top(amplitude, stable).tolist()
    unseen = undetermined(scene, regime) & ~told
    residual = _residual(amplitude, others, unseen)
    zero = np.where(np.isnan(frequency), np.nan, 0.0)  # neither a table nor a truncation
    cycle = _contact_loads(points, empty)
    curve = replace(
        empty,
        frequency=frequency,
        amplitude=amplitude,
        fundamental=_rows(points, "fundamental", empty),
        phase=_rows(points, "phase", empty),
        mean=_rows(points, "mean", empty),
        regime=regime,
        loop=np.full((len(points), *empty.loop.shape[1:]), np.nan),  # the exact cycle has none
        cycle=cycle,
        cycle_error=np.zeros_like(cycle) + error[:, None, None],
        stable=stable,
        table_error=zero,
        error=np.repeat(error[:, None], amplitude.shape[1], axis=1),
        truncation_error=zero,
        complete=not reason,
        undetermined=int(unseen.sum()),
        peaks={
            d: _peak(amplitude[:, i], frequency, of_top, at_top[i], residual[:, i])
            for i, d in enumerate(empty.peaks)
        },
        orbits=_orbits(points, empty, others, stuck),
    )
    curve.greatest = greatest_of(curve)
    return curve


def _orbits(
    points: Sequence[OrbitRecord | None], empty: Curve, others: FrictionExtent, stuck: Sequence[Stuck]
) -> Orbits:
    """Quantities that only exact curves have; stuck : further motions, on no branch and in no family."""
    return Orbits(
        closure_error=_numbers(points, "residual"),
        sweep=np.full(len(points), "", dtype="<U4"),
        repeats=_numbers(points, "repeats"),
        cycle_least=_cycles(points, "least", empty),
        cycle_greatest=_cycles(points, "greatest", empty),
        family_least=others.least,
        family_greatest=others.greatest,
        family_complete=others.whole,
        stuck=[*others.isolated, *stuck],
    )


def _numbers(points: Sequence[OrbitRecord | None], name: str) -> FloatArray:
    """Values (point,) of one number at each point, NaN between branches."""
    return np.array([np.nan if point is None else getattr(point, name) for point in points])


def _rows(points: Sequence[OrbitRecord | None], name: str, empty: Curve) -> FloatArray:
    """One measure of each point, (point, dof)."""
    none = np.full(len(empty.peaks), np.nan)
    rows = [none if point is None else getattr(point.measure, name) for point in points]
    return np.array(rows).reshape(len(points), len(empty.peaks))


def _contact_loads(points: Sequence[OrbitRecord | None], empty: Curve) -> FloatArray:
    """The contact loads at each point, (point, contact, 4)."""
    none = np.full(empty.cycle.shape[1:], np.nan)
    return np.array([none if p is None else p.contact_loads for p in points]).reshape(
        len(points), *none.shape
    )


def _cycles(points: Sequence[OrbitRecord | None], name: str, empty: Curve) -> FloatArray:
    """The least or greatest amplitude of the cycles at each point, (point, dof)."""
    rows = _rows(points, "amplitude", empty)
    for k, point in enumerate(points):
        if point is not None and point.steady is not None:
            rows[k] = getattr(point.steady, name)
    return rows


def _told_points(amplitude: FloatArray, everywhere: bool) -> list[int]:
    """Points at which other motions by residual friction are sought: the peaks, or all points."""
    known = np.isfinite(amplitude).any(axis=1)
    if everywhere:
        return np.flatnonzero(known).tolist()
    return sorted({int(k) for k in np.nanargmax(amplitude, axis=0)}) if known.any() else []


def _regimes(points: Sequence[OrbitRecord | None], contacts: int) -> npt.NDArray[np.str_]:
    rows = [[""] * contacts if point is None else [_short(s) for s in point.states] for point in points]
    return np.array(rows, dtype=str).reshape(len(points), contacts)


def _short(states: str) -> str:
    return states if len(states) <= SENTENCES.max_states else states[: SENTENCES.max_states - 3] + "..."


def _residual(amplitude: FloatArray, others: FrictionExtent, unseen: npt.NDArray[np.bool_]) -> FloatArray:
    """Relative changes of each amplitude (point, dof) by residual friction; NaN where unknown."""
    up, down = others.greatest - amplitude, amplitude - others.least
    change = np.maximum(up, down) / np.where(amplitude > 0.0, amplitude, 1.0)
    unknown = unseen | (np.isfinite(others.greatest).any(axis=1) & (others.whole != 1.0))
    return np.where(unknown[:, None], np.nan, np.where(np.isnan(change), 0.0, np.maximum(change, 0.0)))


def _peak(
    amplitude: FloatArray, frequency: FloatArray, error: FloatArray, stable: float, residual: FloatArray
) -> Peak:
    if not np.isfinite(amplitude).any():
        return Peak(np.nan, np.nan)
    at = int(np.nanargmax(amplitude))
    return Peak(float(amplitude[at]), float(frequency[at]), float(error[at]), stable, float(residual[at]))
