r"""Frequencies at which symmetric motions lose their symmetry by even harmonics that are not balanced.

A symmetric motion has only odd harmonics, and loses its symmetry by even ones. Its branch points are those of
the balance with all even harmonics up to twice the highest; the motion solves it with these at zero. If the
balance with fewer harmonics lacks a branch point, or has it at another frequency, the sign of its determinant
differs along a stretch of the branch. The lacking harmonics are the fewest with which no stretch differs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from fcm.branches.branch_points import branch_point_at, sign_change_at, sign_changes
from fcm.branches.force_level import LEVEL_REACH
from fcm.branches.options import BRANCHING, BranchingOptions
from fcm.branches.symmetry import is_symmetric
from fcm.branches.trace import Traced
from fcm.continuation import Path
from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import begin_near
from fcm.frozen import Frozen
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class SymmetryLoss(Frozen):
    """Frequencies [rad/s] at which symmetry is lost by harmonics not balanced, and these harmonics."""

    frequencies: tuple[float, ...] = ()
    harmonics: tuple[int, ...] = ()


def symmetry_loss(system: System, found: Traced) -> SymmetryLoss:
    """Find where branches leave symmetric ones by even harmonics that the system lacks."""
    few, options = (
        len(system.scene.contacts) < system.option(LEVEL_REACH).min_contacts,
        system.option(BRANCHING),
    )
    most = int((options.even_factor if few else 1.0) * system.harmonics[-1])
    every = tuple(sorted({*system.harmonics, *range(2, most + 1, 2)}))
    if every == system.harmonics or not system.scene.contacts:
        return SymmetryLoss()
    frequencies, harmonics = list[float](), set[int]()
    for path in (one for one in found.branches.paths if is_symmetric(system, one)):
        omega, lacking = _loss_of(system, system.with_harmonics(every), path, options)
        frequencies += omega
        harmonics |= lacking
    for level_omega, even in found.symmetry_lost_in_level:
        if lacking := {*even} - {*system.harmonics}:
            frequencies.append(level_omega)
            harmonics |= lacking
    return SymmetryLoss(tuple(dict.fromkeys(frequencies)), tuple(sorted(harmonics)))


def _loss_of(
    system: System, whole: System, path: Path, options: BranchingOptions
) -> tuple[list[float], set[int]]:
    """Frequencies [rad/s] of the branch points that a path has only with all even harmonics.

    Also returns the harmonics that its system lacks for these.
    """
    finer, coarser = _with_more(system, whole, path, options), _Judged(path, system)
    balance = whole.new_balance()
    frequencies, change = list[float](), np.zeros(len(whole.harmonics))
    changes = sign_changes(finer.path.orientation)
    for i in (i for ends in _differing(finer, coarser, options) for i in ends if i in changes):
        point = branch_point_at(balance, partial(jacobian_of, balance), finer.path, i, options)
        by = np.abs(whole.layout.complex_ports(point.direction)[:, 1:]).max(axis=0)
        if whole.harmonics[int(by.argmax())] % 2 == 0:
            frequencies.append(float(point.z[-1]))
            change = np.maximum(change, by / by.max())
    lacking = set[int]()
    for h in [whole.harmonics[k] for k in np.argsort(-change, kind="stable")] if frequencies else ():
        if h not in system.harmonics:
            lacking.add(h)
            more = system.with_harmonics(tuple(sorted({*system.harmonics, *lacking})))
            if not _differing(finer, _with_more(system, more, path, options), options):
                break
    return frequencies, lacking


class _Judged(Frozen):
    """A path with the determinant's signs of a system as its orientation."""

    path: Path
    system: System


def _differing(finer: _Judged, coarser: _Judged, options: BranchingOptions) -> list[tuple[int, int]]:
    """Points before, and at the end of, stretches of a path whose sign differs with fewer harmonics.

    Only stretches wider than the possible displacement of a branch point count. If that depends on the steps
    at the ends of a stretch, these ends are located."""
    differ = finer.path.orientation * coarser.path.orientation < 0.0
    parameter, wide = finer.path.parameter, list[tuple[int, int]]()
    ends = np.flatnonzero(np.diff(differ, prepend=False, append=False)).tolist()
    for first, end in zip(ends[::2], ends[1::2], strict=True):
        inside, around = parameter[first:end], parameter[max(first - 1, 0) : end + 1]
        if not _is_wide(inside, options) and _is_wide(around, options):
            inside = np.append(inside, list(_places((finer, coarser), (first - 1, end - 1), options)))
        if _is_wide(inside, options):
            wide.append((first - 1, end - 1))
    return wide


def _is_wide(omega: FloatArray, options: BranchingOptions) -> bool:
    return bool(omega.max() > (1.0 + options.max_displacement) * omega.min())


def _places(judged: Sequence[_Judged], steps: Sequence[int], options: BranchingOptions) -> Iterator[float]:
    """Yield the frequencies [rad/s] within the given steps at which one of the signs changes."""
    for i in steps:
        for path, system in ((one.path, one.system) for one in judged):
            if 0 <= i < len(path.z) - 1 and path.orientation[i] * path.orientation[i + 1] < 0.0:
                yield float(sign_change_at(system.new_balance(), path, i, options)[-1])


def _with_more(system: System, more: System, path: Path, options: BranchingOptions) -> _Judged:
    """A path of a system with the orientations that more harmonics give it.

    They are NaN where the path with the further harmonics at zero is no solution, as where these are driven.
    """
    z, direction = (more.extended(one, system.harmonics) for one in (path.z, path.direction))
    newton, orientation = Newton(more.new_balance()), np.full(len(z), np.nan)
    for i, (one, way) in enumerate(zip(z, direction, strict=True)):
        begin_near(newton, one, way)
        if not newton.take_tangent():
            continue
        off = np.asarray(newton.problem.residual) / np.asarray(newton.scale)[:-1]
        if np.abs(off).max(initial=0.0) < options.min_residual:
            orientation[i] = newton.orientation
    return _Judged(replace(path, z=z, direction=direction, orientation=orientation), more)
