"""Nonlinear modes of a scene: frequency and damping of a mode against its amplitude, for each curve."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import numpy.typing as npt

from fcm.accuracy.contact_load_errors import relative
from fcm.accuracy.options import PAIR
from fcm.continuation import Mark, Status
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.contact_motions import contact_motions
from fcm.harmonic_balance.cost_model import with_twice_as_many
from fcm.harmonic_balance.static_equilibrium import RestError, check_contacts_can_close
from fcm.harmonic_balance.wave_extremes import half_peak_to_peak
from fcm.model.scene import FloatArray, Scene
from fcm.nonlinear_modes.backbone import Mode, ModeError, nonlinear_mode, truncation
from fcm.nonlinear_modes.forced_response import at_amplitude, flanks, modal_force, resonances, resonant_level
from fcm.nonlinear_modes.options import NONLINEAR_MODE
from fcm.response.accuracy_shortfall import remedy
from fcm.response.curve_batches import anonymous, lost_curve
from fcm.response.incomplete import no_steady_states, reason_for
from fcm.response.options import INPUT_LIMITS, ResponseOptions
from fcm.response.request import Request, ResponseError, request_of
from fcm.response.ring_limits import check_no_ring, refuse_other_harmonics, refuse_own_laws
from fcm.response.serial_sweep import Tell, one_by_one
from fcm.response.trace import pick
from fcm.response.undetermined_traction import undetermined
from fcm.results.at_rest import without_rounding
from fcm.results.cause import Cause
from fcm.results.contact_maxima import greatest_of
from fcm.results.nonlinear_mode import InternalResonance, MotionOfMode, NonlinearMode, Resonance
from fcm.results.result import INTERRUPTED, NOT_BEGUN, Curve, Response
from fcm.run import IN_THIS_PROCESS, Execution, fingerprint
from fcm.scene.errors import counted
from fcm.units import in_unit


class ModeRequest(Frozen):
    """Request for a nonlinear mode over a span of modal amplitudes.

    The modal amplitude is the root of sum_i |Q_i|^2 over the amplitudes Q_i of the fundamental in modes of
    mass 1: the root of X^H M X. Modes count from the lowest one of the structure with its contacts as at
    rest, without rigid-body modes.

    Attributes
    ----------
    levels
        Levels of the scene's forces at which the response near the resonance is predicted.
    motion_at
        Modal amplitudes at which motions are kept for export. If it is empty, motions at the resonances are
        kept or, without a resonance, the one at the greatest amplitude. If it is None, none is kept.
    """

    number: int
    span: tuple[float, float]
    levels: tuple[float, ...] = (1.0,)
    motion_at: tuple[float, ...] | None = None


def trace_modes(
    scene: Scene,
    asked: ModeRequest,
    execution: Execution = IN_THIS_PROCESS,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    options: ResponseOptions | None = None,
) -> Response:
    """Follow the requested mode for each curve of the scene.

    harmonics and accuracy default to those of the scene. The checkpoint keeps finished curves, which are not
    followed again.

    Raises
    ------
    ResponseError
        If the span is out of range, or there is no such mode.
    KeyboardInterrupt
        If no curve is finished; else the finished curves are returned.
    """
    low, high = asked.span
    if not 0.0 < low < high <= INPUT_LIMITS.max_amplitude_ratio * low:
        raise ResponseError(
            f"level is from {low:g} to {high:g}, but the modal amplitudes must rise, from more than 0, by at "
            f"most a factor of {INPUT_LIMITS.max_amplitude_ratio:g}"
        )
    if not all(0.0 < level <= INPUT_LIMITS.max_level for level in asked.levels):
        raise ResponseError("a level of the forces must be finite and greater than 0")
    check_free(scene)
    begin = time.perf_counter()
    request = request_of(scene, harmonics, accuracy, options)
    of_curves = (asked, request, anonymous(scene.each_curve()))
    mark = b"" if execution.keep is None else fingerprint("mode", *of_curves)
    try:
        curves = one_by_one(
            [
                (lost_curve(one, NOT_BEGUN, Cause.INTERRUPTED), partial(_curve, one, asked, request))
                for one in scene.each_curve()
            ],
            execution,
            mark,
        )
    except ModeError as error:
        raise ResponseError(f"{scene.name}: {error}") from None
    curves = [without_rounding(one) for one in curves]
    response = Response.of(scene, curves, f"nonlinear mode {asked.number}")
    response.seconds = time.perf_counter() - begin
    return response


def check_free(scene: Scene) -> None:
    """Raise ResponseError for scenes whose nonlinear modes cannot be computed."""
    check_no_ring(scene, "nonlinear modes")
    refuse_own_laws(scene, "nonlinear modes")
    refuse_other_harmonics(scene, "what a nonlinear mode predicts")


def _curve(scene: Scene, asked: ModeRequest, request: Request, tell: Tell) -> Curve:
    begin = time.perf_counter()
    system = request.system(scene)
    try:
        check_contacts_can_close(system)
        mode = nonlinear_mode(system, asked.number, asked.span, scene.max_step, progress=tell.covered)
    except RestError as nowhere:
        return lost_curve(scene, str(nowhere))
    (error, theirs), stopped = truncation(mode), ""
    while request.harmonics is None and not _worst(error) <= request.accuracy:
        enlarged = with_twice_as_many(mode.system, mode.path.evaluations)
        if enlarged is None:
            break
        count = len(enlarged.harmonics)
        try:
            tell(f"with {count} harmonics")
            more = nonlinear_mode(enlarged, asked.number, asked.span, scene.max_step, progress=tell.covered)
            if more.path.status is not Status.COMPLETE and mode.path.status is Status.COMPLETE:
                break
            tell(f"the error with {count} harmonics")
            mode, (error, theirs) = more, truncation(more)
        except KeyboardInterrupt:
            stopped = f"{INTERRUPTED} before it was known with {count} harmonics"
            break
    curve = _recorded(mode, asked, error, theirs)
    if request.harmonics is None and curve.complete and not _worst(error) <= request.accuracy:
        these = counted(len(mode.system.harmonics), "harmonic")
        curve.short_of = (
            f"with {these} an estimated error of {_worst(error):.1e} remains. {remedy(mode.system.harmonics)}"
        )
    if asked.motion_at is not None and curve.mode is not None:
        curve.mode.motions = tuple(_motions(mode, asked.motion_at, asked.levels))
    if stopped:
        curve.complete, curve.reason, curve.cause = False, stopped, Cause.INTERRUPTED
    curve.seconds = time.perf_counter() - begin
    return curve


def _worst(error: FloatArray) -> float:
    known = error[np.isfinite(error)]
    return float(known.max()) if known.size else np.inf


def _recorded(mode: Mode, asked: ModeRequest, error: FloatArray, theirs: FloatArray) -> Curve:
    system, path = mode.system, mode.path
    scene, first = system.scene, system.harmonics.index(1)
    empty = lost_curve(scene, "no motion was found at the least amplitude; try another")
    if path.z.shape[0] == 0:
        return empty
    X, mean = mode.displacements()
    amplitude = half_peak_to_peak(X, system.harmonics, system.options.extremes)
    X, rows, unknown = 1j * X, np.arange(mode.omega.size), np.full(mode.omega.size, np.nan)
    whole, loop = path.status is Status.COMPLETE, loops(system, mode.contacts)
    words, contact_loads = cycles(system, mode.contacts, loop)
    lost = no_steady_states(system, mode.contacts, np.ones(mode.omega.size))
    reason = "" if whole else _reason(mode)
    for why, which in lost.items():
        if which.any():
            ends = mode.amplitude[which]
            reason = f"from modal amplitude {ends.min():.5g} to {ends.max():.5g} {reason_for(system, why)}"
    curve = replace(
        empty,
        frequency=mode.omega,
        amplitude=amplitude,
        fundamental=np.abs(X[:, first]),
        phase=np.angle(X[:, first]),
        mean=mean,
        regime=pick(words, rows),
        loop=loop,
        cycle=contact_loads,
        cycle_error=relative(theirs - contact_loads, contact_loads, contact_loads.max(axis=0), PAIR),
        stable=unknown,
        table_error=unknown,
        error=np.full(amplitude.shape, np.nan),
        truncation_error=error,
        complete=not reason,
        reason=reason,
        undetermined=int(undetermined(scene, words).sum()),
        evaluations=path.evaluations,
        harmonics=system.harmonics,
        harmonic=X if len(system.harmonics) > 1 else None,
        mode=_along(mode, asked, ~np.logical_or.reduce([np.zeros(rows.size, bool), *lost.values()])),
        across=contact_motions(system, mode.contacts),
    )
    curve.greatest = greatest_of(curve)
    return curve


def _along(mode: Mode, asked: ModeRequest, steady: npt.NDArray[np.bool_]) -> NonlinearMode:
    """The quantities along a mode, and the response that it predicts at levels of the forces."""
    return NonlinearMode(
        number=asked.number,
        amplitude=mode.amplitude,
        damping=mode.damping,
        force=modal_force(mode),
        resonant_level=resonant_level(mode),
        levels=asked.levels,
        flanks=np.stack([flanks(mode, level) for level in asked.levels], axis=1),
        folds=mode.amplitude[(mode.path.mark & Mark.FOLD) > 0].tolist(),
        resonances=[one for level in asked.levels for one in _resonances(mode, level)],
        steady=steady,
        internal=_internal_resonance(mode),
    )


def _internal_resonance(mode: Mode) -> InternalResonance | None:
    """The range in which harmonics above the first have much of a mode's power; None if there is none."""
    harmonics, power = np.array(mode.system.harmonics), mode.power
    further = np.where(harmonics > 1, power, 0.0)
    share = further.sum(axis=1)
    at = share > NONLINEAR_MODE.shared_power
    if not at.any():
        return None
    a, omega, most = mode.amplitude[at], mode.omega[at], further[share.argmax()].argmax()
    ends = (float(a.min()), float(a.max())), (float(omega.min()), float(omega.max()))
    return InternalResonance(*ends, int(harmonics[most]), float(share.max()))


def _motions(mode: Mode, at: tuple[float, ...], levels: tuple[float, ...]) -> Iterator[MotionOfMode]:
    """Yield motions of a mode at modal amplitudes.

    If `at` is empty, they are those at the resonances or, without one, at the greatest amplitude.
    """
    if at:
        found = [at_amplitude(mode, one) for one in at]
    else:
        found = [resonances(mode, level) for level in levels]
        if all(one is None for one in found):
            found = [at_amplitude(mode, float(mode.amplitude.max()))]
    for points in found:
        if points is None:
            continue
        rest = mode.modes_at_rest
        for a, omega, z, mean, Q in zip(
            points.amplitude, points.omega, points.contacts, points.mean, points.Q, strict=True
        ):
            modes = np.concatenate(((rest + a * mean)[:, None], 1j * a * Q.T), axis=1)
            yield MotionOfMode(float(a), float(omega), z, modes)


def _reason(mode: Mode) -> str:
    """Sentence on why a mode does not reach the greatest amplitude."""
    path = mode.path
    if path.status is not Status.RETURNED:
        return f"stopped at modal amplitude {mode.amplitude[-1]:.6g}: {path.status.value}"
    top, size = int(mode.amplitude.argmax()), np.linalg.norm(mode.Q[-1], axis=1)
    frequency = float(in_unit(mode.omega[top], mode.system.scene.frequency_unit))
    unit, harmonic = mode.system.scene.frequency_unit, mode.system.harmonics[int(size.argmax())]
    into = f" as a motion in harmonic {harmonic}, an internal resonance" if harmonic > 1 else ""
    return (
        f"turns back at modal amplitude {mode.amplitude[top]:.6g}, {frequency:.6g} {unit}, and comes back to "
        f"the least{into}; fewer harmonics may follow the mode on"
    )


def _resonances(mode: Mode, level: float) -> list[Resonance]:
    """Resonances of a mode with the scene's forces at a level."""
    found = resonances(mode, level)
    if found is None:
        return []
    system = found.system
    amplitude = half_peak_to_peak(found.displacements()[0], system.harmonics, system.options.extremes)
    square = 1.0 - 2.0 * found.damping**2  # negative: too much damping for a resonance peak
    frequency = found.omega * np.sqrt(np.where(square > 0.0, square, np.nan))
    dofs = system.scene.modal.dofs
    return [
        Resonance(level, float(w), float(a), dict(zip(dofs, x.tolist(), strict=True)), float(D))
        for w, a, x, D in zip(frequency, found.amplitude, amplitude, found.damping, strict=True)
    ]
