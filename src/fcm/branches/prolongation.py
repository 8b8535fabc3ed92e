"""Solutions with few harmonics prolongated to more: zero for the new ones, then Newton's method.

Each branch is prolongated at several of its points, as the branch of more harmonics may leave that of few
anywhere. The solution with more is sought in the plane normal to the curve of few. If Newton's method
diverges, a homotopy starts from the equations that the point of few solves (`Prolongation`). If that fails,
too, solutions with some of the harmonics are found on the way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from fcm.branches.options import PROLONGATION_POINTS, ProlongationPointOptions
from fcm.continuation import Mark, Path
from fcm.continuation.nearby_solution import solution_near
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray


def prolongated(system: System, fewer: Sequence[int], paths: Sequence[Path]) -> Iterator[FloatArray]:
    """Yield solutions (unknown + 1,) of a system within its range, near points of paths of fewer harmonics.

    The first point of each path comes first, then the next of each, so that most branches are known early.
    Then follow the last points before Newton's method diverges. There the branch of more harmonics leaves
    that of few, and may be another one than elsewhere.
    """
    low, high, options = *system.scene.frequency_range, system.option(PROLONGATION_POINTS)
    ways = _harmonic_stages(system, tuple(fewer), options)
    every = [_ProlongatedPath(path, ways, _prolongation_points(path, options)) for path in paths]
    for k in range(max((len(one.places) for one in every), default=0)):
        for one in every:
            z = one.at(one.places[k]) if k < len(one.places) else None
            if z is not None and low <= z[-1] <= high:
                yield z
    for one in every:
        yield from (z for z in one.ends() if low <= z[-1] <= high)


class _ProlongatedPath:
    """A path of few harmonics, and the solutions with more to which its points lead."""

    def __init__(self, path: Path, ways: Sequence[Sequence[Prolongation]], places: Sequence[int]) -> None:
        self.path, self.ways, self.places = path, ways, places
        self.leads = dict[int, bool]()

    def at(self, i: int) -> FloatArray | None:
        """The solution near point i; None if there is none."""
        there = (_prolongated_by_stages(way, self.path.z[i], self.path.direction[i]) for way in self.ways)
        z = next((z for z in there if z is not None), None)
        self.leads[i] = z is not None
        return z

    def ends(self) -> Iterator[FloatArray]:
        """Yield the solutions near the last points before Newton's method diverges, by bisection."""
        for here, there in pairwise(sorted(self.leads)):
            low, high = (here, there) if self.leads[here] else (there, here)
            if self.leads[here] == self.leads[there]:
                continue
            last = None
            while abs(high - low) > 1:
                middle = (low + high) // 2
                z = self.at(middle)
                low, high, last = (middle, high, z) if z is not None else (low, middle, last)
            if last is not None:
                yield last


def at_its_frequency(system: System, z: FloatArray) -> FloatArray | None:
    """The solution that Newton's method finds from z at its frequency, if that is not far."""
    options = system.option(PROLONGATION_POINTS)
    system.reset_balance()
    newton = system.shared_stepper.newton
    found = solution_near(newton, z)
    return found if found is not None and newton.moved < options.max_change else None


def _harmonic_stages(
    system: System, fewer: tuple[int, ...], options: ProlongationPointOptions
) -> list[list[Prolongation]]:
    """Ways from fewer harmonics to those of a system: in one stage, and in stages with some of them."""
    more = system.harmonics
    between, count = list[tuple[int, ...]](), len(fewer) * options.harmonics_factor
    while count < len(more):
        between.append(tuple(sorted({*fewer, *more[:count]})))
        count *= options.harmonics_factor
    ways = []
    for sets in dict.fromkeys(((more,), tuple(dict.fromkeys((*between, more))))):
        steps = zip((fewer, *sets), sets, strict=False)
        ways.append([_prolongation(system, few, many, options) for few, many in steps])
    return ways


def _prolongation(
    system: System, fewer: tuple[int, ...], more: tuple[int, ...], options: ProlongationPointOptions
) -> Prolongation:
    return Prolongation(system.with_harmonics(more).new_balance(), list(fewer), list(more), options.tolerance)


def _prolongated_by_stages(
    way: Sequence[Prolongation], z: FloatArray, direction: FloatArray
) -> FloatArray | None:
    """The solution near a point of a curve, by stages of more and more harmonics; None if one diverges."""
    for prolongation in way:
        if not (prolongation.find_normal(z, direction) and prolongation.newton.correct(1.0)):
            return None
        z, direction = (
            np.array(prolongation.newton.z),
            np.asarray(prolongation.newton.tangent) * prolongation.newton.scale,
        )
    return z


def _prolongation_points(path: Path, options: ProlongationPointOptions) -> list[int]:
    """The points of a path that are prolongated: its peaks, ends and folds, and some between them.

    A corner, a fold, or a peak at one of them, is replaced by a point beside it. While contacts rest, the
    point with more harmonics is the same, and no branch can start there at its frequency.
    """
    count = len(path.z)
    marked = [path.where(Mark.PEAK), np.array([0, count - 1]), path.where(Mark.FOLD)]
    marked.append(np.linspace(0, count - 1, min(options.spaced_points, count)).astype(np.intp))
    every = np.concatenate([_spaced(one, options.max_of_a_kind) for one in marked])
    plain = _plain_points(path, options)
    if plain.size:
        every = plain[np.abs(every[:, None] - plain).argmin(axis=1)]
    return list(dict.fromkeys(every.tolist()))


def _plain_points(path: Path, options: ProlongationPointOptions) -> npt.NDArray[np.intp]:
    """The points that neither are a corner or a fold, nor coincide with one along the path."""
    size, change = np.abs(path.z).max(axis=1, initial=0.0), np.abs(np.diff(path.z, axis=0)).max(axis=1)
    place = np.concatenate(([0], np.cumsum(change >= options.same_point * size[1:])))
    special = np.flatnonzero(path.mark & (Mark.CORNER | Mark.FOLD))
    return np.flatnonzero(~np.isin(place, place[special]))


def _spaced(places: npt.NDArray[np.intp], most: int) -> npt.NDArray[np.intp]:
    """At most `most` of the places, evenly spaced among them."""
    if len(places) <= most:
        return places
    return places[np.linspace(0, len(places) - 1, most).astype(np.intp)]
