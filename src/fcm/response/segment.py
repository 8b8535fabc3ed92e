"""The curve between two neighbouring points: interpolated, and corrected on the way."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.balance import Balance
from fcm.response.newton import Newton, amplitudes, correct, scales
from fcm.response.structure import IntArray

EXACT = 1e-13  # estimated error of a corrected point, relative
NEAR = 1e-6  # how near a guess is taken to be: a first step above sqrt(EXACT NEAR) is not the last
ITERATIONS = 12
ALONG = 0.3  # cosine to the chord below which an end's direction belongs to a corner and is not used


def correct_exactly(exact: Balance, guess: FloatArray, scale: FloatArray, row: FloatArray) -> Newton:
    """To rounding; with stiff contacts the direction, too, needs a Jacobian taken at the solution."""
    return correct(exact, guess, scale, row, EXACT, ITERATIONS, reach=NEAR)


@dataclass
class Segments:
    """Pieces of curves between neighbouring points; z and directions (segment, unknown + 1)."""

    curve: IntArray
    start: FloatArray
    end: FloatArray
    direction_start: FloatArray
    direction_end: FloatArray
    extent: FloatArray  # (segment,) of the frequency range

    def __post_init__(self) -> None:
        size = amplitudes(self.end[:, :-1])
        self.scale = scales(self.start[:, :-1], size, self.extent)
        self.chord = self.end - self.start
        row = self.chord / self.scale
        self.length = np.sqrt((row * row).sum(axis=1))  # in units of the curve's size
        self.row = row / np.where(self.length > 0.0, self.length, 1.0)[:, None]
        self.slopes = self._slope(self.direction_start), self._slope(self.direction_end)

    def take(self, index: IntArray) -> Segments:
        """Some of the segments, in the order of the index."""
        return Segments(*(getattr(self, f.name)[index] for f in fields(self)))

    def _slope(self, direction: FloatArray) -> FloatArray:
        """An end's direction per share of the chord; the chord itself at a corner."""
        scaled = direction / self.scale
        along = (scaled * self.row).sum(axis=1)
        usable = along > ALONG * np.sqrt((scaled * scaled).sum(axis=1))
        factor = self.length / np.where(usable, along, 1.0)
        return np.where(usable[:, None], direction * factor[:, None], self.chord)

    def points(self, exact: Balance, share: FloatArray) -> Newton:
        """Points at a share (segment,) of each chord: cubic interpolation, corrected across the chord."""
        s = share[:, None]
        first, last = self.slopes
        guess = self.start + s * s * (3.0 - 2.0 * s) * self.chord
        guess += s * (1.0 - s) * ((1.0 - s) * first - s * last)
        new = correct_exactly(exact.take(self.curve), guess, self.scale, self.row)
        away = np.sqrt((((new.z - guess) / self.scale) ** 2).sum(axis=1))
        new.converged &= away < self.length  # a solution further off is of another part of the curve
        new.converged &= new.z[:, -1] > 0.0
        new.tangent = self.scale * new.tangent
        return new
