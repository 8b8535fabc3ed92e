"""Indices of the contacts' displacements, and of the forces along them, among the unknowns of a balance.

For each contact in turn: the means of its displacements along each of its directions, then for each harmonic
the real and imaginary part of each displacement:

    x_0, y_0, ..., Re X_1, Im X_1, Re Y_1, Im Y_1, ..., Re X_2, ...
    x = x_0 + Re sum_j X_j exp(i h_j theta)

The last direction of a contact is its normal. A port is a direction of a contact; ports are numbered
consecutively over all contacts.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

IntArray = npt.NDArray[np.intp]
FloatArray = npt.NDArray[np.float64]


class Layout(Frozen):
    """Layout of the unknowns of contacts, with a number of directions each and a number of harmonics.

    >>> Layout(2, 2, 1).mean_at.tolist(), Layout(2, 2, 1).wave_at.tolist()
    ([0, 1, 6, 7], [2, 4, 8, 10])
    """

    contacts: int
    directions: int
    harmonics: int

    @property
    def ports(self) -> int:
        """Number of directions of all contacts together."""
        return self.contacts * self.directions

    @property
    def width(self) -> int:
        """Number of unknowns of one contact."""
        return self.directions * (1 + 2 * self.harmonics)

    @property
    def unknowns(self) -> int:
        """Number of unknowns of all contacts."""
        return self.contacts * self.width

    @property
    def stride(self) -> int:
        """Number of unknowns of one contact in one harmonic."""
        return 2 * self.directions

    @cached_property
    def mean_at(self) -> IntArray:
        """Index (port,) of the mean of each port."""
        port = np.arange(self.ports)
        return (port // max(self.directions, 1)) * self.width + port % max(self.directions, 1)

    @cached_property
    def wave_at(self) -> IntArray:
        """Index (port,) of the real part of each port's first harmonic."""
        port = np.arange(self.ports)
        along = port % max(self.directions, 1)
        return (port // max(self.directions, 1)) * self.width + self.directions + 2 * along

    @cached_property
    def waves_at(self) -> IntArray:
        """Index (harmonic, port) of the real part of each port's amplitude at every harmonic."""
        return self.wave_at + self.stride * np.arange(self.harmonics)[:, None]

    @cached_property
    def of_normal(self) -> npt.NDArray[np.bool_]:
        """Mask (width,) of a contact's unknowns that belong to its normal displacement."""
        return self.along(self.directions - 1)

    def along(self, direction: int) -> npt.NDArray[np.bool_]:
        """Mask (width,) of a contact's unknowns that belong to its displacement along a direction."""
        means = np.arange(self.directions) == direction
        found: npt.NDArray[np.bool_] = np.concatenate((means, np.tile(np.repeat(means, 2), self.harmonics)))
        return found

    @cached_property
    def places(self) -> tuple[IntArray, ...]:
        """Indices of a contact's unknowns along each direction, each (1 + 2 harmonic,)."""
        return tuple(np.flatnonzero(self.along(direction)) for direction in range(self.directions))

    def harmonic_of(self, harmonics: Sequence[int]) -> IntArray:
        """Harmonic (width,) to which each unknown of a contact belongs, 0 for the means."""
        each = [self.directions, *[self.stride] * self.harmonics]
        return np.repeat([0, *harmonics], each).astype(np.intp)

    def blocks(self, x: FloatArray) -> FloatArray:
        """Unknowns (..., unknown or more) grouped by contact: (..., contact, width)."""
        return x[..., : self.unknowns].reshape(*x.shape[:-1], self.contacts, self.width)

    def complex_ports(self, x: FloatArray) -> npt.NDArray[np.complex128]:
        """Unknowns (unknown or more,) as complex numbers by port: mean, amplitudes (port, 1 + harmonic)."""
        waves = x[self.waves_at] + 1j * x[self.waves_at + 1]
        return np.concatenate((x[self.mean_at][:, None], waves.T), axis=1)

    def flat(self, ports: npt.NDArray[np.complex128]) -> FloatArray:
        """Unknowns (unknown,) from complex numbers (port, 1 + harmonic); inverse of `complex_ports`."""
        x = np.empty(self.unknowns)
        x[self.mean_at] = ports[:, 0].real
        x[self.waves_at], x[self.waves_at + 1] = ports[:, 1:].T.real, ports[:, 1:].T.imag
        return x

    def with_harmonics(self, x: FloatArray, old: Sequence[int], new: Sequence[int]) -> FloatArray:
        """Unknowns (..., unknown + any) converted to other harmonics.

        Amplitudes of new harmonics are zero; the entries after the unknowns follow unchanged.
        """
        wide, to, of = _between(self, tuple(old), tuple(new))
        made = np.zeros((*x.shape[:-1], wide + x.shape[-1] - self.unknowns))
        made[..., to], made[..., wide:] = x[..., of], x[..., self.unknowns :]
        return made


@lru_cache(maxsize=256)
def layout_of(contacts: int, directions: int, harmonics: int) -> Layout:
    """The `Layout` for these numbers, cached."""
    return Layout(contacts, directions, harmonics)


@lru_cache(maxsize=256)
def _between(layout: Layout, old: tuple[int, ...], new: tuple[int, ...]) -> tuple[int, IntArray, IntArray]:
    """Number of unknowns with the new harmonics; indices of the shared harmonics in new and old unknowns."""
    wide = layout_of(layout.contacts, layout.directions, len(new))
    both = [h for h in (0, *old) if h == 0 or h in new]
    to, of = (
        (
            np.arange(one.contacts)[:, None] * one.width + np.flatnonzero(np.isin(one.harmonic_of(has), both))
        ).ravel()
        for one, has in ((wide, new), (layout, old))
    )
    return wide.unknowns, to, of
