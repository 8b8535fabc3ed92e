r"""Linear system of a balance with mostly stuck or open contacts, condensed to the forces of the others.

A contact that stays stuck through the cycle acts as springs, and one that stays open as nothing: both are
linear. The tangent is T = K + D. K has the springs of the stuck contacts; D is zero but for the other
contacts. Then

    1 + A T = (1 + A K) (1 + G D),    G = (1 + A K)^-1 A,    (1 + A K)^-1 = 1 - G K

where G is the receptance of the structure on these springs. Its modes are computed once. E selects the rows
of D that are not zero, and b is the derivative by the parameter. Closed by a row, the system

    [1 + A T  b  ] [x]   [r]        [1 + D G E      D S b     ] [y]   [D S r      ]
    [row'     rho] [l] = [s]   is   [-row' G E   rho - row' S b] [l] = [s - row' S r],   S = 1 - G K

with y = D x and x = S r - G E y - S b l. The determinant keeps its sign, as that of 1 + A K is positive.

Modal damping couples the modes on springs slightly. G leaves this coupling out, so that the condensed system
is an approximation; iterations correct it, see `modal_condensation`.
"""

from __future__ import annotations

import numpy as np

from fcm.continuation.dense_solver import Solver
from fcm.frozen import Frozen
from fcm.harmonic_balance.modal_equations import ModalCompliance, linear_contacts
from fcm.model.scene import FloatArray
from fcm.structure.receptance import Receptance


class LinearContactOptions(Frozen):
    """Options on which contacts of a balance count as linear: stuck or open all the time.

    Attributes
    ----------
    tangent_tolerance : float
        Difference of a contact's tangent from that of its springs, relative to these, up to which the contact
        is linear.
    max_changed : int
        Number of contacts that have changed between stuck and open, above which the modes on the springs are
        computed again.
    min_damping : float
        Least damping ratio of a mode: it keeps an undamped mode finite at its natural frequency.
    max_rounding : float
        Rounding error of the modes on the springs, relative to a displacement, from which on these modes are
        not used: the springs are too stiff.
    """

    tangent_tolerance: float = 1e-3
    max_changed: int = 4
    min_damping: float = 1e-9
    max_rounding: float = 0.1


LINEAR_CONTACTS = LinearContactOptions()  # the default


class LinearContacts:
    """The system condensed to `size - 1` forces: call `choose` with the tangents, then `factor` and `solve`.

    springs (port,): stiffnesses if all contacts stick. counted (contact,): normal stiffness that belongs to
    the structure in the means. Tangents are (contact, width, width), laid out as the unknowns of a contact. A
    part is the mean, or the real or imaginary part of a harmonic.
    """

    def __init__(
        self,
        answer: ModalCompliance,
        springs: FloatArray,
        counted: FloatArray,
        options: LinearContactOptions = LINEAR_CONTACTS,
    ) -> None:
        self.receptance: Receptance = answer.receptance
        self.place, self.options = answer.place, options
        self.flexibility = np.ascontiguousarray(np.asarray(answer.flexibility).T)
        self.contacts, self.parts = counted.size, answer.place.shape[0]
        self.each = springs.size // counted.size
        self.order = answer.place[:, : self.each].ravel()  # indices of a contact's unknowns, part by part
        self.springs = springs.reshape(self.contacts, self.each)
        self.tangent_tolerance = options.tangent_tolerance * self.springs.max(axis=1)
        self.is_stuck, self.is_open = np.zeros((2, self.contacts), dtype=np.uint8)
        counts = np.zeros_like(self.springs)
        counts[:, -1] = counted
        # diagonals of the tangents (contact, part, port) of open and of stuck contacts
        self.open = np.zeros((self.contacts, self.parts, self.each))
        self.open[:, 0] = -counts
        self.stuck = self.open + self.springs[:, None]
        self.closed: np.ndarray[tuple[int], np.dtype[np.bool_]] | None = None  # (contact,) in the modes
        self.ports, self.size, self.max_rounding = np.zeros(0, dtype=np.intp), 0, 0.0
        self.solver = Solver(0)

    def choose(self, tangent: FloatArray, most: int) -> bool:
        """Choose the linear contacts by the tangents; return whether at most `most` equations are left.

        If so, the system is ready to be factored.
        """
        stuck, apart = self.is_stuck.view(np.bool_), self.is_open.view(np.bool_)
        for linear, states in ((self.stuck, self.is_stuck), (self.open, self.is_open)):
            linear_contacts(tangent, self.order, linear, self.tangent_tolerance, states)
        if self.closed is None:
            self._find_modes(~apart | stuck)
        elif int((np.where(self.closed, apart, stuck) & (stuck != apart)).sum()) > self.options.max_changed:
            self._find_modes(np.where(stuck | apart, stuck, self.closed))
        assert self.closed is not None
        others = np.flatnonzero(~np.where(self.closed, stuck, apart))
        if self.parts * others.size >= most or not self.max_rounding < self.options.max_rounding:
            return False
        ordered = tangent[others[:, None, None], self.order[:, None], self.order]
        D = ordered.reshape(others.size, self.parts, self.each, self.parts, self.each)
        part, port = np.arange(self.parts)[:, None], np.arange(self.each)
        linear = np.where(self.closed[others, None, None], self.stuck[others], self.open[others])
        D[:, part, port, part, port] -= linear
        which, port = np.nonzero(
            (np.abs(D) > self.tangent_tolerance[others, None, None, None, None]).any(axis=(1, 3, 4))
        )
        self.ports, self.D = others[which] * self.each + port, D[which, :, port]
        self.size = self.parts * self.ports.size + 1
        return self.size <= most

    def _find_modes(self, closed: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> None:
        """Compute the modes of the structure on the springs of the contacts closed (contact,)."""
        self.closed, receptance = closed, self.receptance
        P, natural, rate = (np.asarray(a) for a in (receptance.shapes, receptance.natural, receptance.rate))
        self.K = (self.springs * closed[:, None]).ravel()
        self.K_mean = np.where(closed[:, None], self.stuck[:, 0], self.open[:, 0]).ravel()
        square, V = np.linalg.eigh(np.diag(natural**2) + (P * self.K) @ P.T)
        self.square, self.shapes = np.maximum(square, 0.0), np.ascontiguousarray(V.T @ P)
        pushed, soft = np.square(P) @ self.K, self.square[self.square > 0.0].min(initial=np.inf)
        stiffest = float((pushed[natural > 0.0] / natural[natural > 0.0] ** 2).max(initial=0.0))
        self.max_rounding = float(np.finfo(float).eps * self.square.max(initial=0.0) / soft * stiffest)
        least = 2.0 * self.options.min_damping * np.sqrt(self.square)
        self.rate = np.maximum(np.square(V.T) @ rate, least)
        F = self.flexibility
        held = np.linalg.solve(np.eye(natural.size) + F @ (P * self.K_mean) @ P.T, F)
        self.mean = V.T @ held @ V

    @np.errstate(invalid="ignore", over="ignore", divide="ignore")
    def factor(self, row: FloatArray, by: FloatArray) -> float:
        """Factor the system closed by a row (unknown + 1,); return the sign of its determinant, or 0.

        by (unknown,) is the derivative by the parameter.
        """
        h = np.asarray(self.receptance.harmonics)[:, None] * self.receptance.omega
        c = 1.0 / (self.square - h * h + 1j * h * self.rate)
        self.c_re, self.c_im = np.ascontiguousarray(c.real), np.ascontiguousarray(c.imag)
        count, parts, forces = self.receptance.count, self.parts, self.ports.size
        self.on_forces = np.ascontiguousarray(self.shapes[:, self.ports])
        which = self.ports // self.each
        contacts, number = np.unique(which, return_inverse=True)
        self.other_stiffness = contacts[:, None] * self.each + np.arange(self.each)
        self.number = number
        around = self.shapes[:, self.other_stiffness.ravel()]
        if self.solver.size != self.size:
            self.solver = Solver(self.size)
        M = np.zeros((forces, parts, parts, forces))
        mean = around.T @ (self.mean @ self.on_forces)
        mean = mean.reshape(contacts.size, self.each, forces)[number]
        M[:, :, 0, :] = self.D[:, :, 0] @ mean
        turned = np.empty((contacts.size, 2, self.each, 2, forces))
        for j in range(count):
            re = (around.T @ (self.c_re[j][:, None] * self.on_forces)).reshape(
                contacts.size, self.each, forces
            )
            im = (around.T @ (self.c_im[j][:, None] * self.on_forces)).reshape(
                contacts.size, self.each, forces
            )
            turned[:, 0, :, 0], turned[:, 0, :, 1] = re, -im
            turned[:, 1, :, 0], turned[:, 1, :, 1] = im, re
            columns = turned.reshape(contacts.size, 2 * self.each, 2 * forces)[number]
            of = self.D[:, :, 1 + 2 * j : 3 + 2 * j].reshape(forces, parts, 2 * self.each)
            M[:, :, 1 + 2 * j : 3 + 2 * j] = (of @ columns).reshape(forces, parts, 2, forces)
        matrix, size = np.asarray(self.solver.matrix), self.size - 1
        matrix[:size, :size] = M.transpose(1, 0, 2, 3).reshape(size, size)
        matrix[np.arange(size), np.arange(size)] += 1.0
        self.row = row
        self.by = self._with_springs(by[self.place])
        matrix[:size, size] = self._other_forces(self.by)
        across = row[:-1][self.place]
        matrix[size, :size] = -self._displaced(across, self.shapes, self.on_forces, -1.0).ravel()
        matrix[size, size] = row[-1] - np.vdot(across, self.by)
        return self.solver.orientation if self.solver.factor() else 0.0

    @np.errstate(invalid="ignore", over="ignore")
    def solve(self, right: FloatArray) -> FloatArray:
        """The solution for a right side (unknown + 1,)."""
        alone = self._with_springs(right[:-1][self.place])
        reduced = np.asarray(self.solver.right)
        reduced[:-1] = self._other_forces(alone)
        reduced[-1] = right[-1] - np.vdot(self.row[:-1][self.place], alone)
        self.solver.solve()
        y = reduced[:-1].reshape(self.parts, self.ports.size)
        found = np.empty_like(right)
        x = alone - self._displaced(y, self.on_forces, self.shapes) - reduced[-1] * self.by
        found[self.place], found[-1] = x, reduced[-1]
        return found

    def _with_springs(self, x: FloatArray) -> FloatArray:
        """S x: displacements x (part, port) with the springs acting against them."""
        force = x * self.K
        force[0] = x[0] * self.K_mean
        held: FloatArray = x - self._displaced(force, self.shapes, self.shapes)
        return held

    def _other_forces(self, x: FloatArray) -> FloatArray:
        """D x: forces (part force,) of displacements x (part, port) in addition to those of the springs."""
        around = x[:, self.other_stiffness].transpose(1, 0, 2)[self.number]  # (force, part, port)
        y = np.matmul(
            self.D.reshape(self.ports.size, self.parts, self.parts * self.each),
            around.reshape(self.ports.size, self.parts * self.each, 1),
        )
        return np.ascontiguousarray(y[:, :, 0].T).ravel()

    def _displaced(self, force: FloatArray, on: FloatArray, at: FloatArray, way: float = 1.0) -> FloatArray:
        """Displacements (part, port) at shapes `at` (mode, port) under forces at shapes `on`.

        With way -1, those of the transposed system.
        """
        q = force @ on.T
        answer = np.empty_like(q)
        answer[0] = self.mean @ q[0] if way > 0.0 else q[0] @ self.mean
        re, im, turn = q[1::2], q[2::2], way * self.c_im
        answer[1::2] = self.c_re * re - turn * im
        answer[2::2] = turn * re + self.c_re * im
        moved: FloatArray = answer @ at
        return moved
