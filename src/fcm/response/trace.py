"""Tracing of one curve of a scene, with all its branches, and the record of its points."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import PAIR, VALIDITY
from fcm.accuracy.refinement import (
    RefinedResponse,
    has_unknown_rival,
    refined_response,
    with_errors,
    with_given_harmonics,
    without_errors,
)
from fcm.accuracy.stability_validity import unreliable_points
from fcm.accuracy.unchecked_response import ResponseInterrupted, UncheckedResponse, points_of
from fcm.at_rest import RestOptions
from fcm.branches.options import FOLDS
from fcm.branches.shakedown import may_wedge, shakedown_at
from fcm.contact.contact_law import ContactLawError
from fcm.continuation import Mark, Path, Status
from fcm.continuation.follow import Progress
from fcm.distinct_values import distinct_values
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.contact_motions import contact_motions
from fcm.harmonic_balance.cost_model import seconds_of
from fcm.harmonic_balance.reported_quantities import PointRecord, recorded, table_errors
from fcm.harmonic_balance.rounding import with_precise_fundamental
from fcm.harmonic_balance.static_equilibrium import RestError, check_contacts_can_close
from fcm.harmonic_balance.stiff_contacts import too_stiff
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.well_posedness import hold_unknown
from fcm.model.scene import FloatArray, Scene
from fcm.response.accuracy_shortfall import shortfall
from fcm.response.best_so_far import BestSoFar, Tell
from fcm.response.incomplete import FLOATING, incomplete
from fcm.response.master_dofs import of_all_dofs, with_master_dofs, with_tops
from fcm.response.options import InterruptedOptions
from fcm.response.refined import Refined, refined
from fcm.response.request import ONE_HARMONIC, Request
from fcm.response.undetermined_traction import residual_changes, undetermined
from fcm.results.cause import Cause
from fcm.results.contact_maxima import greatest_of
from fcm.results.peak import Peak, stability_at_top
from fcm.results.result import Curve
from fcm.run import Interrupted
from fcm.stability.confirmation import confirmed_stable
from fcm.stability.options import STABILITY

METHODS = ("table", "closed-form")
NO_CHECKS = replace(
    PAIR, max_seconds=0.0, max_point_seconds=0.05, max_second_unknowns=0, max_seconds_elsewhere=0.0
)  # after an interruption
IntArray = npt.NDArray[np.intp]


def traced_curve(
    scene: Scene,
    wanted: Request = ONE_HARMONIC,
    poll: Callable[[], None] | None = None,
    tell: Tell | None = None,
    progress: Progress | None = None,
) -> Curve:
    """Trace the response curve of a scene without a sweep.

    poll is called regularly, tell with the state of the calculation, progress with the finished share.

    Raises
    ------
    fcm.run.Interrupted
        With the best curve so far, or the part found of the first one.
    """
    from fcm.response.curve_batches import lost_curve

    begin, so_far = time.perf_counter(), BestSoFar(tell, progress)
    try:
        curve = _traced_curve(scene, wanted, poll, so_far)
    except ContactLawError as useless:  # the check has not covered this motion
        curve = lost_curve(scene, str(useless))
    except KeyboardInterrupt as stopped:
        if isinstance(stopped, ResponseInterrupted):
            so_far.take_part(stopped.response)
        if so_far.found is None:
            raise
        curve = _unfinished(so_far, scene, wanted.options.interrupted)
        curve.seconds = time.perf_counter() - begin
        raise Interrupted([curve]) from None
    curve.seconds = time.perf_counter() - begin
    return curve


def _unfinished(so_far: BestSoFar, scene: Scene, options: InterruptedOptions) -> Curve:
    """The best curve so far, with those errors that can be estimated quickly."""
    assert so_far.found is not None
    whole = so_far.found
    whole.system.work.poll, whole.system.work.tell = int, str  # these do not interrupt
    most = options.max_points(len(scene.contacts) * scene.directions_of_contact)
    few = whole.thinned(most)
    if isinstance(few, RefinedResponse):
        found = few
    elif points_of(few) < points_of(whole) or _seconds_of_errors(few) > options.max_seconds_of_errors:
        found = without_errors(few)
    else:
        found = with_errors(few, np.inf, options=NO_CHECKS)
        so_far.error = found.max_error
    stable = [np.full(len(path.z), np.nan) for path in found.traced.branches.paths]
    if so_far.stable:
        stable = whole.of_thinned(so_far.stable, most)
    every = found if found.system.scene is scene else without_errors(of_all_dofs(found, scene))
    curve = _curve(Refined(found, stable, every=every), quick=True)
    curve.complete, curve.reason, curve.cause = False, so_far.reason(), Cause.INTERRUPTED
    return curve


def _seconds_of_errors(found: UncheckedResponse) -> float:
    """Estimated seconds for comparing each branch with its reference, without continuation."""
    system, probes = found.system, PAIR.probes * len(found.traced.branches.paths)
    count = len(system.harmonics)
    reference = min(max(PAIR.harmonics_factor * count, PAIR.min_harmonic), count + PAIR.max_added)
    return seconds_of(system, probes, reference)


def _traced_curve(scene: Scene, wanted: Request, poll: Callable[[], None] | None, so_far: BestSoFar) -> Curve:
    from fcm.response.curve_batches import lost_curve

    begin = time.process_time()
    system = System(
        with_master_dofs(scene),
        wanted.harmonics or (1,),
        wanted.table,
        wanted.corrected,
        options=wanted.options.balance,
        other_options=wanted.options.others,
    )
    system.work.poll, system.work.tell = so_far.poll if poll is None else poll, so_far.tell_work
    by_need = wanted.harmonics is None
    try:
        check_contacts_can_close(system)
        found = (
            refined_response(
                system, wanted.accuracy, so_far.covered, options=wanted.options.refinement, on_traced=so_far
            )
            if by_need
            else with_given_harmonics(system, so_far.covered, on_traced=so_far)
        )
    except RestError as nowhere:
        return lost_curve(scene, str(nowhere))
    if not found.traced.branches.paths:
        rigid = bool((system.linear.natural == 0.0).any())
        why = "no solution was found at either end of the range; try another range"
        return lost_curve(scene, f"{why}{FLOATING if rigid else too_stiff(system)}")
    so_far(found, found.max_error, ())
    response = refined(found, wanted.accuracy if by_need else None, scene, so_far, so_far.take_stability)
    curve = _curve(response)
    if by_need and curve.complete:
        curve.short_of = shortfall(
            _reported(response), response.lost, wanted.accuracy, time.process_time() - begin
        )
    return curve


def _reported(response: Refined) -> RefinedResponse:
    """The response at all degrees of freedom."""
    return response.every or response.found


def _curve(response: Refined, quick: bool = False) -> Curve:
    """Convert a traced response to a curve: its branches in turn, with a row of NaN between them.

    quick: without results that need further motions.
    """
    found, parts = _reported(response), response.stable
    system, paths = found.system, found.traced.branches.paths
    told = np.concatenate([np.isfinite(one.amplitude).any(axis=1) for one in found.errors])
    points, rounding = with_precise_fundamental(
        system, recorded(system, paths, found.quantities), told if quick else None
    )
    scene, first = system.scene, system.harmonics.index(1)
    ends, rows = np.flatnonzero(np.diff(points.path)) + 1, np.arange(points.path.size)
    rows = np.insert(rows, ends, -1) if ends.size else rows
    contacts = ContactRecord.joined([one.contacts for one in found.errors])
    words, contact_loads, plane = contacts.words, contacts.contact_loads, contact_motions(system, points.z)
    X = 1j * points.X  # from Re(X exp(i theta)) to Im(X exp(i theta))
    reason, nowhere = incomplete(found, points)
    stable = np.where(nowhere, 0.0, np.concatenate(parts))  # a structure that creeps or floats is not steady
    truncations = [one.truncation for one in found.errors]
    believed = [one.on_same_branch for one in found.errors]
    folds = (points.mark & Mark.FOLD) > 0
    far = unreliable_points(points.z[:, -1], believed, stable, folds, system.option(VALIDITY))
    doubted = far & (stable == 1.0)
    beside = (doubted | np.isnan(stable)) & np.isfinite(np.concatenate(believed))
    not_confirmed = 0
    for k in distinct_values(points.path[doubted | beside]).tolist() if not quick else ():
        of = points.path == k
        own = points.z[of], doubted[of], beside[of]
        sure = confirmed_stable(system, *own, system.option(STABILITY), found.errors[k].motions)
        stable[of] = np.where(sure.stable, 1.0, stable[of])
        doubted[of] &= ~sure.stable
        not_confirmed += int(doubted[of].sum()) if sure.limited else 0
    stable[doubted] = np.nan
    if not quick:  # with more harmonics the branch turns back earlier
        ended = np.concatenate([one.ends_before for one in found.errors])
        stable[np.isnan(stable) & ended] = 0.0
    stable[hold_unknown(system, points.z, points.force) & (stable == 1.0)] = np.nan
    peak = np.array((found.peak, found.peak_frequency))
    if response.exceeded:
        peak[:] = np.nan
    error, at_frequency = (
        np.maximum(np.concatenate(each), rounding)
        for each in zip(*((one.amplitude, one.at_frequency) for one in found.errors), strict=True)
    )
    open_to_past = undetermined(scene, words)
    residual = residual_changes(system, points.z, points.amplitude, words, open_to_past, quick)
    curve = Curve(
        parameters=dict(scene.parameters),
        frequency=pick(points.z[:, -1], rows),
        amplitude=pick(points.amplitude, rows),
        fundamental=pick(np.abs(X[:, first]), rows),
        phase=pick(np.angle(X[:, first]), rows),
        mean=pick(points.mean, rows),
        regime=pick(words, rows),
        loop=pick(contacts.loop, rows),
        cycle=pick(_without_slip_of_own_laws(scene, contact_loads), rows),
        cycle_error=pick(np.concatenate([one.contact_loads for one in found.errors]), rows),
        stable=pick(stable, rows),
        table_error=pick(table_errors(system, points), rows),
        error=pick(error, rows),
        error_at_frequency=pick(at_frequency, rows),
        truncation_error=pick(np.concatenate(truncations), rows),
        complete=not reason,
        reason=reason,
        peaks=_peaks(scene, points, peak, rounding, stable, residual),
        folds=points.z[folds, -1].tolist(),
        bifurcations=response.bifurcations,
        seconds=0.0,
        evaluations=sum(path.evaluations for path in paths),
        harmonics=system.harmonics,
        harmonic=pick(X, rows) if len(system.harmonics) > 1 else None,
        across=None if plane is None else plane.at(rows),
        undetermined=int(open_to_past.sum()),
        uncertain_at=[one.omega for one in found.traced.found if not one.complete],
        folds_uncertain_at=list(found.traced.folds_lost),
        symmetry_lost=list(found.traced.symmetry_lost),
        shakedown_at=np.nan if quick else shakedown_at(system, points.z[:, -1], words),
        may_wedge=not quick and bool((stable == 0.0).any()) and not system.own_laws and may_wedge(scene),
        levels=[one.omega for one in found.traced.found],
        folds_between=(FOLDS.min_level, FOLDS.max_level) if scene.contacts else None,
        isolated=tuple(k for k, path in enumerate(paths) if _is_isolated(path)),
        mirrored=len(found.traced.mirrored),
        not_confirmed=not_confirmed,
    )
    contact_load_errors = _of_greatest(found, points.path, contact_loads)
    if system.table is not None:
        laws = {id(one): one for one in (system.coefficients, response.found.system.coefficients)}
        system.table.outside += sum(getattr(one, "outside", 0) for one in laws.values())
    curve.greatest = greatest_of(
        curve, np.full_like(contact_load_errors, np.nan) if response.exceeded else contact_load_errors
    )
    if response.found is not found:
        curve.peaks = with_tops(curve.peaks, found)
    return curve


def _is_isolated(path: Path) -> bool:
    """Whether a path is an isola: closed, and without a branch point."""
    return path.status is Status.CLOSED and not path.where(Mark.BRANCH).any()


def _without_slip_of_own_laws(scene: Scene, contact_loads: FloatArray) -> FloatArray:
    """The contact loads (point, contact, 4), with NaN for the slip path of laws of one's own."""
    own = [i for i, one in enumerate(scene.contacts) if one.law is not None]
    if own:
        contact_loads = contact_loads.copy()
        contact_loads[:, own, 2] = np.nan
    return contact_loads


def _of_greatest(found: RefinedResponse, path: IntArray, contact_loads: FloatArray) -> FloatArray:
    """Errors (contact, 4) of the greatest contact loads over all paths; contact_loads (point, contact, 4).

    NaN where the error of a load of another path that is nearly as great is unknown.
    """
    heights = np.array([contact_loads[path == k].max(axis=0) for k in range(len(found.errors))])
    errors = np.array([one.greatest for one in found.errors])
    own = np.take_along_axis(errors, heights.argmax(axis=0)[None], axis=0)[0]
    return np.where(has_unknown_rival(errors, heights, PAIR), np.nan, own)


def _peaks(
    scene: Scene,
    points: PointRecord,
    error: FloatArray,
    rounding: FloatArray,
    stable: FloatArray,
    residual: FloatArray,
) -> dict[str, Peak]:
    """The greatest peak of each degree of freedom, with its errors.

    All peaks are points of the curve. error (2, dof) has the errors in amplitude and frequency.
    """
    highest, amplitude = points.amplitude.argmax(axis=0), points.amplitude
    at_top = stability_at_top(amplitude, stable).tolist()
    digits = _rounding_of_peaks(points, rounding, scene.of_matrices)
    found = {}
    for d, (dof, i) in enumerate(zip(scene.modal.dofs, highest, strict=True)):
        height, omega = float(amplitude[i, d]), float(points.z[i, -1])
        off, off_frequency = float(max(error[0, d], rounding[i, d])), float(error[1, d])
        found[dof] = Peak(height, omega, off, at_top[d], float(residual[d]), off_frequency, float(digits[d]))
    return found


def _rounding_of_peaks(points: PointRecord, rounding: FloatArray, computed: bool) -> FloatArray:
    """Relative rounding (dof,) of the greatest amplitudes; -1 where no contact is stiff: not estimated.

    computed: the mode shapes come from an eigensolver and have rounding errors. A displacement as small as
    these, relative to the greatest, has no correct digits.
    """
    highest, dofs = points.amplitude.argmax(axis=0), np.arange(points.amplitude.shape[1])
    if not rounding.any():
        return np.full(dofs.size, -1.0)
    size: FloatArray = points.amplitude[highest, dofs]
    found: FloatArray = rounding[highest, dofs]
    if computed:
        of_shapes = RestOptions().displacement * size.max(initial=0.0)
        found = np.fmax(found, np.divide(of_shapes, size, out=np.zeros_like(size), where=size > 0.0))
    return found


def pick(values: npt.NDArray[Any], rows: IntArray) -> npt.NDArray[Any]:
    """Rows of an array at indices; NaN or '' where an index is -1."""
    if len(rows) == len(values):  # no gap
        return np.ascontiguousarray(values)
    out = values[rows]
    out[rows < 0] = "" if values.dtype.kind == "U" else np.nan
    return out
