r"""Pairs resonances with stuck contacts with the modes without contacts that are most alike in shape.

They do not correspond by number: a body that only its contacts hold has rigid-body modes without them.

The measure is the modal assurance criterion with the mass matrix. In modes of mass 1 a stuck shape is a unit
vector t of factors, and its criterion with mode i is

.. math:: MAC_i = t_i^2.

Modes of equal frequency count together, as any combination of them is a mode. The pairing maximises the sum,
with each mode in at most one pair.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.model.scene import FloatArray, Scene
from fcm.scene.contact_springs import stuck_stiffness
from fcm.scene.options import FRICTION_DAMPING, TOLERANCES


class StuckMode(NamedTuple):
    """An elastic mode with all contacts stuck, and the mode without contacts most alike in shape."""

    number: int  # index among all stuck modes by frequency, from 0
    frequency: float  # [rad/s]
    shape: FloatArray  # (mode,) factors of modes of mass 1
    open_mode: int  # index among the scene's modes
    mac: float  # modal assurance criterion of both, with the mass matrix


def stuck_modes(scene: Scene) -> list[StuckMode]:
    """The first elastic modes of a scene with all contacts stuck, by frequency."""
    import scipy.linalg  # which most runs do without
    from scipy.optimize import linear_sum_assignment

    modal, stiffness = scene.modal, stuck_stiffness(scene)
    own = modal.frequency.size - modal.added
    floating = int((modal.frequency == 0.0).sum())  # with contacts there are no more rigid-body modes
    last = min(own, floating + FRICTION_DAMPING.modes) - 1
    squares, shapes = scipy.linalg.eigh(stiffness, subset_by_index=[0, last])
    elastic = np.flatnonzero(squares > TOLERANCES.undamped * np.abs(stiffness).sum(axis=1).max(initial=0.0))
    alike = _equal(modal.frequency[:own]) @ shapes[:own, elastic] ** 2
    places, which = linear_sum_assignment(alike, maximize=True)
    of_stuck = dict(zip(which.tolist(), places.tolist(), strict=True))
    return [
        StuckMode(
            number,
            float(np.sqrt(squares[number])),
            shapes[:, number],
            of_stuck[i],
            float(min(alike[of_stuck[i], i], 1.0)),
        )
        for i, number in enumerate(elastic.tolist()[: FRICTION_DAMPING.modes])
    ]


def _equal(frequency: FloatArray) -> FloatArray:
    """Matrix (mode, mode): 1 where two modes have equal frequencies."""
    size = np.maximum(frequency[:, None], frequency)
    equal = np.abs(frequency[:, None] - frequency) <= TOLERANCES.equal_frequency * size
    return equal.astype(np.float64)
