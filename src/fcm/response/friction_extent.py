"""Range of motions over residual friction at points of a curve where a contact never slips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fcm.at_rest import RestOptions
from fcm.model.scene import FloatArray, Scene, has_friction
from fcm.response.coexisting_search import CoexistingMotions, Search
from fcm.response.options import COEXISTING
from fcm.response.resumable_branches import TimeOver
from fcm.results.orbits import Stuck
from fcm.shooting.orbit_record import OrbitRecord
from fcm.shooting.partly_sticking_orbits import partly_stuck_motions
from fcm.shooting.traction_families import Family, family
from fcm.time_domain.errors import SimulationError

REST = RestOptions()


@dataclass
class FrictionExtent:
    """Extent of the amplitudes over residual friction at points, nan where unique; and isolated motions."""

    least: FloatArray  # (point, dof)
    greatest: FloatArray  # (point, dof)
    whole: FloatArray  # (point,) 1 if the extent covers all residual friction, 0 if not, nan without one
    isolated: list[Stuck] = field(default_factory=list)  # motions outside all extents


def friction_extent(
    scene: Scene,
    points: Sequence[OrbitRecord | None],
    amplitude: FloatArray,
    rows: Sequence[int],
    search: Search,
) -> FrictionExtent:
    """The extent over residual friction at the points rows; amplitude (point, dof) is that of all points."""
    least, greatest = np.full_like(amplitude, np.nan), np.full_like(amplitude, np.nan)
    out = FrictionExtent(least, greatest, np.full(len(points), np.nan))
    told = [(k, point) for k in rows if (point := points[k]) is not None]
    for omega in sorted({point.frequency for _, point in told}):
        here = [k for k, point in told if point.frequency == omega]
        found = search.known(omega, amplitude[here])
        if found is None:
            samples = [point for _, point in told if point.frequency == omega]
            found = _told(scene, samples, CoexistingMotions.unknown(omega, amplitude[here]), search)
            search.keep(found)
        out.least[here], out.greatest[here], out.whole[here] = found.least, found.greatest, found.whole
        out.isolated += found.isolated
    return out


def _told(
    scene: Scene, points: list[OrbitRecord], out: CoexistingMotions, search: Search
) -> CoexistingMotions:
    """Fill out with the extent over residual friction at the points of one frequency."""
    families, amplitude = dict[int, Family](), out.amplitude
    for k, point in enumerate(points):
        same = [
            one
            for one in families
            if np.allclose(amplitude[one], amplitude[k], rtol=COEXISTING.amplitude_tolerance, atol=0.0)
        ]
        found = families[same[0]] if same else _family(scene, point, out.whole, k, search)
        if found is not None:
            families[k] = found
    known = list(families.values())
    try:
        others = partly_stuck_motions(scene, out.frequency, known, search.poll, search.options)
    except TimeOver:
        others = []
    for k, found in families.items():
        those = [one for one in others if not set(one.family.contacts).isdisjoint(found.contacts)]
        least = np.min([found.least, *(one.family.least for one in those)], axis=0)
        greatest = np.max([found.greatest, *(one.family.greatest for one in those)], axis=0)
        whole = found.complete and not search.over
        if (
            greatest - least
            > COEXISTING.amplitude_tolerance * greatest + REST.displacement * greatest.max(initial=0.0)
        ).any():
            out.least[k], out.greatest[k], out.whole[k] = least, greatest, whole
        elif not whole:
            out.whole[k] = 0.0
    for one in others:
        if all(set(one.family.contacts).isdisjoint(found.contacts) for found in families.values()):
            extent = one.family.least, one.family.greatest
            out.isolated.append(Stuck(out.frequency, one.states, 0.0 - one.residual, *extent))
    return out


def _family(scene: Scene, point: OrbitRecord, whole: FloatArray, k: int, search: Search) -> Family | None:
    """The family of point k; None without one, or if it is unknown, and whole[k] is then 0."""
    alone = len(scene.contacts) == 1 and has_friction(scene.contacts[0])
    if "E" not in point.states or (alone and set(point.states) == {"E"}):  # with several, another may slip
        return None
    try:
        if point.repeats:
            return family(scene, point.frequency, point.state, point.repeats, search.poll, search.options)
        if point.steady is not None and (point.steady.shares[:, 0] == 1.0).any():
            whole[k] = 0.0
    except (SimulationError, TimeOver):  # its neighbourhood cannot be computed, or the time is over
        whole[k] = 0.0
    return None
