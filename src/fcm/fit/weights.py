r"""Unstated errors of measured points, estimated from the residuals of a first fit.

The errors of amplitudes A of a response have a floor a and a share b: sigma^2 = a^2 + (b A)^2, as of a sensor
with noise and a calibration error. a and b maximise the likelihood of normally distributed distances r: they
minimise the sum of ln sigma^2 + r^2 / sigma^2. Only one of them is used if the other improves the likelihood
too little. The frequencies of a backbone have one common error, its damping ratios another: the root mean
squares.

Sources: Carroll and Ruppert, "Transformation and Weighting in Regression" (1988), chapter 3; Schwarz,
"Estimating the Dimension of a Model", Annals of Statistics 6 (1978).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from fcm.fit.backbone import backbone_errors
from fcm.fit.forced import errors_of
from fcm.fit.least_squares_rows import ResidualRows
from fcm.fit.options import FitOptions
from fcm.model.scene import FloatArray, Measured


def reweighted(
    data: Sequence[Measured], parts: Sequence[ResidualRows], options: FitOptions, share: bool = False
) -> tuple[list[Measured], float]:
    """The data with estimated errors where none are stated, and how unlikely the distances are.

    All responses of one quantity share their errors. share: whether to use errors proportional to the
    amplitudes even if others are likelier. The unlikeliness is the sum of ln sigma^2 + r^2 / sigma^2 over all
    components; for stated errors r is in their units, and sigma = 1.
    """
    found, unlikely = list(data), 0.0
    alike: dict[str, list[int]] = {}
    for i, (one, rows) in enumerate(zip(data, parts, strict=True)):
        if one.damping is not None and one.frequency_error is None and one.damping_error is None:
            found[i], more = _of_backbone(one, rows, options)
            unlikely += more
        elif one.damping is None and one.amplitude_error is None:
            alike.setdefault(one.quantity, []).append(i)
        else:
            unlikely += 2.0 * rows.cost
    for numbers in alike.values():
        amplitude = np.concatenate([data[i].amplitude for i in numbers])
        square = np.concatenate([_squares(data[i], parts[i], options) for i in numbers])
        components = np.concatenate([np.full(data[i].points, data[i].components - 1.0) for i in numbers])
        more, sigma = _errors(amplitude, square, components, options.min_error, share)
        unlikely += more
        ends = np.cumsum([data[i].points for i in numbers])[:-1]
        for i, own in zip(numbers, np.split(sigma, ends), strict=True):
            found[i] = replace(data[i], estimated=(own / np.sqrt(data[i].weight))[:, None])
    return found, unlikely


def _of_backbone(data: Measured, rows: ResidualRows, options: FitOptions) -> tuple[Measured, float]:
    """A backbone with a common error of frequencies and one of damping ratios, and its unlikeliness."""
    assert data.damping is not None
    distance = rows.residual[:, :2] * backbone_errors(data, options)
    square = (data.weight[:, None] * distance**2).mean(axis=0)
    size = np.maximum(
        np.sqrt(square), options.min_error * np.array([data.frequency.max(), data.damping.max()])
    )
    unlikely = data.points * float((np.log(size**2) + square / size**2).sum())
    return replace(data, estimated=size / np.sqrt(data.weight[:, None])), unlikely


def _squares(data: Measured, rows: ResidualRows, options: FitOptions) -> FloatArray:
    """Weighted squared distances (point,) of a response's points, per independent component."""
    unit, components = errors_of(data, False, options).amplitude, data.components - 1
    distance: FloatArray = (rows.residual[:, : components + 1] ** 2).sum(axis=1) * unit**2
    return distance * data.weight / components


def _errors(
    amplitude: FloatArray, square: FloatArray, components: FloatArray, least: float, share: bool
) -> tuple[float, FloatArray]:
    """How unlikely the distances are, and the errors sigma (point,) that fit their squares best.

    The errors are a floor alone, a share alone, or both, by Schwarz's criterion. A share alone is impossible
    with points of amplitude 0. components : (point,) number of independent ones; share : whether to use a
    share alone.
    """
    top = float(amplitude.max())
    typical = max(float(np.sqrt(square.mean())), least * top)

    def told(size: FloatArray, numbers: int) -> tuple[float, FloatArray]:
        size = size + (least * top) ** 2
        unlikely = float((components * (np.log(size) + square / size)).sum())
        return unlikely + numbers * np.log(components.sum()), np.sqrt(size)

    # with a single parameter the maximum is known: the weighted mean of square / shape
    shapes = [np.ones(amplitude.size), (amplitude / top) ** 2][: 2 if amplitude.all() else 1]
    found = [told(shape * np.average(square / shape, weights=components), 1) for shape in shapes]
    if share:
        return found[-1]

    def both(x: FloatArray) -> FloatArray:
        floor, share = np.exp(np.clip(2.0 * x, -80.0, 80.0)) * typical**2
        size: FloatArray = floor + share * (amplitude / top) ** 2
        return size

    tried = [
        minimize(lambda x: told(both(x), 2)[0], x, method="Nelder-Mead") for x in (np.zeros(2), -np.ones(2))
    ]
    found += [told(both(one.x), 2) for one in tried]
    return min(found, key=lambda one: one[0])
