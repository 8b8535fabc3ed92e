"""Harmonic balance of means and any harmonics, condensed to the contacts, as a continuation problem.

The modes are summed into the receptance G(h omega) between the contacts' ports. So the unknowns are the
relative displacements of the contacts alone, whatever the number of modes:

    X_h = X_external,h - G(h omega) F_h,    x_0 = x_rest - G(0) f_0

with x_rest the response to static loads alone, of which `share` is applied. Displacements count from where
the contacts are unstressed, as [start] of the scene says; so does x_rest. The residual has the unit of a
displacement, and the Jacobian is 1 + G dF/dX. The parameter is the frequency.

The response G F of the structure to contact forces is laid out as the unknowns, see `fcm.structure.layout`.
Each harmonic has its own receptance, the mean the static one.
"""

from __future__ import annotations

import cython
import numpy as np
import numpy.typing as npt
from cython.cimports.libc.math import sqrt

from fcm.harmonic_balance.displacement import Displacements
from fcm.harmonic_balance.modal_condensation import CondensedSystem
from fcm.harmonic_balance.options import HARMONIC_BALANCE, UnitOptions
from fcm.structure.layout import Layout
from fcm.structure.receptance import Receptance

if cython.compiled:
    from cython.cimports.cpython.exc import PyErr_CheckSignals
    from cython.cimports.fcm.continuation.problem import NONE, Problem
    from cython.cimports.fcm.harmonic_balance.contact_law import KINDS, Law
    from cython.cimports.fcm.harmonic_balance.modal_equations import ModalCompliance
else:
    from fcm.continuation.problem import NONE, Problem
    from fcm.harmonic_balance.contact_law import KINDS, Law
    from fcm.harmonic_balance.modal_equations import ModalCompliance

    def PyErr_CheckSignals() -> None:  # the interpreter does it itself
        pass


@cython.cfunc
@cython.exceptval(check=False)
def apply_to_forces(
    receptance: Receptance, force: cython.double[::1], out: cython.double[::1]
) -> cython.void:
    """Fill out (unknown,) with the response G F to forces (unknown,)."""
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    for p in range(receptance.ports):
        total: cython.double = 0.0
        for q in range(receptance.ports):
            total += receptance.static[p, q] * force[receptance.mean_at[q]]
        out[receptance.mean_at[p]] = total
    apply_to_waves(receptance, receptance.G_re, receptance.G_im, force, out)


@cython.cfunc
@cython.exceptval(check=False)
def apply_to_waves(
    receptance: Receptance,
    G_re: cython.double[:, :, ::1],
    G_im: cython.double[:, :, ::1],
    force: cython.double[::1],
    out: cython.double[::1],
) -> cython.void:
    """Fill all but the means of out (unknown,) with G (harmonic, port, port) times the forces (unknown,)."""
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    q: cython.Py_ssize_t
    j: cython.Py_ssize_t
    for p in range(receptance.ports):
        for j in range(receptance.count):
            re: cython.double = 0.0
            im: cython.double = 0.0
            for q in range(receptance.ports):
                f = receptance.wave_at[q] + receptance.stride * j
                re += G_re[j, p, q] * force[f] - G_im[j, p, q] * force[f + 1]
                im += G_im[j, p, q] * force[f] + G_re[j, p, q] * force[f + 1]
            row = receptance.wave_at[p] + receptance.stride * j
            out[row], out[row + 1] = re, im


@cython.cfunc
@cython.exceptval(check=False)
def apply_to_tangents(
    receptance: Receptance, tangent: cython.double[:, :, ::1], out: cython.double[:, ::1]
) -> cython.void:
    """Fill out (unknown, unknown) with G dF/dX for tangents dF/dX (contact, width, width)."""
    contacts: cython.Py_ssize_t = tangent.shape[0]
    w: cython.Py_ssize_t = tangent.shape[1]
    each: cython.Py_ssize_t = receptance.ports // contacts if contacts > 0 else 0
    row: cython.Py_ssize_t
    f: cython.Py_ssize_t
    p: cython.Py_ssize_t
    c: cython.Py_ssize_t
    d: cython.Py_ssize_t
    k: cython.Py_ssize_t
    j: cython.Py_ssize_t
    re: cython.double
    im: cython.double
    for p in range(receptance.ports):
        for c in range(contacts):
            row = receptance.mean_at[p]
            for d in range(each):
                re = receptance.static[p, c * each + d]
                for k in range(w):
                    if d == 0:
                        out[row, c * w + k] = re * tangent[c, d, k]
                    else:
                        out[row, c * w + k] += re * tangent[c, d, k]
            for j in range(receptance.count):
                row = receptance.wave_at[p] + receptance.stride * j
                for d in range(each):
                    re, im = receptance.G_re[j, p, c * each + d], receptance.G_im[j, p, c * each + d]
                    f = each + receptance.stride * j + 2 * d
                    if d == 0:
                        for k in range(w):
                            out[row, c * w + k] = re * tangent[c, f, k] - im * tangent[c, f + 1, k]
                            out[row + 1, c * w + k] = im * tangent[c, f, k] + re * tangent[c, f + 1, k]
                    else:
                        for k in range(w):
                            out[row, c * w + k] += re * tangent[c, f, k] - im * tangent[c, f + 1, k]
                            out[row + 1, c * w + k] += im * tangent[c, f, k] + re * tangent[c, f + 1, k]


@cython.cfunc
@cython.exceptval(check=False)
def slope(
    receptance: Receptance, force: cython.double[::1], load: cython.double, out: cython.double[::1]
) -> cython.void:
    """Fill out (unknown,) with the derivative of the residual by the frequency; 0 for the means.

    It is that of the response to the contact forces, less that to the external forces times load.
    """
    p: cython.Py_ssize_t
    for p in range(receptance.ports):
        out[receptance.mean_at[p]] = 0.0
    apply_to_waves(receptance, receptance.dG_re, receptance.dG_im, force, out)
    subtract_external(receptance, receptance.dX_re, receptance.dX_im, load, out)


@cython.cfunc
@cython.exceptval(check=False)
def subtract_external(
    receptance: Receptance,
    X_re: cython.double[:, ::1],
    X_im: cython.double[:, ::1],
    load: cython.double,
    out: cython.double[::1],
) -> cython.void:
    """Subtract load times X (forced harmonic, port) from out (unknown,).

    X is the response to the external forces, or its derivative; load is the level of these forces.
    """
    j: cython.int
    p: cython.Py_ssize_t
    for j in range(receptance.count):
        k: cython.int = receptance.forced[j]
        if k >= 0:
            for p in range(receptance.ports):
                row: cython.Py_ssize_t = receptance.wave_at[p] + receptance.stride * j
                out[row] -= load * X_re[k, p]
                out[row + 1] -= load * X_im[k, p]


@cython.cclass
class Balance(Problem):
    """The balance of contact laws on a structure; unknowns are laid out as in `fcm.structure.layout`."""

    def __init__(
        self,
        displacements: Displacements,
        laws: list[Law],
        counted: npt.NDArray[np.float64],
        span: cython.double,
        rank: cython.int = 0,
        units: UnitOptions = HARMONIC_BALANCE.units,
    ) -> None:
        receptance: Receptance = displacements.receptance
        layout: Layout = receptance.layout
        width: cython.int = layout.width
        Problem.__init__(self, layout.unknowns, sum(law.margins for law in laws), displacements.dofs, rank)
        self.receptance, self.displacements, self.laws, self.contacts, self.width = (
            receptance,
            displacements,
            laws,
            len(laws),
            width,
        )
        self.layout, self.directions, self.ports = layout, layout.directions, layout.ports
        self.group = laws[0].margins if laws else 0  # the same for all contacts
        self.has_root_margins = layout.directions > 2  # circular motion begins to slip at all angles at once
        self.counted, self.span, self.load, self.share = np.array(counted), span, 1.0, 1.0
        self.rest, self.reported = np.zeros(layout.ports), np.ones(displacements.dofs)
        self.force, self.now, self.rate, self.by_frequency = np.zeros((4, self.unknowns))
        self.evaluated = np.zeros(self.unknowns + 1)
        self.tangent = np.zeros((len(laws), width, width))
        self.condensed: CondensedSystem | None = None  # of size rank, see `condense`
        self.answer: ModalCompliance | None = None  # that of `condensed`
        self.largest, self.size = np.zeros(layout.ports), np.zeros(layout.ports)
        self.own, self.greatest, self.of_preload = (
            units.own_fraction,
            units.greatest_fraction,
            units.preload_fraction,
        )
        self.alike = len(laws) >= units.min_contacts

    def condense(self, condensed: CondensedSystem) -> None:
        """Solve the linear systems of Newton's method by a condensed system; only if rank > 0."""
        self.condensed, self.answer = condensed, condensed.answer

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.evaluate_contacts(z, True)
        self.slopes()
        for i in range(self.unknowns):
            self.jacobian[i, 0 if self.rank else self.unknowns] = self.by_frequency[i]
        if not self.rank:
            apply_to_tangents(self.receptance, self.tangent, self.jacobian)
            for i in range(self.unknowns):
                self.jacobian[i, i] += 1.0
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_residual(self, z: cython.double[::1]) -> cython.int:
        return self.evaluate_contacts(z, False)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def evaluate_contacts(self, z: cython.double[::1], tangents: cython.bint) -> cython.int:
        """Fill the residual and the contact forces at z; with tangents, those of the contacts too."""
        i: cython.Py_ssize_t
        p: cython.Py_ssize_t
        self.receptance.at(z[self.unknowns])
        self.contact_forces(z, tangents)
        if self.condensed is None:
            apply_to_forces(self.receptance, self.force, self.residual)
        else:
            assert self.answer is not None
            self.answer.displace(self.force, self.residual)
        for p in range(self.ports):
            self.residual[self.receptance.mean_at[p]] -= self.share * self.rest[p]
        subtract_external(
            self.receptance, self.receptance.X_re, self.receptance.X_im, self.load, self.residual
        )
        for i in range(self.unknowns):
            self.residual[i] += z[i]
        for i in range(self.unknowns + 1):
            self.evaluated[i] = z[i]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def slopes(self) -> cython.int:
        """Fill the derivatives of the residual by the frequency."""
        if self.condensed is None:
            slope(self.receptance, self.force, self.load, self.by_frequency)
            return 0
        assert self.answer is not None
        self.answer.rate(self.force, self.by_frequency)
        subtract_external(
            self.receptance, self.receptance.dX_re, self.receptance.dX_im, self.load, self.by_frequency
        )
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def contact_forces(self, z: cython.double[::1], tangents: cython.bint) -> cython.int:
        """Fill forces and tangents of the contacts, without the stiffness that counts to the structure."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        first: cython.Py_ssize_t
        normal: cython.Py_ssize_t = self.directions - 1
        for c in range(self.contacts):
            law: Law = self.laws[c]
            first = c * self.width
            if not tangents:
                law.evaluate_forces(z, first)
            else:
                law.evaluate(z, first)
                for i in range(self.width):
                    for k in range(self.width):
                        self.tangent[c, i, k] = law.tangent[i, k]
                self.tangent[c, normal, normal] -= self.counted[c]
            for i in range(self.width):
                self.force[first + i] = law.force[i]
            self.force[first + normal] -= self.counted[c] * z[first + normal]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_scale(self, z: cython.double[::1]) -> cython.int:
        """Fill the units: of displacements their present size, of the frequency the width of its range.

        Each direction of a contact has its own unit; the two tangential directions of a plane share one. With
        many contacts all displacements have one. The unit of a normal displacement has a lower bound, so that
        rounding of the preload does not matter.
        """
        p: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        overall: cython.double = 0.0
        for p in range(self.ports):
            k = self.receptance.mean_at[p]
            total: cython.double = z[k] * z[k]
            for i in range(self.receptance.count):
                k = self.receptance.wave_at[p] + self.receptance.stride * i
                total += z[k] * z[k] + z[k + 1] * z[k + 1]
            self.size[p] = sqrt(total)
        self.together()
        for p in range(self.ports):
            self.largest[p] = max(self.largest[p], self.size[p])
            overall = max(overall, self.largest[p])
        many: cython.double = sqrt(cython.cast(cython.double, self.ports))
        for p in range(self.ports):
            unit: cython.double = max(self.size[p], max(self.own * self.largest[p], self.greatest * overall))
            if unit > 0.0 and not self.alike and p % self.directions == self.directions - 1:
                law: Law = self.laws[p // self.directions]
                if law.k_v > 0.0:
                    unit = max(unit, self.of_preload * law.n_0 / law.k_v)
            unit = unit * many if unit > 0.0 else many
            self.scale[self.receptance.mean_at[p]] = unit
            for i in range(self.receptance.count):
                k = self.receptance.wave_at[p] + self.receptance.stride * i
                self.scale[k] = self.scale[k + 1] = unit
        self.scale[self.unknowns] = self.span
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def together(self) -> cython.int:
        """Replace the sizes of displacements by common ones.

        With many contacts this is the root mean square of all. Else the two tangential directions of a plane
        share one.
        """
        p: cython.Py_ssize_t
        total: cython.double = 0.0
        if self.alike:
            for p in range(self.ports):
                total += self.size[p] * self.size[p]
            self.size[:] = sqrt(total / max(self.ports, 1))
        elif self.directions > 2:
            for p in range(0, self.ports, self.directions):
                total = sqrt(self.size[p] * self.size[p] + self.size[p + 1] * self.size[p + 1])
                self.size[p] = self.size[p + 1] = total
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_margins(self, z: cython.double[::1]) -> cython.int:
        """Fill the margins of all contacts in turn."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        at: cython.Py_ssize_t = 0
        for c in range(self.contacts):
            law: Law = self.laws[c]
            law.evaluate_margins(z, c * self.width)
            for i in range(law.margins):
                self.margin[at], self.angle[at] = law.margin[i], law.angle[i]
                self.kind[at] = law.kind[i] + c * KINDS if law.kind[i] != NONE else NONE
                at += 1
        return 0

    @cython.ccall
    @cython.exceptval(-1.0, check=True)
    def squared_margin(self, kind: cython.int, z: cython.double[::1]) -> cython.double:
        """The square of the margin by which a contact in a plane begins to slip."""
        law: Law = self.laws[kind // KINDS]
        return law.squared_margin(kind % KINDS, z, kind // KINDS * self.width)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_outputs(self, z: cython.double[::1], direction: cython.double[::1]) -> cython.int:
        """Fill the amplitudes of the degrees of freedom, and their growth along direction.

        The growth of unreported ones is 0. Where loads act, their displacement may be a sum that cancels: its
        growth would be rounding error and shorten the steps.
        """
        self.receptance.at(z[self.unknowns])
        self.forces_at(z, direction)
        self.displacements.at(self.load, self.now, self.rate, z, direction)
        i: cython.Py_ssize_t
        for i in range(self.outputs):
            self.output[i] = self.displacements.amplitude[i]
            self.growth[i] = self.displacements.growth[i] * self.reported[i]
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def forces_at(self, z: cython.double[::1], direction: cython.double[::1]) -> cython.int:
        """Fill now with the forces at z, linearised at the last evaluation, and rate with their rates.

        z is one last Newton step from that evaluation.
        """
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        first: cython.Py_ssize_t
        for c in range(self.contacts):
            first = c * self.width
            for i in range(self.width):
                change: cython.double = 0.0
                rate: cython.double = 0.0
                for k in range(self.width):
                    change += self.tangent[c, i, k] * (z[first + k] - self.evaluated[first + k])
                    rate += self.tangent[c, i, k] * direction[first + k]
                self.now[first + i] = self.force[first + i] + change
                self.rate[first + i] = rate
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        by = np.asarray(self.jacobian)[:, 0]
        assert self.condensed is not None
        sign: cython.double = self.condensed.factor(np.asarray(row), by, np.asarray(scale))
        return sign

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        assert self.condensed is not None
        self.condensed.solve(np.asarray(right))
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def solved_sign(self) -> cython.double:
        assert self.condensed is not None
        sign: cython.double = self.condensed.sign
        return sign


@cython.cclass
class PointQuantities:
    """Reported quantities at points (point, unknown + 1) with directions, filled by `evaluate`.

    re, im (point, harmonic, dof), mean, amplitude, growth (point, dof) are those of `Displacements`, with the
    growth along the direction; force (point, unknown). linear (point,): 1 where no contact slips or
    separates, else 0.
    """

    def __init__(self, balance: Balance, count: cython.int) -> None:
        displacements = balance.displacements
        dofs, harmonics = displacements.dofs, balance.receptance.count
        self.balance = balance
        self.re, self.im = np.zeros((2, count, harmonics, dofs))
        self.mean, self.amplitude, self.growth = np.zeros((3, count, dofs))
        self.force, self.linear = np.zeros((count, balance.unknowns)), np.ones(count, dtype=np.intc)

    def evaluate(
        self, z: cython.double[:, ::1], direction: cython.double[:, ::1], level: cython.double[::1]
    ) -> PointQuantities:
        """Fill the quantities at points z; the external forces are multiplied by level (point,).

        Signals are polled between points.
        """
        b: Balance = self.balance
        i: cython.Py_ssize_t
        d: cython.Py_ssize_t
        j: cython.Py_ssize_t
        for i in range(z.shape[0]):
            PyErr_CheckSignals()
            b.load = level[i]
            b.evaluate_contacts(z[i], True)
            b.evaluate_outputs(z[i], direction[i])
            for d in range(b.displacements.dofs):
                self.mean[i, d], self.amplitude[i, d] = b.displacements.mean[d], b.displacements.amplitude[d]
                self.growth[i, d] = b.displacements.growth[d]
                for j in range(b.receptance.count):
                    self.re[i, j, d], self.im[i, j, d] = b.displacements.re[j, d], b.displacements.im[j, d]
            for j in range(b.unknowns):
                self.force[i, j] = b.force[j]
            for j in range(b.contacts):
                law: Law = b.laws[j]
                if law.nonlinear:
                    self.linear[i] = 0
        return self


def cycles_of(
    law: Law,
    x: cython.double[:, ::1],
    first: cython.Py_ssize_t,
    state: cython.int[:, ::1],
    contact_loads: cython.double[:, ::1],
) -> None:
    """Fill states and contact loads over the cycles of a contact whose unknowns begin at x[:, first].

    state (point, piece): entries after the last piece stay as they are. contact_loads (point, 4): see `Law`.
    """
    i: cython.Py_ssize_t
    p: cython.int
    for i in range(x.shape[0]):
        law.cycle(x[i], first)
        for p in range(law.pieces):
            state[i, p] = law.state[p]
        for p in range(4):
            contact_loads[i, p] = law.contact_loads[p]
