"""Advises the measurement that would best determine the numbers that the data leave undetermined.

This is the measurement with which the standard errors become least.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fcm.fit.forced import NoMotionError, errors_of, forced_rows, sampled
from fcm.fit.options import ADVICE, FIT, FitOptions
from fcm.fit.parameters import Parameters
from fcm.fit.solve import Solved
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray


class Advice(Frozen):
    """A response to measure over the range of the data, at a degree of freedom and a force level.

    error : relative standard error of the number with this measurement.
    """

    key: str
    dof: str
    level: float
    error: float


def advice(
    parameters: Parameters,
    fitted: Solved,
    doubtful: Sequence[int],
    harmonics: tuple[int, ...],
    options: FitOptions = FIT,
) -> list[Advice]:
    """The responses that would best determine undetermined numbers; none for a number that no one helps."""
    responses = [one for one in fitted.data if one.damping is None]
    if not responses or not doubtful:
        return []
    scene, rates = parameters.at(fitted.values), parameters.rates(fitted.values)
    known = _information(fitted.rows.rates * rates)
    before = _errors(known)
    best: dict[int, Advice] = {}
    model = responses[0]
    dofs = list(dict.fromkeys([*(one.dof for one in responses), *scene.modal.dofs]))[: ADVICE.max_dofs]
    levels = [float(one.level.min()) for one in responses] + [float(one.level.max()) for one in responses]
    tried = sorted(
        {min(levels) * f for f in ADVICE.level_factors if f < 1.0}
        | {max(levels) * f for f in ADVICE.level_factors if f > 1.0}
    )
    tried += sorted(set(levels)) if len(dofs) > 1 else []
    for dof in dofs:
        for level in tried:
            try:
                imagined = sampled(scene, replace(model, dof=dof), level, ADVICE.points, harmonics, options)
                errors = errors_of(imagined, False, options)
                found = forced_rows(scene, parameters.keys, harmonics, imagined, errors, options)
            except (NoMotionError, np.linalg.LinAlgError):
                continue
            after = _errors(known + _information(found.rates * rates))
            for k in doubtful:
                if after[k] < min(ADVICE.max_ratio * before[k], options.max_standard_error) and (
                    k not in best or after[k] < best[k].error
                ):
                    best[k] = Advice(parameters.keys[k], dof, level, float(after[k]))
    return [best[k] for k in doubtful if k in best]


def _information(J: FloatArray) -> FloatArray:
    """Information matrix J^T J of independent residuals in units of their errors."""
    flat = J.reshape(-1, J.shape[-1])
    found: FloatArray = flat.T @ flat
    return found


def _errors(information: FloatArray) -> FloatArray:
    """Standard errors of the unknowns; infinite where the information is zero."""
    size = np.sqrt(np.maximum(np.diag(information), 0.0))
    seen = size > 0.0
    errors = np.full(size.size, np.inf)
    if seen.any():
        scaled = information[np.ix_(seen, seen)] / np.outer(size[seen], size[seen])
        values, vectors = np.linalg.eigh(scaled)
        values = np.maximum(values, ADVICE.min_eigenvalue)
        errors[seen] = np.sqrt(((vectors**2) / values).sum(axis=1)) / size[seen]
    return errors
