"""Convert motions and parameters of contacts to the arrays of kernels, and their results back."""

from __future__ import annotations

from collections.abc import Mapping
from math import prod
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact.contact_kernel import ContactKernel

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


class KernelArguments(NamedTuple):
    """Motions and parameters of contacts as arrays, with one row for each contact."""

    directions: int
    harmonics: list[int]  # of the motion
    outputs: list[int]  # harmonics of the forces
    shape: tuple[int, ...]  # to which the arguments broadcast
    unknowns: FloatArray  # (point, unknown)
    parameters: FloatArray  # (point, number): mu, k_u, k_v, n_0 and starts of sliders

    @classmethod
    def of(
        cls, motions: Mapping[str, npt.ArrayLike], harmonics: int | None, numbers: Mapping[str, npt.ArrayLike]
    ) -> KernelArguments:
        """Arguments from the motion along each direction, the normal last.

        The forces get as many harmonics as the motion unless `harmonics` is given.

        Raises
        ------
        ValueError
            If mu, k_u or k_v is negative, or a motion has no coefficients.
        """
        *first, last = motions
        found = [np.atleast_1d(np.asarray(one, np.complex128)) for one in motions.values()]
        if min(one.shape[-1] for one in found) < 1:
            raise ValueError(f"{', '.join(first)} and {last} have at least one coefficient, their mean")
        if harmonics is not None and harmonics < 0:
            raise ValueError(f"harmonics is {harmonics}, but it is a number of harmonics, at least 0")
        parameters = {name: np.asarray(value, np.float64) for name, value in numbers.items()}
        for name in ("mu", "k_u", "k_v"):
            if np.any(parameters[name] < 0.0):
                raise ValueError(f"{name} must not be negative")
        shape = np.broadcast_shapes(
            *(one.shape[:-1] for one in found), *(value.shape for value in parameters.values())
        )
        count, d = max(one.shape[-1] for one in found), len(found)
        x = np.zeros((*shape, count, 2 * d))
        for i, one in enumerate(found):
            x[..., : one.shape[-1], 2 * i] = one.real
            x[..., 1 : one.shape[-1], 2 * i + 1] = one.imag[..., 1:]
        x = x.reshape(prod(shape), 2 * d * count)
        unknowns = np.concatenate((x[:, 0 : 2 * d : 2], x[:, 2 * d :]), axis=1)
        columns = [np.broadcast_to(value, shape).reshape(-1) for value in parameters.values()]
        outputs = count - 1 if harmonics is None else harmonics
        return cls(
            d, list(range(1, count)), list(range(1, outputs + 1)), shape,
            np.ascontiguousarray(unknowns), np.ascontiguousarray(np.stack(columns, axis=-1)),
        )  # fmt: skip

    @classmethod
    def of_one(
        cls, motions: Mapping[str, npt.ArrayLike], numbers: Mapping[str, npt.ArrayLike]
    ) -> KernelArguments:
        """Arguments for one motion of one contact; ValueError if there are several, or one is not finite."""
        found = cls.of(motions, None, numbers)
        if found.shape:
            raise ValueError(f"one loop needs numbers and one motion, not arrays of shape {found.shape}")
        if not (np.isfinite(found.unknowns).all() and np.isfinite(found.parameters).all()):
            raise ValueError("all coefficients and parameters must be finite numbers")
        return found

    def evaluated(self, kernel: ContactKernel, gradient: bool) -> tuple[FloatArray, FloatArray]:
        """Forces (point, equation) and, if wanted, their derivatives (point, equation, unknown).

        Raises
        ------
        RuntimeError
            If no steady cycle is found.
        """
        count, unknowns = self.unknowns.shape
        forces = np.empty((count, kernel.equations))
        jacobian = np.empty((count if gradient else 0, kernel.equations, unknowns))
        unsolved = kernel.all(self.unknowns, self.parameters, forces, jacobian)
        if unsolved >= 0:
            raise RuntimeError(f"no steady cycle of the motion with number {unsolved} was found")
        return forces, jacobian

    def coefficients(self, forces: FloatArray) -> list[ComplexArray]:
        """Complex Fourier coefficients of each force, from a kernel's real numbers along axis 1."""
        d, count = self.directions, self.unknowns.shape[0]
        rest = forces[:, d:].reshape(count, forces.shape[1] // (2 * d), 2 * d, *forces.shape[2:])
        found = (
            np.concatenate(
                (forces[:, i : i + 1] + 0j, rest[:, :, 2 * i] + 1j * rest[:, :, 2 * i + 1]), axis=1
            )
            for i in range(d)
        )
        return [one.reshape(*self.shape, *one.shape[1:]) for one in found]

    def derivatives(self, jacobian: FloatArray) -> list[ComplexArray]:
        """Derivatives of the force coefficients; the last axis becomes motion, harmonic and part."""
        points, equations, unknowns = jacobian.shape
        d = self.directions
        means = np.zeros((points, equations, 1, 2 * d))
        means[:, :, 0, ::2] = jacobian[:, :, :d]
        rest = jacobian[:, :, d:].reshape(points, equations, unknowns // (2 * d), 2 * d)
        by = np.concatenate((means, rest), axis=2)
        return self.coefficients(by.reshape(points, equations, by.shape[2], d, 2).swapaxes(2, 3))
