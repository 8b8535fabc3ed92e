"""The picture of the guide: curves of folds in (frequency, level), and the isolated branch that one shows.

usage: python -m tests.branches.fold_picture PICTURE.png
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np

from fcm.accuracy.refinement import every_branch
from fcm.branches.fold_continuation import folds_from
from fcm.branches.force_level import level_frequencies, solutions
from fcm.branches.options import FOLDS, LevelCurveOptions
from fcm.branches.surface import Surface
from fcm.continuation import Status
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene

SCENE = Path(__file__).parent / "scenes/closed_impact.toml"
HARMONICS = (1, 2, 3, 4)


@dataclass(frozen=True)
class Picture:
    """Curves of folds, places where the level turned at the frequencies looked at, and the branches."""

    folds: list[np.ndarray]  # of each curve (point, 2): frequency [rad/s], level
    turns: np.ndarray  # (turn, 2)
    branches: list[np.ndarray]  # of each (point, 2): frequency, amplitude
    closed: list[bool]

    def crossings(self):
        """The frequencies at which curves of folds cross the level 1."""
        for curve in self.folds:
            off = curve[:, 1] - 1.0
            for i in np.flatnonzero(off[:-1] * off[1:] < 0.0):
                part = off[i] / (off[i] - off[i + 1])
                yield curve[i, 0] + part * (curve[i + 1, 0] - curve[i, 0])


def calculated():
    """What the picture shows."""
    far = (LevelCurveOptions(max_gap=np.inf),)  # no level is followed where the closed branch is
    system = System(load_scene(SCENE).each_curve()[0], HARMONICS, other_options=far)
    folds, turns = [], []
    for omega in level_frequencies(system):
        for turn in solutions(system, omega, np.inf).folds:
            if not (turn.unfinished and FOLDS.covers(turn.level)):
                continue
            turns.append((omega, turn.level))
            start, span = np.append(turn.z, turn.level), system.scene.frequency_range
            curve = folds_from(Surface(system.new_balance()), start, turn.directions, span)
            if curve is not None:
                folds.append(np.column_stack((curve.frequency, curve.level)))
    paths = every_branch(system).traced.branches.paths
    branches = [
        np.column_stack((path.parameter, reported_quantities(system, path).amplitude[:, 0])) for path in paths
    ]
    return Picture(folds, np.array(turns), branches, [path.status is Status.CLOSED for path in paths])


def draw(picture):
    """The figure."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 5.2), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    for k, curve in enumerate(picture.folds):
        above.plot(*curve.T, color="C0", linewidth=1.2, label=None if k else "curves of folds")
    above.plot(*picture.turns.T, "o", color="C0", markersize=4, label="the level turns here")
    above.axhline(1.0, color="black", linewidth=0.8)
    above.set_yscale("log")
    above.set_ylim(FOLDS.min_level, FOLDS.max_level)
    levels = [FOLDS.min_level, 0.5, 1.0, 2.0, FOLDS.max_level]
    above.set_yticks(levels, [f"{level:g}" for level in levels])
    above.minorticks_off()
    above.set_ylabel("level of the forces")
    said = set()
    for points, closed in zip(picture.branches, picture.closed, strict=True):
        label = "closed branch" if closed else "other branches"
        below.plot(
            *points.T,
            color="C3" if closed else "black",
            linewidth=1.2,
            label=None if label in said else label,
        )
        said.add(label)
    for k, omega in enumerate(picture.crossings()):
        label = "a curve of folds crosses the level 1" if k == 0 else None
        above.plot(omega, 1.0, "s", color="C3", markersize=5, label=label)
        for axes in (above, below):
            axes.axvline(omega, color="C3", linewidth=0.6, linestyle=":")
    for axes in (above, below):
        axes.legend(fontsize=8)
    below.set_ylabel("amplitude at the level 1")
    below.set_xlabel("frequency [rad/s]")
    return figure


if __name__ == "__main__":
    mpl.use("Agg")
    draw(calculated()).savefig(sys.argv[1], dpi=110)
