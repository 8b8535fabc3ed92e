"""Prolongation of solutions to more harmonics, and homotopies to a solution.

A homotopy parameter is the level of the forces, starting from a structure at rest (`ForceLevelProblem`). The
other is the subtracted part of the residual at a guess: F(z) - part F(guess) = 0 has the solution guess for
part = 1 (`Homotopy`).

`Prolongation` moves a point of a balance to the curve of a balance with more harmonics, in the plane normal
to its own curve. With many contacts Newton's method is damped: its full steps from a motion without the
further harmonics are too long where some contacts stick and others slip. A step is shortened until the next
step, with the same Jacobian, is sufficiently shorter (natural monotonicity test; Deuflhard, Newton Methods
for Nonlinear Problems, 2004, section 3.3). A solution may predict the next one, see
`Prolongation.predict_from`.
"""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.libc.math import fabs, sqrt

from fcm.continuation.corrector import Newton
from fcm.continuation.problem import Problem
from fcm.harmonic_balance.contact_law import Law
from fcm.harmonic_balance.options import HARMONIC_BALANCE, PROLONGATION, ProlongationOptions, UnitOptions
from fcm.harmonic_balance.residual import Balance


@cython.cclass
class ForceLevelProblem(Problem):
    """The balance at a fixed frequency omega, with the level of the forces as parameter."""

    def __init__(
        self, balance: Balance, omega: cython.double = 0.0, units: UnitOptions = HARMONIC_BALANCE.units
    ) -> None:
        Problem.__init__(self, balance.unknowns, balance.margins, 0, balance.rank)
        self.group, self.residual, self.jacobian = balance.group, balance.residual, balance.jacobian
        self.margin, self.kind, self.angle = balance.margin, balance.kind, balance.angle
        self.unbounded *= self.unbounded  # the level may grow by this factor, too
        self.balance, self.z = balance, np.zeros(balance.unknowns + 1)
        self.many, self.has_root_margins, self.min_level_unit = (
            self.costly,
            balance.has_root_margins,
            units.min_level_unit,
        )
        self.begin(omega)

    def begin(self, omega: float, lightly: bool = False) -> None:
        """Prepare for another curve, at omega.

        lightly: steps pass over slight corners even if there are few unknowns.
        """
        self.omega, self.costly = omega, lightly or self.many
        self.balance.largest[:] = 0.0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        b: Balance = self.balance
        n: cython.Py_ssize_t = self.unknowns
        last: cython.Py_ssize_t = 0 if self.rank else n
        row: cython.Py_ssize_t
        p: cython.Py_ssize_t
        i: cython.Py_ssize_t
        j: cython.int
        k: cython.int
        self.place(z)
        b.evaluate(self.z)
        for i in range(n):
            self.jacobian[i, last] = 0.0
        for j in range(b.receptance.count):
            k = b.receptance.forced[j]
            for p in range(b.ports if k >= 0 else 0):
                row = b.receptance.wave_at[p] + b.receptance.stride * j
                self.jacobian[row, last] = -b.receptance.X_re[k, p]
                self.jacobian[row + 1, last] = -b.receptance.X_im[k, p]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_residual(self, z: cython.double[::1]) -> cython.int:
        self.place(z)
        return self.balance.evaluate_residual(self.z)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_scale(self, z: cython.double[::1]) -> cython.int:
        self.place(z)
        self.balance.evaluate_scale(self.z)
        self.scale[:] = self.balance.scale
        self.scale[self.unknowns] = max(abs(z[self.unknowns]), self.min_level_unit)
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_margins(self, z: cython.double[::1]) -> cython.int:
        self.place(z)
        return self.balance.evaluate_margins(self.z)

    @cython.ccall
    @cython.exceptval(-1.0, check=True)
    def squared_margin(self, kind: cython.int, z: cython.double[::1]) -> cython.double:
        self.place(z)
        return self.balance.squared_margin(kind, self.z)

    @cython.cfunc
    @cython.exceptval(check=False)
    def place(self, z: cython.double[::1]) -> cython.void:
        i: cython.Py_ssize_t
        for i in range(self.unknowns):
            self.z[i] = z[i]
        self.z[self.unknowns] = self.omega
        self.balance.load = z[self.unknowns]

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        return self.balance.factor(row, scale)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        return self.balance.solve(right)

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def solved_sign(self) -> cython.double:
        return self.balance.solved_sign()


@cython.cclass
class Homotopy(Problem):
    """The problem F(z) - subtracted_part * initial_residual = 0, with initial_residual = F(guess)."""

    def __init__(self, inner: Problem) -> None:
        Problem.__init__(self, inner.unknowns, 0, 0, inner.rank)
        self.has_root_margins = inner.has_root_margins
        self.inner, self.subtracted_part, self.initial_residual = inner, 0.0, np.zeros(inner.unknowns)
        self.jacobian = inner.jacobian

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.inner.evaluate(z)
        for i in range(self.unknowns):
            self.residual[i] = self.inner.residual[i] - self.subtracted_part * self.initial_residual[i]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def evaluate_residual(self, z: cython.double[::1]) -> cython.int:
        i: cython.Py_ssize_t
        self.inner.evaluate_residual(z)
        for i in range(self.unknowns):
            self.residual[i] = self.inner.residual[i] - self.subtracted_part * self.initial_residual[i]
        return 0

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def factor(self, row: cython.double[::1], scale: cython.double[::1]) -> cython.double:
        return self.inner.factor(row, scale)

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def solve(self, right: cython.double[::1]) -> cython.int:
        return self.inner.solve(right)

    @cython.ccall
    @cython.exceptval(-2.0, check=False)
    def solved_sign(self) -> cython.double:
        return self.inner.solved_sign()


@cython.cclass
class Prolongation:
    """Find points of a balance with more harmonics near points of a balance with fewer, by `find_normal`.

    A point found is newton.z, the direction of its curve newton.tangent, and found (1 + dof,) has its
    frequency and amplitudes. Newton's method has converged when a step is shorter than `tolerance` times the
    distance moved.
    """

    def __init__(
        self,
        balance: Balance,
        fewer: list[int],
        more: list[int],
        enough: cython.double,
        options: ProlongationOptions = PROLONGATION,
    ) -> None:
        self.balance, self.tolerance = balance, enough
        self.costly_size = balance.unknowns >= options.costly_size
        self.many, self.brief = balance.unknowns >= options.chord_size, self.costly_size
        self.damps = balance.contacts >= options.damped.min_contacts
        self.take_options(options)
        self.homotopy = Homotopy(balance)
        self.newton = Newton(self.homotopy)
        self.guess, self.row = np.zeros(balance.unknowns + 1), np.zeros(balance.unknowns + 1)
        self.normal = balance.layout.of_normal.astype(np.uint8)
        self.still, self.prediction = np.zeros((2, balance.unknowns + 1))
        self.begin, self.way = np.zeros((2, balance.unknowns + 1))
        self.found = np.zeros(1 + balance.outputs)
        self.more = more
        self.fewer: list[int] = []
        self.set_harmonics(fewer)

    def take_options(self, options: ProlongationOptions) -> None:
        """Store the tolerances as numbers of C."""
        self.max_iterations, self.max_chord_steps = options.max_iterations, options.max_chord_steps
        self.final_step, self.max_change, self.min_cosine = (
            options.final_step,
            options.max_change,
            options.min_cosine,
        )
        self.chord_step, self.chord_contraction = options.chord_step, options.chord_contraction
        self.max_first_step, self.homotopy_parts = (
            options.first_step_ratio * options.max_change,
            options.homotopy_parts,
        )
        damped = options.damped
        self.max_damped_steps, self.min_damping, self.damped_final_step = (
            damped.max_steps,
            damped.min_damping,
            damped.final_step,
        )
        self.min_factor, self.max_factor = damped.min_factor, damped.max_factor

    def set_harmonics(self, fewer: list[int]) -> None:
        """Expect points of a balance with the harmonics `fewer`; the others are zero in the guesses."""
        if fewer == self.fewer:
            return
        self.fewer = fewer
        layout = self.balance.layout
        block = np.flatnonzero(np.isin(layout.harmonic_of(self.more), [0, *fewer]))
        place = np.arange(0, layout.unknowns, layout.width)[:, None] + block
        self.place = np.append(place, self.balance.unknowns).astype(np.intc)
        self.guess[:], self.row[:], self.prediction[:] = 0.0, 0.0, 0.0

    def reset(self, fewer: list[int], contacts: list[tuple[float, float, float, float]]) -> None:
        """Prepare for points with the harmonics `fewer` and for other contacts; forget the prediction.

        contacts: mu, k_u, k_v, n_0 of each.
        """
        self.set_harmonics(fewer)
        for law, numbers in zip(self.balance.laws, contacts, strict=True):
            law.set_parameters(*numbers)
        self.balance.largest[:] = 0.0
        self.prediction[:] = 0.0
        self.newton.evaluations = 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def predict_from(self, z: cython.double[::1], there: cython.double[::1]) -> cython.int:
        """With many contacts, use there - z as the predicted offset of the next point from its guess.

        z (fewer unknowns + 1,) is a guess, there (unknown + 1,) the point found from it. If the prediction
        fails, the guess itself is tried.
        """
        i: cython.Py_ssize_t
        if self.damps:
            self.prediction[:] = there
            for i in range(self.place.shape[0]):
                self.prediction[self.place[i]] -= z[i]
        return 0

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_normal(
        self, z: cython.double[::1], direction: cython.double[::1], briefly: cython.bint = False
    ) -> cython.bint:
        """Find a point near z (fewer unknowns + 1,) in the plane normal to direction; return success.

        briefly: no homotopy is tried where there are many unknowns, as for one of many points.
        """
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        self.brief = self.costly_size or (self.many and briefly)
        for i in range(self.place.shape[0]):
            self.guess[self.place[i]] = z[i]
        self.balance.evaluate_scale(self.guess)
        for i in range(self.place.shape[0]):
            self.row[self.place[i]] = direction[i] / self.balance.scale[self.place[i]]
            total += self.row[self.place[i]] * self.row[self.place[i]]
        if not total > 0.0:
            return False
        for i in range(self.guess.shape[0]):
            self.newton.scale[i] = self.balance.scale[i]
            self.newton.row[i] = self.row[i] / sqrt(total)
        return self.correct() and self.report()

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def find_at_frequency(self, z: cython.double[::1], gradually: cython.bint) -> cython.bint:
        """Find a point near z (unknown + 1,) at its frequency; return whether there is.

        gradually: if Newton's method fails, try the homotopy.
        """
        self.prediction[:] = 0.0
        self.hold(z)
        return (self.correct_at_once(z) or (gradually and self.correct_by_homotopy(z))) and self.report()

    @cython.ccall
    @cython.exceptval(-1, check=False)
    def rebalance(self, z: cython.double[::1], lack: cython.double[::1]) -> cython.bint:
        """Solve F = lack (unknown,) near z (unknown + 1,) at its frequency; return whether that succeeds.

        The solution is left in newton.z.
        """
        self.prediction[:] = 0.0
        self.hold(z)
        self.homotopy.initial_residual[:] = lack
        return self.correct_at_once(z, 1.0)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def hold(self, z: cython.double[::1]) -> cython.int:
        """Set Newton's method up to hold the frequency of z (unknown + 1,)."""
        i: cython.Py_ssize_t
        self.brief = self.costly_size
        self.balance.evaluate_scale(z)
        for i in range(z.shape[0]):
            self.newton.scale[i], self.newton.row[i] = self.balance.scale[i], 0.0
        self.newton.row[self.balance.unknowns] = 1.0
        return 0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def report(self) -> cython.bint:
        """Fill found with frequency and amplitudes of the point; return true."""
        i: cython.Py_ssize_t
        self.balance.evaluate_outputs(self.newton.z, self.still)
        self.found[0] = self.newton.z[self.balance.unknowns]
        for i in range(self.balance.outputs):
            self.found[1 + i] = self.balance.output[i]
        return True

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def correct(self) -> cython.bint:
        """Correct the guess by Newton's method or homotopy; return whether it leads to this curve."""
        if self.correct_at_once(self.guess) and self.keeps_direction():
            return True
        return not self.brief and self.correct_by_homotopy(self.guess) and self.keeps_direction()

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def correct_at_once(self, guess: cython.double[::1], taken: cython.double = 0.0) -> cython.bint:
        """Correct a guess by Newton's method; return whether it converges to a point near the guess.

        taken: the subtracted part of the initial residual. With many contacts the prediction is tried first.
        """
        i: cython.Py_ssize_t
        leads: cython.bint = False
        self.homotopy.subtracted_part = taken
        self.newton.guess[:] = guess
        if self.damps:
            for i in range(guess.shape[0]):
                self.newton.z[i] = guess[i] + self.prediction[i]
                leads = leads or self.prediction[i] != 0.0
            if leads and self.damped_newton() and self.strain_from(guess) <= self.max_change:
                return True
            self.newton.z[:] = guess
            return self.damped_newton() and self.strain_from(guess) <= self.max_change
        self.newton.z[:] = guess
        return self.newton_to_tolerance() and self.newton.moved <= self.max_change

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def correct_by_homotopy(self, guess: cython.double[::1]) -> cython.bint:
        """Correct a guess by the homotopy; return whether it leads to a point near the guess.

        It is not tried with many contacts: there it finds nothing that damped steps do not find.
        """
        if self.damps:
            return False
        self.newton.z[:] = guess
        self.homotopy.evaluate(guess)
        self.homotopy.initial_residual[:] = self.homotopy.residual
        for part in self.homotopy_parts:
            self.homotopy.subtracted_part = 1.0 - part
            if not self.newton.correct(1.0) or self.newton.moved > self.max_change:
                return False
        return self.distance_from(guess) <= self.max_change

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def keeps_direction(self) -> cython.bint:
        """Whether the curve with more harmonics has nearly the same direction at the point found.

        With many contacts the directions are compared in the common harmonics, weighted by the energy in the
        contact springs.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        along: cython.double = 0.0
        way: cython.double = 0.0
        row: cython.double = 0.0
        weight: cython.double
        newton: Newton = self.newton
        if not self.damps:
            for i in range(self.guess.shape[0]):
                along += newton.tangent[i] * newton.row[i]
            return along >= self.min_cosine
        size: cython.double = self.strain(self.guess)
        for j in range(self.place.shape[0]):
            i = self.place[j]
            weight = 1.0
            if i < self.balance.unknowns and size > 0.0:
                weight = self.spring(i) * (newton.scale[i] / size) ** 2
            along += weight * newton.tangent[i] * newton.row[i]
            way += weight * newton.tangent[i] ** 2
            row += weight * newton.row[i] ** 2
        return along >= self.min_cosine * sqrt(way * row)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def newton_to_tolerance(self) -> cython.bint:
        """Newton's method as in `Newton.correct`, to the accuracy that `tolerance` asks for."""
        count: cython.int
        step: cython.double
        first: cython.double = 0.0
        before: cython.double = 1.0
        newton: Newton = self.newton
        for count in range(self.max_iterations):
            if not newton.factor():
                return False
            step = newton.step()
            if count > 0 and step > 0.25 * before and newton.is_rounding(step, count):
                return newton.compute_tangent()
            if not step < 1e30 or (count > 1 and step > 2.0 * before):
                return False
            if self.brief and (
                step > self.max_first_step if count == 0 else step > min(2.0 * before, self.max_change)
            ):
                return False
            self.move()
            first = step if count == 0 else first
            if step < self.final_step or (count > 0 and step < self.tolerance * first):
                return newton.compute_tangent()
            if (self.many or step < self.chord_step) and self.chord_steps_converge(
                self.tolerance * first, step
            ):
                return newton.compute_tangent()
            before = step
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def damped_newton(self) -> cython.bint:
        """Damped Newton's method for many contacts: steps satisfy the natural monotonicity test."""
        i: cython.Py_ssize_t
        count: cython.int
        step: cython.double
        then: cython.double
        bend: cython.double
        part: cython.double = 1.0
        newton: Newton = self.newton
        for count in range(self.max_damped_steps):
            if not newton.factor():
                return False
            step = newton.step()
            if not step < 1e30:
                return False
            for i in range(self.guess.shape[0]):
                self.begin[i], self.way[i] = newton.z[i], newton.delta[i]
            part = min(1.0, self.max_factor * part) if count > 0 else 1.0
            while True:
                for i in range(self.guess.shape[0]):
                    newton.z[i] = self.begin[i] + part * newton.scale[i] * self.way[i]
                # the remaining error is far less than the last step
                if part == 1.0 and (
                    step < self.damped_final_step or step < self.tolerance * self.distance_from(newton.guess)
                ):
                    return newton.compute_tangent()
                newton.problem.evaluate_residual(newton.z)
                then = newton.step()
                if then < (1.0 - 0.25 * part) * step:
                    break
                if part <= self.min_damping:
                    return False
                bend = 0.0
                if then < 1e30:
                    for i in range(self.guess.shape[0]):
                        bend += (newton.delta[i] - (1.0 - part) * self.way[i]) ** 2
                    bend = 0.5 * part * part * step / sqrt(bend)  # damping factor from the curvature
                part = max(self.min_factor * part, min(0.5 * part, bend))
            if part == 1.0 and then < self.chord_contraction * step:
                self.move()
                if then < self.damped_final_step or self.chord_steps_converge(
                    self.tolerance * self.distance_from(newton.guess), then
                ):
                    return newton.compute_tangent()
        return False

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def chord_steps_converge(self, enough: cython.double, before: cython.double) -> cython.bint:
        """Take chord steps (same Jacobian); return whether one is shorter than enough.

        before: length of the step before. A step that does not contract enough is not taken and ends them.
        """
        count: cython.int
        step: cython.double
        newton: Newton = self.newton
        for count in range(self.max_chord_steps):  # noqa: B007
            newton.problem.evaluate_residual(newton.z)
            step = newton.step()
            if not step < self.chord_contraction * before:
                return False
            self.move()
            if step < enough:
                return True
            before = step
        return False

    @cython.cfunc
    @cython.exceptval(check=False)
    def move(self) -> cython.void:
        """Add the Newton step delta to the point."""
        i: cython.Py_ssize_t
        for i in range(self.guess.shape[0]):
            self.newton.z[i] += self.newton.scale[i] * self.newton.delta[i]

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def distance_from(self, guess: cython.double[::1]) -> cython.double:
        """Distance of the point from a guess."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(guess.shape[0]):
            total += fabs((self.newton.z[i] - guess[i]) / self.newton.scale[i]) ** 2
        return sqrt(total)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def strain_from(self, guess: cython.double[::1]) -> cython.double:
        """Distance of the point from a guess in the energy norm of the contact springs, relative to both.

        In this norm, contacts that hardly move may change by any part of their own motion.
        """
        i: cython.Py_ssize_t
        size: cython.double = max(self.strain(guess), self.strain(self.newton.z))
        for i in range(self.guess.shape[0]):
            self.way[i] = self.newton.z[i] - guess[i]
        return self.strain(self.way) / size if size > 0.0 else 0.0

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def strain(self, x: cython.double[::1]) -> cython.double:
        """The energy norm of displacements: the root of twice the energy in the contact springs."""
        i: cython.Py_ssize_t
        energy: cython.double = 0.0
        for i in range(self.balance.unknowns):
            energy += self.spring(i) * x[i] * x[i]
        return sqrt(energy)

    @cython.cfunc
    @cython.exceptval(-1, check=False)
    def spring(self, i: cython.Py_ssize_t) -> cython.double:
        """The stiffness of the contact spring along the displacement that is unknown i."""
        law: Law = self.balance.laws[i // self.balance.width]
        return law.k_v if self.normal[i % self.balance.width] else law.k_u
