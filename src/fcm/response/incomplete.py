"""Why a curve is not complete, and what would help."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.continuation import Status
from fcm.harmonic.choice import Accurate
from fcm.harmonic.drift import REASONS, undetermined
from fcm.harmonic.record import Record
from fcm.harmonic.rigid import too_stiff
from fcm.harmonic.system import System
from fcm.units import in_unit

FLOATING = "; rigid-body modes are at rest only while closed contacts hold them"
UNDAMPED = "; nothing damps the structure, so that it may turn back on the spot: try a damping ratio of 1e-4"


def incomplete(found: Accurate, points: Record) -> tuple[str, npt.NDArray[np.bool_]]:
    """Why a curve is not complete, empty if it is; and which of its points are no steady states (point,)."""
    system, branches = found.system, found.traced.branches
    scene, unit = system.scene, system.scene.frequency_unit
    reasons = undetermined(system, points.z, points.force)
    nowhere = np.logical_or.reduce([np.zeros(points.path.size, dtype=bool), *reasons.values()])
    for why, which in reasons.items():
        if which.any():
            omega = in_unit(points.z[which, -1], unit)
            return f"from {omega.min():.5g} to {omega.max():.5g} {unit} {REASONS[why]}", nowhere
    status = branches.status
    if status is Status.COMPLETE:
        return "", nowhere
    broken = next((path for path in branches.paths if path.status is status), None)
    why = _would_do(system, status)
    if broken is None:
        return f"{status.value}{why}", nowhere
    end = float(in_unit(broken.parameter[-1], scene.frequency_unit))
    return f"stopped at {end:.8g} {scene.frequency_unit}: {status.value}{why}", nowhere


def _would_do(system: System, status: Status) -> str:
    """What would help where a curve has stalled, if that is known."""
    if status is not Status.STALLED:
        return ""
    if not system.linear.natural.all():
        return FLOATING
    return too_stiff(system) or ("" if system.linear.damping.any() else UNDAMPED)
