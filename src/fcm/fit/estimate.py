r"""Result of a fit: numbers, standard errors, intervals, correlations, and what is undetermined.

With the residuals r of N components in units of their errors, and their rates J by the k unknowns, the
covariance of the unknowns is

    C = s^2 (J^T J)^-1,    s^2 = r^T r / (N - k)

This holds if the errors of the points are independent, and known up to one common factor. Intervals are those
of Student's distribution with N - k degrees of freedom. Values beyond the bounds of a number were not
compared with the data, so that the data do not determine an end of an interval there.
Source: Seber and Wild, "Nonlinear Regression" (1989), section 2.1.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import t as student

from fcm.fit.least_squares_rows import ResidualRows
from fcm.fit.options import FIT, FitOptions
from fcm.fit.parameters import Parameters
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray


class Estimate(Frozen):
    """The best-fit numbers and their uncertainty.

    values, error: (number,), the standard error in the number's unit. interval: (number, 2), NaN for an end
    beyond the bounds. correlation: (number, number), NaN for a number without effect. without_effect,
    undetermined, at_bound: (number,) 1 where true, else 0. alike: pairs (i, j, p) that the data do not
    distinguish; they determine only number i times number j to the power of p.
    """

    values: FloatArray
    error: FloatArray
    interval: FloatArray
    correlation: FloatArray
    without_effect: FloatArray
    undetermined: FloatArray
    at_bound: FloatArray
    alike: tuple[tuple[int, int, float], ...]


def estimated(
    parameters: Parameters, values: FloatArray, rows: ResidualRows, options: FitOptions = FIT
) -> Estimate:
    """The estimate from the rows of residuals at the best-fit numbers."""
    rates = parameters.rates(values)
    J = rows.rates * rates
    count = J.shape[-1]
    effect = np.abs(J).max(axis=(0, 1), initial=0.0)
    told = np.flatnonzero(effect > options.min_effect)
    covariance = np.full((count, count), np.nan)
    freedom = max(rows.independent - told.size, 1)
    if told.size:
        covariance[np.ix_(told, told)] = _covariance(
            rows.residual, J[:, :, told], freedom, options.rank_tolerance
        )
    spread = np.sqrt(np.where(np.isnan(np.diag(covariance)), np.inf, np.diag(covariance)))
    with np.errstate(invalid="ignore", divide="ignore"):
        correlation = covariance / np.outer(spread, spread)
    half_width = student.ppf(0.5 + 0.5 * options.confidence, freedom) * spread
    x = parameters.unknowns(values)
    with np.errstate(over="ignore", invalid="ignore"):
        ends = np.column_stack((parameters.values(x - half_width), parameters.values(x + half_width)))
        ends[ends[:, 0] < parameters.low, 0] = np.nan
        ends[ends[:, 1] > parameters.high, 1] = np.nan
    without = np.ones(count)
    without[told] = 0.0
    relative = np.where(
        parameters.log > 0.0, spread, spread * parameters.unit / np.maximum(abs(values), 1e-300)
    )
    close = [np.isclose(values, end, rtol=1e-4, atol=0.0) for end in (parameters.low, parameters.high)]
    of_told = J[:, :, told].reshape(len(J) * J.shape[1], told.size)  # empty if no number has an effect
    pairs = _alike(_floored(of_told, options.rank_tolerance), options) if told.size else []
    alike = tuple(
        (int(told[i]), int(told[j]), power)
        for i, j, power in pairs
        if max(relative[told[i]], relative[told[j]]) > options.sure_standard_error
    )
    return Estimate(
        values=values,
        error=spread * rates,
        interval=ends,
        correlation=correlation,
        without_effect=without,
        undetermined=((relative > options.max_standard_error) & (without == 0.0)).astype(float),
        at_bound=(close[0] | close[1]).astype(float),
        alike=alike,
    )


def _covariance(residual: FloatArray, J: FloatArray, freedom: int, rank: float) -> FloatArray:
    """C (number, number); variances are infinite for numbers in a combination without effect."""
    flat = J.reshape(-1, J.shape[-1])
    size = np.sqrt((flat**2).sum(axis=0))
    _, singular, V = np.linalg.svd(flat / size, full_matrices=False)
    seen = singular > rank * singular.max(initial=0.0)
    inverse = (V[seen].T / singular[seen] ** 2) @ V[seen]
    found: FloatArray = inverse / np.outer(size, size) * float((residual**2).sum()) / freedom
    hidden = np.abs(V[~seen]).max(axis=0, initial=0.0) > np.sqrt(rank)
    found[np.diag_indices(len(found))] = np.where(hidden, np.inf, np.diag(found))
    return found


def _floored(J: FloatArray, rank: float) -> FloatArray:
    """(J^T J)^-1, with the singular values of the normalised J bounded below by a share of the greatest.

    So correlations are also finite for combinations without effect.
    """
    size = np.sqrt((J**2).sum(axis=0))
    _, singular, V = np.linalg.svd(J / size, full_matrices=False)
    inverse = (V.T / np.maximum(singular, rank * singular.max(initial=0.0)) ** 2) @ V
    found: FloatArray = inverse / np.outer(size, size)
    return found


def _alike(covariance: FloatArray, options: FitOptions) -> list[tuple[int, int, float]]:
    """Strongly correlated pairs (i, j, p), of which the data determine i times j to the power of p.

    The combination x_i + p x_j of the unknowns has the least variance for p = -C_ij / C_jj.
    """
    spread = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(spread, spread)
    pairs = [
        (j, i)
        for i in range(len(spread))
        for j in range(i)
        if abs(correlation[i, j]) > options.max_correlation
    ]
    return [(i, j, float(-covariance[i, j] / covariance[j, j])) for i, j in pairs]
