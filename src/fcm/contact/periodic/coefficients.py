"""Fourier coefficients of a contact's forces over any periodic motion, for arrays of motions."""

from __future__ import annotations

from typing import NamedTuple

import numpy.typing as npt

from fcm.contact.kernel_arguments import ComplexArray, KernelArguments
from fcm.contact.periodic.cycle import PeriodicContact


class PeriodicGradients(NamedTuple):
    """Coefficients of `periodic_forces` and their derivatives."""

    f: ComplexArray  # (..., harmonic)
    n: ComplexArray  # (..., harmonic)
    df: ComplexArray  # (..., harmonic, motion, harmonic of the motion, part)
    dn: ComplexArray  # the same axes as df


def periodic_forces(
    u: npt.ArrayLike,
    v: npt.ArrayLike,
    mu: npt.ArrayLike,
    k_u: npt.ArrayLike,
    k_v: npt.ArrayLike,
    n_0: npt.ArrayLike,
    *,
    harmonics: int | None = None,
    start: npt.ArrayLike = 0.0,
) -> tuple[ComplexArray, ComplexArray]:
    r"""Friction and normal force of a contact in periodic motion with any number of harmonics, exactly.

    With x(theta) = Re sum_h X_h exp(i h theta), and the slider w held between two moving limits,

        n = max(n_0 + k_v v, 0)
        f = k_u (u - w),   w = clip(w, u - mu n / k_u, u + mu n / k_u),   w = u while n = 0

    Parameters
    ----------
    u, v : array_like, complex, shape (..., harmonic)
        Coefficients of the tangential and normal displacement across the contact [length], the mean first;
        the imaginary part of the mean is ignored. The shorter array is padded with zeros.
    mu : array_like
        Friction coefficient [-], at least 0.
    k_u, k_v : array_like
        Tangential and normal contact stiffness [force / length], at least 0.
    n_0 : array_like
        Preload [force]; negative for a gap, n_0 = -k_v gap.
    harmonics : int, optional
        Greatest harmonic of the forces; by default that of the motion.
    start : array_like, optional
        Displacement u at which the contact began unstressed [length]. It matters only for a contact that
        never slips: its slider rests there, or as near as the slip limits permit.

    Returns
    -------
    f, n : complex128, shape (..., harmonic) [force]
        Coefficients of the friction force on the displacement u, and of the normal force, the mean first.
        All arguments broadcast, except along the harmonics. NaN where an argument is not finite.

    Raises
    ------
    ValueError
        If mu, k_u or k_v is negative, or a motion has no coefficients.

    Notes
    -----
    All events of the cycle are located, and none is missed, whatever the number of evaluations. Between them
    the forces are trigonometric polynomials, which are integrated in closed form. Compared with time marching
    in extended precision, the error is below 1e-14 of the greatest force, for 10 000 motions of 1 to 15
    harmonics that decay as h**-0.7 to h**-3. The error is greater if the normal load varies much more than
    the friction force, or if the contact closes for a small part of its normal motion. With one harmonic the
    result is that of `fourier_coefficients`. Source: Yang, Chu and Menq (1998), equations (1) to (7), for
    motions of several harmonics.

    Examples
    --------
    Constant normal load at half the slip limit, u = sin(theta): the classical stiffness and damping.

    >>> f, n = periodic_forces([0.0, -1j], [0.0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> complex(f[1].round(6)), n[0].real.item()
    ((0.31831-0.5j), 1.0)
    """
    numbers = {"mu": mu, "k_u": k_u, "k_v": k_v, "n_0": n_0, "start": start}
    motion = KernelArguments.of({"u": u, "v": v}, harmonics, numbers)
    kernel = PeriodicContact(motion.harmonics, motion.outputs)
    f, n = motion.coefficients(motion.evaluated(kernel, gradient=False)[0])
    return f, n


def periodic_gradients(
    u: npt.ArrayLike,
    v: npt.ArrayLike,
    mu: npt.ArrayLike,
    k_u: npt.ArrayLike,
    k_v: npt.ArrayLike,
    n_0: npt.ArrayLike,
    *,
    harmonics: int | None = None,
    start: npt.ArrayLike = 0.0,
) -> PeriodicGradients:
    """Coefficients of `periodic_forces` with their derivatives by all coefficients of u and v.

    Arguments and exceptions are those of `periodic_forces`.

    Returns
    -------
    PeriodicGradients
        f, n, and df, dn of shape (..., harmonic, 2, harmonic of the motion, 2): ``df[..., h, 1, k, 0]`` is
        the derivative of the h-th coefficient of f by the real part of the k-th of v. The last index is 1 for
        the imaginary part; that of a mean has the derivative 0.

    Notes
    -----
    Exact. Within rounding of the onset of slip or of separation, the derivative is the one-sided derivative
    without slip or separation.

    Examples
    --------
    >>> G = periodic_gradients([0.0, -1j], [0.0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> round(float(G.df[1, 1, 0, 0].imag), 6)  # stiffness F_s = -Im f_1, by v at constant load
    -0.63662
    """
    numbers = {"mu": mu, "k_u": k_u, "k_v": k_v, "n_0": n_0, "start": start}
    motion = KernelArguments.of({"u": u, "v": v}, harmonics, numbers)
    kernel = PeriodicContact(motion.harmonics, motion.outputs)
    forces, jacobian = motion.evaluated(kernel, gradient=True)
    return PeriodicGradients(*motion.coefficients(forces), *motion.derivatives(jacobian))
