r"""How wrong a curve of a balance is by the harmonics that it leaves out, with their feedback on the others.

At some points of the curve the balance with more harmonics is solved in the plane normal to the curve, so
that nothing special happens at folds: these points are displaced to the corrected curve. In between the
displacement is interpolated. The error of an amplitude is its difference to the corrected curve at the same
frequency; that of a peak, the difference of the heights; that of a fold, the difference of the frequencies.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fcm.continuation import Mark, Path
from fcm.harmonic.abreast import with_those_abreast
from fcm.harmonic.corrected import Corrected, Indices
from fcm.harmonic.crest import crests, rise_beside, settling_at_ends
from fcm.harmonic.ended import without_ended
from fcm.harmonic.further import HIGHEST
from fcm.harmonic.points import Points
from fcm.harmonic.ranking import COVERED
from fcm.harmonic.ripple import ripple
from fcm.harmonic.shifted import shifted
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

ComplexArray = npt.NDArray[np.complex128]

CHANCE = 0.1  # of the typical error of the degrees of freedom: less is a chance, at a change of sign
CHANCE_AT_PEAKS = 0.05  # the same of peaks, which are displaced until they settle


@dataclass(frozen=True)
class Reported:
    """What is reported along a path, as of a `Record`; growth (point, dof) of the amplitude along the path's
    direction; linear (point,) where no contact slips or separates."""

    X: ComplexArray
    mean: FloatArray
    amplitude: FloatArray
    force: FloatArray
    growth: FloatArray
    linear: npt.NDArray[np.bool_]

    def with_rows(self, after: Indices, other: Reported) -> Reported:
        """With the points of another inserted after some points."""
        rows = zip(vars(self).values(), vars(other).values(), strict=True)
        return Reported(*(np.insert(mine, after + 1, its, axis=0) for mine, its in rows))


@dataclass(frozen=True)
class Errors:
    """Of a path; relative; NaN where the method cannot tell.

    amplitude (point, dof): by how much the corrected curve differs at the same frequency.
    truncation (point,): the greatest difference of an amplitude over the greatest amplitude.
    peak (dof,): of the height of the greatest amplitude; at least what the harmonics beyond all that are
    looked at do to it.
    height (dof,): the greatest amplitude of the corrected curve, as an amplitude.
    fold (fold,): of the frequencies of the folds, in their order.
    share (harmonic 1 to HIGHEST,): what each harmonic left out would have without feedback, at peaks and
    folds, of the greatest amplitude of the degree of freedom to which it matters most.
    """

    amplitude: FloatArray
    truncation: FloatArray
    peak: FloatArray
    height: FloatArray
    fold: FloatArray
    share: FloatArray


def reported(system: System, path: Path) -> Reported:
    """What is reported along a path."""
    return reported_at(system, path.z, path.direction)


def reported_at(system: System, z: FloatArray, direction: FloatArray) -> Reported:
    """The same of points z with directions there, both (point, unknown + 1)."""
    points = Points(system.looking, len(z))
    points.take(z, direction, np.ones(len(z)))
    X = np.empty(np.shape(points.re), dtype=np.complex128)
    X.real, X.imag = points.re, points.im
    return Reported(
        X=X,
        mean=np.asarray(points.mean),
        amplitude=np.asarray(points.amplitude),
        force=np.asarray(points.force),
        growth=np.asarray(points.growth),
        linear=np.asarray(points.linear) > 0,
    )


def errors_along(system: System, path: Path, shown: Reported | None = None) -> Errors:
    """Errors of the points of a path of a system's balance.

    Parameters
    ----------
    shown : Reported, optional
        Along the path, if it is known.
    """
    shown = shown or reported(system, path)
    tops, d = shown.amplitude.argmax(axis=0), np.arange(shown.amplitude.shape[1])
    folds = path.where(Mark.FOLD)
    special = np.unique(np.concatenate((folds, path.where(Mark.PEAK), tops)))
    corrected = Corrected(system, path, shown.amplitude, shown.linear)
    if corrected.linear.all():
        none = np.zeros_like(shown.amplitude)
        height = shown.amplitude.max(axis=0)
        return Errors(none, none[:, 0], none[0], height, np.zeros(len(folds)), np.zeros(HIGHEST))
    change = corrected.everywhere(special, tops)
    unit, growth = corrected.unit, shown.growth
    shift = shifted(corrected.place, path.z, path.direction, shown.amplitude, growth, unit, change)
    shift[np.isnan(change).any(axis=1)] = np.nan  # the corrected curve is missed there
    shift = without_ended(corrected, with_those_abreast(corrected, shift))
    error = _of_points(corrected, shown, change, shift)
    error[folds] = np.nan  # the corrected curve has two amplitudes at that frequency, or none
    inside = (tops > 0) & (tops < len(path.z) - 1)
    at_ends = shown.amplitude[tops, d] + unit[tops, d] * shift[tops, d]
    at_ends += settling_at_ends(corrected, growth, tops)
    height = np.where(inside, crests(corrected, growth, change[:, 1:], tops), at_ends)
    own = rise_beside(corrected, growth, np.zeros_like(unit), tops)  # no error
    now = shown.amplitude[tops, d] + np.where(inside, own, 0.0)
    settles = inside | ~corrected.linear[tops]
    told = settles & np.isfinite(height)
    error[tops[told], d[told]] = _of_peaks(np.abs(height - now) / unit[tops, d])[told]
    for top in np.unique(tops[settles]).tolist():
        beyond = np.abs(ripple(system, path.z[top], shown.X[top])) / unit[top]
        error[top] = np.where(tops == top, np.maximum(error[top], beyond), error[top])
    error *= unit / np.where(shown.amplitude > 0.0, shown.amplitude, unit)
    size = shown.amplitude.max(axis=1)
    share = corrected.shares(special, shown.amplitude.max(axis=0))[:HIGHEST]
    system.work.take(corrected.corrector.seconds())
    return Errors(
        amplitude=error,
        truncation=(error * shown.amplitude).max(axis=1) / np.where(size > 0.0, size, 1.0),
        peak=np.where(told | ~settles, error[tops, d], np.nan),
        height=height,
        fold=np.abs(change[folds, 0]),
        share=share,
    )


def _of_points(corrected: Corrected, shown: Reported, change: FloatArray, shift: FloatArray) -> FloatArray:
    """Errors (point, dof) at the same frequency, in units of the corrected curve."""
    error = np.abs(shift)
    # what hardly moves may have any error, and says nothing of that of others
    most = np.where(shown.amplitude < corrected.unit, 0.0, error).max(axis=1, keepdims=True)
    typical = _medians(np.minimum(error, most))[:, None]
    error = np.where(corrected.linear[:, None], 0.0, np.maximum(error, CHANCE * typical))
    # what is covered in part only is known in part only, though the displacements cancel at a frequency
    moved = corrected.weight[:, None] * np.abs(change[:, :1]) + np.abs(change[:, 1:])
    moved[np.isnan(moved).any(axis=1)] = 0.0  # those abreast are told by their shifts alone
    covered: FloatArray = np.maximum(error, (1.0 - COVERED) * moved)
    return covered


def _of_peaks(error: FloatArray) -> FloatArray:
    """Errors (dof,) of the greatest amplitudes by their changes, of which one may be small by chance."""
    told = error[np.isfinite(error)]
    peaks: FloatArray = np.maximum(error, CHANCE_AT_PEAKS * _medians(told[None])[0] if told.size else 0.0)
    return peaks


def _medians(values: FloatArray) -> FloatArray:
    """Of each row, NaN where all of it is; as `numpy.median`, which takes ten times as long for so few."""
    count = values.shape[1]
    ordered = np.sort(values, axis=1) if count > 2 else values
    middle: FloatArray = 0.5 * (ordered[:, (count - 1) // 2] + ordered[:, count // 2])
    return middle
