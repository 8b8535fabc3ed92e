"""Fourier coefficients of the forces of a contact that slides in a plane, for arrays of motions."""

from __future__ import annotations

from math import prod
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact.plane.forces import PlanarContact
from fcm.contact.plane.options import FINE

ComplexArray = npt.NDArray[np.complex128]
FloatArray = npt.NDArray[np.float64]


class PlanarGradients(NamedTuple):
    """Coefficients of `planar_forces` with their derivatives."""

    f_x: ComplexArray  # (..., harmonic)
    f_y: ComplexArray
    n: ComplexArray
    df_x: ComplexArray  # (..., harmonic, motion, harmonic of the motion, part)
    df_y: ComplexArray
    dn: ComplexArray


def planar_forces(
    u_x: npt.ArrayLike,
    u_y: npt.ArrayLike,
    v: npt.ArrayLike,
    mu: npt.ArrayLike,
    k_u: npt.ArrayLike,
    k_v: npt.ArrayLike,
    n_0: npt.ArrayLike,
    *,
    harmonics: int | None = None,
    start_x: npt.ArrayLike = 0.0,
    start_y: npt.ArrayLike = 0.0,
) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    r"""Friction and normal force of a contact that slides in a plane, in periodic motion, exactly.

    With x(theta) = Re sum_h X_h exp(i h theta), vectors in the plane, and the slider w held in a moving disc,

        n = max(n_0 + k_v v, 0)
        f = k_u (u - w),   |f| <= mu n,   w' = lambda f / |f| with lambda >= 0, and 0 while |f| < mu n

    Parameters
    ----------
    u_x, u_y, v : array_like, complex, shape (..., harmonic)
        Coefficients of the two tangential and the normal displacement across the contact [length], the mean
        first; the imaginary part of the mean does not count. The shorter are taken as filled up with zeros.
    mu : array_like
        Friction coefficient [-], at least 0.
    k_u, k_v : array_like
        Tangential stiffness, the same in both directions, and normal stiffness [force / length], at least 0.
    n_0 : array_like
        Preload [force]; negative for a gap, n_0 = -k_v gap.
    harmonics : int, optional
        Greatest harmonic of the forces that is asked for; otherwise as many as the motion has.
    start_x, start_y : array_like, optional
        Displacement at which the contact began unstressed [length]. It matters only to a contact that never
        slips: its slider rests there, or at the nearest place that all slip limits allow.

    Returns
    -------
    f_x, f_y, n : complex128, shape (..., harmonic) [force]
        Coefficients of the friction force on the displacement u, and of the normal force, the mean first. All
        arguments but for their harmonics broadcast. NaN where an argument is not finite.

    Raises
    ------
    ValueError
        If mu, k_u or k_v is negative, or a motion has no coefficients.
    RuntimeError
        If no steady cycle is found.

    Notes
    -----
    While it slips, f = mu n (cos alpha, sin alpha), and the direction obeys a Riccati equation,

        r alpha' = e_perp . u',   lambda = e . u' - r' >= 0,   r = mu n / k_u

    which is the linear equation y' = [[u_x', u_y'], [u_y', -u_x']] y / (2 r) of tan(alpha / 2) = y_2 / y_1.
    It is solved by collocation of order 15, slips end where lambda vanishes and sticks where |u - w| = r, all
    located. What a contact that never opens remembers of the period before is found by Newton's method.
    Measured against extrapolated marches and in 30 digits: error below 1e-10 of k_u times the greatest
    coefficient; with motion along one line it is `periodic_forces`.

    Examples
    --------
    A circle of radius 1 under constant load at half the slip limit: the force lags by 60 degrees.

    >>> f_x, f_y, n = planar_forces([0, 1], [0, -1j], [0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> complex(f_x[1].round(6)), complex(f_y[1].round(6))
    ((0.25+0.433013j), (0.433013-0.25j))
    """
    motion = _Motion.of(
        u_x, u_y, v, harmonics, mu=mu, k_u=k_u, k_v=k_v, n_0=n_0, start_x=start_x, start_y=start_y
    )
    forces, _ = motion.evaluate(gradient=False)
    f_x, f_y, n = (part.reshape(*motion.shape, *part.shape[1:]) for part in _complex(forces))
    return f_x, f_y, n


def planar_gradients(
    u_x: npt.ArrayLike,
    u_y: npt.ArrayLike,
    v: npt.ArrayLike,
    mu: npt.ArrayLike,
    k_u: npt.ArrayLike,
    k_v: npt.ArrayLike,
    n_0: npt.ArrayLike,
    *,
    harmonics: int | None = None,
    start_x: npt.ArrayLike = 0.0,
    start_y: npt.ArrayLike = 0.0,
) -> PlanarGradients:
    """Coefficients of `planar_forces` with their derivatives by all coefficients of u_x, u_y and v.

    Arguments and errors are those of `planar_forces`.

    Returns
    -------
    PlanarGradients
        f_x, f_y, n, and df_x, df_y, dn of shape (..., harmonic, 3, harmonic of the motion, 2):
        ``df_x[..., h, 2, k, 0]`` is the derivative of the h-th coefficient of f_x by the real part of the
        k-th of v; the last index is 1 for the imaginary part. That of a mean is 0.

    Notes
    -----
    By the variational equation of the slip direction, and through all that the slider remembers; measured
    against differences, 1e-8 of the stiffness. Where the contact just does not slip, or does not open, within
    rounding, a derivative is that of the side on which it does not.

    Examples
    --------
    >>> G = planar_gradients([0, 1], [0, -1j], [0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> round(float(G.df_x[1, 2, 0, 0].real), 6)  # radial part of the force, r**2, by v at constant load
    0.5
    """
    motion = _Motion.of(
        u_x, u_y, v, harmonics, mu=mu, k_u=k_u, k_v=k_v, n_0=n_0, start_x=start_x, start_y=start_y
    )
    forces, jacobian = motion.evaluate(gradient=True)
    slopes = (part.reshape(*motion.shape, *part.shape[1:]) for part in _complex(_by_coefficients(jacobian)))
    values = (part.reshape(*motion.shape, *part.shape[1:]) for part in _complex(forces))
    return PlanarGradients(*values, *slopes)


def one_motion(
    u_x: npt.ArrayLike, u_y: npt.ArrayLike, v: npt.ArrayLike, **numbers: float
) -> tuple[list[int], FloatArray, FloatArray]:
    """The harmonics of one motion, its unknowns and its parameters, as the kernel takes them."""
    motion = _Motion.of(u_x, u_y, v, None, **numbers)
    if motion.shape:
        raise ValueError(f"one loop needs numbers and one motion, not arrays of shape {motion.shape}")
    return list(range(1, motion.harmonics)), motion.unknowns[0], motion.parameters[0]


class _Motion(NamedTuple):
    """Arguments as the kernel takes them: a row for each contact."""

    harmonics: int  # with the mean
    outputs: int
    shape: tuple[int, ...]  # to which the arguments broadcast
    unknowns: FloatArray  # (point, unknown)
    parameters: FloatArray  # (point, 6): mu, k_u, k_v, n_0, start_x, start_y

    @classmethod
    def of(
        cls,
        u_x: npt.ArrayLike,
        u_y: npt.ArrayLike,
        v: npt.ArrayLike,
        harmonics: int | None,
        **numbers: npt.ArrayLike,
    ) -> _Motion:
        motions = [np.atleast_1d(np.asarray(one, np.complex128)) for one in (u_x, u_y, v)]
        if min(one.shape[-1] for one in motions) < 1:
            raise ValueError("u_x, u_y and v have at least one coefficient, their mean")
        if harmonics is not None and harmonics < 0:
            raise ValueError(f"harmonics is {harmonics}, but it is a number of harmonics, at least 0")
        parameters = {name: np.asarray(value, np.float64) for name, value in numbers.items()}
        for name in ("mu", "k_u", "k_v"):
            if np.any(parameters[name] < 0.0):
                raise ValueError(f"{name} must not be negative")
        shape = np.broadcast_shapes(
            *(one.shape[:-1] for one in motions), *(value.shape for value in parameters.values())
        )
        count = max(one.shape[-1] for one in motions)
        x = np.zeros((*shape, count, 6))
        for i, one in enumerate(motions):
            x[..., : one.shape[-1], 2 * i] = one.real
            x[..., 1 : one.shape[-1], 2 * i + 1] = one.imag[..., 1:]
        x = x.reshape(prod(shape), 6 * count)
        columns = [np.broadcast_to(value, shape).reshape(-1) for value in parameters.values()]
        unknowns = np.concatenate((x[:, 0:6:2], x[:, 6:]), axis=1)
        return cls(
            count, count - 1 if harmonics is None else harmonics, shape,
            np.ascontiguousarray(unknowns), np.ascontiguousarray(np.stack(columns, axis=-1)),
        )  # fmt: skip

    def evaluate(self, gradient: bool) -> tuple[FloatArray, FloatArray]:
        """Forces (point, equation), and if wanted their derivatives (point, equation, unknown)."""
        contact = PlanarContact(
            list(range(1, self.harmonics)), list(range(1, self.outputs + 1)), options=FINE
        )
        count = self.unknowns.shape[0]
        forces = np.empty((count, contact.equations))
        jacobian = np.empty((count if gradient else 0, contact.equations, contact.unknowns))
        unsolved = contact.all(self.unknowns, self.parameters, forces, jacobian)
        if unsolved >= 0:
            raise RuntimeError(f"no steady cycle of the motion with number {unsolved} was found")
        return forces, jacobian


def _complex(forces: FloatArray) -> list[ComplexArray]:
    """The coefficients of the three forces from the order of the kernel, along axis 1."""
    rest = forces[:, 3:].reshape(forces.shape[0], forces.shape[1] // 6, 6, *forces.shape[2:])
    return [
        np.concatenate((forces[:, i : i + 1] + 0j, rest[:, :, 2 * i] + 1j * rest[:, :, 2 * i + 1]), axis=1)
        for i in range(3)
    ]


def _by_coefficients(jacobian: FloatArray) -> FloatArray:
    """Derivatives by motion, harmonic and part, in three axes instead of the last."""
    points, equations, unknowns = jacobian.shape
    means = np.zeros((points, equations, 1, 6))
    means[:, :, 0, ::2] = jacobian[:, :, :3]
    rest = jacobian[:, :, 3:].reshape(points, equations, unknowns // 6, 6)
    by = np.concatenate((means, rest), axis=2)
    return by.reshape(points, equations, by.shape[2], 3, 2).swapaxes(2, 3)
