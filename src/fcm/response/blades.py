"""Peaks of the tuned ring, the reference for the amplification of a mistuned ring."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from fcm.model.scene import Scene
from fcm.results.curve_extracts import extract_of
from fcm.results.curve_summary import at_edge
from fcm.results.result import Blades, Response
from fcm.scene.mistuning import factors_of


def with_blades(response: Response, scene: Scene, trace: Callable[[Scene], Response]) -> Response:
    """Trace the tuned ring, and add its peaks to the response of the mistuned ring.

    Swept keys that the tuned ring lacks, such as those of one sector's contact, do not change its curves.
    """
    assert scene.tuned is not None
    tuned = scene.tuned.in_use()
    names = tuned.reported
    found = trace(tuned)
    known = {tuple(one.parameters.values()): one for one in found.curves if one.complete}
    keys = list(found.curves[0].parameters)
    peaks = np.full((len(response.curves), len(names), 2), np.nan)
    at_end = np.zeros(peaks.shape[:2], np.bool_)
    for row, ends, curve in zip(peaks, at_end, response.curves, strict=True):
        own = known.get(tuple(curve.parameters[key] for key in keys))
        if own is not None:
            extract = own.extract or extract_of(own)
            row[:] = [own.peaks[name][:2] for name in names]
            ends[:] = [at_edge(own, own.peaks[name], extract) for name in names]
    response.blades = Blades(names, _factors(scene), peaks[..., 0], peaks[..., 1], at_end)
    return response


def _factors(scene: Scene) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Mistuning factors of the sectors of each curve, (curve, sector)."""
    curves: Sequence[Scene] = scene.each_curve()
    assert scene.draft is not None
    return np.array([factors_of(scene.draft.fixed(one).parts["whole"][0]) for one in curves])
