"""Reasons why a curve is not complete, and remedies."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.accuracy.refinement import RefinedResponse
from fcm.continuation import Status
from fcm.harmonic_balance.reported_quantities import PointRecord
from fcm.harmonic_balance.residual import PointQuantities
from fcm.harmonic_balance.stiff_contacts import too_stiff
from fcm.harmonic_balance.system import System
from fcm.harmonic_balance.well_posedness import REASONS, hold_unknown, undetermined
from fcm.model.scene import FloatArray
from fcm.response.options import SENTENCES
from fcm.units import in_unit

FLOATING = ". Rigid-body modes are at rest only while closed contacts hold them: give these more preload"
UNDAMPED = (
    ". Nothing damps the structure, so that the curve may turn back on the spot: try a damping ratio of 1e-4"
)


def incomplete(found: RefinedResponse, points: PointRecord) -> tuple[str, npt.NDArray[np.bool_]]:
    """Sentence on why a curve is incomplete, else empty; and the points (point,) without steady state."""
    system, branches = found.system, found.traced.branches
    unit = system.scene.frequency_unit
    reasons = undetermined(system, points.z, points.force)
    nowhere = np.logical_or.reduce([np.zeros(points.path.size, dtype=bool), *reasons.values()])
    for why, which in reasons.items():
        if which.any():
            omega = in_unit(points.z[which, -1], unit)
            return f"from {omega.min():.5g} to {omega.max():.5g} {unit} {reason_for(system, why)}", nowhere
    status = branches.status
    if status is Status.COMPLETE:
        return "", nowhere
    broken = next((path for path in branches.paths if path.status is status), None)
    if broken is None:
        return f"{status.value}{remedy(system, status)}", nowhere
    end = float(broken.parameter[-1])
    why = f"{status.value}{remedy(system, status)}"
    if status is Status.STALLED:
        why = _resonant(system, end) or why
    return f"stopped at {in_unit(end, unit):.8g} {unit}: {why}", nowhere


def reason_for(system: System, why: str) -> str:
    """One of REASONS, worded with the scene's keys; "loaded" replaces "pushed" if static loads push."""
    linear = system.linear
    why = "loaded" if why == "pushed" and linear.load[linear.adrift].any() else why
    return REASONS[why].format(_soft(system.scene.of_matrices))


def _soft(of_matrices: bool) -> str:
    """Name, by its key in the scene, of a spring that holds a rigid-body mode and hardly changes others."""
    return "soft springs in structure.stiffness" if of_matrices else "a small modal.frequency"


def no_steady_states(system: System, z: FloatArray, level: FloatArray) -> dict[str, npt.NDArray[np.bool_]]:
    """Masks (point,) of the points z (point, unknown + 1) to which each of REASONS applies.

    level (point,) : level of the forces; at level 0 the structure is at rest and no reason applies. Empty
    without rigid-body modes.
    """
    if system.linear.natural.all():
        return {}
    found = undetermined(system, z, _forces(system, z, level))
    return {why: which & (level > 0.0) for why, which in found.items()}


def holds_unknown(system: System, z: FloatArray, level: FloatArray) -> npt.NDArray[np.bool_]:
    """Points (point,) at levels where it is unknown whether sticking contacts hold, see `hold_unknown`."""
    if system.linear.natural.all():
        return np.zeros(len(z), dtype=np.bool_)
    return hold_unknown(system, z, _forces(system, z, level))


def _forces(system: System, z: FloatArray, level: FloatArray) -> FloatArray:
    """Forces of the contacts, laid out as the unknowns (point, unknown)."""
    points = PointQuantities(system.shared_balance, len(z))
    points.evaluate(np.ascontiguousarray(z), np.zeros_like(z), np.ascontiguousarray(level))
    return np.asarray(points.force)


def _resonant(system: System, omega: float) -> str:
    """Sentence on a harmonic in undamped resonance at a frequency [rad/s], with a remedy; else empty.

    The resonance is that of a body on its closed contacts. There the harmonic is unbounded, and the curve may
    turn back on the spot. Empty also if a mode is damped.
    """
    linear, unit = system.linear, system.scene.frequency_unit
    if linear.natural.all() or (linear.natural * linear.damping).any():
        return ""
    met = linear.stiffened(system.springs(stuck=True))
    for h in system.harmonics:
        near = met[np.abs(met - h * omega) < SENTENCES.resonance_tolerance * met]
        if near.size:
            at, soft = (float(in_unit(x, unit)) for x in (near[0], near[0] / SENTENCES.spring_ratio))
            hold = f"try a modal.frequency of {soft:.1g} for them, with a ratio of 0.01"
            if system.scene.of_matrices:
                spring = f"the frequencies of their modes to some {soft:.1g} {unit}"
                hold = f"try soft springs in structure.stiffness that raise {spring}, with a damping of 0.01"
            return (
                f"no further point could be found: harmonic {h} meets a resonance on the closed contacts, "
                f"at {at:.6g} {unit}, that nothing damps. Rigid-body modes have no damping ratio: {hold}"
            )
    return ""


def remedy(system: System, status: Status) -> str:
    """Sentence on a remedy where a curve has stalled, if one is known; empty for other statuses."""
    if status is not Status.STALLED:
        return ""
    linear = system.linear
    undamped = linear.natural.any() and not (linear.natural * linear.damping).any()
    return too_stiff(system) or (UNDAMPED if undamped else "")
