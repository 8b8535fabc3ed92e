"""Derivatives of the peaks of a response's curves by the numbers of the scene."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene
from fcm.reduction.restore import unknowns
from fcm.response.optimum import scenes_at
from fcm.response.ring_limits import check_no_ring, refuse_own_laws
from fcm.results.cause import Cause
from fcm.results.result import INTERRUPTED, Curve, Response
from fcm.run import Progress
from fcm.scene.errors import several
from fcm.sensitivity.peak import PeakKind, Unknown
from fcm.sensitivity.peaks import Sensitivities, sensitivities

WITHOUT = f"{INTERRUPTED} before its sensitivities were known"
REMARKS = {
    PeakKind.CORNER: "at a corner of the curve: derivatives hold as long as the peak stays on it",
    PeakKind.EDGE: "at an end of the range: the derivative of the amplitude there",
}
MAY_BE_FOUND = (Unknown.NOT_SOLVED, Unknown.ONE_SIDED, Unknown.NO_MAXIMUM)  # with other points of the curve


def add_sensitivities(response: Response, scene: Scene, progress: Progress | None = None) -> None:
    """Add the sensitivities of the peaks to every curve of a response to the scene.

    After an interruption the curves without sensitivities are marked as incomplete.
    """
    check_no_ring(scene, "sensitivities")
    refuse_own_laws(scene, "a sensitivity")
    scenes = tuple(scene.each_curve()) if response.curves else ()
    if response.curves and response.tracking is not None and response.tracking.optima:
        scenes = scenes_at(scene, response.tracking.optima)
    for i, (curve, one) in enumerate(zip(response.curves, scenes, strict=True)):
        try:
            if progress is not None:
                progress(i / len(scenes), "sensitivities")
            if curve.points and curve.harmonics and one.contacts:
                curve.sensitivity = _of_curve(curve, one)
        except KeyboardInterrupt:
            without_sensitivities(response.curves[i:])
            return


def without_sensitivities(curves: Iterable[Curve]) -> None:
    """Mark curves as incomplete without sensitivities, as the run was interrupted."""
    for curve in curves:
        curve.complete, curve.reason = False, curve.reason or WITHOUT
        curve.cause = Cause.INTERRUPTED


def _of_curve(curve: Curve, scene: Scene) -> Sensitivities:
    reported = [d for d, dof in enumerate(curve.peaks) if scene.reports(dof)]
    peaks = [_peak(curve, scene, d) for d in reported if curve.amplitude[:, d].any()]
    return sensitivities(scene, curve.harmonics, [one for one in peaks if one is not None], len(curve.peaks))


def _peak(curve: Curve, scene: Scene, dof: int) -> tuple[int, FloatArray, bool] | None:
    """The degree of freedom, the point of its peak, and whether it is at an end of the range; or None."""
    amplitude: npt.NDArray[np.float64] = curve.amplitude[:, dof]
    if not np.isfinite(amplitude).any():
        return None
    i = int(np.nanargmax(amplitude))
    known = curve.frequency[np.isfinite(curve.frequency)]
    edge = bool(curve.frequency[i] in (known.min(), known.max()))
    return dof, unknowns(curve, scene, np.array([i]), curve.harmonics)[0], edge


def remarks(response: Response, scene: Scene) -> list[str]:
    """Sentences on peaks that are no smooth maximum, and on derivatives that are unknown."""
    groups: dict[str, list[tuple[int, str]]] = {}
    by_number: dict[Unknown, list[tuple[int, str, str]]] = {}
    for number, curve in enumerate(response.curves):
        found = curve.sensitivity
        if found is None:
            continue
        for d, dof in enumerate(curve.peaks):
            if not scene.reports(dof) or not curve.peaks[dof].amplitude > 0.0:
                continue
            kind, why = found.kind[d], found.why[d]
            if what := REMARKS.get(kind, ""):
                groups.setdefault(what, []).append((number, dof))
            elif kind is PeakKind.UNKNOWN:
                groups.setdefault(f"are unknown: {_reason(why)}", []).append((number, dof))
            for key, one in zip(found.numbers, found.why_by_number[d], strict=True):
                if one is not Unknown.NOTHING:
                    by_number.setdefault(one, []).append((number, dof, key))
    said = [f"sensitivities of peaks ({_first(of)}) {what}" for what, of in groups.items()]
    for why, of in by_number.items():
        keys = list(dict.fromkeys(key for *_, key in of))
        peaks = list(dict.fromkeys((number, dof) for number, dof, _ in of))
        said.append(
            f"sensitivities of peaks ({_first(peaks)}) by {several(keys)} are unknown: {_reason(why)}"
        )
    return said


def _first(of: Sequence[tuple[int, str]]) -> str:
    number, dof = of[0]
    return f"curve {number}, {dof}" + (f", and {len(of) - 1} more" if len(of) > 1 else "")


def _reason(why: Unknown) -> str:
    """Text on why a derivative is unknown, with a remedy."""
    finds = "Another max_step may find it; a" if why in MAY_BE_FOUND else "A"
    return f"{why.value}. {finds} [sweep] of two near values shows what a number does"
