"""Contact laws of the balance: forces, their tangent, and margins, from a contact's block of the unknowns.

The unknowns of a contact are the mean and amplitudes of its displacement along each of its directions, laid
out as in `fcm.structure.layout`. The last direction is its normal. The forces on the structure have the same
layout: friction along the tangential directions, and n - max(n_0, 0) along the normal. The preload is left
out because the structure at rest balances it.

Only the law knows the number of directions, the harmonics of the forces, and where the forces are not smooth.
`KernelLaw`, on a line or in a plane, is exact for a mean and any harmonics. `SingleHarmonicLaw`, on a line
with a mean and one harmonic, is a closed form (section 4 of the paper).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import cython
import numpy as np
from cython.cimports.libc.math import atan2, hypot, sqrt

from fcm.contact.closed_form import CoefficientLaw
from fcm.contact.periodic.cycle import PeriodicContact
from fcm.contact.periodic.margins import Margins, Measures
from fcm.harmonic_balance import options
from fcm.model.scene import Contact

if cython.compiled:
    from cython.cimports.fcm.contact.closed_form import PI
    from cython.cimports.fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        STUCK,
        ContactKernel,
        ContactParameters,
        CycleMeasures,
    )
    from cython.cimports.fcm.contact.periodic.margins import CLOSES, LEAST, MOST, OPENS, SLIPS, RegimeMargins
    from cython.cimports.fcm.continuation.problem import NONE
else:
    from fcm.contact.closed_form import PI
    from fcm.contact.contact_kernel import (
        CLOSED,
        MIXED,
        STUCK,
        ContactKernel,
        ContactParameters,
        CycleMeasures,
    )
    from fcm.contact.periodic.margins import CLOSES, LEAST, MOST, OPENS, SLIPS, RegimeMargins
    from fcm.continuation.problem import NONE

if TYPE_CHECKING:
    from fcm.contact.plane.cycle import PlanarContact

KINDS = cython.declare(cython.int, 9)  # of margins, at most


MIN_AMPLITUDE = cython.declare(cython.double, options.MIN_AMPLITUDE)
NAN = cython.declare(cython.double, float("nan"))


@cython.cclass
class Law(ContactParameters):
    """Base class of contact laws; the forces may have more harmonics than the motion.

    Attributes
    ----------
    force (equation,), tangent (equation, width)
        By `evaluate`.
    nonlinear
        By `evaluate`: whether the contact slips or separates within the cycle, so that its forces have
        harmonics that its motion lacks.
    margin, kind, angle (margins,)
        By `evaluate_margins`, as those of a `Problem`, with kinds from 0 to KINDS - 1.
    resistance (direction, direction)
        By `compute_resistance`: derivatives of the forces by the displacements, averaged over the cycle.
    pieces, state (piece,)
        By `cycle`: the sequence of states, 0 stick, 1 slip, -1 slip the other way, 2 separation.
    contact_loads (4,)
        By `cycle`: greatest normal force, greatest friction force, slip path, and the energy that
        friction dissipates.
    """

    def __init__(
        self, width: cython.int, directions: cython.int, margins: cython.int, contact: Contact
    ) -> None:
        self.width, self.directions, self.margins = width, directions, margins
        ContactParameters.__init__(self, contact.mu, contact.k_u, contact.k_v, contact.n_0)
        self.nonlinear = False
        self.force, self.tangent = np.zeros(width), np.zeros((width, width))
        self.margin, self.angle = np.ones(margins), np.zeros(margins)
        self.kind = np.arange(margins, dtype=np.intc)
        self.resistance, self.contact_loads = np.zeros((directions, directions)), np.zeros(4)
        self.pieces, self.state = 0, np.zeros(0, dtype=np.intc)

    def set_parameters(self, mu: float, k_u: float, k_v: float, n_0: float) -> None:
        """Set the parameters mu, k_u, k_v and n_0 of the contact."""
        self.mu, self.k_u, self.k_v, self.n_0 = mu, k_u, k_v, n_0

    def without_margins(self) -> None:
        """Mark all margins as absent."""
        self.kind[:] = NONE

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Compute forces and tangent; the unknowns of the contact begin at x[first]."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_forces(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Compute the forces alone where that is cheaper, else forces and tangent."""
        return self.evaluate(x, first)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_margins(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Fill the margins: functions of the unknowns that change sign where the forces are not smooth."""
        return 0

    @cython.ccall
    @cython.exceptval(-1.0, check=True)
    def squared_margin(
        self, kind: cython.int, x: cython.double[::1], first: cython.Py_ssize_t
    ) -> cython.double:
        """The smooth function whose square root is the margin of a kind; NaN if the margin is no root."""
        return NAN

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def compute_resistance(self) -> cython.int:
        """Fill `resistance` at the motion evaluated last."""
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cycle(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Compute the states over the cycle of a motion, and the contact loads."""
        return 0


@cython.cclass
class KernelLaw(Law):
    """Contact law with the forces of a kernel, exact for a motion of any harmonics.

    Contacts may share the kernel, its margins and its measures: they are workspaces. The tangent is the
    array of the kernel.
    """

    def __init__(
        self, kernel: ContactKernel, bounds: RegimeMargins, measures: CycleMeasures, contact: Contact
    ) -> None:
        Law.__init__(self, kernel.unknowns, kernel.motion.directions, bounds.most, contact)
        self.kernel, self.bounds, self.measures = kernel, bounds, measures
        self.force, self.tangent = np.zeros(kernel.equations), kernel.jacobian
        self.state = measures.state

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        return self.forces(x, first, True)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_forces(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        return self.forces(x, first, False)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def forces(self, x: cython.double[::1], first: cython.Py_ssize_t, tangent: cython.bint) -> cython.int:
        """Compute the forces without the preload that the structure at rest balances; optionally the tangent.

        Where the contact never opens, the mean normal force follows from the displacement. The difference of
        mean load and preload would have their rounding error, which may exceed the force of a small motion.
        """
        i: cython.Py_ssize_t
        normal: cython.int = self.directions - 1
        self.kernel.evaluate(x, first, self, tangent)
        for i in range(self.force.shape[0]):
            self.force[i] = self.kernel.forces[i]
        closed: cython.bint = self.kernel.behaviour == CLOSED
        # a contact without friction that stays closed has no further harmonics
        smooth: cython.bint = closed and not self.mu * self.k_u > 0.0
        self.nonlinear = self.kernel.kind == MIXED and not smooth
        if self.kernel.kind == STUCK or closed:
            self.force[normal] = self.k_v * x[first + normal] + min(self.n_0, 0.0)
        else:
            self.force[normal] -= max(self.n_0, 0.0)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_margins(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Fill the margins that `bounds` finds; the others are absent."""
        i: cython.Py_ssize_t
        self.bounds.find(x, first, self)
        for i in range(self.margins):
            self.kind[i] = self.bounds.kind[i] if i < self.bounds.count else NONE
        self.margin[:] = self.bounds.value
        self.angle[:] = self.bounds.angle
        return 0

    @cython.ccall
    @cython.exceptval(-1.0, check=True)
    def squared_margin(
        self, kind: cython.int, x: cython.double[::1], first: cython.Py_ssize_t
    ) -> cython.double:
        return self.bounds.squared(kind, x, first, self)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def compute_resistance(self) -> cython.int:
        self.kernel.resist(self, self.resistance)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def cycle(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        self.kernel.solve(x, first, self)
        self.measures.bear(self)
        self.pieces = self.measures.pieces
        self.contact_loads[0], self.contact_loads[1] = (
            self.measures.greatest_load,
            self.measures.greatest_friction,
        )
        self.contact_loads[2], self.contact_loads[3] = self.measures.slip_path, self.measures.dissipation
        return 0


def laws_on_a_line(kernel: PeriodicContact, contacts: Iterable[Contact]) -> list[KernelLaw]:
    """Laws of contacts on a line; all share one kernel."""
    bounds, measures = Margins(kernel.cycle), Measures(kernel.cycle)
    return [KernelLaw(kernel, bounds, measures, c) for c in contacts]


def laws_in_a_plane(kernel: PlanarContact, contacts: Iterable[Contact]) -> list[KernelLaw]:
    """Laws of contacts that slide in a plane; all share one kernel."""
    from fcm.contact.plane.margins import PlanarMargins, PlanarMeasures  # most scenes have none

    bounds, measures = PlanarMargins(kernel.cycle), PlanarMeasures(kernel.cycle)
    return [KernelLaw(kernel, bounds, measures, c) for c in contacts]


def margin_kind(law: Law, i: int, contact: int) -> int:
    """The kind of margin i of a contact, numbered over all contacts; for problems in Python."""
    return NONE if law.kind[i] == NONE else int(law.kind[i] + contact * KINDS)


@cython.cclass
class SingleHarmonicLaw(Law):
    """Forces (27) and (29) and their derivatives by u_0, v_0, U, V.

    The coefficients come from the closed form or from a table.
    """

    def __init__(self, coefficients: CoefficientLaw, contact: Contact) -> None:
        Law.__init__(self, 6, 2, 5, contact)
        self.coefficients = coefficients
        self.numbers, self.slopes = np.zeros(12), np.zeros((3, 6))
        self.least, self.most = 0.0, 0.0  # see `limits`

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        b: cython.double = hypot(x[first + 4], x[first + 5])
        self.force[:] = 0.0
        self.tangent[:, :] = 0.0
        self.nonlinear = False
        if self.k_v > 0.0:
            self.normal(x, first, b)
        if self.mu > 0.0 and self.k_u > 0.0:
            self.limits(x, first, b)
            if self.rests():
                self.stuck(x, first)
            elif self.margin[CLOSES] > 0.0:
                self.nonlinear = True
                self.slipping(x, first, b)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_margins(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.int:
        """Fill the margins of a contact; all are forces.

        They are the greatest and the least normal load over the cycle, and the distance below the slip limit
        (25). Where the contact never slips, the distances of the mean friction from its two limits follow.
        """
        self.limits(x, first, hypot(x[first + 4], x[first + 5]))
        return 0

    @cython.cfunc
    @cython.exceptval(check=False)
    def limits(self, x: cython.double[::1], first: cython.Py_ssize_t, b: cython.double) -> cython.void:
        """Fill the margins where |V| is b, and the limits of the mean friction of a contact that sticks."""
        load: cython.double = self.n_0 + self.k_v * x[first + 1]
        variation: cython.double = self.k_v * b
        self.margin[CLOSES] = load + variation if variation > 0.0 else load
        self.margin[OPENS] = load - variation
        self.most = self.mu * load - self.limit(x, first, -1.0)
        self.least = self.limit(x, first, 1.0) - self.mu * load
        self.margin[SLIPS] = self.most - self.least
        within: cython.bint = self.most > self.least and load > variation
        self.margin[MOST] = self.most - self.k_u * x[first] if within else 0.0
        self.margin[LEAST] = self.k_u * x[first] - self.least if within else 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def rests(self) -> cython.bint:
        """Whether the contact never slips nor opens, by the margins filled last."""
        return self.margin[SLIPS] > 0.0 and self.margin[OPENS] > 0.0

    @cython.cfunc
    @cython.exceptval(check=False)
    def limit(self, x: cython.double[::1], first: cython.Py_ssize_t, sign: cython.double) -> cython.double:
        """|k_u U + sign mu k_v V|: k_u a times ell_1 (sign -1) or ell_2 (sign 1) of (A9)."""
        m: cython.double = sign * self.mu * self.k_v
        return hypot(self.k_u * x[first + 2] + m * x[first + 4], self.k_u * x[first + 3] + m * x[first + 5])

    @cython.cfunc
    @cython.exceptval(check=False)
    def stuck(self, x: cython.double[::1], first: cython.Py_ssize_t) -> cython.void:
        """Fill force and tangent of a contact that sticks: a spring.

        The spring also resists the mean displacement, within the `limits` of the mean friction.
        """
        k: cython.double = self.k_u
        sign: cython.double = 0.0
        i: cython.Py_ssize_t
        for i in range(2, 4):
            self.force[i] = k * x[first + i]
            self.tangent[i, i] = k
        if k * x[first] > self.most:
            sign, self.force[0] = -1.0, self.most
        elif k * x[first] < self.least:
            sign, self.force[0] = 1.0, self.least
        else:
            self.force[0], self.tangent[0, 0] = k * x[first], k
            return
        # the derivative of sign (|k_u U + sign mu k_v V| - mu n)
        m: cython.double = sign * self.mu * self.k_v
        size: cython.double = max(self.limit(x, first, sign), MIN_AMPLITUDE)
        for i in range(2):
            along: cython.double = (k * x[first + 2 + i] + m * x[first + 4 + i]) / size
            self.tangent[0, 2 + i] = sign * k * along
            self.tangent[0, 4 + i] = sign * m * along
        self.tangent[0, 1] = -m

    @cython.cfunc
    @cython.exceptval(check=False)
    def normal(self, x: cython.double[::1], first: cython.Py_ssize_t, b: cython.double) -> cython.void:
        """Fill the normal force, (28) to (31): k_v b (N_b + N_s cos), less the preload balanced at rest."""
        k: cython.double = self.k_v
        load: cython.double = self.n_0 + k * x[first + 1]
        preload: cython.double = max(self.n_0, 0.0)
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        if load >= k * b:
            # closed throughout: the preload, which may be far larger than the force, does not enter
            self.force[1] = k * x[first + 1] + min(self.n_0, 0.0)
            self.tangent[1, 1] = k
            for i in range(4, 6):
                self.force[i] = k * x[first + i]
                self.tangent[i, i] = k
            return
        self.force[1] = -preload
        if load <= -k * b:
            return
        self.nonlinear = True
        star: cython.double = load / (k * b)
        closed: cython.double = sqrt(1.0 + star)
        opened: cython.double = sqrt(1.0 - star)
        theta_1: cython.double = 2.0 * atan2(closed, opened)
        sin_1: cython.double = closed * opened
        N_s: cython.double = (star * sin_1 + theta_1) / PI
        slope: cython.double = 2.0 * sin_1 / PI  # of N_s by n0_star
        self.force[1] = k * b * (sin_1 + star * theta_1) / PI - preload
        self.tangent[1, 1] = k * theta_1 / PI
        for i in range(2):
            self.force[4 + i] = k * N_s * x[first + 4 + i]
            along_i: cython.double = x[first + 4 + i] / b
            self.tangent[1, 4 + i] = k * sin_1 / PI * along_i
            self.tangent[4 + i, 1] = k * slope * along_i
            for j in range(2):
                self.tangent[4 + i, 4 + j] = -k * slope * star * along_i * x[first + 4 + j] / b
            self.tangent[4 + i, 4 + i] += k * N_s

    @cython.cfunc
    @cython.exceptval(check=False)
    def slipping(self, x: cython.double[::1], first: cython.Py_ssize_t, b: cython.double) -> cython.void:
        """Fill force and tangent of a contact that slips: (27) with the phase of u restored.

        The force is k_u U (F_s + i F_c), its mean k_u a F_b.
        """
        k: cython.double = self.k_u
        U_r: cython.double = x[first + 2]
        U_i: cython.double = x[first + 3]
        V_r: cython.double = x[first + 4]
        V_i: cython.double = x[first + 5]
        a: cython.double = max(hypot(U_r, U_i), MIN_AMPLITUDE)
        ratio: cython.double = self.mu / (k * a)
        n0_bar: cython.double = ratio * (self.n_0 + self.k_v * x[first + 1])
        b_bar: cython.double = ratio * self.k_v * b
        phi: cython.double = atan2(V_i * U_r - V_r * U_i, V_r * U_r + V_i * U_i)
        self.coefficients.evaluate(n0_bar, b_bar, phi, True, self.numbers, 0)
        self.chain(x, first, n0_bar, b_bar, a, max(b, MIN_AMPLITUDE))
        F_b: cython.double = self.numbers[0]
        F_s: cython.double = self.numbers[1]
        F_c: cython.double = self.numbers[2]
        cos_u: cython.double = U_r / a
        sin_u: cython.double = U_i / a
        i: cython.Py_ssize_t
        for i in range(6):
            self.tangent[0, i] = k * self.slopes[0, i]
            self.tangent[2, i] = k * (cos_u * self.slopes[1, i] - sin_u * self.slopes[2, i])
            self.tangent[3, i] = k * (sin_u * self.slopes[1, i] + cos_u * self.slopes[2, i])
        self.force[0] = k * a * F_b
        self.force[2] = k * (F_s * U_r - F_c * U_i)
        self.force[3] = k * (F_s * U_i + F_c * U_r)
        self.tangent[0, 2] += k * F_b * cos_u
        self.tangent[0, 3] += k * F_b * sin_u
        self.tangent[2, 2] += k * F_s
        self.tangent[3, 3] += k * F_s
        self.tangent[2, 3] -= k * F_c
        self.tangent[3, 2] += k * F_c

    @cython.cfunc
    @cython.exceptval(check=False)
    def chain(
        self,
        x: cython.double[::1],
        first: cython.Py_ssize_t,
        n0_bar: cython.double,
        b_bar: cython.double,
        a: cython.double,
        b: cython.double,
    ) -> cython.void:
        """Fill slopes: a times the derivatives of F_b, F_s, F_c by the unknowns.

        The chain rule gives them from the derivatives by n0_bar, b_bar, phi.
        """
        k: cython.double = self.mu / self.k_u * self.k_v
        relative: cython.double = a / b
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for j in range(3):
            by_n0: cython.double = self.numbers[3 + 3 * j]
            by_b: cython.double = self.numbers[4 + 3 * j]
            by_phi: cython.double = self.numbers[5 + 3 * j]
            self.slopes[j, 1] = by_n0 * k
            for i in range(2):
                along: cython.double = x[first + 2 + i] / a
                self.slopes[j, 2 + i] = -(by_n0 * n0_bar + by_b * b_bar) * along
                self.slopes[j, 4 + i] = by_b * k * x[first + 4 + i] / b
            self.slopes[j, 2] += by_phi * x[first + 3] / a
            self.slopes[j, 3] -= by_phi * x[first + 2] / a
            self.slopes[j, 4] -= by_phi * relative * x[first + 5] / b
            self.slopes[j, 5] += by_phi * relative * x[first + 4] / b
