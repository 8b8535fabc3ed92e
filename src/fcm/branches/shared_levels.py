"""Curves of the level shared by systems that differ only by a common factor of all preloads.

The equations are homogeneous in displacements, forces and preloads together: the response to the preload n_0
and the level 1 is n_0 times that to the preload 1 and the level 1 / n_0. So a sweep of preloads follows one
curve at a frequency, with the greatest preload 1 (or -1), as far as any system needs it. Each system finds
its solutions on that curve. Which one followed it does not matter.
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
    """Cache of each thread: curves of the level by their key; None for those without an end."""

    def __init__(self) -> None:
        self.paths: OrderedDict[tuple[object, ...], Path | None] = OrderedDict()


_CURVES = _CurveCache()


def clear() -> None:
    """Forget all curves, at the beginning of another sweep."""
    _CURVES.paths.clear()


def shared_curve(system: System, omega: float, top: float, followed: Followed) -> Path | None:
    """The curve of the normalised system, with the greatest preload 1, up to a level; followed only once.

    A longer known curve is cut there. None if the curve does not come to its end.
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
    """Solutions (unknown + 1,) of the system at the level 1, from the shared curve.

    None if Newton's method does not find one between the points that enclose it.
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
    """The solution at the level 1 near a fraction of the chord between two other levels, if between them."""
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
