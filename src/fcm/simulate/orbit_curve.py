"""Periodic solutions as a curve of a response: arrays over its points, peaks, folds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.groups import lost_curve
from fcm.response.result import Curve, Orbits
from fcm.scene.model import Scene
from fcm.simulate.branch import Branch
from fcm.simulate.measure import Measure
from fcm.simulate.periodic import Orbit

LONGEST_REGIME = 60  # letters; a contact that chatters has more, and the rest is cut off


def curve_of(scene: Scene, branch: Branch) -> Curve:
    """The points of a branch as a curve."""
    return _with_points(lost_curve(scene, branch.reason), branch.orbits, branch)


def _with_points(empty: Curve, orbits: Sequence[Orbit], branch: Branch) -> Curve:
    measures = [orbit.measure for orbit in orbits]
    amplitude = _columns(measures, "amplitude")
    frequency = np.array([orbit.frequency for orbit in orbits])
    return replace(
        empty,
        frequency=frequency,
        amplitude=amplitude,
        phase=_columns(measures, "phase"),
        mean=_columns(measures, "mean"),
        regime=np.array([[_short(s) for s in orbit.states] for orbit in orbits], dtype=str).reshape(
            len(orbits), -1
        ),
        loop=np.full(
            (len(orbits), empty.loop.shape[1], empty.loop.shape[2]), np.nan
        ),  # none has one angle phi
        stable=np.array([orbit.stable for orbit in orbits]),
        table_error=np.zeros(len(orbits)),
        truncation_error=np.zeros(len(orbits)),
        complete=branch.complete,
        reason=branch.reason,
        peaks={d: _peak(amplitude[:, i], frequency) for i, d in enumerate(empty.peaks)},
        folds=[fold.frequency for fold in branch.folds],
        orbits=Orbits(
            _columns(measures, "fundamental"),
            np.array([orbit.residual for orbit in orbits]),
            np.full(len(orbits), ""),
        ),
    )


def _columns(measures: Sequence[Measure], name: str) -> FloatArray:
    return np.array([getattr(measure, name) for measure in measures])


def _short(states: str) -> str:
    return states if len(states) <= LONGEST_REGIME else states[: LONGEST_REGIME - 3] + "..."


def _peak(amplitude: FloatArray, frequency: FloatArray) -> tuple[float, float]:
    at = int(amplitude.argmax())
    return float(amplitude[at]), float(frequency[at])
