"""Extremes over a cycle of many motions with several harmonics at once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.options import HARMONIC_BALANCE, ExtremeOptions
from fcm.model.scene import FloatArray
from fcm.structure.linear import ComplexArray


def half_peak_to_peak(
    X: ComplexArray, harmonics: tuple[int, ...], options: ExtremeOptions = HARMONIC_BALANCE.extremes
) -> FloatArray:
    """Half the peak-to-peak (point, dof) of x = Re sum X_h exp(i h theta), X (point, harmonic, dof)."""
    if harmonics == (1,):
        return np.abs(X[:, 0])
    h = np.array(harmonics)
    return 0.5 * (greatest(X, h, options) + greatest(-X, h, options))


def greatest(
    X: ComplexArray, h: npt.NDArray[np.intp], options: ExtremeOptions = HARMONIC_BALANCE.extremes
) -> FloatArray:
    """Maximum (point, dof) over a cycle of x = Re sum X_h exp(i h theta), X (point, harmonic, dof).

    All local maxima next to samples that may be highest are computed. Between samples x rises by at most half
    the curvature times the square of half the sampling interval.
    """
    samples = options.samples * h[-1]
    step = 2.0 * np.pi / samples
    waves = np.exp(1j * np.outer(h, step * np.arange(samples)))
    x = np.einsum("ht,phd->tpd", waves, X).real
    between = np.einsum("h,phd->pd", 0.125 * (h * step) ** 2, np.abs(X))
    neighbour = np.maximum(np.roll(x, 1, axis=0), np.roll(x, -1, axis=0))
    k, p, d = np.nonzero((x >= neighbour) & (x + between >= x.max(axis=0)))
    found: FloatArray = x.max(axis=0)
    np.maximum.at(found, (p, d), _extreme(X[p, :, d], h, step * k, step, options.max_steps))
    return found


def _extreme(
    X: ComplexArray, h: npt.NDArray[np.intp], start: FloatArray, step: float, steps: int
) -> FloatArray:
    """Displacements (n,) of motions X (n, harmonic) at the extremes next to angles, by Newton's method."""
    theta = start
    for _ in range(steps):
        turns = X * np.exp(1j * h * theta[:, None])
        slope, bend = (np.sum((1j * h) ** k * turns, axis=1).real for k in (1, 2))
        theta = theta - slope / np.where(bend != 0.0, bend, 1.0)
        theta = np.where(np.abs(theta - start) < step, theta, start)
    found: FloatArray = np.sum(X * np.exp(1j * h * theta[:, None]), axis=1).real
    return found
