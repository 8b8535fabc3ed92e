"""Estimate the size of a scene's results from its numbers of curves, contacts and outputs."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

from fcm.frozen import Frozen
from fcm.model.scene import Scene

NUMBER = 8  # bytes


class SizeOptions(Frozen):
    """Options on the numbers and bytes from which the size of results is estimated."""

    of_curve: int = 3000  # bytes of a curve without its points: names, peaks and arrays
    of_point: int = 4  # numbers of a point: frequency, stability, two errors
    # numbers of each degree of freedom at a point: amplitude, fundamental, phase, mean, two errors
    of_dof: int = 6
    # numbers of each contact at a point: five of its loop, four of its cycle, its states
    of_contact: int = 12
    kept_of_peaks: int = 6  # about the points kept of a curve without its points
    of_cycle: int = 3  # numbers of a cycle of a schedule, and as many for each degree of freedom
    matrices: int = 3  # matrices (unknown, unknown) of a balance: derivatives, a copy, factors
    few_modes: float = 0.5  # modes over ports below which the balance's matrices are condensed to the modes


def least_points(
    scene: Scene, peaks_only: bool, options: SizeOptions | None = None, curves: int | None = None
) -> int:
    """Least number of points that are kept of all curves; curves: their number, if they are not made yet.

    >>> from fcm import load_scene
    >>> least_points(load_scene("yang1998"), peaks_only=False)
    200
    """
    options = options or SizeOptions()
    if not scene.has_range:
        return 0
    curves = len(scene.each_curve()) if curves is None else curves
    return curves * (options.kept_of_peaks if peaks_only else ceil(1.0 / scene.max_step))


def bytes_of_results(
    scene: Scene,
    harmonics: Sequence[int],
    peaks_only: bool,
    options: SizeOptions | None = None,
    curves: int | None = None,
) -> float:
    """Lower bound of the bytes of curves and motions, in memory and as many again in a file.

    curves is their number, if they are not made yet.

    >>> from fcm import load_scene
    >>> scene = load_scene("yang1998")
    >>> bytes_of_results(scene, (1,), peaks_only=False)
    81200.0
    """
    options = options or SizeOptions()
    dofs, contacts = len(scene.modal.dofs), len(scene.contacts)
    curves = len(scene.each_curve()) if curves is None else curves
    many = 2 * len(harmonics)  # amplitude and phase of each
    motions = many * scene.directions_of_contact if len(harmonics) > 1 or scene.planar else 0
    point = options.of_point + dofs * (options.of_dof + many) + contacts * (options.of_contact + motions)
    cycles = sum(phase.cycles for phase in scene.schedule)
    moved = curves * cycles * options.of_cycle * (1 + dofs)
    return float(
        curves * options.of_curve
        + NUMBER * (least_points(scene, peaks_only, options, curves) * point + moved)
    )


def bytes_of_matrices(scene: Scene, harmonics: Sequence[int], options: SizeOptions | None = None) -> float:
    """Bytes of the matrices of the balance; 0 if they are condensed to the modes.

    >>> from fcm import load_scene
    >>> bytes_of_matrices(load_scene("yang1998"), (1, 2, 3))
    4704.0
    """
    options = options or SizeOptions()
    contacts = len(scene.contacts)
    unknowns = contacts * (2 + 4 * len(harmonics))
    if scene.ring is None and len(scene.modal.frequency) < options.few_modes * 2 * contacts:
        return 0.0
    return float(options.matrices * NUMBER * unknowns**2)
