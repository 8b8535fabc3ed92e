"""Fourier coefficients of the friction force, equation (27), and their derivatives, in closed form."""

from __future__ import annotations

import numpy.typing as npt

from fcm.contact.closed_form import ClosedForm
from fcm.contact.limits import FloatArray


def fourier_coefficients(
    n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
) -> tuple[FloatArray, FloatArray, FloatArray]:
    r"""Mean, sine and cosine coefficient of the friction force over a cycle, in closed form.

    For u = a sin(theta), v = b sin(theta + phi), equation (27):

        f(theta) ~ k_u a (F_b + F_s sin(theta) + F_c cos(theta))

    F_s is the equivalent stiffness, F_c >= 0 the equivalent damping.

    Parameters
    ----------
    n0_bar : array_like
        Preload mu n_0 / (k_u a) [-], any real number; negative for a gap.
    b_bar : array_like
        Normal load variation mu k_v b / (k_u a) [-], at least 0.
    phi : array_like
        Phase of v before u [rad], any real number.

    Returns
    -------
    F_b, F_s, F_c : float64, the shape to which the arguments broadcast [-]
        Where an argument is NaN, all three are NaN.

    Raises
    ------
    ValueError
        If an element of b_bar is negative.

    Notes
    -----
    Absolute error below 1e-12 for b_bar up to 1e3, below 1e-7 up to 1e300, boundary cases included. The
    worst of 400 000 random and boundary points, against fifty digits, was 9e-16. Where n0_bar and b_bar are
    small, as those of a stiff contact, the error is small against the force as well. It is below 1e-12 of the
    greatest coefficient for loads from 1e-10 on.
    A contact that never slips carries the mean force nearest to zero, F_b = clip(0, ell_2 - n0_bar,
    n0_bar - ell_1). Source: Yang, Chu and Menq (1998), sections 3.4, 4.1 and appendix.

    Examples
    --------
    Constant normal load (b_bar = 0) at half the slip limit, the classical stiffness and damping:

    >>> F_b, F_s, F_c = fourier_coefficients(0.5, 0.0, 0.0)
    >>> print(f"{F_b:.3f} {F_s:.3f} {F_c:.6f}")
    0.000 0.500 0.318310
    """
    F_b, F_s, F_c = ClosedForm().many(n0_bar, b_bar, phi, False)
    return F_b, F_s, F_c


def fourier_gradients(
    n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    r"""Coefficients of `fourier_coefficients` with their analytic derivatives.

    Returns
    -------
    F : ndarray, shape (3, ...)
        F_b, F_s, F_c [-].
    dF : ndarray, shape (3, 3, ...)
        ``dF[i, j]`` is the derivative of F[i] by (n0_bar, b_bar, phi)[j]. It is finite everywhere. On a
        boundary between sequences where a derivative jumps, it is the one-sided derivative of one side.

    Notes
    -----
    The force is continuous in theta, so the derivative of the integral is the integral of the derivative: of
    +-(dn/dx) in slip, and in stick of the constant value from the beginning of the stick.

    Examples
    --------
    >>> F, dF = fourier_gradients(0.5, 0.0, 0.0)
    >>> round(float(dF[1, 0]), 6)  # 4 sqrt(n0 (1 - n0)) / pi
    1.27324
    """
    numbers = ClosedForm().many(n0_bar, b_bar, phi, True)
    return numbers[:3], numbers[3:].reshape(3, 3, *numbers.shape[1:])
