r"""The linear system of a balance of many contacts on few modes, condensed to the modes.

The contacts' displacements answer to their forces through the modes only: the Jacobian of a balance is
1 + A B with A (unknown, rank), B (rank, unknown); rank is the number of modes times 1 + 2 harmonics. With
b the derivative by the parameter and a row that closes the system,

    [1 + A B   b  ] [x]   [r]            [1 + B A      B b     ] [y]   [B r      ]
    [row'      rho] [l] = [s]    is      [-row' A   rho - row' b] [l] = [s - row' r],   x = r - A y - b l,

of the same determinant, and no worse conditioned at a fold.
"""

from __future__ import annotations

import numpy as np

from fcm.scene.model import FloatArray
from fcm.structure.receptance import Receptance

FEWEST = 200  # unknowns from which on this is faster
SHARE = 0.7  # and of the number of ports, how many modes at most


def rank_of(modes: int, ports: int, harmonics: int) -> int:
    """Size of the condensed system; 0 where the system itself is to be solved."""
    few = modes < SHARE * ports and ports * (1 + 2 * harmonics) >= FEWEST
    return modes * (1 + 2 * harmonics) if few else 0


class Condensed:
    """A and B of a balance as it was evaluated last.

    Unknowns are sorted into parts (part, port): the mean, and real and imaginary part of each harmonic;
    those of the condensed system are (part, mode).
    """

    def __init__(self, seen: Receptance, flexibility: FloatArray, tangent: FloatArray) -> None:
        self.seen, self.tangent = seen, tangent
        self.flexibility = flexibility
        shapes = np.asarray(seen.shapes)
        self.shapes, self.ports, self.modes = shapes, shapes.shape[1], shapes.shape[0]
        self.parts, self.contacts = 1 + 2 * seen.count, self.ports // 2
        part = [np.arange(2), *(2 + 4 * j + i + np.array([0, 2]) for j in range(seen.count) for i in (0, 1))]
        self.order = np.concatenate(part)  # of the unknowns of a contact: part by part, u and v
        self.pairs = np.ascontiguousarray(shapes.T.reshape(self.contacts, 2, self.modes))
        width = 2 * self.parts
        at = np.arange(self.contacts)[None, :, None] * width + self.order.reshape(self.parts, 1, 2)
        self.place = at.reshape(self.parts, self.ports)  # of each part and port among the unknowns
        rank = self.parts * self.modes
        # forces on ports by modes (contact, part port part, mode), the same by part, and the modes' answer
        self.kept = (
            np.empty((self.contacts, 2 * self.parts**2, self.modes)),
            np.empty((self.parts, self.ports, rank)),
            np.empty((self.parts, self.modes, rank)),
        )
        self.ordered, self.b, self.r = tangent, np.empty((0, 0)), np.empty((0, 0))
        self.row, self.rho = self.b, 0.0

    def matrix(self, row: FloatArray, by: FloatArray, out: FloatArray) -> None:
        """Fill (rank + 1, rank + 1); row (unknown + 1,), by (unknown,) the derivative by the parameter."""
        parts, rank = self.parts, self.parts * self.modes
        self.b, self.row, self.rho = by[self.place], row[self.place], float(row[-1])
        self.ordered = self.tangent[:, self.order[:, None], self.order]
        by_mode, blocks, product = self.kept  # to have this much memory anew takes longer than to fill it
        np.matmul(self.ordered.reshape(self.contacts, -1, 2), self.pairs, out=by_mode)
        sorted_by_part = by_mode.reshape(self.contacts, parts, 2, rank).transpose(1, 0, 2, 3)
        blocks.reshape(parts, self.contacts, 2, rank)[:] = sorted_by_part
        self.answer(blocks, product)
        out[:rank, :rank] = product.reshape(rank, rank)
        out[np.arange(rank), np.arange(rank)] += 1.0
        out[:rank, rank] = self.image(self.b).ravel()
        out[rank, :rank] = -(self.row @ self.shapes.T).ravel()
        out[rank, rank] = self.rho - np.vdot(self.row, self.b)

    def shorten(self, right: FloatArray, out: FloatArray) -> None:
        """Right side (rank + 1,) of one (unknown + 1,)."""
        self.r = right[self.place]
        out[:-1] = self.image(self.r).ravel()
        out[-1] = right[-1] - np.vdot(self.row, self.r)

    def lengthen(self, short: FloatArray, out: FloatArray) -> None:
        """The solution (unknown + 1,) from that of the condensed system."""
        y = short[:-1].reshape(self.parts, self.modes)
        out[self.place] = self.r - y @ self.shapes - self.b * short[-1]
        out[-1] = short[-1]

    def image(self, x: FloatArray) -> FloatArray:
        """B x: what the modes answer to the forces' change, (part, mode)."""
        pairs = x.reshape(self.parts, self.contacts, 2).swapaxes(0, 1).reshape(self.contacts, -1, 1)
        force = (self.ordered @ pairs)[:, :, 0]
        blocks = force.reshape(self.contacts, self.parts, 2).swapaxes(0, 1)
        out = np.empty((self.parts, self.modes, 1))
        self.answer(blocks.reshape(self.parts, self.ports, 1), out)
        return out[:, :, 0]

    def answer(self, force: FloatArray, out: FloatArray) -> None:
        """Fill (part, mode, column) with what the modes answer to forces on the ports (part, port, column).

        One product for both parts of a harmonic: sums of whole arrays would take longer than it.
        """
        re, im = (np.asarray(c)[:, :, None] * self.shapes for c in (self.seen.c_re, self.seen.c_im))
        both = np.concatenate((np.concatenate((re, -im), 2), np.concatenate((im, re), 2)), 1)
        columns, count = out.shape[2], len(both)
        out[0] = self.flexibility @ (self.shapes @ force[0])
        np.matmul(both, force[1:].reshape(count, -1, columns), out=out[1:].reshape(count, -1, columns))
