"""The curve of periodic solutions over the frequency, through folds."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fcm.scene.model import FloatArray, Scene
from fcm.simulate.errors import SimulationError
from fcm.simulate.periodic import RANK, TOLERANCE, Orbit, Shot, periodic
from fcm.simulate.run import cycles_from
from fcm.simulate.system import System

SHORTEST_STEP = 1e-7
MOST_CORRECTIONS = 8
FREQUENCY_STEP = 1e-7  # of the difference quotient by frequency, relative
SHARPEST_TURN = 0.8  # least cosine between successive tangents
MOST_POINTS = 25  # on a curve, divided by the longest step
LEAPS = (0.003, 0.03, 0.3)  # across a corner, in longest steps
LEAP_CYCLES = 30
MOST_CORNERS = 20
CORNER = 1e-3  # step around a corner that turns back, in longest steps
NEAR = 3.0  # distance, in longest steps, within which a solution is on the same curve
FOLD = 1e-9  # to which a fold is located, relative


@dataclass
class Branch:
    """Periodic solutions along one curve."""

    orbits: list[Orbit]  # in the order along the curve
    folds: list[Orbit] = field(default_factory=list)  # where it turns back in frequency
    complete: bool = False
    reason: str = ""  # why it is not complete, else ''


@dataclass(frozen=True)
class _Point:
    """A periodic solution with the direction of the curve, in units of scale."""

    shot: Shot
    tangent: FloatArray  # (unknown + 1,)
    scale: FloatArray  # (unknown + 1,) of x and the frequency

    @property
    def z(self) -> FloatArray:
        return np.append(self.shot.x, self.shot.system.omega)


def trace_orbits(scene: Scene, max_step: float | None = None, start: Orbit | None = None) -> Branch:
    """Follow the periodic solutions of a scene over its frequency range, stable or not.

    Pseudo-arclength continuation of the exact motion: the same points as `periodic` finds, in order.

    Parameters
    ----------
    scene : Scene
        Its `frequency_range` is traced.
    max_step : float, optional
        Longest step relative to the range and to the size of the motion; by default the scene's.
    start : Orbit, optional
        Where to start, at the lower end of the range by default.

    Returns
    -------
    Branch
        Its folds are located to 1e-9 of their frequency. Where regimes begin the curve has corners; it
        may be left incomplete there, with a reason, and then succeeds with another max_step.

    Raises
    ------
    SimulationError
        If no periodic solution is found to start from.

    Examples
    --------
    >>> import fcm
    >>> from dataclasses import replace
    >>> scene = replace(fcm.load_scene("yang1998-n5"), frequency_range=(1.1, 1.3))
    >>> [round(fold.frequency, 4) for fold in trace_orbits(scene).folds]
    [1.2398, 1.1936]
    """
    low, high = scene.frequency_range
    longest = scene.max_step if max_step is None else max_step
    if not longest > 0.0:
        raise SimulationError(f"max_step is {longest:g}; it must be positive")
    first = periodic(scene, low) if start is None else start
    forward = np.zeros(first.state.q.size * 2 + first.state.friction.size + 1)
    forward[-1] = 1.0
    point = _start(scene, first, forward, high - low)
    branch, step, corners = Branch([point.shot.orbit(0)]), longest, 0
    while True:
        new, step, corner = _advance(point, step, longest)
        corners += corner
        if new is None or corners > MOST_CORNERS:
            branch.reason = f"the curve cannot be followed beyond {point.shot.system.omega:g} rad/s"
            return branch
        omega = new.shot.system.omega
        if not low <= omega <= high:
            _finish(branch, scene, point, high if omega > high else low)
            if omega < low:
                branch.complete, branch.reason = False, "the curve came back to where it began"
            return branch
        if new.tangent[-1] * point.tangent[-1] < 0.0:
            branch.folds.append(_fold(point, new, step))
        branch.orbits.append(new.shot.orbit(0))
        if len(branch.orbits) > MOST_POINTS / longest:
            branch.reason = f"only very short steps succeed near {omega:g} rad/s; try another max_step"
            return branch
        point, step = new, min(1.5 * step, longest)


def _advance(point: _Point, step: float, longest: float) -> tuple[_Point | None, float, bool]:
    """The next point, the step that led there, and whether it was across a corner."""
    while step >= SHORTEST_STEP:
        new = _step(point, step)
        if new is not None:
            return new, step, False
        step *= 0.5
    beyond = _leap(point, longest) or _step(point, CORNER * longest, sharpest=-1.0)
    return beyond, longest / 8.0, True


def _start(scene: Scene, first: Orbit, forward: FloatArray, span: float) -> _Point:
    """The first point, its stuck contacts unstressed."""
    x = np.concatenate((first.state.q, first.state.velocity, first.state.friction))
    shot = Shot(System(scene, first.frequency), x, choose=True)
    direction = forward / np.linalg.norm(forward)
    point = _Point(shot, direction, np.append(shot.scale * np.sqrt(shot.x.size), span))
    found = _corrected(point, point.z, fixed=True)
    if found is None:
        raise SimulationError(f"the solution at {first.frequency:g} rad/s to start from cannot be improved")
    return _point(found, forward, span)


def _finish(branch: Branch, scene: Scene, last: _Point, end: float) -> None:
    """The point at the end of the range itself."""
    along = (end - last.shot.system.omega) / (last.tangent[-1] * last.scale[-1])
    z = last.z + along * last.tangent * last.scale
    new = _corrected(last, z, fixed=True)
    if new is not None:
        branch.orbits.append(new.orbit(0))
    branch.complete = True


def _matrix(shot: Shot, scale: FloatArray) -> FloatArray:
    """Derivative of the closure by x and frequency, in units of scale: (unknown, unknown + 1)."""
    for sense in (1.0, -1.0):
        delta = sense * FREQUENCY_STEP * shot.system.omega
        near = Shot(System(shot.system.scene, shot.system.omega + delta), shot.x, choose=True)
        by_frequency = (near.gap - shot.gap) / delta
        if _sequence(near) == _sequence(shot):
            break  # else the quotient is across a corner, which the derivative by x is not
    for choice in shot.chosen:
        if not choice.limited:  # w = 0 at every frequency, though the neighbour may just slip
            by_frequency[2 * shot.system.modes + choice.contact] = 0.0
    columns: FloatArray = np.column_stack((shot.closure, by_frequency)) * scale / scale[:-1, None]
    return columns


def _sequence(shot: Shot) -> list[str]:
    return [segment.states for segment in shot.segments]


def _point(shot: Shot, towards: FloatArray, span: float) -> _Point:
    """The curve's direction at a solution, on the side of `towards` (in physical units)."""
    scale = np.append(shot.scale * np.sqrt(shot.x.size), span)
    along = towards / scale
    along /= np.linalg.norm(along)
    bordered = np.vstack((_matrix(shot, scale), along))
    right = np.zeros(shot.x.size + 1)
    right[-1] = 1.0
    tangent = np.linalg.lstsq(bordered, right, rcond=RANK)[0]
    return _Point(shot, tangent / np.linalg.norm(tangent), scale)


def _step(point: _Point, size: float, sharpest: float = SHARPEST_TURN) -> _Point | None:
    """The solution a step further along the curve; None if the step is too long."""
    shot = _corrected(point, point.z + size * point.tangent * point.scale)
    if shot is None:
        return None
    new = _point(shot, point.tangent * point.scale, float(point.scale[-1]))
    turn = float(new.tangent * new.scale / point.scale @ point.tangent)
    turn /= float(np.linalg.norm(new.tangent * new.scale / point.scale))
    return new if turn > sharpest else None


def _leap(point: _Point, longest: float) -> _Point | None:
    """A solution beyond a corner of the curve, where steps along it fail: at a frequency a little further.

    It is reached by simulation, and taken only if it is near.
    """
    system, span = point.shot.system, float(point.scale[-1])
    sense = 1.0 if point.tangent[-1] >= 0.0 else -1.0
    for share in LEAPS:
        omega = system.omega + sense * share * longest * span
        if omega <= 0.0:
            return None
        beyond = System(system.scene, omega)
        *_, (_, state) = cycles_from(beyond, LEAP_CYCLES, point.shot.state)
        z = np.append(np.concatenate((state.q, state.velocity, state.friction)), omega)
        shot = _corrected(point, z, fixed=True)
        if shot is not None:
            away = np.append(shot.x, omega) - point.z
            if np.linalg.norm(away / point.scale) < NEAR * longest:
                forward = np.zeros_like(away)
                forward[-1] = sense
                return _point(shot, forward, span)
    return None


def _corrected(point: _Point, z: FloatArray, fixed: bool = False) -> Shot | None:
    """Newton's method across the curve's direction, or at fixed frequency; None if it fails."""
    normal = point.tangent.copy()
    if fixed:
        normal[:] = 0.0
        normal[-1] = 1.0
    for _ in range(MOST_CORRECTIONS):
        if not z[-1] > 0.0:
            return None
        shot = Shot(System(point.shot.system.scene, float(z[-1])), z[:-1], choose=True)
        if shot.residual <= TOLERANCE:
            return shot
        bordered = np.vstack((_matrix(shot, point.scale), normal))
        right = np.append(-shot.gap / point.scale[:-1], 0.0)
        step = np.linalg.lstsq(bordered, right, rcond=RANK)[0] * point.scale
        z = np.append(shot.x + step[:-1], z[-1] + (0.0 if fixed else step[-1]))
    return shot if shot.residual <= 100.0 * TOLERANCE else None


def _fold(before: _Point, after: _Point, size: float) -> Orbit:
    """Where between two points the frequency stops: false position on the tangent's component."""
    low, high = (0.0, float(before.tangent[-1])), (size, float(after.tangent[-1]))
    best = after
    for _ in range(60):
        at = (low[0] * high[1] - high[0] * low[1]) / (high[1] - low[1])
        at = min(max(at, low[0] + 0.05 * (high[0] - low[0])), high[0] - 0.05 * (high[0] - low[0]))
        new = _step(before, at)
        if new is None:
            break
        moved = abs(new.shot.system.omega - best.shot.system.omega)
        best, slope = new, float(new.tangent[-1])
        if moved <= FOLD * best.shot.system.omega and high[0] - low[0] < 1e-3 * size:
            break
        if slope * low[1] > 0.0:
            low = (at, slope)
        else:
            high = (at, slope)
    return best.shot.orbit(0)
