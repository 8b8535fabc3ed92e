"""Response curves of a scene as results: traced or exact, swept, with statements of what was left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from fcm.model.scene import Scene
from fcm.quoting import quoted
from fcm.response.request import ResponseError
from fcm.response.sweep import trace
from fcm.response.trace import METHODS
from fcm.results.result import Curve, Response
from fcm.run import Execution, place_of
from fcm.scene.rules import step_fault

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import xarray

    from fcm.response.options import ResponseOptions

__all__ = ["METHODS", "Curve", "Response", "ResponseError", "respond", "trace"]


def respond(
    scene: Scene,
    method: str = "table",
    *,
    at: Sequence[float] | None = None,
    harmonics: int | Sequence[int] | None = None,
    accuracy: float | None = None,
    max_step: float | None = None,
    executor: Executor | None = None,
    sensitivity: bool = False,
    options: ResponseOptions | None = None,
) -> xarray.Dataset:
    """Response curves of a scene, and the motion of its schedule, as the dataset of ``fcm respond``.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`.
    method : {"table", "closed-form", "exact"}
        Harmonic balance in closed form, of which "table" also shows how far the solutions of a table are
        from there; or the exact periodic solutions, by shooting.
    at : sequence of float, optional
        With "exact": frequencies in the scene's unit, visited by an upward and then a downward sweep.
    harmonics : int or sequence of int, optional
        Harmonics of the balance: up to a number, or some that begin with 1; the scene's by default.
    accuracy : float, optional
        Instead: relative error of peaks and folds, for which as many harmonics are taken as that needs; the
        scene's by default, and 1e-2 where it says neither.
    max_step : float, optional
        Longest step along a curve, relative to its extent; the scene's by default.
    executor : concurrent.futures.Executor, optional
        Where the curves of a sweep are computed, in batches; its owner ends it. In this process by default.
    sensitivity : bool
        Whether to add the derivatives of each peak, its height and frequency, by the numbers of the scene.
    options : fcm.response.options.ResponseOptions, optional
        Tolerances and limits.

    Returns
    -------
    xarray.Dataset
        Dimensions curve, point, dof, contact, fold, and those of a schedule, instant, cycle, transition,
        schedule_phase; padded with NaN. Frequencies in the scene's unit, phases in rad, displacements in
        the scene's unit of length.

    Raises
    ------
    ResponseError
        If the method is unknown, or does not fit the other arguments.
    TypeError
        If the scene is none, but the name of one, say.
    fcm.run.PlaceClosed
        If the executor takes nothing any more, and nothing is finished. Later what is finished is returned,
        with a warning; the other curves are not complete.

    Examples
    --------
    >>> import fcm
    >>> data = fcm.respond(fcm.load_scene("yang1998-n5"), method="closed-form")
    >>> data.fold_frequency.values.round(4).tolist()
    [[1.2388, 1.1875]]
    """
    from fcm.response.ring_limits import check_no_ring, refuse_own_laws
    from fcm.response.visible_dofs import check_solvable, visible
    from fcm.results.output import to_dataset

    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; fcm.load_scene gives one of a file or a name")
    scene = scene.in_use()
    check_solvable(scene)
    if max_step is not None:
        if fault := step_fault(max_step):
            raise ResponseError(f"max_step {fault}")
        scene = scene.with_step(max_step)
    if sensitivity and method == "exact":
        raise ResponseError('sensitivities are of the peaks of harmonic balance; the method is "exact"')
    if sensitivity:
        check_no_ring(scene, "sensitivities")
        refuse_own_laws(scene, "a sensitivity")
    if scene.schedule:
        refuse_own_laws(scene, "the motion of a schedule")
    place = None if executor is None else place_of(executor)
    asked = {"harmonics": harmonics, "accuracy": accuracy, "options": options}
    response = _curves(scene, method, at, asked, Execution(place=place))
    if sensitivity:
        from fcm.response.sensitivity import add_sensitivities

        add_sensitivities(response, scene)
    if scene.schedule:
        from fcm.time_domain import histories

        response.histories = histories(scene)
    return to_dataset(visible(response, scene))


def _curves(
    scene: Scene, method: str, at: Sequence[float] | None, asked: dict[str, Any], execution: Execution
) -> Response:
    if method not in (*METHODS, "exact"):
        raise ResponseError(f"method {quoted(method)} is not one of {', '.join((*METHODS, 'exact'))}")
    if at is not None and method != "exact":
        raise ResponseError(f'frequencies to visit need the method "exact"; the method is {quoted(method)}')
    if scene.fit is not None:
        return _fit(scene, method, asked)
    if scene.optimum is not None:
        return _optimum(scene, method, asked)
    if at is None and not scene.has_range and scene.schedule:
        return Response.without_curves(scene)
    if method == "exact":
        if asked["harmonics"] is not None or asked["accuracy"] is not None:
            raise ResponseError('harmonics and accuracy are of no use with the method "exact"')
        from fcm.response.exact import trace_exact
        from fcm.response.options import RESPONSE

        return trace_exact(scene, at, execution, options=asked["options"] or RESPONSE)
    return trace(scene, method, execution, **asked)


def _fit(scene: Scene, method: str, asked: dict[str, Any]) -> Response:
    from fcm.response.fit import fit

    if method == "exact":
        raise ResponseError('the method "exact" is of no use with [fit]')
    return fit(scene, method, **asked)


def _optimum(scene: Scene, method: str, asked: dict[str, Any]) -> Response:
    from fcm.response.optimum import optimise

    if method == "exact" or scene.schedule:
        what = 'the method "exact"' if method == "exact" else "[[schedule]]"
        raise ResponseError(f"{what} is of no use with [optimum]")
    return optimise(scene, method, **asked)
