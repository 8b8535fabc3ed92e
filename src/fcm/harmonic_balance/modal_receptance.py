"""What the structure answers to forces of many contacts, by way of its modes: no array of ports by ports."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray
from fcm.structure.receptance import Receptance


class ModalAnswer:
    """Of a receptance at the frequency that it was put to last; forces are laid out as unknowns.

    flexibility (mode, mode): displacements under mean forces. place (part, port): where the mean and the real
    and imaginary part of each harmonic of a port are among the unknowns.
    """

    def __init__(self, seen: Receptance, flexibility: FloatArray) -> None:
        self.seen, self.flexibility, self.shapes = seen, flexibility, np.asarray(seen.shapes)
        diagonal = flexibility.diagonal()
        self.diagonal = None if np.any(flexibility != np.diag(diagonal)) else diagonal[:, None]
        mean, wave = np.asarray(seen.mean_at), np.asarray(seen.wave_at)
        rows = [wave + seen.stride * j + i for j in range(seen.count) for i in (0, 1)]
        self.place = np.array([mean, *rows])

    @np.errstate(invalid="ignore", over="ignore")  # where Newton's method has gone astray
    def to(self, force: FloatArray) -> FloatArray:
        """The displacements (unknown, ...) that forces (unknown, ...) take away."""
        q = self._on_modes(force)
        answer = np.empty_like(q)
        mean = q[0]
        answer[0] = self.flexibility @ mean if self.diagonal is None else self.diagonal * mean
        self._turn(np.asarray(self.seen.c_re), np.asarray(self.seen.c_im), q, answer)
        return self._on_ports(answer, force)

    @np.errstate(invalid="ignore", over="ignore")
    def rate(self, force: FloatArray) -> FloatArray:
        """Their derivatives by the frequency; the means have none."""
        q = self._on_modes(force)
        answer = np.zeros_like(q)
        self._turn(np.asarray(self.seen.s_re), np.asarray(self.seen.s_im), q, answer)
        return self._on_ports(answer, force)

    def _on_modes(self, force: FloatArray) -> FloatArray:
        """Forces (part, mode, column) on the modes."""
        return self.shapes @ force[self.place].reshape(*self.place.shape, -1)  # type: ignore[no-any-return]

    def _turn(self, re: FloatArray, im: FloatArray, q: FloatArray, out: FloatArray) -> None:
        """Fill the harmonics of out with what modes of compliances (harmonic, mode) answer to forces q."""
        a, b = re[:, :, None], im[:, :, None]
        out[1::2] = a * q[1::2] - b * q[2::2]
        out[2::2] = b * q[1::2] + a * q[2::2]

    def _on_ports(self, answer: FloatArray, like: FloatArray) -> FloatArray:
        out = np.empty_like(like)
        out[self.place] = (self.shapes.T @ answer).reshape(*self.place.shape, *like.shape[1:])
        return out
