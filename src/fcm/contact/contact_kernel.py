"""Kernel: what contacts on a line and in a plane have in common."""

from __future__ import annotations

import cython


@cython.cclass
class ContactParameters:
    """Parameters of a contact: mu [-], k_u, k_v [force / length], preload n_0 [force].

    start_x, start_y: the tangential displacement at which it began unstressed [length], usually 0. The slider
    of a contact that never slips rests there, or as near as the slip limits allow. On a line start_y is 0.
    """

    def __init__(
        self,
        mu: float = 0.0,
        k_u: float = 0.0,
        k_v: float = 0.0,
        n_0: float = 0.0,
        start_x: float = 0.0,
        start_y: float = 0.0,
    ) -> None:
        self.mu, self.k_u, self.k_v, self.n_0 = mu, k_u, k_v, n_0
        self.start_x, self.start_y = start_x, start_y

    def take_row(self, table: cython.double[:, ::1], i: cython.Py_ssize_t) -> None:
        """Takes row i of (contact, 4 to 6): mu, k_u, k_v, n_0, start_x, start_y; those left out are 0."""
        self.mu, self.k_u = float(table[i, 0]), float(table[i, 1])
        self.k_v, self.n_0 = float(table[i, 2]), float(table[i, 3])
        self.start_x = float(table[i, 4]) if table.shape[1] > 4 else 0.0
        self.start_y = float(table[i, 5]) if table.shape[1] > 5 else 0.0

    def take(self, other: ContactParameters) -> None:
        """Takes the parameters of another contact."""
        self.mu, self.k_u, self.k_v, self.n_0 = other.mu, other.k_u, other.k_v, other.n_0
        self.start_x, self.start_y = other.start_x, other.start_y

    def equals(self, other: ContactParameters) -> bool:
        """Whether all parameters are those of another contact."""
        if not (self.mu == other.mu and self.k_u == other.k_u and self.k_v == other.k_v):
            return False
        return self.n_0 == other.n_0 and self.start_x == other.start_x and self.start_y == other.start_y
