"""Dense arrays of a balance: its full Jacobian, and the response of the structure to contact forces."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.harmonic_balance.options import HARMONIC_BALANCE, ExtremeOptions
from fcm.harmonic_balance.residual import Balance
from fcm.model.scene import FloatArray

ComplexArray = npt.NDArray[np.complex128]


def jacobian_of(balance: Balance) -> FloatArray:
    """The Jacobian (unknown, unknown + 1) at the last evaluation of a balance, condensed or not."""
    if not balance.rank:
        return np.array(balance.jacobian)
    tangent, n, w = np.asarray(balance.tangent), balance.unknowns, balance.width
    found = np.empty((n, n + 1))
    for c in range(balance.contacts):
        columns = np.zeros((n, w))
        columns[c * w : (c + 1) * w] = tangent[c]
        found[:, c * w : (c + 1) * w] = apply_compliance(balance, columns)
    found[range(n), range(n)] += 1.0
    found[:, n] = np.asarray(balance.jacobian)[:, 0]
    return found


def apply_compliance(balance: Balance, force: FloatArray) -> FloatArray:
    """G F: minus the displacements (unknown, ...) that the contact forces (unknown, ...) cause."""
    receptance, (mean, first) = balance.receptance, unknown_positions(balance)
    if balance.condensed is not None:
        columns = np.ascontiguousarray(force.reshape(len(force), -1).T)
        found = np.empty_like(columns)
        for column, moved in zip(columns, found, strict=True):
            balance.condensed.answer.displace(column, moved)
        return found.T.reshape(force.shape)
    out = np.empty_like(force)
    out[mean] = np.asarray(receptance.static) @ force[mean]
    G = np.asarray(receptance.G_re) + 1j * np.asarray(receptance.G_im)
    F = force[first] + 1j * force[first + 1]
    x = (G @ F.reshape(*first.shape, -1)).reshape(F.shape)
    out[first], out[first + 1] = x.real, x.imag
    return out


def unknown_positions(balance: Balance) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Indices of the mean (port,) and of the real part of each harmonic (harmonic, port) in the unknowns."""
    return balance.layout.mean_at, balance.layout.waves_at


class Amplitude:
    """Half the peak-to-peak displacement of a degree of freedom, with its derivatives.

    It changes by Re sum_h W_h dX_h with the amplitudes X_h of the displacement. W_h is half the difference of
    exp(i h theta) at the greatest and at the least displacement.
    """

    def __init__(
        self, balance: Balance, dof: int, options: ExtremeOptions = HARMONIC_BALANCE.extremes
    ) -> None:
        self.balance, self.dof, self.options = balance, dof, options
        self.value, self.slopes = 0.0, np.zeros(balance.unknowns + 1)
        self.weights = np.zeros(balance.receptance.count, dtype=np.complex128)
        self.angles = np.zeros(2)  # of the extremes, if there are several harmonics
        self.of_forces = np.zeros(balance.unknowns)  # its slopes by the contacts' forces

    def at(self, z: FloatArray, near: FloatArray | None = None) -> None:
        """Compute value and slopes at z (unknown + 1,), where the balance was evaluated last.

        near (2,) gives angles [rad]: then the extremes next to them count, even if others are greater. The
        value is NaN if there are no such extremes.
        """
        balance, d, n = self.balance, self.dof, self.balance.unknowns
        direction = np.zeros(n + 1)
        direction[-1] = 1.0
        balance.evaluate_outputs(z, direction)
        self.value, self.slopes[n] = balance.output[d], balance.growth[d]
        displacements, receptance, rows = (
            balance.displacements,
            balance.receptance,
            unknown_positions(balance)[1],
        )
        X = np.asarray(displacements.re)[:, d] + 1j * np.asarray(displacements.im)[:, d]
        h, self.angles = np.asarray(receptance.harmonics), np.array(displacements.angles)[:, d]
        if near is not None and h.size > 1:
            self.angles = _extremes(X, h, near, self.options)
            if np.isnan(self.angles).any():
                self.value = np.nan
                return
        self.weights = W = _weights(X, h, self.angles)
        if near is not None and h.size > 1:
            by_omega = np.asarray(displacements.d_re)[:, d] + 1j * np.asarray(displacements.d_im)[:, d]
            self.value, self.slopes[n] = float((W @ X).real), (W @ by_omega).real
        if not balance.contacts:
            return
        if not displacements.without_modes[d]:  # a combination of the contacts' displacements
            of_ports = W[:, None] * np.asarray(displacements.attached)[:, d]
            self.slopes[rows], self.slopes[rows + 1] = of_ports.real, -of_ports.imag
            return
        c = np.asarray(receptance.c_re) + 1j * np.asarray(receptance.c_im)
        of_ports = -W[:, None] * (
            (c * np.asarray(displacements.shapes)[:, d]) @ np.asarray(receptance.shapes)
        )
        self.of_forces[rows], self.of_forces[rows + 1] = of_ports.real, -of_ports.imag
        blocks = self.of_forces.reshape(balance.contacts, 1, -1) @ np.asarray(balance.tangent)
        self.slopes[:n] = blocks.ravel()


def _weights(X: ComplexArray, harmonics: FloatArray, angles: FloatArray) -> ComplexArray:
    """W (harmonic,) of a displacement X (harmonic,) whose greatest and least values are at angles (2,)."""
    if harmonics.size == 1:
        size = np.abs(X)
        return np.asarray(np.conj(X) / np.where(size > 0.0, size, 1.0), dtype=np.complex128)
    ends = np.exp(1j * harmonics[:, None] * angles)
    return 0.5 * (ends[:, 0] - ends[:, 1])  # type: ignore[no-any-return]


def _extremes(
    X: ComplexArray, harmonics: FloatArray, near: FloatArray, options: ExtremeOptions
) -> FloatArray:
    """Angles (2,) of the maximum and minimum of Re sum X_h exp(i h theta) next to near (2,), else NaN."""
    theta: FloatArray = near
    h = np.asarray(harmonics, dtype=np.float64)
    for _ in range(options.max_iterations):
        turned = np.exp(1j * (theta[:, None] * h)) * X
        slope, bend = -(turned.imag @ h), -(turned.real @ (h * h))
        if not (bend[0] < 0.0 < bend[1]):
            break
        step = slope / bend
        theta = theta - step
        if np.abs(theta - near).max() * h[-1] > np.pi:  # more than half the shortest wave
            break
        if np.abs(step).max() < options.angle_tolerance:
            return np.asarray(theta, dtype=np.float64)
    return np.full(2, np.nan)
