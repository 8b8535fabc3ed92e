"""Restores omitted contacts in results, and measures the effect of omitted modes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.continuation.corrector import Newton
from fcm.continuation.nearby_solution import begin_near
from fcm.harmonic_balance.contact_cycles import cycles, loops
from fcm.harmonic_balance.contact_motions import contact_motions
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray, Scene
from fcm.reduction.negligible_parts import ReducedScenes
from fcm.reduction.options import REDUCTION
from fcm.results.contact_maxima import greatest_of
from fcm.results.result import Curve, Response
from fcm.structure.layout import Layout

IntArray = npt.NDArray[np.intp]


def restored(response: Response, lighter: ReducedScenes) -> Response:
    """The response with all contacts, including those that were not traced."""
    full = lighter.full
    if len(lighter.contacts) < len(full[0].contacts):
        response.contacts = tuple(c.name for c in full[0].contacts)
        for curve, scene in zip(response.curves, full, strict=True):
            _put_back(curve, scene, list(lighter.contacts))
    return response


def checked(response: Response, lighter: ReducedScenes) -> float:
    """Greatest relative shift of sampled points of the curves by a correction with all modes."""
    per_curve = max(min(REDUCTION.max_checked_of_curve, REDUCTION.max_checked // len(response.curves)), 1)
    shifts = []
    for number in _spread(len(response.curves), REDUCTION.max_checked):
        curve, scene = response.curves[number], lighter.exact[number]
        at = _sample(curve, per_curve)
        if at.size and scene.contacts:
            shifts.append(_shift(curve, scene, at))
    return max(shifts, default=0.0)


def _put_back(curve: Curve, scene: Scene, traced: list[int]) -> None:
    """Adds to a curve the loops and states of the contacts that were not traced, which carry no load."""
    if curve.points == 0:
        traced = []
        curve.loop, curve.regime, curve.cycle = curve.loop[:, :0], curve.regime[:, :0], curve.cycle[:, :0]
        curve.cycle_error = curve.cycle_error[:, :0]
    at = np.flatnonzero(np.isfinite(curve.frequency))
    loop = np.full((curve.frequency.size, len(scene.contacts), curve.loop.shape[-1]), np.nan)
    regime = np.full(loop.shape[:2], "", dtype=np.result_type("<U6", curve.regime))
    system = System(scene)
    z = unknowns(curve, scene, at, system.harmonics)
    cycle = np.full((*regime.shape, curve.cycle.shape[-1]), np.nan)
    loop[at] = loops(system, z)
    harmonics = curve.harmonics or (1,)
    motions = contact_motions(System(scene, harmonics), unknowns(curve, scene, at, harmonics))
    rows = np.full(curve.frequency.size, -1)
    rows[at] = np.arange(at.size)
    curve.across = None if motions is None else motions.at(rows)
    regime[at], cycle[at] = cycles(system, z, loop[at])
    loop[:, traced], regime[:, traced], cycle[:, traced] = curve.loop, curve.regime, curve.cycle
    error = np.where(cycle == 0.0, 0.0, np.nan)  # zeros of a contact without load are exact
    of_greatest = np.where(at.size > 0 and (cycle[at] == 0.0).all(axis=0), 0.0, np.nan)
    error[:, traced] = curve.cycle_error
    if curve.greatest is not None and traced:
        of_greatest[traced] = curve.greatest.error
    curve.loop, curve.regime, curve.cycle, curve.cycle_error = loop, regime, cycle, error
    curve.greatest = greatest_of(curve, of_greatest)


def _amplitudes(curve: Curve, at: IntArray) -> npt.NDArray[np.complex128]:
    """(point, harmonic, dof) of x = mean + Re sum X exp(i h theta)."""
    if curve.harmonic is not None:
        return curve.harmonic[at] / 1j
    X: npt.NDArray[np.complex128] = curve.fundamental[at] * np.exp(1j * curve.phase[at]) / 1j
    return X[:, None, :]


def unknowns(curve: Curve, scene: Scene, at: IntArray, harmonics: tuple[int, ...]) -> FloatArray:
    """z (point, unknown + 1) of all contacts at points of a curve, from its displacements."""
    sliders = scene.sliders()
    places = [curve.harmonics.index(h) for h in harmonics] if curve.harmonics else slice(len(harmonics))
    X = _amplitudes(curve, at)[:, places]
    layout = Layout(len(scene.contacts), scene.directions_of_contact, len(harmonics))
    x = np.empty((at.size, layout.unknowns))
    for port, direction in enumerate(scene.directions_of_contacts()):
        amplitude, rows = X @ direction, layout.waves_at[:, port]
        x[:, layout.mean_at[port]] = curve.mean[at] @ direction - sliders[port]
        x[:, rows], x[:, rows + 1] = amplitude.real, amplitude.imag
    return np.column_stack((x, curve.frequency[at]))


def _sample(curve: Curve, count: int) -> IntArray:
    """Indices of points of a curve: those of the greatest amplitudes, and others spread evenly."""
    there = np.flatnonzero(np.isfinite(curve.frequency))
    if there.size == 0:
        return there
    highest = there[curve.amplitude[there].argmax(axis=0)]
    highest = highest[_spread(highest.size, count)]
    return np.union1d(highest, there[_spread(there.size, count)]).astype(np.intp)


def _spread(count: int, most: int) -> IntArray:
    return np.unique(np.linspace(0, count - 1, min(count, most)).astype(np.intp))


def _shift(curve: Curve, scene: Scene, at: IntArray) -> float:
    """Greatest relative shift of points by a correction with all modes, along the normal of the curve."""
    system = System(scene, curve.harmonics)
    newton = Newton(system.new_balance())
    low, high = scene.frequency_range
    worst = 0.0
    for z, before in zip(unknowns(curve, scene, at, curve.harmonics), _amplitudes(curve, at), strict=True):
        moved = corrected(newton, z)
        if moved is None:
            return np.inf
        X = reported_at(system, moved[None]).X[0]
        change = np.abs(X - before).max() / np.abs(X).max()
        # the shift in frequency counts as well, relative to the range
        worst = max(worst, float(change + abs(moved[-1] - z[-1]) / (high - low)))
    return worst


def corrected(newton: Newton, z: FloatArray, along: bool = True) -> FloatArray | None:
    """The corrected point near z: in the plane normal to the curve if along, else at the frequency of z.

    None if Newton's method does not converge.
    """
    begin_near(newton, z)
    if along and newton.take_tangent():
        newton.row[:] = newton.tangent
    return np.array(newton.z) if newton.correct(1.0) else None
