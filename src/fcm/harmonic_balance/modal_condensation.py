r"""The linear system of a balance of many contacts, condensed to the modes that matter beside the contacts.

The contacts' displacements answer to their forces through the modes: the Jacobian of a balance is 1 + A B
with A (unknown, rank), B (rank, unknown); rank is the number of modes times 1 + 2 harmonics. With b the
derivative by the parameter and a row that closes the system,

    [1 + A B   b  ] [x]   [r]            [1 + B A      B b     ] [y]   [B r      ]
    [row'      rho] [l] = [s]    is      [-row' A   rho - row' b] [l] = [s - row' r],   x = r - A y - b l,

of the same determinant, and no worse conditioned at a fold.

A mode far above the harmonics is stiff beside the contacts. With modal mass 1 and shapes p on the ports it
yields y = sum_p k_p p^2 / (w^2 - (H omega)^2) times as much as the contacts' springs k. Modes of which that
is small are left out of the condensed system. This is then the preconditioner of the whole one, with all
modes, whose solution takes few iterations. With y the greatest yield of the modes left out, the spectrum is
within 1 and 1 + y, so that an iteration leaves the part

    (sqrt(1 + y) - 1) / (sqrt(1 + y) + 1)

of an error (Saad 2003, 6.11). As many modes are kept as make factorisation and iterations cheapest.

Where most contacts stay stuck or open, the forces of the others may be fewer than these modes. Then the
system is condensed to these forces, see `fcm.harmonic_balance.linear_contacts`. A small system is solved as
fast as it is.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from fcm.frozen import Frozen
from fcm.harmonic_balance.linear_contacts import LinearContacts
from fcm.harmonic_balance.modal_equations import ModalCompliance, ModalEquations
from fcm.model.scene import FloatArray


class CondensationOptions(Frozen):
    """Options on when a balance of many contacts is condensed to modes, and how it is solved.

    Attributes
    ----------
    min_unknowns : int
        Number of unknowns from which on condensing is faster; and number of those of the condensed system,
        from which on it is condensed further, to the forces of some contacts.
    max_fraction : float
        Largest size of the condensed system, relative to the number of unknowns.
    compliance_limits : tuple of float
        Compliances beside the contacts up to which a mode is left out: the cheapest of these limits is taken.
    solutions : int
        Number of solutions with one factorisation that is assumed for that choice.
    product_speed : float
        Speed of a product of matrices, relative to that of a matrix and a vector, that is assumed for that
        choice.
    tolerance : float
        Length of the last correction of a solution, relative to the solution.
    newton_tolerance : float
        Length of the last correction of a Newton step, relative to the square of the step in units of scale:
        the step itself leaves as much.
    min_step : float
        Length of a step, in units of scale, below which `tolerance` is relative to this length.
    max_corrections : int
        Most corrections in a row.
    max_contraction : float
        What these leave, relative to what was left before, above which twice as many modes are taken.
    """

    min_unknowns: int = 200
    max_fraction: float = 0.5
    compliance_limits: tuple[float, ...] = (0.03, 0.3, 1.0)
    solutions: int = 3
    product_speed: float = 8.0
    tolerance: float = 1e-9
    newton_tolerance: float = 0.1
    min_step: float = 1e-3
    max_corrections: int = 20
    max_contraction: float = 0.1


CONDENSATION = CondensationOptions()  # where nothing else is said


def modal_compliance(
    natural: FloatArray, shapes: FloatArray, flexibility: FloatArray, springs: FloatArray, highest: float
) -> FloatArray:
    """How much each mode (mode,) yields up to a frequency, beside springs (port,); inf if it resonates.

    >>> modal_compliance(np.array([1.0, 10.0]), np.ones((2, 1)), np.diag([1.0, 0.01]), np.array([3.0]), 5.0)
    array([ inf, 0.04])
    """
    apart = natural**2 - highest**2
    moving = np.divide(1.0, apart, out=np.full(natural.size, np.inf), where=apart > 0.0)
    size = np.maximum(moving, np.abs(flexibility).sum(axis=1))
    share = np.square(shapes) @ springs
    return np.where(share > 0.0, size, 0.0) * np.where(share > 0.0, share, 1.0)


def retained_modes(
    yields: FloatArray, ports: int, parts: int, options: CondensationOptions = CONDENSATION
) -> int:
    """Number of modes to which many contacts are condensed, each in so many parts; 0 where these are not much
    fewer than the ports.

    >>> modes = np.r_[np.full(40, 10.0), np.full(250, 0.5), np.full(310, 0.1)]
    >>> retained_modes(modes, 600, 7), retained_modes(modes[::5], 120, 3)
    (40, 8)
    """
    number = {stiff: max(int((yields > stiff).sum()), 1) for stiff in options.compliance_limits}
    few = {stiff: modes for stiff, modes in number.items() if modes < options.max_fraction * ports}

    def cost(stiff: float) -> float:
        """Multiplications for one factorisation and what is solved with it."""
        rank, root = parts * few[stiff], math.sqrt(1.0 + stiff)
        factored = rank**3 / 3.0 + rank * rank * ports
        by_iteration = math.log((root + 1.0) / (root - 1.0)) if stiff > 0.0 else math.inf
        iterations = -math.log(options.tolerance) / by_iteration
        each = 2.0 * parts * ports * yields.size + rank * rank
        return factored / options.product_speed + options.solutions * iterations * each

    return few[min(few, key=cost)] if few else 0


class Condensable(Protocol):
    """A system of many contacts: how it may be condensed, and how much its modes yield beside these."""

    @property
    def condensation(self) -> CondensationOptions: ...

    @property
    def modal_compliance(self) -> FloatArray: ...


def condensed_size(system: Condensable, ports: int, harmonics: int) -> int:
    """Size of the condensed system; 0 where the system itself is to be solved, as where its unknowns are few:
    then nobody asks how much its modes yield."""
    parts = 1 + 2 * harmonics
    if ports * parts < system.condensation.min_unknowns or not system.modal_compliance.size:
        return 0
    return retained_modes(system.modal_compliance, ports, parts, system.condensation) * parts


class CondensedSystem:
    """A balance as it was evaluated last, closed by a row: `factor`, then `solve`.

    Unknowns are sorted into parts (part, port): the mean, and real and imaginary part of each harmonic;
    those of the condensed system are (part, mode).
    """

    def __init__(
        self,
        answer: ModalCompliance,
        tangent: FloatArray,
        yields: FloatArray,
        springs: FloatArray,
        counted: FloatArray,
        options: CondensationOptions = CONDENSATION,
    ) -> None:
        self.answer, self.tangent, self.options = answer, tangent, options
        self.equations = ModalEquations(self.answer, tangent, options.max_corrections)
        self.ranking = np.argsort(-yields, kind="stable")
        parts = 1 + 2 * answer.receptance.count
        self.choose_modes(retained_modes(yields, answer.receptance.ports, parts, options))
        self.linear_contacts = LinearContacts(answer, springs, counted)
        self.row, self.scale = np.zeros((2, tangent.shape[0] * tangent.shape[1] + 1))
        self.omega, self.sign = 0.0, 0.0  # of what was factored

    @property
    def by_contacts(self) -> bool:
        """Whether the system is condensed to the forces of contacts."""
        return self.equations.held is not None

    def choose_modes(self, modes: int) -> None:
        """Condense to a number of modes, those that matter most."""
        self.modes = min(max(modes, 1), self.ranking.size)
        self.equations.choose_modes(np.sort(self.ranking[: self.modes]))

    @np.errstate(invalid="ignore", over="ignore")  # where Newton's method has gone astray
    def factor(self, row: FloatArray, by: FloatArray, scale: FloatArray) -> float:
        """Factor the system closed by a row (unknown + 1,) in units of scale; the sign of its determinant, or
        0.

        by (unknown,) is the derivative by the parameter.
        """
        np.divide(row, scale, out=self.row)
        self.scale[:], self.omega = scale, self.answer.receptance.omega
        self.equations.set_closing_row(row, by, scale)
        rank = self.equations.rank
        if rank >= self.options.min_unknowns and self.linear_contacts.choose(self.tangent, rank):
            self.equations.held = self.linear_contacts
            self.sign = self.linear_contacts.factor(self.row, by)
        else:
            self.equations.held = None
            self.sign = float(self.equations.factor())
        return self.sign

    @np.errstate(invalid="ignore", over="ignore")
    def solve(self, right: FloatArray, step: bool = True) -> None:
        """Replace a right side (unknown + 1,) in units of scale by the solution in these.

        step: it is one of Newton's method, or a direction if the equations have no right side but the last.
        The structure answers as where the system was factored: a right side may be that of another frequency.
        """
        receptance, now = self.answer.receptance, self.answer.receptance.omega
        receptance.at(self.omega)
        self._solve_there(right, step)
        receptance.at(now)

    def _solve_there(self, right: FloatArray, step: bool) -> None:
        """Replace a right side by the solution, with the structure at the frequency of what was factored."""
        whole, found = right * self.scale, np.empty_like(right)
        whole[-1] = right[-1]
        self.equations.condensed(whole, found)
        is_step = bool(right[:-1].any())
        enough = self._tolerance(found, step and is_step)
        while (self.by_contacts or self.modes < self.ranking.size) and np.isfinite(found).all():
            done, turned = self._corrected(whole, found, enough)
            if done:
                self.sign *= 1.0 if is_step else turned
                break
            if not self.by_contacts:
                self.choose_modes(2 * self.modes)
            self.equations.held = None
            self.sign = float(self.equations.factor())
            if self.modes == self.ranking.size:  # that is the system itself
                left, change = np.empty((2, right.size))
                self.equations.multiply(found, left)
                self.equations.condensed(whole - left, change)
                found += change
        np.divide(found, self.scale, out=right)

    def _corrected(self, whole: FloatArray, found: FloatArray, enough: float) -> tuple[bool, float]:
        """Whether corrections of a solution, as long as they shrink, leave no more than enough; and -1 where
        those of the first hold another sign of the determinant, else 1.

        Where a contact in a plane begins to slip its tangent has no bound: that takes some more of them, but
        no more modes at all other points.
        """
        before, turned, options = np.inf, 0.0, self.options
        while (left := self.equations.correct(whole, found, enough, options.max_corrections)) > enough:
            turned = turned or self.equations.turned
            if not left < options.max_contraction * before:
                return False, turned
            before = left
        return True, turned or self.equations.turned

    def _tolerance(self, found: FloatArray, step: bool) -> float:
        """Length that the last correction of a solution may have, in units of scale.

        It is larger for a Newton step than for a direction.
        """
        size, options = float(np.linalg.norm(found / self.scale)), self.options
        of_step = options.newton_tolerance * min(size, 1.0) ** 2 if step else 0.0
        return max(options.tolerance * max(size, options.min_step), of_step)
