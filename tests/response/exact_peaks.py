"""The truncation error at the peak of each of the paper's curves beside the true error of that peak.

The truth is the greatest amplitude of the exact periodic solutions, found by climbing from the harmonic
balance's point. Run as a program, this prints the table.
"""

from __future__ import annotations

from typing import NamedTuple

import fcm
from fcm.model.scene import Scene
from fcm.response import Curve, trace
from fcm.shooting import Orbit, harmonic_state, periodic
from fcm.time_domain import SimulationError

FIRST, LAST = 2e-3, 2e-6  # [rad/s] steps of the climb: near a maximum the amplitude errs by their square
SAME_BRANCH = 0.3  # greatest relative change of the amplitude by a step
ROUNDING = 1e-12  # of relative errors
TRIED = 8  # points of the curve from which the climb may begin, to either side of the peak


class Peak(NamedTuple):
    preload: float
    balanced: float  # peak of single-harmonic balance
    exact: float  # half the peak-to-peak of the exact motion at its own peak
    truncation_error: float  # reported at the balanced peak

    @property
    def true_error(self) -> float:
        return self.balanced / self.exact - 1.0


def peaks() -> list[Peak]:
    """The peaks of u at the preloads of figure 13."""
    scene = fcm.load_scene("yang1998")
    curves = trace(scene, "closed-form").curves
    return [_peak(one, curve) for one, curve in zip(scene.curves, curves, strict=True)]


def _peak(scene: Scene, curve: Curve) -> Peak:
    highest = int(curve.amplitude[:, 0].argmax())
    orbit = _climbed(scene, _start(scene, curve, highest))
    estimate = curve.peaks["u"].error
    return Peak(scene.contacts[0].n_0, curve.peaks["u"].amplitude, orbit.measure.amplitude[0], estimate)


def _start(scene: Scene, curve: Curve, at: int) -> Orbit:
    """An exact solution near a point of the curve: the balanced peak may lie beyond the end of its branch."""
    for away in sorted(range(-TRIED, TRIED + 1), key=abs):
        point = (field[at + away] for field in (curve.frequency, curve.amplitude, curve.phase, curve.mean))
        frequency, *motion = point
        try:
            orbit = periodic(scene, frequency, harmonic_state(scene, frequency, *motion))
        except SimulationError:
            continue
        if abs(orbit.measure.amplitude[0] / motion[0][0] - 1.0) < SAME_BRANCH:
            return orbit
    raise AssertionError(f"no exact solution near {curve.frequency[at]}")


def _climbed(scene: Scene, orbit: Orbit) -> Orbit:
    """The solution of the greatest amplitude, by shorter and shorter steps of the frequency."""
    step = FIRST
    while step > LAST:
        higher = [new for sign in (1.0, -1.0) if (new := _higher(scene, orbit, sign * step)) is not None]
        orbit, step = (higher[0], step) if higher else (orbit, 0.3 * step)
    return orbit


def _higher(scene: Scene, orbit: Orbit, step: float) -> Orbit | None:
    try:
        new = periodic(scene, orbit.frequency + step, orbit.state)
    except SimulationError:
        return None
    growth = new.measure.amplitude[0] / orbit.measure.amplitude[0] - 1.0
    return new if 0.0 < growth < SAME_BRANCH else None


def _shown(error: float) -> str:
    """Two digits, and 0 where there is rounding alone."""
    return f"{error:.1e}" if abs(error) > ROUNDING else "0"


if __name__ == "__main__":
    print("| preload | peak u, balanced | exact | estimated error | true error |")
    print("| ---: | ---: | ---: | ---: | ---: |")
    for peak in peaks():
        print(
            f"| {peak.preload:g} | {peak.balanced:.4f} | {peak.exact:.4f} "
            f"| {_shown(peak.truncation_error)} | {_shown(peak.true_error)} |"
        )
