r"""Changes that the harmonics beyond the reference would still make to one of its motions, without feedback.

Each harmonic is the coefficient of the exact forces times the receptance, as in `residual_spectrum`. All are
added to the motion, and change its half peak-to-peak displacement. If the frequency is far below some modes,
only harmonics higher than those of any balance meet these.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import PairOptions
from fcm.harmonic_balance.residual import Balance, PointQuantities
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray

ComplexArray = npt.NDArray[np.complex128]


def changes_left_out(system: System, balance: Balance, z: FloatArray, options: PairOptions) -> FloatArray:
    """Changes (dof,) of the amplitudes of a motion z (unknown + 1,) by the harmonics that a balance lacks.

    They are zero if no mode is met beyond its harmonics, and for a ring. With many modes and degrees of
    freedom, harmonics count only as far as the options allow.
    """
    last = _highest_harmonic(system, float(z[-1]), options)
    others = tuple(h for h in range(1, last + 1) if h not in system.harmonics)
    if not others or others[-1] < system.harmonics[-1]:
        return np.zeros(system.linear.dofs.shape[1])
    points = PointQuantities(balance, 1).evaluate(z[None], np.zeros((1, len(z))), np.ones(1))
    X = np.asarray(points.re)[0] + 1j * np.asarray(points.im)[0]
    top = max(last, system.harmonics[-1])
    spectrum = np.zeros((options.samples_per_period * top // 2 + 1, X.shape[1]), dtype=np.complex128)
    spectrum[list(system.harmonics)] = X
    without = np.ptp(np.fft.irfft(spectrum, axis=0), axis=0)
    spectrum[list(others)] = -_moved(system, z, others)
    changed = np.ptp(np.fft.irfft(spectrum, axis=0), axis=0) - without
    half: FloatArray = 0.5 * (len(spectrum) - 1) * changed
    return half


def _highest_harmonic(system: System, omega: float, options: PairOptions) -> int:
    """The highest harmonic whose force is evaluated; 0 for a ring or a structure without modes."""
    linear = system.linear
    if system.scene.ring is not None or not linear.natural.size:
        return 0
    each = linear.natural.size * (linear.ports.shape[1] + linear.dofs.shape[1])
    # a power of 2, the same for many frequencies, so that they share a kernel
    wide = 2.0 ** np.ceil(np.log2(max(options.residual_factor * linear.natural.max() / omega, 1.0)))
    return int(min(wide, options.max_residual_harmonic, options.max_products / each))


def _moved(system: System, z: FloatArray, others: tuple[int, ...]) -> ComplexArray:
    """Displacements (harmonic, dof) by the contact forces in harmonics that the balance leaves out."""
    motion, forces = np.ascontiguousarray(z), []
    for i, law in enumerate(system.exact_laws(others)):
        law.evaluate_forces(motion, i * law.width)
        forces.append(np.array(law.force))
    ports = system.layout_of(others).complex_ports(np.concatenate(forces))[:, 1:].T[None]
    found: ComplexArray = system.linear.displacements(np.array(others, dtype=np.float64), z[-1:], ports)[0]
    return found
