"""Curves of the level that systems have in common, whose preloads alone differ, and those all by one factor.

The equations are homogeneous in displacements, forces and preloads together: what a preload n_0 makes of the
level 1, the preload 1 makes of the level 1 / n_0. So a sweep of preloads follows one curve at a frequency,
of the greatest preload 1 (and -1), as far as any of them needs it. Each of its curves finds its solutions on
that. Which one of them followed it does not matter.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fcm.branches.options import LEVEL_CURVE, SHARED_LEVELS
from fcm.continuation import Path, Status
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

Followed = Callable[[System, float, float], Path]


class _CurveCache(threading.local):
    """Curves of the level that each thread keeps, by what they depend on; None for those that did not end."""

    def __init__(self) -> None:
        self.paths: OrderedDict[tuple[object, ...], Path | None] = OrderedDict()


_CURVES = _CurveCache()


def clear() -> None:
    """Forget all curves, at the beginning of another sweep."""
    _CURVES.paths.clear()


def shared_curve(system: System, omega: float, top: float, followed: Followed) -> Path | None:
    """The curve of the system with preloads of 1 up to a level, as it is followed once.

    A longer one that is known is cut there. Nothing if that does not come to its end.
    """
    key = (*_curve_key(system), omega)
    kept, enough = _CURVES.paths, top / (1.0 + system.option(LEVEL_CURVE).level_tolerance)
    path = kept.get(key)
    if key not in kept or (path is not None and path.parameter[-1] < enough):
        path = followed(system.normalised, omega, top)
        kept[key] = path = path if path.status is Status.COMPLETE else None
    kept.move_to_end(key)
    if len(kept) > SHARED_LEVELS.max_kept:
        kept.popitem(last=False)
    if path is None:
        return None
    count = 1 + int((path.parameter >= enough).argmax())
    return replace(path.part(np.arange(count)), evaluations=path.evaluations * count // len(path.z))


def _curve_key(system: System) -> tuple[object, ...]:
    """The numbers that a curve of the level depends on, besides the frequency."""
    laws = tuple((c.mu, c.k_u, c.k_v, c.n_0) for c in system.normalised.scene.contacts)
    return *system.linear.numbers, laws, system.harmonics, system.other_options


def solutions_at_level_one(system: System, path: Path, omega: float) -> list[FloatArray] | None:
    """Solutions (unknown + 1,) of the system at the level 1, from the curve in common.

    Nothing if one that has to be there is not found between the points that enclose it.
    """
    unit = system.preload_unit
    off = path.parameter - 1.0 / unit
    found = []
    for i in np.flatnonzero((off[:-1] * off[1:] < 0.0) | (off[:-1] == 0.0)):
        ends = unit * path.z[i : i + 2, :-1]
        x = _solution_between(system, omega, ends, off[i] / (off[i] - off[i + 1]))
        if x is None:
            return None
        found.append(np.append(x, omega))
    return found


def _solution_between(system: System, omega: float, ends: FloatArray, part: float) -> FloatArray | None:
    """The solution near a part of the way between two of other levels, if it lies between them."""
    level, stepper = system.level_problem
    level.begin(omega)
    newton, chord = stepper.newton, ends[1] - ends[0]
    newton.z[:] = np.append(ends[0] + part * chord, 1.0)
    newton.row[:] = np.append(np.zeros(chord.size), 1.0)
    level.evaluate_scale(newton.z)
    newton.scale[:] = level.scale
    unit = np.asarray(newton.scale)[:-1]
    way = chord / unit
    length = float(np.linalg.norm(way))
    if not newton.correct(length) or newton.moved > length:
        return None
    x = np.array(newton.z)[:-1]
    along = float(((x - ends[0]) / unit) @ way) / length**2
    return x if -SHARED_LEVELS.extrapolation <= along <= 1.0 + SHARED_LEVELS.extrapolation else None
