r"""Linear system of a balance with many contacts, condensed to the modes that are soft against the contacts.

The contacts' displacements respond to their forces through the modes: the Jacobian of a balance is 1 + A B
with A (unknown, rank), B (rank, unknown); rank is the number of modes times 1 + 2 harmonics. With b the
derivative by the parameter and a row that closes the system,

    [1 + A B   b  ] [x]   [r]            [1 + B A      B b     ] [y]   [B r      ]
    [row'      rho] [l] = [s]    is      [-row' A   rho - row' b] [l] = [s - row' r],   x = r - A y - b l,

The determinant is the same, and the condition at a fold no worse.

A mode far above the harmonics is stiff against the contacts. With modal mass 1 and shapes p on the ports, its
compliance relative to the contacts' springs k is y = sum_p k_p p^2 / (w^2 - (H omega)^2). The condensed
system leaves out modes of small y. It then preconditions the full system, whose solution takes few
iterations. With y the greatest of the modes left out, the spectrum lies between 1 and 1 + y, so that an
iteration leaves the part

    (sqrt(1 + y) - 1) / (sqrt(1 + y) + 1)

of an error (Saad 2003, 6.11). The number of retained modes minimises the cost of factorisation and
iterations.

Where most contacts stay stuck or open, the forces of the others may be fewer than these modes. Then the
system is condensed to these forces, see `fcm.harmonic_balance.linear_contacts`. A small system is not
condensed.
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
        Number of unknowns from which on a system is condensed. From the same number on, a condensed system is
        condensed further, to the forces of some contacts.
    max_fraction : float
        Largest size of the condensed system, relative to the number of unknowns.
    compliance_limits : tuple of float
        Compliances, relative to the contacts, up to which a mode is left out; the cheapest limit is taken.
    solutions : int
        Number of solutions per factorisation that this choice assumes.
    product_speed : float
        Speed of a matrix-matrix product, relative to a matrix-vector product, that this choice assumes.
    tolerance : float
        Length of the last correction of a solution, relative to the solution.
    newton_tolerance : float
        Length of the last correction of a Newton step, relative to the square of the step in units of scale.
        The error of the step itself is of that order.
    min_step : float
        Length of a step, in units of scale, below which `tolerance` is relative to this length.
    max_corrections : int
        Most corrections in a row.
    max_contraction : float
        Error after these corrections, relative to that before, above which twice as many modes are retained.
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


CONDENSATION = CondensationOptions()  # the default


def modal_compliance(
    natural: FloatArray, shapes: FloatArray, flexibility: FloatArray, springs: FloatArray, highest: float
) -> FloatArray:
    """Compliance of each mode (mode,) up to a frequency, relative to springs (port,); inf if it resonates.

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
    """Number of modes to condense to, each in a number of parts; 0 if not much fewer than the ports.

    >>> modes = np.r_[np.full(40, 10.0), np.full(250, 0.5), np.full(310, 0.1)]
    >>> retained_modes(modes, 600, 7), retained_modes(modes[::5], 120, 3)
    (40, 8)
    """
    number = {stiff: max(int((yields > stiff).sum()), 1) for stiff in options.compliance_limits}
    few = {stiff: modes for stiff, modes in number.items() if modes < options.max_fraction * ports}

    def cost(stiff: float) -> float:
        """Multiplications for one factorisation and its solutions."""
        rank, root = parts * few[stiff], math.sqrt(1.0 + stiff)
        factored = rank**3 / 3.0 + rank * rank * ports
        by_iteration = math.log((root + 1.0) / (root - 1.0)) if stiff > 0.0 else math.inf
        iterations = -math.log(options.tolerance) / by_iteration
        each = 2.0 * parts * ports * yields.size + rank * rank
        return factored / options.product_speed + options.solutions * iterations * each

    return few[min(few, key=cost)] if few else 0


class Condensable(Protocol):
    """A system with many contacts: options of its condensation, and compliances of its modes."""

    @property
    def condensation(self) -> CondensationOptions: ...

    @property
    def modal_compliance(self) -> FloatArray: ...


def condensed_size(system: Condensable, ports: int, harmonics: int) -> int:
    """Size of the condensed system; 0 where the system is solved as it is.

    For few unknowns the compliances of the modes are not computed.
    """
    parts = 1 + 2 * harmonics
    if ports * parts < system.condensation.min_unknowns or not system.modal_compliance.size:
        return 0
    return retained_modes(system.modal_compliance, ports, parts, system.condensation) * parts


class CondensedSystem:
    """Linear system of a balance at its last evaluation, closed by a row: call `factor`, then `solve`.

    Unknowns are sorted into parts (part, port): the mean, and real and imaginary part of each harmonic.
    The unknowns of the condensed system are (part, mode).
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
        self.omega, self.sign = 0.0, 0.0  # at the last factorisation

    @property
    def by_contacts(self) -> bool:
        """Whether the system is condensed to the forces of contacts."""
        return self.equations.held is not None

    def choose_modes(self, modes: int) -> None:
        """Condense to a number of modes, the most compliant ones."""
        self.modes = min(max(modes, 1), self.ranking.size)
        self.equations.choose_modes(np.sort(self.ranking[: self.modes]))

    @np.errstate(invalid="ignore", over="ignore")  # where Newton's method has diverged
    def factor(self, row: FloatArray, by: FloatArray, scale: FloatArray) -> float:
        """Factor the system closed by a row (unknown + 1,); return the sign of its determinant, or 0.

        The row is in units of scale; by (unknown,) is the derivative by the parameter.
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
        """Replace a right side (unknown + 1,) by the solution, both in units of scale.

        step: the solution is a Newton step, or the tangent if only the last entry of the right side is not 0.
        The receptance is that of the factorisation, even if the right side belongs to another frequency.
        """
        receptance, now = self.answer.receptance, self.answer.receptance.omega
        receptance.at(self.omega)
        self._solve_there(right, step)
        receptance.at(now)

    def _solve_there(self, right: FloatArray, step: bool) -> None:
        """Replace a right side by the solution; the receptance is at the frequency of the factorisation."""
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
            if self.modes == self.ranking.size:  # all modes: this is the full system
                left, change = np.empty((2, right.size))
                self.equations.multiply(found, left)
                self.equations.condensed(whole - left, change)
                found += change
        np.divide(found, self.scale, out=right)

    def _corrected(self, whole: FloatArray, found: FloatArray, enough: float) -> tuple[bool, float]:
        """Correct a solution while the corrections shrink; return whether this suffices, and a sign.

        The sign is -1 where the first corrections show that the determinant has the other sign, else 1. Where
        a contact in a plane begins to slip, its tangent is unbounded. More corrections are cheaper there than
        more modes at all other points.
        """
        before, turned, options = np.inf, 0.0, self.options
        while (left := self.equations.correct(whole, found, enough, options.max_corrections)) > enough:
            turned = turned or self.equations.turned
            if not left < options.max_contraction * before:
                return False, turned
            before = left
        return True, turned or self.equations.turned

    def _tolerance(self, found: FloatArray, step: bool) -> float:
        """Greatest length of the last correction, in units of scale; larger for a step than for a tangent."""
        size, options = float(np.linalg.norm(found / self.scale)), self.options
        of_step = options.newton_tolerance * min(size, 1.0) ** 2 if step else 0.0
        return max(options.tolerance * max(size, options.min_step), of_step)
