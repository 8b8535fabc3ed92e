"""Fit of the numbers of a scene to measured data, and the response or nonlinear mode with these numbers."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fcm.fit.advice import advice
from fcm.fit.backbone import backbone_errors, measured_span
from fcm.fit.estimate import Estimate, estimated
from fcm.fit.forced import errors_of
from fcm.fit.options import FIT
from fcm.fit.parameters import FitError, Parameters, parameters_of
from fcm.fit.remedy import remedy
from fcm.fit.solve import Searches, SearchResult, Solved, solved
from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Measured, Scene
from fcm.nonlinear_modes.backbone import ModeError
from fcm.response.mode import ModeRequest, check_free, trace_modes
from fcm.response.options import FITTED_RESPONSE, ResponseOptions
from fcm.response.request import Request, ResponseError, request_of
from fcm.response.ring_limits import check_no_ring, refuse_own_laws
from fcm.response.sweep import trace
from fcm.results.fitted import Fitted, FittedData, FittedStart, misfit
from fcm.results.result import Response
from fcm.run import IN_THIS_PROCESS, CheckpointFile, Execution, Results, fingerprint
from fcm.scene.address import LEVEL
from fcm.scene.draft import number_of
from fcm.scene.errors import quoted
from fcm.table import Table
from fcm.units import EXCITED


def fit(
    scene: Scene,
    method: str | Table = "table",
    execution: Execution = IN_THIS_PROCESS,
    *,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    options: ResponseOptions | None = None,
) -> Response:
    """Fit the numbers of a scene with a [fit]; return its response, with a curve for each measured level.

    If all data are backbones of one mode, the response is this nonlinear mode.

    With an accuracy the fit begins with one harmonic. It is repeated with the harmonics that the response at
    the numbers found needs, for the accuracy and for a tenth of the misfit of the data.

    Parameters
    ----------
    method, execution, harmonics, accuracy, options
        As of `trace`. The checkpoint keeps the searches from each start, also an interrupted one.

    Raises
    ------
    ResponseError
        If the model has no response near the data, or such a scene cannot be fitted.
    KeyboardInterrupt
        If nothing has been found; else the best numbers so far are returned, without a response.
    """
    assert scene.fit is not None
    check_no_ring(scene, "fits")
    refuse_own_laws(scene, "a fit")
    if any(one.damping is not None for one in scene.fit.data):
        check_free(scene)
    begin, request = time.perf_counter(), request_of(scene, harmonics, accuracy, options)
    with execution.checkpoint() as checkpoint:
        response = _fit(scene, method, request, replace(execution, keep=checkpoint))
        if not response.interrupted:
            execution.discard(checkpoint)
    response.seconds = time.perf_counter() - begin
    return response


def _fit(scene: Scene, method: str | Table, request: Request, execution: Execution) -> Response:
    """Fit the numbers with given harmonics, or with as many as the data need; return the response.

    With enough harmonics the error of the response is less than the misfit of the data. With fewer, the
    numbers would compensate for the harmonics left out.
    """
    assert scene.fit is not None
    plain, data = replace(scene, fit=None), scene.fit.data
    chosen, rounds = request.harmonics or (1,), list[_Round]()
    response = Response.without_curves(plain)
    while True:
        near = [_ends(one) for one in rounds[-1:]]
        last = request.harmonics is not None or len(rounds) == FITTED_RESPONSE.max_rounds - 1
        begin, found, end = _shares(len(rounds), last)
        try:
            stage = execution.stage(begin, found)
            rounds.append(_Round(*_fitted_parameters(plain, scene, chosen, *near, execution=stage), chosen))
        except KeyboardInterrupt:
            if not rounds:
                raise
            rounds[-1].solved.interrupted = True
        if rounds[-1].solved.interrupted:
            break
        stage = execution.stage(found, end)
        accuracy = None if last else _accuracy(rounds[-1].solved, request)
        try:
            response = _model_response(rounds[-1], data, accuracy, method, request, stage)
            if accuracy is not None and not response.interrupted:
                more = tuple(sorted({h for curve in response.curves for h in curve.harmonics} | set(chosen)))
                if more != chosen:
                    chosen = more
                    continue
                if any(tuple(curve.harmonics) != chosen for curve in response.curves):
                    response = _model_response(rounds[-1], data, None, method, request, stage)
        except KeyboardInterrupt:
            response = Response.without_curves(plain)
            response.fitted = _fitted(rounds, advise=False, untraced=True)
            return response
        break
    response.fitted = _fitted(rounds, advise=not (rounds[-1].solved.interrupted or response.interrupted))
    response.fitted.data = [_on_mode(one, response) for one in response.fitted.data]
    return response


class _Round(Frozen):
    """The numbers found in one round of a fit, with the same harmonics."""

    parameters: Parameters
    solved: Solved
    harmonics: tuple[int, ...]


def _shares(rounds: int, last: bool) -> tuple[float, float, float]:
    """Shares of the progress at which a round begins, has its numbers, and ends.

    rounds: number of earlier rounds. Each round takes half of the remaining progress, since another may
    follow; the last takes all.
    """
    begin = 1.0 - 0.5**rounds
    end = 1.0 if last else 1.0 - 0.5 ** (rounds + 1)
    return begin, begin + FITTED_RESPONSE.fit_share * (end - begin), end


def _ends(one: _Round) -> list[FloatArray]:
    """Distinct numbers at which the searches of a round ended, the best first."""
    found = [one.solved.values]
    for start in one.solved.starts:
        same = (np.allclose(start.end, known, rtol=FIT.number_tolerance, atol=0.0) for known in found)
        if not any(same):
            found.append(start.end)
    return found


def _accuracy(found: Solved, request: Request) -> float:
    """Accuracy of the response at which the harmonics left out do not affect the misfit of the data."""
    off = min(
        misfit(one, rows.residual, _errors(one)) for one, rows in zip(found.data, found.parts, strict=True)
    )
    return min(request.accuracy, max(FITTED_RESPONSE.misfit_share * off, FITTED_RESPONSE.min_accuracy))


def _model_response(
    found: _Round,
    data: Sequence[Measured],
    accuracy: float | None,
    method: str | Table,
    request: Request,
    execution: Execution,
) -> Response:
    """The response with the numbers found: at the levels of the data, or the mode if all are its backbones.

    It has the harmonics of the fit, or those that an accuracy needs.
    """
    given = found.harmonics if accuracy is None else None
    parameters, numbers = found.parameters, found.solved
    modes = {one.mode if one.damping is not None else None for one in data}
    number = modes.pop()
    if modes or number is None:
        there = _at_levels(parameters, numbers, data)
        return trace(there, method, execution, harmonics=given, accuracy=accuracy, options=request.options)
    scene = parameters.at(numbers.values)
    spans = [measured_span(System(scene, found.harmonics), one) for one in data]
    span = min(low for low, _ in spans), max(high for _, high in spans)
    mode = ModeRequest(number, span)
    return trace_modes(scene, mode, execution, harmonics=given, accuracy=accuracy, options=request.options)


def _on_mode(data: FittedData, response: Response) -> FittedData:
    """The data with the modal amplitudes at which the computed mode has the measured amplitudes."""
    curve = response.curves[0] if response.curves else None
    if curve is None or curve.mode is None or not curve.points:
        return data
    along, dof = curve.mode.amplitude, data.measured.dof
    size = curve.fundamental[:, list(response.dofs).index(dof)] if dof else along
    rising = np.flatnonzero(size == np.maximum.accumulate(size))
    sizes, modal = np.log(size[rising]), np.log(along[rising])
    found = np.interp(np.log(data.measured.amplitude), sizes, modal, left=np.nan, right=np.nan)
    return replace(data, modal_amplitude=np.exp(found))


def _fitted_parameters(
    plain: Scene,
    scene: Scene,
    harmonics: tuple[int, ...],
    near: Sequence[FloatArray] = (),
    *,
    execution: Execution,
) -> tuple[Parameters, Solved]:
    """Fit the numbers with some harmonics; near: results of searches with fewer, as starts."""
    assert scene.fit is not None
    try:
        parameters = parameters_of(plain, scene.fit.vary, scene.fit.bounds)
        with execution.checkpoint() as checkpoint:
            kept = None if checkpoint is None else _kept(scene, harmonics, near, checkpoint)
        options = replace(FIT, starts=scene.fit.starts or FIT.starts)
        data = scene.fit.data
        searches = Searches(kept, execution.progress)
        return parameters, solved(parameters, data, harmonics, options, searches, begin=near)
    except FitError as error:
        raise ResponseError(f"{scene.name}: {error}") from None
    except ModeError as error:
        raise ResponseError(f"{scene.name}: fit: {error}") from None
    except ValueError as error:
        if "rigid-body" not in str(error):
            raise
        raise ResponseError(f"{scene.name}: fit: {error}; it cannot be fitted") from None


def _kept(
    scene: Scene, harmonics: tuple[int, ...], near: Sequence[FloatArray], checkpoint: CheckpointFile
) -> Results:
    """The saved results of this fit, which is identified by everything that decides its numbers."""
    count = len(scene.fit.vary) if scene.fit is not None else 0
    mark = fingerprint("fit", FIT, harmonics, list(near), replace(scene, name="", title=""))
    found = checkpoint.results(mark, (SearchResult,), lambda _, results: is_search_result(count, results))
    for number, states in list(found.states.items()):
        found.states[number] = [one for one in states if is_search_result(count, [one]) and one.x is not None]
    return found


def is_search_result(count: int, results: Any) -> bool:
    """Whether an object read from a file can be the result of a search with this number of parameters."""
    if not (isinstance(results, list) and len(results) == 1 and isinstance(results[0], SearchResult)):
        return False
    x, cost, settled = results[0].x, results[0].cost, results[0].settled
    if not isinstance(settled, bool):
        return False
    if x is None:
        return isinstance(cost, float)
    right = isinstance(x, np.ndarray) and x.shape == (count,) and x.dtype == np.float64
    return right and isinstance(cost, float) and bool(np.isfinite(x).all())


def _at_levels(parameters: Parameters, found: Solved, data: Sequence[Measured]) -> Scene:
    """The scene with the numbers found, a curve for each measured level, at most `FIT.max_levels`."""
    scene = parameters.at(found.values)
    every = np.unique(np.concatenate([one.level for one in data]))
    if every.size > FIT.max_levels:
        every = np.geomspace(every[0], every[-1], FIT.max_levels)
    number = number_of(scene, LEVEL)
    curves = tuple(
        replace(number.put(scene, level), parameters={EXCITED: level}, draft=None, curves=())
        for level in every.tolist()
    )
    return replace(scene, curves=curves, draft=None)


def _fitted(rounds: Sequence[_Round], *, advise: bool, untraced: bool = False) -> Fitted:
    """Report on the numbers of the last round; untraced: the response with them was interrupted."""
    parameters, found, harmonics = rounds[-1].parameters, rounds[-1].solved, rounds[-1].harmonics
    told = estimated(parameters, found.values, found.rows)
    return Fitted(
        keys=parameters.keys,
        begin=parameters.start,
        values=told.values,
        error=told.error,
        interval=told.interval,
        confidence=FIT.confidence,
        poor=FIT.poor_misfit,
        correlation=told.correlation,
        without_effect=told.without_effect,
        undetermined=told.undetermined,
        at_bound=told.at_bound,
        alike=told.alike,
        data=[
            FittedData(one, rows.residual, _errors(one), int(rows.unreached.sum()))
            for one, rows in zip(found.data, found.parts, strict=True)
        ],
        starts=[
            FittedStart(one.begin, one.end, one.cost, one.points, one.finished, each.harmonics)
            for each in rounds
            for one in each.solved.starts
        ],
        harmonics=harmonics,
        advice=_advice(parameters, found, told, harmonics) if advise else [],
        remedy=remedy(parameters, found, harmonics) if advise else "",
        final=not found.interrupted,
        settled=found.settled,
        interrupted=found.interrupted or untraced,
    )


def _errors(data: Measured) -> FloatArray:
    """Errors of the points of data: of the amplitude, or of frequency and damping ratio."""
    if data.damping is not None:
        return backbone_errors(data, FIT)
    return errors_of(data, False, FIT).amplitude[:, None]


def _advice(parameters: Parameters, found: Solved, told: Estimate, harmonics: tuple[int, ...]) -> list[str]:
    """Sentences that advise further measurements."""
    doubtful = set(np.flatnonzero(told.without_effect + told.undetermined).tolist())
    doubtful |= {k for i, j, _ in told.alike for k in (i, j)}
    every = advice(parameters, found, sorted(doubtful), harmonics)
    said = [
        f"{one.key}: a response at {quoted(one.dof)} with forces at a level of {one.level:.2g} would "
        f"determine it to {100.0 * one.error:.2g} %"
        for one in every
    ]
    helped = {one.key for one in every}
    if without := [key for k in sorted(doubtful) if (key := parameters.keys[k]) not in helped]:
        them = "it" if len(without) == 1 else "them"
        said.append(f"{' and '.join(without)}: no response at the levels that were tried determines {them}")
    return said
