"""A scene prepared for motion in time: modes, contacts and forces at a frequency."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import isfinite
from threading import local
from typing import Any, NamedTuple
from weakref import ref

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray, Scene, has_friction
from fcm.structure.loads import driven_harmonics, loads_of
from fcm.time_domain.constant_matrices import held_as_springs, held_limits, held_rows, matrices_of
from fcm.time_domain.contact_states import Codes, made
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.flow import Flows
from fcm.time_domain.integrator import March
from fcm.time_domain.measures import MotionIntegrals, Powers, Scan, SparseRows
from fcm.time_domain.options import TIME, FlowOptions
from fcm.time_domain.segments import Segments, Steps, Walk
from fcm.time_domain.variational import Derivative, Directional

LETTERS = "SEPN"  # of the codes SEPARATED, STICKING, POSITIVE_SLIP, NEGATIVE_SLIP
OWN = ("scene", "omega")  # attributes that systems of a scene do not share, or must not keep


class ReportedRows(NamedTuple):
    """Slices of the rows of reported quantities of a motion."""

    displaced: slice  # of each degree of freedom
    forces: slice  # k_v v of each contact, then f
    limits: slice  # see `held_limits`
    held: slice  # see `held_rows`


class EquationsOfMotion:
    """A scene at an excitation frequency omega [rad/s]; its flows serve all frequencies.

    Parameters
    ----------
    scene : Scene
    omega : float
    kept : FlowOptions, optional
        How many flows are kept; used only if the scene has none yet.

    level is the force level, by which all harmonic forces are multiplied; it is 1 for the scene itself. If
    by_level is true, motions are differentiated by the level instead of the frequency.
    """

    level, by_level = 1.0, False

    def __init__(self, scene: Scene, omega: float, kept: FlowOptions = TIME.flows) -> None:
        self.scene, self.omega = scene, _checked(omega)
        if known := _LATEST.known(scene):
            self.__dict__.update(known)
            return
        self.contacts = scene.contacts
        modal = scene.modal
        m, c = modal.mass.size, len(scene.contacts)
        self.harmonics = driven_harmonics(scene)
        self.modes, self.linear = m, 2 * m + 2 * c + 1
        self.size = self.linear + 2 * len(self.harmonics)
        self.q, self.p = slice(0, m), slice(m, 2 * m)
        self.f, self.n = slice(2 * m, 2 * m + c), slice(2 * m + c, 2 * m + 2 * c)
        self.unknowns = 2 * m + c  # (q, q', f): these determine the rest
        self.tangential = np.array([modal.shapes @ k.tangential for k in scene.contacts]).reshape(c, m)
        self.normal = np.array([modal.shapes @ k.normal for k in scene.contacts]).reshape(c, m)
        law = np.array([(k.mu, k.k_u, k.k_v, k.n_0) for k in scene.contacts]).reshape(c, 4)
        self.mu, self.k_u, self.stiffness, self.preload = law.T.copy()
        shapes = np.abs(modal.shapes).max(axis=1, initial=0.0)
        self.per_unit = np.where(shapes > 0.0, shapes, 1.0)  # greatest displacement for a unit of each mode
        loads = loads_of(scene)
        self.constant, self.square = loads.constant @ modal.shapes.T, loads.square @ modal.shapes.T
        self.static: FloatArray = modal.shapes @ loads.static  # modal
        self.stretch, self.pull, pressed = held_as_springs(scene)
        self.steady = self.static + pressed
        self.sticking = np.zeros((c, self.unknowns))  # k_u w of the contacts, by x = (q, q', f)
        self.sticking[:, self.q], self.sticking[:, self.f] = self.k_u[:, None] * self.tangential, -np.eye(c)
        self.rough = [has_friction(contact) for contact in scene.contacts]
        self.limit_rows = self._limit_rows()
        self.flows = Flows(matrices_of(self), kept)
        self._march, self._derivative = March(self.flows), Derivative(self.flows)
        self._along, self.integrals = Directional(self.flows), MotionIntegrals(self.flows)
        none = np.zeros(m)
        self.made = dict[str, Any]()  # results that other packages compute once for a scene
        self.slips = Powers(self.flows, none[None], none, none, everywhere=False)
        self.displaced, self.limits, self.reported, self.parts = self._scans()
        _LATEST.keep(scene, {name: what for name, what in vars(self).items() if name not in OWN})

    def at(self, omega: float) -> EquationsOfMotion:
        """The same scene at another frequency, with the same flows."""
        other = EquationsOfMotion.__new__(EquationsOfMotion)
        other.__dict__.update(self.__dict__)
        other.omega = _checked(omega)
        return other

    def at_level(self, level: float, by_level: bool = False) -> EquationsOfMotion:
        """The same scene at another force level, with the same flows; by_level makes it the parameter."""
        other = self.at(self.omega)
        other.level, other.by_level = level, by_level
        return other

    @property
    def wave(self) -> npt.NDArray[np.complex128]:
        """Modal amplitudes (waves, mode) of the forces at each harmonic h, as in Im(wave exp(i h theta))."""
        wave: npt.NDArray[np.complex128] = self.level * (self.constant + self.omega**2 * self.square)
        return wave

    @property
    def period(self) -> float:
        """Period of the force [s]."""
        return 2.0 * np.pi / self.omega

    def tuned(self) -> Flows:
        """The flows at this frequency."""
        self.flows.at(self.omega)
        return self.flows

    def march(self) -> March:
        """The march at this frequency; all frequencies share one object."""
        self.tuned()
        return self._march

    def derivative(self) -> Derivative:
        """The derivative of motions at this frequency; all frequencies share one object."""
        self.tuned()
        return self._derivative

    def derivative_along(self) -> Directional:
        """The derivative along one direction at this frequency; all frequencies share one object."""
        self.tuned()
        return self._along

    def make(self, states: Codes) -> int:
        """Makes the flow of a combination of states, adds it to the pool, and returns its place."""
        return int(self.flows.add(made(self, states)))

    def steps(self, segments: Segments) -> Steps:
        """The steps of segments at this frequency."""
        return Steps(self.tuned(), segments)

    def run(self, kernel: Walk, segments: Segments) -> None:
        """Runs a kernel through segments at this frequency, making missing flows."""
        self.tuned()
        kernel.begins(segments)
        while kernel.go() < 0:
            self.make(np.asarray(segments.states)[kernel.at + 1])

    def loads(self, y: FloatArray) -> FloatArray:
        """Normal loads n_0 + k_v v of the contacts (contact,), negative while they are open."""
        return self.preload + y[self.n]

    def _scans(self) -> tuple[Scan, Scan, Scan, ReportedRows]:
        """Scans of the displacements, of the slip limits and of all reported rows, with their slices."""
        displacements = np.zeros((self.scene.modal.shapes.shape[1], self.linear))
        displacements[:, self.q] = self.scene.modal.shapes.T
        parts = displacements, self._force_rows(), held_limits(self), held_rows(self)
        rows = displacements, self.limit_rows, np.concatenate(parts)
        first, second, third = (Scan(self.flows, SparseRows(each)) for each in rows)
        ends = np.cumsum([0, *(len(part) for part in parts)]).tolist()
        return first, second, third, ReportedRows(*(slice(a, b) for a, b in pairwise(ends)))

    def _force_rows(self) -> FloatArray:
        """Rows of k_v v, then of f, of all contacts, for y without the forces' angle."""
        c = len(self.contacts)
        rows = np.zeros((2 * c, self.linear))
        rows[:c, self.n], rows[c:, self.f] = np.eye(c), np.eye(c)
        return rows

    def _limit_rows(self) -> FloatArray:
        """Rows of mu n - f and mu n + f of each contact, for y without the forces' angle."""
        c, each = len(self.contacts), np.arange(len(self.contacts))
        rows = np.zeros((c, 2, self.linear))
        for i, sign in enumerate((-1.0, 1.0)):
            rows[each, i, self.f.start + each] = sign
            rows[each, i, self.n.start + each], rows[:, i, -1] = self.mu, self.mu * self.preload
        return rows.reshape(2 * c, self.linear)


class _Latest(local):
    """The parts shared by systems of this thread's latest scene, as flows are expensive to make.

    They are dropped with the scene.
    """

    of: Callable[[], Scene | None] = staticmethod(lambda: None)
    common: dict[str, Any] | None = None

    def known(self, scene: Scene) -> dict[str, Any] | None:
        """The parts that systems of a scene share, if it is the latest one; otherwise None."""
        return self.common if self.of() is scene else None

    def keep(self, scene: Scene, common: dict[str, Any]) -> None:
        """Keeps the shared parts of a scene until the scene is deleted or another comes."""
        self.of, self.common = ref(scene, lambda gone: self.drop(gone)), common

    def drop(self, gone: object) -> None:
        """Drops the shared parts of a deleted scene."""
        if self.of is gone:
            self.common = None


_LATEST = _Latest()


def _checked(omega: float) -> float:
    if not (isfinite(omega) and omega > 0.0):
        raise SimulationError(f"the frequency is {omega:g}; a simulation needs one that is positive")
    return float(omega)
