"""Small scenes with contacts that open, close and slip hard, and what is asked of their responses."""

from dataclasses import replace

import numpy as np

from fcm.branches.trace import traced
from fcm.continuation import Mark
from fcm.harmonic_balance.system import System
from fcm.scene import scene_from_dict

TWO_MODES = {
    "dofs": ["u", "v"],
    "frequency": [1.0, 3.7],
    "damping": [0.01, 0.01],
    "shapes": [[0.3, 0.95], [0.95, -0.3]],
}
GAP = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.05, "k_u": 0.5, "k_v": 3.0, "gap": 5.0}
STUCK = {"name": "c", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 0.5, "k_v": 3.0, "n_0": 6.0}


def scene(modal, contacts, span):
    force = [{"dof": "v", "amplitude": 1.0}]
    return scene_from_dict(
        {"modal": modal, "contact": contacts, "force": force, "response": {"frequency": list(span)}}
    )


def gap5():
    """A gap that closes under the greatest amplitudes only."""
    return scene(TWO_MODES, [GAP], (0.7, 1.5))


def isola():
    """The same in a range that begins where the closed branch of large amplitudes is passed."""
    return scene(TWO_MODES, [GAP], (1.2, 1.5))


def isola_stuck():
    """A preloaded contact that opens and slips on an isolated branch only."""
    return scene(TWO_MODES, [STUCK], (1.2, 1.5))


def stuck_mean():
    """A contact that opens pushes another one, which stays stuck, aside on average."""
    modal = {
        "dofs": ["u", "v"],
        "frequency": [1.0, 2.5],
        "damping": [0.02, 0.008],
        "shapes": [[0.7, 0.7], [0.7, -0.7]],
    }
    opens = {"name": "A", "tangential": "u", "normal": "v", "mu": 0.0, "k_u": 0.5, "k_v": 2.0, "gap": 0.6}
    sticks = {"name": "B", "tangential": "u", "normal": "v", "mu": 0.5, "k_u": 10.0, "k_v": 0.1, "n_0": 200.0}
    return scene(modal, [opens, sticks], (0.8, 2.2))


def up_to(highest):
    return tuple(range(1, highest + 1))


class Curves:
    """Branches of a scene with some harmonics; fundamental and amplitude (point, dof), frequency (point,)."""

    def __init__(self, of, harmonics, **more):
        self.system = System(replace(of, **more), harmonics)
        self.found = traced(self.system)
        self.branches = self.found.branches
        self.paths = self.branches.paths
        shown = [displacements(self.system, z) for path in self.paths for z in path.z]
        self.fundamental, self.amplitude = (np.array(rows) for rows in zip(*shown, strict=True))
        self.frequency = np.concatenate([path.parameter for path in self.paths])

    @property
    def folds(self):
        return np.concatenate([path.parameter[path.where(Mark.FOLD)] for path in self.paths])

    def peak(self, dof):
        """Greatest fundamental of a degree of freedom and its frequency, by a parabola along the curve."""
        i = int(self.fundamental[:, dof].argmax())
        near = slice(i - 1, i + 2)
        s, y = self.frequency[near] - self.frequency[i], self.fundamental[near, dof]
        arc = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(s) / np.ptp(s), np.diff(y) / y[1]))))
        bend, slope, _ = np.polyfit(arc - arc[1], y, 2)
        at = -0.5 * slope / bend
        omega = np.polyval(np.polyfit(arc - arc[1], s, 2), at) + self.frequency[i]
        return float(y[1] - 0.25 * slope**2 / bend), float(omega)


def displacements(system, z):
    """Fundamental and half the peak-to-peak of each degree of freedom at a solution."""
    balance = system.new_balance()
    balance.evaluate(z)
    balance.evaluate_outputs(z, np.zeros(z.size))
    j = system.harmonics.index(1)
    return np.hypot(balance.displacements.re[j], balance.displacements.im[j]), np.array(balance.output)
