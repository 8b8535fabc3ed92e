"""Response against the level of the harmonic forces at fixed frequencies.

Static loads keep their full size; level 0 is the equilibrium under the static loads.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.accuracy.level_errors import LevelPoints, errors_at_levels, stable_at_levels
from fcm.accuracy.options import VALIDITY
from fcm.accuracy.required_harmonics import dofs_of_interest
from fcm.branches.force_level import LevelRange, level_curve
from fcm.branches.linear_limits import highest_linear_limit
from fcm.continuation import Mark, Status
from fcm.continuation.path import Path
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.contact_motions import contact_motions
from fcm.harmonic_balance.cost_model import with_twice_as_many
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.sampled_law import check_own_laws
from fcm.harmonic_balance.static_equilibrium import RestError, check_contacts_can_close
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.response.accuracy_shortfall import exact_is_advised, remedy
from fcm.response.curve_batches import anonymous, lost_curve
from fcm.response.incomplete import holds_unknown, no_steady_states, reason_for
from fcm.response.options import INPUT_LIMITS, ResponseOptions
from fcm.response.request import Request, ResponseError, request_of
from fcm.response.ring_limits import check_modes
from fcm.response.serial_sweep import Tell, one_by_one
from fcm.response.trace import IntArray, pick
from fcm.response.undetermined_traction import residual_changes_at_levels, undetermined
from fcm.results.at_rest import without_rounding
from fcm.results.cause import Cause
from fcm.results.contact_maxima import greatest_of
from fcm.results.peak import Peak, stability_at_top
from fcm.results.result import INTERRUPTED, NOT_BEGUN, Curve, Response
from fcm.run import IN_THIS_PROCESS, Execution, fingerprint
from fcm.scene.errors import counted
from fcm.units import EXCITATION, UNIT, in_unit


class LevelRequest(Frozen):
    """Request for curves over a span of levels of the forces, at frequencies in the scene's unit."""

    frequencies: Sequence[float]
    span: tuple[float, float]


def trace_levels(
    scene: Scene,
    asked: LevelRequest,
    execution: Execution = IN_THIS_PROCESS,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    options: ResponseOptions | None = None,
) -> Response:
    """Trace a curve against the level for each curve of the scene and each frequency.

    A curve begins at rest and is followed through its folds until the level has left the span for good. It
    has the given harmonics, or as many as a relative accuracy needs, of the greatest amplitudes and of the
    motions at level 1. Without either, the scene decides. Errors are the changes by the harmonics left out at
    the same level, NaN where unknown, as beside folds. The checkpoint keeps finished curves, which are not
    followed again.

    Raises
    ------
    ResponseError
        If the span or a frequency is out of range.
    KeyboardInterrupt
        If no curve is finished; else the finished curves are returned.
    """
    (low, high), at = asked.span, asked.frequencies
    if fault := level_fault(low, high):
        raise ResponseError(f"level is from {low:g} to {high:g}: {fault}")
    if not all(np.isfinite(f) and f > 0.0 for f in at):
        raise ResponseError("a frequency must be finite and greater than 0")
    begin = time.perf_counter()
    request = request_of(scene, harmonics, accuracy, options)
    check_own_laws(scene)
    check_modes(scene, request)
    ways = [
        (curve, frequency * UNIT[scene.frequency_unit]) for curve in scene.each_curve() for frequency in at
    ]
    tasks = [
        (
            _without(curve, omega, NOT_BEGUN, Cause.INTERRUPTED),
            partial(_level_curve, curve, request, omega, asked.span),
        )
        for curve, omega in ways
    ]
    of_curves = (request, tuple(at), asked.span, anonymous(scene.each_curve()))
    mark = b"" if execution.keep is None else fingerprint("level", *of_curves)
    curves = [without_rounding(one) for one in one_by_one(tasks, execution, mark)]
    response = Response.of(scene, curves, "level of the forces")
    response.seconds = time.perf_counter() - begin
    return response


def span_fault(low: float, high: float) -> str:
    """Text on the fault of a span of levels, of the forces or of a mode; empty if it is valid."""
    return "" if 0.0 <= low < high else "the levels must rise, from 0 or more"


def level_fault(low: float, high: float) -> str:
    """Text on the fault of a span of levels of the forces; empty if it is valid."""
    if fault := span_fault(low, high):
        return fault
    if high > INPUT_LIMITS.max_level:
        return f"a level beyond {INPUT_LIMITS.max_level:g} is a mistake of units"
    return (
        ""
        if high > INPUT_LIMITS.min_level
        else f"up to a level of {INPUT_LIMITS.min_level:g} there is but rest"
    )


def _without(scene: Scene, omega: float, reason: str, cause: Cause = Cause.CALCULATION) -> Curve:
    """A curve without points, with the reason."""
    parameters = {**scene.parameters, EXCITATION: float(in_unit(omega, scene.frequency_unit))}
    return replace(lost_curve(scene, reason, cause), parameters=parameters, level=np.empty(0))


def _level_curve(
    scene: Scene, request: Request, omega: float, span: tuple[float, float], tell: Tell
) -> Curve:
    """The curve with the harmonics of the request, or with more and more until the accuracy is reached."""
    begin, stopped = time.perf_counter(), ""
    system = request.system(scene)
    curve = _followed(system, omega, span, tell)
    while request.harmonics is None and curve.complete and not _worst(curve, scene) <= request.accuracy:
        more = with_twice_as_many(system, curve.evaluations)
        if more is None:
            break
        try:
            tell(f"with {len(more.harmonics)} harmonics")
            then = _followed(more, omega, span, tell)
        except KeyboardInterrupt:
            stopped = f"{INTERRUPTED} before it was known with {len(more.harmonics)} harmonics"
            break
        if not then.complete:
            break
        system, curve = more, then
    if stopped:
        curve.complete, curve.reason, curve.cause = False, stopped, Cause.INTERRUPTED
    elif (
        request.harmonics is None
        and curve.complete
        and not (worst := _worst(curve, scene)) <= request.accuracy
    ):
        what = (
            "the errors of some peaks are unknown"
            if np.isnan(worst)
            else f"an estimated error of {worst:.1e} remains"
        )
        count = counted(len(system.harmonics), "harmonic")
        helps = remedy(system.harmonics, exact=exact_is_advised(scene))
        curve.short_of = f"with {count} {what}. {helps}"
    curve.seconds = time.perf_counter() - begin
    return curve


def _worst(curve: Curve, scene: Scene) -> float:
    """Greatest error of the peaks and of the motions at level 1 whose error is known.

    NaN if the error of a peak is unknown. Degrees of freedom that hardly move do not count.
    """
    assert curve.level is not None
    height = np.nanmax(curve.amplitude, axis=0)
    moves = dofs_of_interest(scene, height)
    peaks = np.array([peak.error for peak in curve.peaks.values()])[moves]
    there = curve.error[curve.level == 1.0][:, moves]
    return float(np.max([*peaks, *there[np.isfinite(there)]], initial=0.0))


def _followed(system: System, omega: float, span: tuple[float, float], tell: Tell) -> Curve:
    """The curve with the harmonics of a system."""
    try:
        check_contacts_can_close(system)
        system.rest  # noqa: B018  # computed and cached
    except RestError as error:
        return _without(system.scene, omega, str(error))
    # parts that fold back into the span from above belong to the curve
    followed = (span[0], max(span[1], highest_linear_limit(system, omega)))
    beyond = (followed[1] - followed[0]) / (span[1] - span[0])
    levels = LevelRange(
        followed, system.scene.max_step, (1.0, span[1]), progress=lambda share: tell.covered(share * beyond)
    )
    path = level_curve(system, omega, levels)
    inside = np.flatnonzero((path.parameter >= span[0]) & (path.parameter <= span[1]))
    curve = _without(system.scene, omega, "no response was found at the least level")
    if inside.size:
        curve = replace(curve, **_points(system, path, inside, omega))
        curve.greatest = greatest_of(curve)
        whole, last = path.status is Status.COMPLETE, path.parameter[inside[-1]]
        curve.harmonics, curve.evaluations = system.harmonics, path.evaluations
        curve.reason = curve.reason if whole else f"stopped at level {last:.6g}: {path.status.value}"
        curve.complete = not curve.reason
    return curve


def _points(system: System, path: Path, inside: IntArray, omega: float) -> dict[str, Any]:
    """Contents of a `Curve` at the points of a path inside the span, with NaN where the path leaves it."""
    left = np.flatnonzero(np.diff(inside) > 1) + 1
    rows = np.insert(np.arange(inside.size), left, -1)  # -1: outside the span
    level, z = path.parameter[inside], path.z[inside].copy()
    z[:, -1] = omega
    reported = reported_at(system, z, level=level)
    X, mean, amplitude = reported.X, reported.mean, reported.amplitude
    X = 1j * X
    first, parity = X[:, system.harmonics.index(1)], path.parity[inside]
    loop = loops(system, z)
    words, contact_loads = cycles(system, z, loop)
    points = LevelPoints(z, level, amplitude, contact_loads, parity)
    error, contact_load_errors = errors_at_levels(system, points)
    truncation = (error * amplitude).max(axis=1) / np.where(size := amplitude.max(axis=1), size, 1.0)
    stable = stable_at_levels(system, z, parity)
    # where the truncation error is large, the solution may not exist with more harmonics
    known = truncation <= system.option(VALIDITY).max_error
    lost = no_steady_states(system, z, level)
    known &= ~holds_unknown(system, z, level)
    stable[~known & (stable == 1.0)] = np.nan
    for which in lost.values():
        stable[which] = 0.0  # a structure that creeps or floats has no steady state
    of_points = {
        "frequency": np.full(level.size, omega),
        "level": level,
        "amplitude": amplitude,
        "fundamental": np.abs(first),
        "phase": np.angle(first),
        "mean": mean,
        "regime": words,
        "loop": loop,
        "cycle": contact_loads,
        "cycle_error": contact_load_errors,
        "stable": stable,
        "table_error": np.zeros(level.size),
        "error": error,
        "truncation_error": truncation,
    }
    if len(system.harmonics) > 1:
        of_points["harmonic"] = X
    plane, tops = contact_motions(system, z), amplitude.argmax(axis=0)
    residual = residual_changes_at_levels(system, z, level, amplitude, words).tolist()
    at_top = stability_at_top(amplitude, stable).tolist()
    folds = level[(path.mark[inside] & Mark.FOLD) > 0]
    of_curve = {
        "peaks": {
            dof: Peak(
                float(amplitude[i, d]),
                omega,
                float(error[i, d]),
                at_top[d],
                residual[d],
                level=float(level[i]),
            )
            for d, (dof, i) in enumerate(zip(system.scene.modal.dofs, tops, strict=True))
        },
        "level_folds": folds.tolist(),
        "undetermined": int(undetermined(system.scene, words).sum()),
        "reason": _unsteady_ranges(system, level, lost),
        "across": None if plane is None else plane.at(rows),
    }
    return {name: pick(values, rows) for name, values in of_points.items()} | of_curve


def _unsteady_ranges(system: System, level: FloatArray, lost: Mapping[str, npt.NDArray[np.bool_]]) -> str:
    """Sentence on the range of levels without a steady state, and why; empty if there is one everywhere."""
    for why, which in lost.items():
        if which.any():
            return (
                f"from level {level[which].min():.5g} to {level[which].max():.5g} {reason_for(system, why)}"
            )
    return ""
