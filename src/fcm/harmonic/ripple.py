r"""What harmonics beyond all that are looked at would do to an amplitude, far below some modes.

There modes are met by so high harmonics that a balance has none of them. Without feedback each is the
coefficient of the exact forces times the receptance, as in `further`; all of them together are added to the
motion, whose half peak-to-peak displacement then differs.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.periodic.workspace import periodic_contact
from fcm.harmonic.further import HIGHEST, highest
from fcm.harmonic.system import System
from fcm.scene.model import FloatArray

ComplexArray = npt.NDArray[np.complex128]

PAST = 1.5  # times the harmonic that meets the highest mode: what is beyond it hardly moves
FARTHEST = 1024  # harmonic that is looked at here
EFFORT = 10_000_000  # multiplications, some hundredth of a second: as many harmonics as these allow
SAMPLES = 8  # of the period of the highest harmonic
NO_GRADIENT = np.empty((0, 0, 0))


def ripple(system: System, z: FloatArray, X: ComplexArray) -> FloatArray:
    """By how much (dof,) the amplitudes of a motion z (unknown + 1,) change by what is beyond the `highest`.

    X (harmonic, dof) are the displacements of the harmonics of the balance. Zero where no mode is met there.
    Of a ring nothing is looked at, and of many modes and degrees of freedom only as far as `EFFORT` allows.
    """
    last = _reach(system, z[-1])
    others = tuple(range(highest(system) + 1, last + 1))
    if not others:
        return np.zeros(X.shape[1])
    spectrum = np.zeros((SAMPLES * last // 2 + 1, X.shape[1]), dtype=np.complex128)
    spectrum[list(system.harmonics)] = X
    without = np.ptp(np.fft.irfft(spectrum, axis=0), axis=0)
    spectrum[others[0] : last + 1] = -_moved(system, z, others)
    changed = np.ptp(np.fft.irfft(spectrum, axis=0), axis=0) - without
    half: FloatArray = 0.5 * (len(spectrum) - 1) * changed
    return half


def _reach(system: System, omega: float) -> int:
    """The last harmonic that is looked at."""
    linear = system.linear
    if system.scene.ring is not None or not linear.natural.size:
        return 0
    met = PAST * linear.natural.max() / omega
    if met <= HIGHEST:
        return 0
    each = linear.natural.size * (linear.ports.shape[1] + linear.dofs.shape[1])
    wide = 2.0 ** np.ceil(np.log2(met))  # the same for many frequencies, so that they share a kernel
    return int(min(wide, FARTHEST, HIGHEST + EFFORT / each))


def _moved(system: System, z: FloatArray, others: tuple[int, ...]) -> ComplexArray:
    """What the forces of other harmonics displace (harmonic, dof)."""
    contacts = system.scene.contacts
    laws = np.array([(c.mu, c.k_u, c.k_v, c.n_0, 0.0) for c in contacts])
    force = np.empty((len(contacts), 2 + 4 * len(others)))
    kernel = periodic_contact(system.harmonics, others)
    kernel.all(np.ascontiguousarray(z[:-1]).reshape(len(contacts), -1), laws, force, NO_GRADIENT)
    F = force[:, 2:].reshape(len(contacts), len(others), 2, 2)
    ports = (F[..., 0] + 1j * F[..., 1]).transpose(1, 0, 2).reshape(1, len(others), -1)
    found: ComplexArray = system.linear.displacements(np.array(others, dtype=np.float64), z[-1:], ports)[0]
    return found
