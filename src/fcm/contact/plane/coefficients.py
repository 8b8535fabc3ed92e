"""Fourier coefficients of the forces of a contact that slides in a plane, for arrays of motions."""

from __future__ import annotations

from typing import NamedTuple

import numpy.typing as npt

from fcm.contact.kernel_arguments import ComplexArray, KernelArguments
from fcm.contact.plane.cycle import PlanarContact
from fcm.contact.plane.options import FINE


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

    With x(theta) = Re sum_h X_h exp(i h theta), vectors in the plane, and the slider w held within a moving
    disc,

        n = max(n_0 + k_v v, 0)
        f = k_u (u - w),   |f| <= mu n,   w' = lambda f / |f| with lambda >= 0, and 0 while |f| < mu n

    Parameters
    ----------
    u_x, u_y, v : array_like, complex, shape (..., harmonic)
        Coefficients of the two tangential and the normal displacement across the contact [length], the mean
        first; the imaginary part of the mean is ignored. Shorter arrays are padded with zeros.
    mu : array_like
        Friction coefficient [-], at least 0.
    k_u, k_v : array_like
        Tangential stiffness, the same in both directions, and normal stiffness [force / length], at least 0.
    n_0 : array_like
        Preload [force]; negative for a gap, n_0 = -k_v gap.
    harmonics : int, optional
        Greatest harmonic of the forces; by default that of the motion.
    start_x, start_y : array_like, optional
        Displacement at which the contact began unstressed [length]. It matters only for a contact that never
        slips: its slider rests there, or at the nearest place that all slip limits permit.

    Returns
    -------
    f_x, f_y, n : complex128, shape (..., harmonic) [force]
        Coefficients of the friction force on the displacement u, and of the normal force, the mean first. All
        arguments broadcast, except along the harmonics. NaN where an argument is not finite.

    Raises
    ------
    ValueError
        If mu, k_u or k_v is negative, or a motion has no coefficients.
    RuntimeError
        If no steady cycle is found.

    Notes
    -----
    In slip, f = mu n (cos alpha, sin alpha), and the direction obeys a Riccati equation,

        r alpha' = e_perp . u',   lambda = e . u' - r' >= 0,   r = mu n / k_u

    which is the linear equation y' = [[u_x', u_y'], [u_y', -u_x']] y / (2 r) of tan(alpha / 2) = y_2 / y_1.
    It is solved by collocation of order 15. Slips end where lambda vanishes, and sticks where |u - w| = r;
    all these events are located. If the contact never opens, Newton's method finds the place of the slider
    that repeats after a period. Compared with extrapolated time marching and with 30 digits, the error is
    below 1e-10 of k_u times the greatest coefficient. For motion along one line the result is that of
    `periodic_forces`.

    Examples
    --------
    A circle of radius 1 under constant load at half the slip limit: the force lags by 60 degrees.

    >>> f_x, f_y, n = planar_forces([0, 1], [0, -1j], [0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> complex(f_x[1].round(6)), complex(f_y[1].round(6))
    ((0.25+0.433013j), (0.433013-0.25j))
    """
    numbers = {"mu": mu, "k_u": k_u, "k_v": k_v, "n_0": n_0, "start_x": start_x, "start_y": start_y}
    motion = KernelArguments.of({"u_x": u_x, "u_y": u_y, "v": v}, harmonics, numbers)
    kernel = PlanarContact(motion.harmonics, motion.outputs, options=FINE)
    f_x, f_y, n = motion.coefficients(motion.evaluated(kernel, gradient=False)[0])
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

    Arguments and exceptions are those of `planar_forces`.

    Returns
    -------
    PlanarGradients
        f_x, f_y, n, and df_x, df_y, dn of shape (..., harmonic, 3, harmonic of the motion, 2):
        ``df_x[..., h, 2, k, 0]`` is the derivative of the h-th coefficient of f_x by the real part of the
        k-th of v. The last index is 1 for the imaginary part; that of a mean has the derivative 0.

    Notes
    -----
    The derivatives follow from the variational equation of the slip direction and from the memory of the
    slider. They differ from difference quotients by 1e-8 of the stiffness. Within rounding of the onset of
    slip or of opening, the derivative is the one-sided derivative without slip or opening.

    Examples
    --------
    >>> G = planar_gradients([0, 1], [0, -1j], [0], mu=0.5, k_u=1.0, k_v=1.0, n_0=1.0)
    >>> round(float(G.df_x[1, 2, 0, 0].real), 6)  # radial part of the force, r**2, by v at constant load
    0.5
    """
    numbers = {"mu": mu, "k_u": k_u, "k_v": k_v, "n_0": n_0, "start_x": start_x, "start_y": start_y}
    motion = KernelArguments.of({"u_x": u_x, "u_y": u_y, "v": v}, harmonics, numbers)
    kernel = PlanarContact(motion.harmonics, motion.outputs, options=FINE)
    forces, jacobian = motion.evaluated(kernel, gradient=True)
    return PlanarGradients(*motion.coefficients(forces), *motion.derivatives(jacobian))
