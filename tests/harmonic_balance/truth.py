"""What a curve of a balance of few harmonics is in truth: the balance of many, and the exact motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

import fcm
from fcm.continuation import FollowOptions, follow
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.time_domain import SimulationError, State

SCENES = Path(__file__).parent / "scenes"
MANY = tuple(range(1, 22))
SAME = 0.02  # relative difference of the exact motion to the balance of many harmonics on the same branch


def scene(name, preload=None):
    """A scene by its name, with a preload of its only contact."""
    file = SCENES / f"{name}.toml"
    loaded = fcm.load_scene(file if file.exists() else name).each_curve()[0]
    if preload is None:
        return loaded
    (contact,) = loaded.contacts
    return replace(loaded, contacts=(replace(contact, n_0=float(preload)),))


def state(system, z):
    """The exact motion's state at the forces' angle 0, of a motion of a balance."""
    linear, omega = system.linear, z[-1]
    problem = system.new_balance()
    problem.evaluate(z)
    force = np.asarray(problem.force).reshape(len(system.scene.contacts), -1)
    q = -linear.flexibility @ linear.ports @ force[:, :2].ravel()
    velocity = np.zeros_like(q)
    friction = force[:, 0].copy()
    for j, h in enumerate(system.harmonics):
        block = force[:, 2 + 4 * j : 6 + 4 * j]
        F = block[:, [0, 2]] + 1j * block[:, [1, 3]]
        w = h * omega
        driven = linear.force[linear.driven.index(h)] if h in linear.driven else 0.0
        modal = driven - linear.ports @ F.ravel()
        modal = modal / (linear.natural**2 - w**2 + 2j * linear.damping * linear.natural * w)
        q, velocity, friction = q + modal.real, velocity + (1j * w * modal).real, friction + F[:, 0].real
    unit = np.sqrt(system.scene.modal.mass)
    return State(q / unit, velocity / unit, friction)


def exact(system, z):
    """Amplitudes of the exact motion beside one of a balance of many harmonics; None if none is found."""
    from fcm.shooting.periodic_orbit import periodic

    try:
        return periodic(system.scene, float(z[-1]), state(system, z)).measure.amplitude
    except SimulationError:
        return None


class Truth:
    """Of points of a system's curves."""

    def __init__(self, system, many=MANY):
        self.system, self.many = system, system.with_harmonics(many)
        self.lifted = Prolongation(self.many.new_balance(), list(system.harmonics), list(many), 1e-9)

    def at(self, z, direction):
        """The motion of many harmonics at the frequency of z, on the curve next to it; None if there is none.

        From the point normal to the curve, then along the curve of many harmonics to the frequency.
        """
        near = self.beside(z, direction)
        if near is None:
            return None
        newton = self.lifted.newton
        tangent = np.array(newton.tangent)
        if near[-1] == z[-1]:
            return near
        onward = (z[-1] - near[-1]) * tangent[-1] > 0.0  # along the curve, whichever way that leads
        forward = z[-1] > near[-1]
        span = (min(near[-1], z[-1]), max(near[-1], z[-1]))
        path = follow(self.many.new_balance(), near, span, options=FollowOptions(0.05), forward=forward)
        if not len(path.z) or path.parameter[-1] != z[-1]:
            return None
        heading = path.direction[0] / newton.scale @ tangent
        return path.z[-1] if (heading > 0.0) == onward else None

    def beside(self, z, direction):
        """The motion of many harmonics next to z, normal to the curve; None if there is none."""
        return np.array(self.lifted.newton.z) if self.lifted.find_normal(z, direction) else None

    def amplitude(self, z):
        """Half the peak-to-peak displacements of a motion of many harmonics."""
        problem = self.many.new_balance()
        problem.evaluate(z)
        problem.evaluate_outputs(z, np.zeros_like(z))
        return np.array(problem.output)
