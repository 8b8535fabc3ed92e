"""One curve of a scene: every branch of it traced, and its points recorded."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import PAIR
from fcm.accuracy.refinement import Accurate, accurate, enlarged, finer, given, judged
from fcm.accuracy.stability_limits import Lost, lost_along, moved
from fcm.accuracy.stability_validity import astray, disbelieved
from fcm.branches.options import FOLDS
from fcm.contact.contact_law import ContactLawError
from fcm.continuation import Mark
from fcm.harmonic_balance.planar_quantities import in_plane
from fcm.harmonic_balance.reported_quantities import Reported, reported_at
from fcm.harmonic_balance.residual_traction import peak_changes
from fcm.harmonic_balance.response_quantities import Record, cycles, loops, recorded
from fcm.harmonic_balance.rounding import with_digits
from fcm.harmonic_balance.static_equilibrium import RestError
from fcm.harmonic_balance.stiff_contacts import too_stiff
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.response.accuracy_shortfall import short_of
from fcm.response.all_branches import with_all_branches
from fcm.response.best_so_far import SoFar, Tell
from fcm.response.further_levels import with_levels_where_unstable
from fcm.response.incomplete import FLOATING, incomplete
from fcm.response.master_dofs import leading, of_all, with_tops
from fcm.response.request import ONE_HARMONIC, Request
from fcm.response.undetermined_traction import undetermined
from fcm.results.cause import Cause
from fcm.results.contact_maxima import greatest_of
from fcm.results.peak import Peak, stability_at_top
from fcm.results.result import Curve
from fcm.run import Interrupted
from fcm.stability.bifurcations import Inserted, stability, with_points
from fcm.structure.linear import Linear

METHODS = ("table", "closed-form")
ROUNDS = 2  # of more harmonics, for the frequencies at which stability is lost: what is left is said
QUICK = replace(PAIR, seconds=0.0, points=0.05, dearest=0)  # where nobody waits any more
Rows = npt.NDArray[np.intp]


def traced_curve(
    scene: Scene,
    wanted: Request = ONE_HARMONIC,
    poll: Callable[[], None] | None = None,
    tell: Tell | None = None,
) -> Curve:
    """The response curve of a scene without a sweep; poll is called now and then, tell with what there is.

    Raises
    ------
    fcm.run.Interrupted
        With the best curve that there is, where an interruption comes after the first.
    """
    from fcm.response.groups import lost_curve

    begin, so_far = time.perf_counter(), SoFar(tell)
    try:
        curve = _traced_curve(scene, wanted, poll, so_far)
    except ContactLawError as useless:  # of a motion that was not tried before
        curve = lost_curve(scene, str(useless))
    except KeyboardInterrupt:
        if so_far.found is None:
            raise
        curve = _unfinished(so_far, scene)
        curve.seconds = time.perf_counter() - begin
        raise Interrupted([curve]) from None
    curve.seconds = time.perf_counter() - begin
    return curve


def _unfinished(so_far: SoFar, scene: Scene) -> Curve:
    """The best curve that there is, with its errors as far as they are told quickly."""
    assert so_far.found is not None
    found = so_far.found
    found.system.work.poll = int  # which interrupts no more
    if not isinstance(found, Accurate):
        found = judged(found, np.inf, options=QUICK)
    stable = [np.full(len(path.z), np.nan) for path in found.traced.branches.paths]
    if found.system.scene is not scene:
        found = of_all(found, scene, np.inf)
    curve = _curve(_Followed(found, stable, []), quick=True)
    curve.complete, curve.reason, curve.cause = False, so_far.reason(), Cause.INTERRUPTED
    return curve


def _traced_curve(scene: Scene, wanted: Request, poll: Callable[[], None] | None, so_far: SoFar) -> Curve:
    from fcm.response.groups import lost_curve

    system = System(leading(scene), wanted.harmonics or (1,), wanted.table, wanted.corrected)
    system.work.poll = poll or system.work.poll
    by_need = wanted.harmonics is None
    try:
        found = accurate(system, wanted.accuracy, keep=so_far) if by_need else given(system, keep=so_far)
    except RestError as nowhere:
        return lost_curve(scene, str(nowhere))
    if wanted.table is not None:
        wanted.table.outside += getattr(system.coarse, "outside", 0)
    if not found.traced.branches.paths:
        rigid = bool((system.linear.natural == 0.0).any())
        why = "no solution was found at either end of the range; try another range"
        return lost_curve(scene, f"{why}{FLOATING if rigid else too_stiff(system)}")
    so_far(found, found.worst, ())
    followed = _followed(found, wanted.accuracy if by_need else None)
    if by_need:
        followed = _with_jumps(followed, wanted.accuracy)
    if system.scene is scene:
        curve = _curve(followed)
    else:
        followed = _with_all(followed, scene, wanted.accuracy if by_need else np.inf)
        curve = _curve(followed)
        curve.peaks = with_tops(curve.peaks, followed.found)
    if by_need and curve.complete:
        curve.short_of = short_of(followed.found, followed.lost, wanted.accuracy)
    return curve


@dataclass(frozen=True)
class _Followed:
    """A response with the points at which stability changes, and whether each point is stable.

    lost: how far the frequencies are off at which it changes without a fold, where harmonics are chosen.
    exceeded: whether more harmonics have a higher branch, where they are given.
    bifurcations: how stability changes without a fold, and where [rad/s]."""

    found: Accurate
    stable: list[FloatArray]
    lost: list[Lost]
    exceeded: bool = False
    bifurcations: list[tuple[str, float]] = field(default_factory=list)


def _with_jumps(followed: _Followed, accuracy: float) -> _Followed:
    """With as many harmonics as it takes to have the frequencies at which stability is lost accurately."""
    for _ in range(ROUNDS):
        off = [one for one in followed.lost if not one.error <= accuracy]
        more = {h for one in off for h in one.harmonics} | set(followed.found.system.harmonics)
        if len(more) == len(followed.found.system.harmonics):
            break
        again = finer(followed.found, tuple(sorted(more)), accuracy)
        if again is None:
            break
        then = _followed(again, accuracy)
        followed = replace(then, lost=moved(then.lost, followed.lost))
    return followed


def _with_all(followed: _Followed, scene: Scene, accuracy: float) -> _Followed:
    """With all degrees of freedom of a scene, of those that lead; with more harmonics if one takes them."""
    for _ in range(ROUNDS if followed.found.reached else 0):
        every = of_all(followed.found, scene, accuracy)
        if every.reached:
            return replace(followed, found=every)
        again = finer(followed.found, enlarged(every, accuracy), accuracy)
        if again is None:
            return replace(followed, found=every)
        followed = _followed(again, accuracy)
        del every  # which may be large
    return replace(followed, found=of_all(followed.found, scene, accuracy))


def _curve(followed: _Followed, quick: bool = False) -> Curve:
    """What was traced as a curve: branches one after the other, with a row of NaN between them.

    quick: without what takes further motions to tell."""
    found, parts = followed.found, followed.stable
    system, paths = found.system, found.traced.branches.paths
    points, rounding = with_digits(system, recorded(system, paths, found.shown))
    scene, first = system.scene, system.harmonics.index(1)
    ends, rows = np.flatnonzero(np.diff(points.path)) + 1, np.arange(points.path.size)
    rows = np.insert(rows, ends, -1) if ends.size else rows
    loop, plane = loops(system, points.z), in_plane(system, points.z)
    words, borne = cycles(system, points.z, loop)
    X = 1j * points.X  # from Re(X exp(i theta)) to Im(X exp(i theta))
    reason, nowhere = incomplete(found, points)
    stable = np.where(nowhere, 0.0, np.concatenate(parts))  # what creeps away, or floats, is no steady state
    truncations = [one.truncation for one in found.errors]
    believed = [one.believed for one in found.errors]
    far = disbelieved(points.z[:, -1], believed, stable, (points.mark & Mark.FOLD) > 0)
    stable[far & (stable == 1.0)] = np.nan
    peak = np.full_like(found.peak, np.nan) if followed.exceeded else found.peak
    error = np.maximum(np.concatenate([one.amplitude for one in found.errors]), rounding)
    open_to_past = undetermined(scene, words)
    residual = _residual_changes(system, points, words, open_to_past, quick)
    curve = Curve(
        parameters=dict(scene.parameters),
        frequency=pick(points.z[:, -1], rows),
        amplitude=pick(points.amplitude, rows),
        fundamental=pick(np.abs(X[:, first]), rows),
        phase=pick(np.angle(X[:, first]), rows),
        mean=pick(points.mean, rows),
        regime=pick(words, rows),
        loop=pick(loop, rows),
        cycle=pick(_without_slip_of_own_laws(scene, borne), rows),
        cycle_error=pick(np.concatenate([one.borne for one in found.errors]), rows),
        stable=pick(stable, rows),
        table_error=pick(points.shift, rows),
        error=pick(error, rows),
        truncation_error=pick(np.concatenate(truncations), rows),
        complete=not reason,
        reason=reason,
        peaks=_peaks(scene.modal.dofs, points, peak, rounding, stable, residual),
        folds=points.z[(points.mark & Mark.FOLD) > 0, -1].tolist(),
        bifurcations=followed.bifurcations,
        seconds=0.0,
        evaluations=sum(path.evaluations for path in paths),
        harmonics=system.harmonics,
        harmonic=pick(X, rows) if len(system.harmonics) > 1 else None,
        in_plane=None if plane is None else plane.at(rows),
        undetermined=int(open_to_past.sum()),
        unsure=[one.omega for one in found.traced.found if not one.complete],
        folds_unsure=list(found.traced.folds_lost),
        symmetry_lost=list(found.traced.symmetry_lost),
        levels=[one.omega for one in found.traced.found],
        digits=bool(rounding.any()),
        folds_between=(FOLDS.lowest, FOLDS.highest) if scene.contacts else None,
        mirrored=len(found.traced.mirrored),
    )
    of_borne = _of_greatest(found, points.path, borne)
    curve.greatest = greatest_of(curve, np.full_like(of_borne, np.nan) if followed.exceeded else of_borne)
    return curve


def _without_slip_of_own_laws(scene: Scene, borne: FloatArray) -> FloatArray:
    """What contacts bear (point, contact, 4), with NaN for the way of the slip where the law is one's own."""
    own = [i for i, one in enumerate(scene.contacts) if one.law is not None]
    if own:
        borne = borne.copy()
        borne[:, own, 2] = np.nan
    return borne


def _of_greatest(found: Accurate, path: Rows, borne: FloatArray) -> FloatArray:
    """Errors (contact, 4) of the greatest forces, slip and energy of all paths, which are borne
    (point, contact, 4); unknown where that of one nearly as great is."""
    heights = np.array([borne[path == k].max(axis=0) for k in range(len(found.errors))])
    errors = np.array([one.greatest for one in found.errors])
    unknown = (np.isnan(errors) & (heights > PAIR.rival * heights.max(axis=0))).any(axis=0)
    own = np.take_along_axis(errors, heights.argmax(axis=0)[None], axis=0)[0]
    return np.where(unknown, np.nan, own)


def _followed(found: Accurate, accuracy: float | None) -> _Followed:
    """A response with every branch, and its stability."""
    most = np.inf if accuracy is None else accuracy
    followed = _with_stability(_Followed(with_all_branches(found, accuracy), [], []), accuracy)
    more, exceeded = with_levels_where_unstable(followed.found, followed.stable, most)
    return _with_stability(replace(followed, found=more, exceeded=exceeded), accuracy)


def _with_stability(followed: _Followed, accuracy: float | None) -> _Followed:
    """With points where stability changes between folds, and whether each point is stable, for the branches
    of which that is not known yet.

    With an accuracy, and how far it is from where more harmonics have these; not of a curve that has not come
    to it, and is said not to: of that nothing is looked for where it has long lost that of more harmonics.
    """
    found, stable, lost = followed.found, list(followed.stable), list(followed.lost)
    bifurcations = list(followed.bifurcations)
    short, known = accuracy is not None and not found.reached, len(stable)
    every = found.traced.branches.paths
    paths, shown, errors = list(every[:known]), list(found.shown[:known]), list(found.errors[:known])
    for path, seen, error in zip(every[known:], found.shown[known:], found.errors[known:], strict=True):
        judged = stability(found.system, path, astray(error.believed) if short else None)
        inserted = judged.inserted
        bifurcations += [(one.kind.value, one.frequency) for one in judged.crossings]
        if accuracy is not None and not short:
            lost += lost_along(found.system, path, judged.crossings, accuracy)
        if not inserted:
            paths.append(path)
            shown.append(seen)
            errors.append(error)
            stable.append(judged.stable)
            continue
        after = np.array([one.after for one in inserted], dtype=np.intp)
        paths.append(with_points(path, inserted))
        shown.append(_with_reported(found.system, seen, inserted, after))
        errors.append(
            replace(
                error,
                amplitude=_between(error.amplitude, after),
                truncation=_between(error.truncation, after),
                met=np.insert(error.met, after + 1, error.met[after]),
                borne=_between(error.borne, after),
            )
        )
        stable.append(np.insert(judged.stable, after + 1, [one.stable for one in inserted]))
    branches = replace(found.traced.branches, paths=tuple(paths))
    traced = replace(found.traced, branches=branches)
    found = replace(found, traced=traced, shown=tuple(shown), errors=tuple(errors))
    return replace(followed, found=found, stable=stable, lost=lost, bifurcations=bifurcations)


def _with_reported(system: System, known: Reported, inserted: Sequence[Inserted], after: Rows) -> Reported:
    """With what is reported of points inserted after some others."""
    z, direction = (np.array([getattr(one, name) for one in inserted]) for name in ("z", "direction"))
    return known.with_rows(after, reported_at(system, z, direction))


def _between(values: FloatArray, after: Rows) -> FloatArray:
    """With the means of neighbours inserted after some rows."""
    means = 0.5 * (values[after] + values[np.minimum(after + 1, len(values) - 1)])
    return np.insert(values, after + 1, means, axis=0)


def _residual_changes(
    system: System,
    points: Record,
    words: npt.NDArray[np.str_],
    undetermined: npt.NDArray[np.bool_],
    quick: bool,
) -> FloatArray:
    """By how much residual friction may change each peak (dof,), see `harmonic_balance.residual_traction`."""
    top, contacts = points.amplitude.argmax(axis=0), system.scene.contacts
    if not undetermined[top].any():
        return np.zeros(top.size)
    if quick or type(system.linear) is not Linear:
        return np.where(undetermined[top], np.nan, 0.0)
    rough = np.array([one.mu * one.k_u > 0.0 for one in contacts], dtype=np.bool_)
    stuck = (words[top] == "E") & rough & undetermined[top, None]
    return peak_changes(system, points.z, points.amplitude, top, stuck)


def _peaks(
    dofs: tuple[str, ...],
    points: Record,
    error: FloatArray,
    rounding: FloatArray,
    stable: FloatArray,
    residual: FloatArray,
) -> dict[str, Peak]:
    """Where each degree of freedom is greatest: at a point, for every peak is one."""
    highest, amplitude = points.amplitude.argmax(axis=0), points.amplitude
    at_top = stability_at_top(amplitude, stable).tolist()
    found = {}
    for d, (dof, i) in enumerate(zip(dofs, highest, strict=True)):
        off = float(max(error[d], rounding[i, d]))
        found[dof] = Peak(float(amplitude[i, d]), float(points.z[i, -1]), off, at_top[d], float(residual[d]))
    return found


def pick(values: npt.NDArray[Any], rows: Rows) -> npt.NDArray[Any]:
    """Rows of a curve: all in order, but for gaps of NaN or '' where an index is -1."""
    if len(rows) == len(values):  # no gap
        return np.ascontiguousarray(values)
    out = values[rows]
    out[rows < 0] = "" if values.dtype.kind == "U" else np.nan
    return out
