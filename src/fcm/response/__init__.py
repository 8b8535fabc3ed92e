"""Response curves by single-harmonic balance with the mean (section 4.3): solve, follow, correct, write."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from fcm.response.result import Curve, Response
from fcm.response.sweep import trace
from fcm.response.trace import METHODS, ResponseError
from fcm.scene.model import Scene

if TYPE_CHECKING:
    import xarray

__all__ = ["METHODS", "Curve", "Response", "ResponseError", "respond", "trace"]


def respond(scene: Scene, method: str = "table", *, at: Sequence[float] | None = None) -> xarray.Dataset:
    """Response curves of a scene, and the motion of its schedule, as the dataset of ``fcm respond``.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`.
    method : {"table", "closed-form", "exact"}
        Harmonic balance with the Fourier coefficients of a table or in closed form while the curve is
        followed (its points are the same either way); or the exact periodic solutions, by shooting.
    at : sequence of float, optional
        With "exact": frequencies in the scene's unit, visited by an upward and then a downward sweep.

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

    Examples
    --------
    >>> import fcm
    >>> data = fcm.respond(fcm.load_scene("yang1998-n5"), method="closed-form")
    >>> data.fold_frequency.values.round(4).tolist()
    [[1.2388, 1.1875]]
    """
    from fcm.response.output import to_dataset
    from fcm.response.visible import check_solvable, visible

    scene = scene.in_use()
    check_solvable(scene)
    response = _curves(scene, method, at)
    response.notes, response.units = list(scene.notes), scene.units
    if scene.schedule:
        from fcm.motion import histories

        response.histories = histories(scene)
    return to_dataset(visible(response, scene))


def _curves(scene: Scene, method: str, at: Sequence[float] | None) -> Response:
    if method not in (*METHODS, "exact"):
        raise ResponseError(f"method {method!r} is not one of {', '.join((*METHODS, 'exact'))}")
    if at is not None and method != "exact":
        raise ResponseError(f"frequencies to visit need the method 'exact'; the method is {method!r}")
    if at is None and not scene.has_range and scene.schedule:
        return Response.without_curves(scene)
    if method == "exact":
        from fcm.simulate import trace_exact

        return trace_exact(scene, at)
    return trace(scene, method)
