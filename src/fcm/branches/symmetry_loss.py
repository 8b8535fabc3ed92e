r"""Frequencies at which symmetric motions lose their symmetry by even harmonics that are not balanced.

A symmetric motion has odd harmonics alone, and loses its symmetry by even ones. So its branch points are
those of the balance with all even harmonics up to the highest, which it solves with none of these. Where the
balance with fewer lacks one, or has it at another frequency, the sign of the determinant is another along a
stretch of the branch. The harmonics that it lacks are the fewest with which there is no such stretch.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fcm.branches.branch_points import BranchPoint, branch_point_at, sign_changes
from fcm.branches.options import BRANCHING, BranchingOptions
from fcm.branches.trace import Traced
from fcm.continuation import Path
from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import begin_near
from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


class SymmetryLoss(Frozen):
    """Frequencies [rad/s] at which symmetric motions lose their symmetry by harmonics that are not balanced,
    and which these are."""

    frequencies: tuple[float, ...] = ()
    harmonics: tuple[int, ...] = ()


def symmetry_loss(system: System, found: Traced, options: BranchingOptions = BRANCHING) -> SymmetryLoss:
    """Places where branches of a system leave symmetric ones by even harmonics that it lacks."""
    whole = system.with_harmonics(tuple(sorted({*system.harmonics, *range(2, system.harmonics[-1] + 1, 2)})))
    if whole.harmonics == system.harmonics or not system.scene.contacts:
        return SymmetryLoss()
    frequencies, harmonics = list[float](), set[int]()
    for path in found.branches.paths:
        omega, lacking = _loss_of(system, whole, path, options)
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
    """Frequencies [rad/s] of branch points of a path with all even harmonics that its system has not, and the
    harmonics that it lacks."""
    finer, balance = _with_more(system, whole, path, options), whole.new_balance()
    frequencies, change = list[float](), np.zeros(len(whole.harmonics))
    changes = sign_changes(finer.orientation)
    for i in (i for ends in _differing(finer, path, options) for i in ends if i in changes):
        point = branch_point_at(balance, balance, finer, i, options)
        by = _changes(whole, point)
        if whole.harmonics[int(by.argmax())] % 2 == 0 and by.any():
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


def _differing(finer: Path, coarser: Path, options: BranchingOptions) -> list[tuple[int, int]]:
    """The points before and at the end of stretches of a path where its sign is another with fewer harmonics.

    Only stretches that are wider than the possible displacement of a branch point."""
    differ, wide = finer.orientation * coarser.orientation < 0.0, list[tuple[int, int]]()
    ends = np.flatnonzero(np.diff(differ, prepend=False, append=False)).tolist()
    for first, end in zip(ends[::2], ends[1::2], strict=True):
        omega = finer.parameter[first:end]
        if omega.max() > (1.0 + options.max_displacement) * omega.min():
            wide.append((first - 1, end - 1))
    return wide


def _changes(system: System, point: BranchPoint) -> FloatArray:
    """Changes of the displacements of each harmonic (harmonic,) where branches leave a point."""
    ports = [system.layout.complex_ports(one - point.z)[:, 1:] for one in point.starts]
    change: FloatArray = np.max([np.abs(one).max(axis=0) for one in ports], axis=0, initial=0.0)
    return change


def _with_more(system: System, more: System, path: Path, options: BranchingOptions) -> Path:
    """A path of a system with the orientations that more harmonics give it; NaN where it is no solution with
    nothing of the others, as where these are driven."""
    z, direction = (more.extended(one, system.harmonics) for one in (path.z, path.direction))
    newton, orientation = Newton(more.new_balance()), np.full(len(z), np.nan)
    for i, (one, way) in enumerate(zip(z, direction, strict=True)):
        begin_near(newton, one, way)
        if not newton.take_tangent():
            continue
        off = np.asarray(newton.problem.residual) / np.asarray(newton.scale)[:-1]
        if np.abs(off).max(initial=0.0) < options.min_residual:
            orientation[i] = newton.orientation
    return replace(path, z=z, direction=direction, orientation=orientation)
