r"""Periodic motion of the structure without forces, a nonlinear mode: the extended periodic motion concept.

Friction dissipates energy, so that a free motion decays. Negative damping proportional to the mass, which
restores the energy lost in each cycle, makes it periodic. See Krack, "Nonlinear modal analysis of
nonconservative systems: extension of the periodic motion concept":

    M x'' + (C - 2 D omega M) x' + K x + f(x) = 0

omega is the mode's frequency, and D its damping ratio, at the amplitude of the motion; for a linear mode they
are its own. With modes of mass 1 the receptance at the harmonic h has the denominators

    e_i = w_i^2 - (h omega)^2 + 2 i h omega (zeta_i w_i - D omega)

x is counted from rest, where the contacts balance the static loads, and f from its value there. All
amplitudes are divided by the mode's amplitude a: the fundamental's modal amplitudes are a Q_i, with
sum_i |Q_i|^2 = 1. A linear motion is therefore the same at all a. The parameter is ln a. Modes whose
frequency the motion may reach have no receptance there; their Q are unknowns beside the contacts'
displacements.
"""

from __future__ import annotations

from dataclasses import replace
from math import exp
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.continuation import Problem
from fcm.continuation.options import NewtonOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_law import margin_kind
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.nonlinear_modes.options import NONLINEAR_MODE, NonlinearModeOptions
from fcm.nonlinear_modes.scaled_contacts import ScaledContacts

ComplexArray = npt.NDArray[np.complex128]

AMPLITUDE_UNIT = float(np.log(10.0))  # unit of the parameter


class ModeGuess(Frozen):
    """Initial guess of a mode: modal amplitudes Q (mode,), frequency and damping.

    `kept` are the modes whose frequencies the motion may come near; their Q are unknowns.
    """

    Q: FloatArray
    omega: float
    damping: float
    kept: npt.NDArray[np.intp]


class ModalMotion(Frozen):
    """Motion at a point of a mode: a, omega, D, and modal displacements over a.

    These are the mean from rest, `mean` (mode,), and the harmonics Q (harmonic, mode).
    """

    amplitude: float
    omega: float
    damping: float
    mean: FloatArray
    Q: ComplexArray


class AutonomousProblem(Problem):
    """The equations of a mode, with the parameter ln a.

    The unknowns are those of the contacts as in `contact_law`, over a; Re and Im of the kept Q; omega; and D.
    precision: options of Newton's method, in the units of `evaluate_scale`.
    """

    def __init__(
        self, system: System, guess: ModeGuess, options: NonlinearModeOptions = NONLINEAR_MODE
    ) -> None:
        self.contacts, self.linear, self.guess = ScaledContacts(system), system.linear, guess
        self.options, self.units = options, options.units
        many = len(self.contacts.laws) >= options.many.min_contacts
        self.unit_factor = options.many.unit_factor if many else 1.0
        self.precision = _scaled_steps(self.unit_factor)
        self.h = np.array(system.harmonics, dtype=np.float64)
        self.driven = system.harmonics.index(1)
        self.mean_rows, self.rows = self.contacts.mean_rows, self.contacts.rows
        self.ports = self.mean_rows.size
        self.contact_unknowns, self.kept = self.contacts.unknowns, guess.kept.size
        count = self.contact_unknowns + 2 * self.kept + 2
        margins = 0 if many else sum(law.margins for law in self.contacts.laws)
        super().__init__(count, margins, 2)
        self.n, self.has_root_margins = count, any(law.directions > 2 for law in self.contacts.laws)
        self.static = self.linear.ports.T @ self.linear.flexibility @ self.linear.ports
        self.largest = np.zeros(self.ports)
        self.views = {name: np.asarray(getattr(self, name)) for name in ("residual", "jacobian", "scale")}

    def start(self, log_amplitude: float) -> FloatArray:
        """The guess as unknowns and parameter."""
        z = np.zeros(self.n + 1)
        z[self.rows[self.driven]] = self.linear.ports.T @ self.guess.Q
        z[self.contact_unknowns : self.n - 2 : 2] = self.guess.Q[self.guess.kept]
        z[self.n - 2 :] = self.guess.omega, self.guess.damping, log_amplitude
        return z

    def with_harmonics_of(self, z: FloatArray, other: AutonomousProblem) -> FloatArray:
        """A point, or a direction, of another problem of the same mode, in the harmonics of this one.

        Harmonics that the other problem lacks are 0.
        """
        found = np.zeros(self.n + 1)
        found[self.contact_unknowns :] = z[other.contact_unknowns :]
        found[self.mean_rows] = z[other.mean_rows]
        _, mine, others = np.intersect1d(self.h, other.h, return_indices=True)
        rows, from_rows = self.rows[mine], other.rows[others]
        found[rows], found[rows + 1] = z[from_rows], z[from_rows + 1]
        return found

    def modal_amplitude(self, z: FloatArray) -> float:
        """The amplitude a, limited to a range that does not overflow if a step leads astray."""
        return exp(min(max(z[self.n], -self.units.max_log_amplitude), self.units.max_log_amplitude))

    def contact_motion(self, z: FloatArray) -> FloatArray:
        """Displacements of the contacts (unknown,) as in `contact_law`, including those at rest."""
        return self.contacts.rest + self.modal_amplitude(z) * z[: self.contact_unknowns]

    def evaluate(self, z: Any) -> int:
        z = np.asarray(z)
        m, n = self.contact_unknowns, self.n
        J, residual = self.views["jacobian"], self.views["residual"]
        J[:], residual[:] = 0.0, 0.0
        self.contacts.evaluate(z[:m], self.modal_amplitude(z))
        force, tangent = self.contacts.force, self.contacts.tangent
        grows = (tangent @ z[:m].reshape(*tangent.shape[:2], 1)).ravel() - force  # derivative by ln a
        J[self.mean_rows, :m] = self.of_contacts(self.static, tangent[:, : self.contacts.directions])
        J[self.mean_rows, n] = self.static @ grows[self.mean_rows]
        residual[self.mean_rows] = self.static @ force[self.mean_rows]
        for j, h in enumerate(self.h):
            self.harmonic(j, h, z, grows)
        residual[:m] += z[:m]
        J[range(m), range(m)] += 1.0
        return 0

    def of_contacts(self, answer: FloatArray, tangent: FloatArray) -> FloatArray:
        """Multiply answer (row, port) by the contacts' tangent (contact, direction, unknown).

        tangent has the derivatives of each contact's forces by its own unknowns. Returns (row, unknown of all
        contacts).
        """
        (contacts, directions, width), rows = tangent.shape, len(answer)
        each = answer.reshape(rows, contacts, directions).swapaxes(0, 1) @ tangent
        return each.swapaxes(0, 1).reshape(rows, contacts * width)

    def denominators(self, h: float, z: FloatArray) -> tuple[ComplexArray, ComplexArray, complex]:
        """The denominators e (mode,), and their derivatives by omega (mode,) and D."""
        omega, D, natural = z[self.n - 2], z[self.n - 1], self.linear.natural
        rate = 2.0 * self.linear.damping * natural
        e = (natural - h * omega) * (natural + h * omega) + 1j * h * omega * (rate - 2.0 * D * omega)
        by_omega = -2.0 * h * h * omega + 1j * h * (rate - 4.0 * D * omega)
        return e, by_omega, -2j * h * omega * omega

    def harmonic(self, j: int, h: float, z: FloatArray, grows: FloatArray) -> None:
        """Fill the rows of one harmonic, X + G F; the kept modes of the fundamental have their own rows."""
        m, n, P, rows = self.contact_unknowns, self.n, self.linear.ports, self.rows[j]
        e, by_omega, by_damping = self.denominators(h, z)
        push, first = P @ _complex(self.contacts.force, rows), int(rows[0]) if rows.size else 0
        last, tangent = first + 2 * self.contacts.directions, self.contacts.tangent
        real, imaginary = tangent[:, first:last:2], tangent[:, first + 1 : last : 2]
        d_push = self.of_contacts(P, real) + 1j * self.of_contacts(P, imaginary)
        derivative = np.zeros((e.size, n + 1), dtype=np.complex128)
        kept = self.guess.kept if j == self.driven else self.guess.kept[:0]
        c = 1.0 / np.where(np.isin(np.arange(e.size), kept), 1.0, e)
        Q = -c * push
        derivative[:, :m] = -c[:, None] * d_push
        derivative[:, n] = -c * (P @ _complex(grows, rows))
        derivative[:, n - 2], derivative[:, n - 1] = -c * by_omega * Q, -c * by_damping * Q
        if j == self.driven:
            self.own_rows(z, Q, derivative, (e, by_omega, by_damping))
        self.add(rows, -P.T @ Q, -(P.T @ derivative.real) - 1j * (P.T @ derivative.imag))

    def own_rows(
        self,
        z: FloatArray,
        Q: ComplexArray,
        derivative: ComplexArray,
        denominators: tuple[ComplexArray, ComplexArray, complex],
    ) -> None:
        """Fill the rows of the kept modes, of amplitude and of phase; set Q and derivative of these modes."""
        m, n, kept = self.contact_unknowns, self.n, self.guess.kept
        J, residual = self.views["jacobian"], self.views["residual"]
        unit = self.guess.omega**2
        e, by_omega, by_damping = (np.broadcast_to(one, Q.shape)[kept] for one in denominators)
        at = m + 2 * np.arange(self.kept)
        push, d_push = -Q[kept], -derivative[kept]  # with c = 1
        own = z[at] + 1j * z[at + 1]
        d_push[:, n - 2], d_push[:, n - 1] = by_omega * own, by_damping * own
        d_push[range(self.kept), at], d_push[range(self.kept), at + 1] = e, 1j * e
        self.add(at, (e * own + push) / unit, d_push / unit)
        Q[kept], derivative[kept] = own, 0.0
        derivative[kept, at], derivative[kept, at + 1] = 1.0, 1j
        residual[n - 2] = 0.5 * self.guess.omega * (np.sum(np.abs(Q) ** 2) - 1.0)
        J[n - 2] = self.guess.omega * (Q.conj() @ derivative).real
        residual[n - 1] = self.units.damping * (self.guess.Q @ Q).imag
        J[n - 1] = self.units.damping * (self.guess.Q @ derivative).imag

    def add(self, rows: npt.NDArray[np.intp], value: ComplexArray, derivative: ComplexArray) -> None:
        """Set rows to the real parts of complex equations, and the rows after them to the imaginary parts."""
        J, residual = self.views["jacobian"], self.views["residual"]
        residual[rows], residual[rows + 1] = value.real, value.imag
        J[rows], J[rows + 1] = derivative.real, derivative.imag

    def evaluate_scale(self, z: Any) -> int:
        """Set the units: those of displacements are their present sizes, by port, with a floor."""
        z, scale = np.asarray(z), self.views["scale"]
        size = np.sqrt(z[self.mean_rows] ** 2 + (z[self.rows] ** 2 + z[self.rows + 1] ** 2).sum(axis=0))
        self.largest = np.maximum(self.largest, size)
        floor = np.maximum(
            self.units.own_fraction * self.largest,
            self.units.greatest_fraction * self.largest.max(initial=0.0),
        )
        unit = np.maximum(size, floor)
        unit = np.where(unit > 0.0, unit, 1.0) * np.sqrt(max(self.ports, 1)) * self.unit_factor
        scale[:] = self.unit_factor
        scale[self.mean_rows] = scale[self.rows] = scale[self.rows + 1] = unit
        scale[self.n - 2 :] = (
            self.unit_factor * self.guess.omega,
            self.unit_factor * self.units.damping,
            AMPLITUDE_UNIT,
        )
        return 0

    def evaluate_margins(self, z: Any) -> int:
        """Fill the margins of the contacts, one after the other."""
        if self.margins == 0:
            return 0
        z = np.asarray(z)
        x, at = self.contact_motion(z), 0
        for c, law in enumerate(self.contacts.laws):
            law.evaluate_margins(x, c * self.contacts.width)
            for i in range(law.margins):
                self.margin[at], self.angle[at] = law.margin[i], law.angle[i]
                self.kind[at] = margin_kind(law, i, c)
                at += 1
        return 0

    def evaluate_outputs(self, z: Any, direction: Any) -> int:
        """Report the damping ratio and the frequency with their growth along the curve."""
        omega = self.guess.omega
        self.output[0], self.growth[0] = self.units.damping_offset + abs(z[self.n - 1]), direction[self.n - 1]
        self.output[1], self.growth[1] = z[self.n - 2] / omega, direction[self.n - 2] / omega
        return 0

    def motion(self, z: FloatArray) -> ModalMotion:
        """The modal motion at a point."""
        self.contacts.evaluate(z[: self.contact_unknowns], self.modal_amplitude(z))
        P, force = self.linear.ports, self.contacts.force
        Q = np.array([-(P @ _complex(force, rows)) for rows in self.rows])
        for j, h in enumerate(self.h):
            e = self.denominators(h, z)[0]
            e[self.guess.kept] = 1.0 if j == self.driven else e[self.guess.kept]
            Q[j] /= e
        own = z[self.contact_unknowns : self.n - 2].reshape(-1, 2)
        Q[self.driven, self.guess.kept] = own[:, 0] + 1j * own[:, 1]
        mean = -self.linear.flexibility @ (P @ force[self.mean_rows])
        return ModalMotion(self.modal_amplitude(z), float(z[self.n - 2]), float(z[self.n - 1]), mean, Q)


def _complex(values: FloatArray, rows: npt.NDArray[np.intp]) -> ComplexArray:
    found: ComplexArray = values[rows] + 1j * values[rows + 1]
    return found


def _scaled_steps(coarse: float) -> NewtonOptions:
    """Newton options whose lengths stay the same in units that are larger by a factor."""
    usual = NewtonOptions()
    lengths = (
        "tolerance",
        "final_step",
        "negligible_step",
        "stalled_rounding",
        "growing_rounding",
        "chord_step",
        "last_chord_step",
        "max_rounding",
    )
    return replace(usual, **{name: getattr(usual, name) / coarse for name in lengths})
