"""Response curves by single-harmonic balance with the mean (section 4.3): solve, follow, correct, write."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fcm.response.result import Curve, Response
from fcm.response.sweep import trace
from fcm.response.trace import METHODS, ResponseError
from fcm.scene.model import Scene

if TYPE_CHECKING:
    import xarray

__all__ = ["METHODS", "Curve", "Response", "ResponseError", "respond", "trace"]


def respond(scene: Scene, method: str = "table") -> xarray.Dataset:
    """Response curves of a scene as the dataset that ``fcm respond`` writes.

    Parameters
    ----------
    scene : Scene
        From `fcm.load_scene`.
    method : {"table", "closed-form"}
        Source of the Fourier coefficients while the curve is followed; the points are exact either way.

    Returns
    -------
    xarray.Dataset
        Dimensions curve, point, dof, contact, fold; padded with NaN. Frequencies in the scene's unit,
        phases in rad, displacements in the scene's unit of length.

    Raises
    ------
    ResponseError
        If the method is unknown.

    Examples
    --------
    >>> import fcm
    >>> data = fcm.respond(fcm.load_scene("yang1998-n5"), method="closed-form")
    >>> data.fold_frequency.values.round(4).tolist()
    [[1.2388, 1.1875]]
    """
    from fcm.response.output import to_dataset

    return to_dataset(trace(scene, method))
