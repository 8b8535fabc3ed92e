"""The structure of a ring's sector as arrays, which differ between the harmonics of a travelling wave."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.ring import Ring
from fcm.model.scene import FloatArray, Scene
from fcm.structure.linear import FROM_SINE, Linear, amplitudes, attached_to, with_springs
from fcm.structure.loads import Loads
from fcm.structure.receptance import DrivenModes, Receptance, TravellingReceptance

ComplexArray = npt.NDArray[np.complex128]


class Wave(Frozen):
    """The modes of a sector for one harmonic of a travelling wave."""

    natural: FloatArray  # (mode,) [rad/s]
    damping: FloatArray  # (mode,) ratio
    ports: ComplexArray  # (mode, port)
    dofs: ComplexArray  # (mode, dof)

    def stiffened(self, springs: FloatArray) -> FloatArray:
        """Natural frequencies [rad/s] with springs (port,) along the ports."""
        return with_springs(self.natural, self.ports, springs)


class RingLinear(Linear):
    """The structure of a sector; the fields of `Linear` are those of the mean, with nodal diameter 0."""

    ring: Ring
    directions: FloatArray  # (dof, port)
    loads: Loads  # on the sector's degrees of freedom

    def wave(self, harmonic: int) -> Wave:
        """The modes of the sector for a harmonic of the travelling wave."""
        natural, damping, shapes = self.ring.modes(harmonic)
        return Wave(natural, damping, shapes @ self.directions, shapes)

    @cached_property
    def attached(self) -> tuple[FloatArray, npt.NDArray[np.intc]]:
        """Combination of ports that equals each degree of freedom in every wave, see `Linear.attached`."""
        waves = [self.wave(harmonic) for harmonic in range(self.ring.period)]
        ports, dofs = (np.concatenate([getattr(one, name) for one in waves]) for name in ("ports", "dofs"))
        return attached_to(*(np.concatenate((shapes.real, shapes.imag)) for shapes in (ports, dofs)))

    def receptance(self, harmonics: FloatArray, summed: bool = True) -> Receptance:
        """Receptances of the sector's ports at some harmonics."""
        waves = [self._real(int(h)) for h in harmonics]
        return TravellingReceptance(waves, self.static, harmonics, self.counted.size, self.driven)

    def _real(self, harmonic: int) -> Receptance:
        """Receptance of one harmonic, with real and imaginary parts of the ports as separate ports."""
        wave = self.wave(harmonic)
        both = np.concatenate((wave.ports.real, wave.ports.imag), axis=1)
        force, square = np.zeros((2, 1, len(wave.dofs)), dtype=np.complex128)
        if harmonic in self.driven:
            k, onto = self.driven.index(harmonic), FROM_SINE * wave.dofs.conj()
            force[0], square[0] = onto @ self.loads.constant[k], onto @ self.loads.square[k]
        static, at = np.zeros((both.shape[1], both.shape[1])), np.array([float(harmonic)])
        return Receptance(
            DrivenModes(both, wave.natural, wave.damping, force, square, (harmonic,)), static, at
        )

    def displacements(self, harmonics: FloatArray, omega: FloatArray, force: ComplexArray) -> ComplexArray:
        """Displacements (point, harmonic, dof) under forces on the ports (point, harmonic, port)."""
        found = np.zeros((*force.shape[:2], self.directions.shape[0]), dtype=np.complex128)
        for j, h in enumerate(harmonics):
            wave = self.wave(int(h))
            modal = force[:, j : j + 1] @ wave.ports.conj().T
            found[:, j : j + 1] = (
                amplitudes(wave.natural, wave.damping, omega, np.array([h]), modal) @ wave.dofs
            )
        return found

    def stiffened(self, springs: FloatArray, harmonic: int = 1) -> FloatArray:
        """Natural frequencies (mode,) [rad/s] at a harmonic, with springs (port,) instead of contacts."""
        return self.wave(harmonic).stiffened(springs)


class Diameter(Frozen):
    """Natural frequencies [rad/s] of one nodal diameter, in ascending order, each array (mode,)."""

    number: int
    opened: FloatArray  # without the contacts
    stuck: FloatArray  # with k_u, k_v of every contact; with k_v alone if it has no friction


def nodal_diameters(scene: Scene) -> list[Diameter]:
    """Natural frequencies of all nodal diameters that have modes, from 0 to half of the sectors.

    >>> import fcm
    >>> disk = nodal_diameters(fcm.load_scene("bladed-disk"))
    >>> [round(float(one.opened[0] / 2 / np.pi), 4) for one in disk[:3]]
    [88.2637, 169.3441, 189.3019]
    """
    ring = scene.ring
    assert ring is not None
    rows = scene.directions_of_contacts()
    directions = np.array(rows).reshape(len(rows), len(scene.modal.dofs)).T
    along = scene.directions_of_contact - 1
    each = [(*[one.k_u if one.mu > 0.0 else 0.0] * along, one.k_v) for one in scene.contacts]
    springs = np.array(each).ravel()
    found = []
    for number in sorted(set(ring.diameter.tolist())):
        which = ring.diameter == number
        natural, own = ring.frequency[which], int((~ring.added[which]).sum())
        stuck = with_springs(natural, ring.shapes[which] @ directions, springs)
        found.append(Diameter(number, np.sort(natural[~ring.added[which]]), stuck[:own]))
    return found
