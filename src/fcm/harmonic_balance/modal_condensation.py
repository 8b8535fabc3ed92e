r"""The linear system of a balance of many contacts, condensed to the modes that matter beside the contacts.

The contacts' displacements answer to their forces through the modes: the Jacobian of a balance is 1 + A B
with A (unknown, rank), B (rank, unknown); rank is the number of modes times 1 + 2 harmonics. With b the
derivative by the parameter and a row that closes the system,

    [1 + A B   b  ] [x]   [r]            [1 + B A      B b     ] [y]   [B r      ]
    [row'      rho] [l] = [s]    is      [-row' A   rho - row' b] [l] = [s - row' r],   x = r - A y - b l,

of the same determinant, and no worse conditioned at a fold.

A mode far above the harmonics is stiff beside the contacts: with modal mass 1 and shapes p on the ports it
yields sum_p k_p p^2 / (w^2 - (H omega)^2) of what a contact's spring k does. Modes of which that is small are
left out of the condensed system, which then is the preconditioner of the whole one, with all modes: of that
the solution is, after few iterations, as what is left out changes little.

Where most contacts stay stuck or open, the forces of the others may be fewer than these modes: then they are
condensed to, see `fcm.harmonic_balance.held_contacts`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fcm.continuation.dense_solver import Solver
from fcm.harmonic_balance.held_contacts import HeldContacts
from fcm.harmonic_balance.modal_receptance import ModalAnswer
from fcm.model.scene import FloatArray
from fcm.structure.receptance import Receptance


@dataclass(frozen=True)
class CondensedOptions:
    """What of a balance is condensed, and how well it is solved.

    fewest: unknowns from which on that is faster. share: of the unknowns, how large the condensed system
    may be. stiff: how much a mode that is left out may yield beside the contacts. accurate: of the last
    correction of a solution, relative to it. inexact: the same of a step of Newton's method, over its length
    in units of scale: what the step itself leaves is a part of its square. least: a step, to a shorter one of
    which what is left is not relative. corrections: after so many that do
    not come to that, twice as many modes are taken.
    """

    fewest: int = 200
    share: float = 0.5
    stiff: tuple[float, ...] = (0.03, 0.3, 1.0)
    accurate: float = 1e-9
    inexact: float = 0.1
    least: float = 1e-3
    corrections: int = 20


OPTIONS = CondensedOptions()  # where nothing else is said


def yielding(
    natural: FloatArray, shapes: FloatArray, flexibility: FloatArray, springs: FloatArray, highest: float
) -> FloatArray:
    """How much each mode (mode,) yields up to a frequency, beside springs (port,); inf if it resonates.

    >>> yielding(np.array([1.0, 10.0]), np.ones((2, 1)), np.diag([1.0, 0.01]), np.array([3.0]), 5.0)
    array([ inf, 0.04])
    """
    apart = natural**2 - highest**2
    moving = np.divide(1.0, apart, out=np.full(natural.size, np.inf), where=apart > 0.0)
    size = np.maximum(moving, np.abs(flexibility).sum(axis=1))
    share = np.square(shapes) @ springs
    return np.where(share > 0.0, size, 0.0) * np.where(share > 0.0, share, 1.0)


def modes_taken(yields: FloatArray, ports: int, options: CondensedOptions = OPTIONS) -> int:
    """To how many modes many contacts are condensed; 0 where these are not much fewer than the ports."""
    for stiff in options.stiff:
        modes = int((yields > stiff).sum())
        if modes < options.share * ports:
            return max(modes, 1)
    return 0


def condensed_size(
    yields: FloatArray, ports: int, harmonics: int, options: CondensedOptions = OPTIONS
) -> int:
    """Size of the condensed system; 0 where the system itself is to be solved."""
    parts = 1 + 2 * harmonics
    many = yields.size > 0 and ports * parts >= options.fewest
    return modes_taken(yields, ports, options) * parts if many else 0


class Condensed:
    """A balance as it was evaluated last, closed by a row: `factor`, then `solve`.

    Unknowns are sorted into parts (part, port): the mean, and real and imaginary part of each harmonic;
    those of the condensed system are (part, mode).
    """

    def __init__(
        self,
        seen: Receptance,
        flexibility: FloatArray,
        tangent: FloatArray,
        yields: FloatArray,
        springs: FloatArray,
        counted: FloatArray,
        options: CondensedOptions = OPTIONS,
    ) -> None:
        self.answer, self.tangent, self.options = ModalAnswer(seen, flexibility), tangent, options
        self.seen, self.flexibility, self.parts = seen, flexibility, 1 + 2 * seen.count
        self.contacts, self.width = tangent.shape[0], tangent.shape[1]
        self.each = seen.ports // self.contacts
        self.order = self.answer.place[:, : self.each].ravel()  # of a contact's unknowns: part by part
        self.ranking = np.argsort(-yields, kind="stable")
        self.take(modes_taken(yields, seen.ports, options))
        self.held = HeldContacts(self.answer, flexibility, springs, counted)
        self.holds = False  # whether the system is condensed to the forces of contacts
        self.by, self.row, self.scale = np.empty(0), np.empty(0), np.empty(0)

    def take(self, modes: int) -> None:
        """Condense to so many modes."""
        self.modes = modes = min(max(modes, 1), self.ranking.size)
        self.rank, chosen = self.parts * modes, np.sort(self.ranking[:modes])
        self.chosen, self.shapes = chosen, np.ascontiguousarray(self.answer.shapes[chosen])
        self.mean = self.flexibility[np.ix_(chosen, chosen)]
        self.along = np.ascontiguousarray(self.shapes.T.reshape(self.contacts, self.each, modes))
        self.solver = Solver(self.rank + 1)
        # forces on ports by modes: by contact (part port part, mode), by port; and on the modes
        self.by_mode = np.empty((self.contacts, self.each * self.parts**2, modes))
        self.by_port = np.empty((self.seen.ports, self.parts * self.rank))
        self.on_modes = np.empty((modes, self.parts, self.rank))

    @np.errstate(invalid="ignore", over="ignore")  # where Newton's method has gone astray
    def factor(self, row: FloatArray, by: FloatArray, scale: FloatArray) -> float:
        """Of the system closed by a row (unknown + 1,) in units of scale; the sign of its determinant, or 0.

        by (unknown,) is the derivative by the parameter.
        """
        self.by, self.row, self.scale = by.copy(), row / scale, scale.copy()
        self.ordered = self.tangent[:, self.order[:, None], self.order]
        self.holds = self.held.choose(self.ordered, self.rank)
        return self.held.factor(self.row, self.by) if self.holds else self._factor()

    def _factor(self) -> float:
        rank, matrix = self.rank, np.asarray(self.solver.matrix)
        np.matmul(self.ordered.reshape(self.contacts, -1, self.each), self.along, out=self.by_mode)
        sorted_by_port = self.by_mode.reshape(self.contacts, self.parts, self.each, rank).transpose(
            0, 2, 1, 3
        )
        self.by_port.reshape(self.contacts, self.each, self.parts, rank)[:] = sorted_by_port
        np.matmul(self.shapes, self.by_port, out=self.on_modes.reshape(self.modes, -1))
        self._answered(self.on_modes, matrix)
        matrix[np.arange(rank), np.arange(rank)] += 1.0
        column = np.empty((rank, 1))
        self._answered(self._pushed(self.by)[:, :, None], column)
        matrix[:rank, rank] = column[:, 0]
        row, last = self._parts(self.row[:-1]), self.row[-1]
        matrix[rank, :rank] = -(row @ self.shapes.T).ravel()
        matrix[rank, rank] = last - self.row[:-1] @ self.by
        return self.solver.orientation if self.solver.factor() else 0.0

    @np.errstate(invalid="ignore", over="ignore")
    def solve(self, right: FloatArray) -> None:
        """Replace a right side (unknown + 1,) in units of scale by the solution in these."""
        whole = right.copy()
        whole[:-1] *= self.scale[:-1]
        found = self._condensed(whole)
        enough = self._enough(whole, found)
        while (self.holds or self.modes < self.ranking.size) and np.isfinite(found).all():
            change = self._condensed(whole - self._image(found))
            moved, small = self._corrected(change / self.scale, enough)
            found += moved * self.scale
            if small:
                break
            if not self.holds:
                self.take(2 * self.modes)
            self.holds = False
            self._factor()
            if self.modes == self.ranking.size:  # that is the system itself
                found += self._condensed(whole - self._image(found))
        right[:] = found / self.scale

    def _enough(self, right: FloatArray, found: FloatArray) -> float:
        """What a correction of a solution may leave, in units of scale; of a direction, which is no step,
        little."""
        size, options = float(np.linalg.norm(found / self.scale)), self.options
        step = min(size, 1.0) if right[:-1].any() else 0.0
        return max(options.accurate * max(size, options.least), options.inexact * step * step)

    def _corrected(self, change: FloatArray, enough: float) -> tuple[FloatArray, bool]:
        """What a correction by the condensed system, in units of scale, comes to with all modes.

        By the generalised minimal residuals (Saad and Schultz 1986), and whether these are small enough.
        """
        most, size = self.options.corrections, float(np.linalg.norm(change))
        if size <= enough:
            return change, True
        basis, R = np.empty((most + 1, change.size)), np.zeros((most, most))
        basis[0] = change / size
        turns, right = list[tuple[float, float]](), [size]  # of the planes in which R is made triangular
        left, taken = size, 0
        for k in range(most):
            new = self._condensed(self._image(basis[k] * self.scale)) / self.scale
            column = basis[: k + 1] @ new
            new -= column @ basis[: k + 1]
            further = float(np.linalg.norm(new))
            column = column.tolist()
            for i, (c, s) in enumerate(turns):
                column[i : i + 2] = c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]
            long = math.hypot(column[k], further)
            if not 0.0 < long < math.inf:
                break
            c, s = column[k] / long, further / long
            column[k] = long
            turns.append((c, s))
            right[k:] = [c * right[k], -s * right[k]]
            R[: k + 1, k], left, taken = column, abs(right[k + 1]), k + 1
            if not left > enough or further == 0.0:
                break
            basis[k + 1] = new / further
        part = np.linalg.solve(R[:taken, :taken], right[:taken])
        moved: FloatArray = part @ basis[:taken]
        return moved, not left > enough

    def _condensed(self, right: FloatArray) -> FloatArray:
        """The solution with the modes that are condensed to alone, or beside contacts that are held."""
        if self.holds:
            return self.held.solve(right)
        reduced, column = np.asarray(self.solver.right), np.empty((self.rank, 1))
        self._answered(self._pushed(right[:-1])[:, :, None], column)
        reduced[:-1], reduced[-1] = column[:, 0], right[-1] - self.row[:-1] @ right[:-1]
        self.solver.solve()
        y = reduced[:-1].reshape(self.parts, self.modes)
        found = np.empty_like(right)
        found[:-1] = right[:-1] - self.by * reduced[-1]
        found[self.answer.place] -= y @ self.shapes
        found[-1] = reduced[-1]
        return found

    def _image(self, x: FloatArray) -> FloatArray:
        """What the whole system makes of x (unknown + 1,)."""
        out = np.empty_like(x)
        out[:-1] = x[:-1] + self.answer.to(self._forces(x[:-1])) + self.by * x[-1]
        out[-1] = self.row @ x
        return out

    def _forces(self, x: FloatArray) -> FloatArray:
        """The change of the contacts' forces, (unknown,)."""
        force: FloatArray = (self.tangent @ x.reshape(self.contacts, self.width, 1)).ravel()
        return force

    def _parts(self, x: FloatArray) -> FloatArray:
        return x[self.answer.place]  # type: ignore[no-any-return]

    def _pushed(self, x: FloatArray) -> FloatArray:
        """Forces on the modes (mode, part) of what the contacts' forces change by x (unknown,)."""
        return self.shapes @ self._parts(self._forces(x)).T

    def _answered(self, force: FloatArray, out: FloatArray) -> None:
        """Fill the first columns of out with the modes' answer to forces (mode, part, column)."""
        m, columns = self.modes, force.shape[2]
        c_re, c_im = np.asarray(self.seen.c_re)[:, self.chosen], np.asarray(self.seen.c_im)[:, self.chosen]
        out[:m, :columns] = self.mean @ force[:, 0]
        for j in range(self.seen.count):
            re, im = force[:, 1 + 2 * j], force[:, 2 + 2 * j]
            first = (1 + 2 * j) * m
            c, d = c_re[j][:, None], c_im[j][:, None]
            out[first : first + m, :columns] = c * re - d * im
            out[first + m : first + 2 * m, :columns] = d * re + c * im
