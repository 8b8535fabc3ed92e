r"""Floquet multipliers of a wave that travels around a ring of sectors.

The motion repeats after n = sectors / gcd(engine_order, sectors) sectors. Only disturbances that do so, too,
are considered; with n = sectors these are all. Their growth in 1 / n of a period, in the frame of the wave,
is an eigenvalue of `RingMonodromy` (in a plane `RingPlanarMonodromy`). A real one crosses 1 at a fold of
the curve of travelling waves. Any other one outside the unit circle breaks up the wave, even if its power for
the whole period is real.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.harmonic_balance.residual_spectrum import EnrichedMotion, enriched_harmonics
from fcm.harmonic_balance.system import System
from fcm.model.ring import Ring
from fcm.model.scene import FloatArray
from fcm.stability.classification import Classification
from fcm.stability.disturbance import Stiffness
from fcm.stability.monodromy import RingMonodromy
from fcm.stability.multipliers import Multipliers, VariationalProblem
from fcm.stability.options import STABILITY, StabilityOptions
from fcm.stability.planar_monodromy import PlanarSequence, RingPlanarMonodromy
from fcm.stability.quasi_static_modes import PortModes, quasi_static_modes
from fcm.stability.state_sequence import BalancedSequence
from fcm.structure.ring import RingLinear

MAX_NAMED = 8  # nodal diameters listed in a message


def stability_unknown(system: System, highest: float, options: StabilityOptions = STABILITY) -> str:
    """Reason why the stability of a system's waves is unknown; empty if it is known."""
    ring = system.scene.ring
    assert ring is not None
    missing = sorted(set(ring.lacking(range(ring.period)).values()))
    if missing:
        diameters = ", ".join(map(str, missing[:MAX_NAMED])) + (", ..." if len(missing) > MAX_NAMED else "")
        return f"there are no modes of nodal diameter {diameters}, which disturbances have"
    natural = ring.frequency[_places(ring)]
    harmonics = [int(h) for h in system.harmonics]
    near = ~quasi_static_modes(natural, highest, harmonics, system.scene.planar, options)
    count = 2 * int(near.sum()) + ring.period * len(system.scene.contacts)
    if count > options.structure.max_disturbances:
        most = options.structure.max_disturbances
        return (
            f"{count} disturbances of {ring.period} sectors are too many; up to {most} are looked at. "
            "structure.modes may take fewer modes of a sector"
        )
    return ""


class RingModes(Frozen):
    """The modes of n sectors, of mass 1, and the matrix that renumbers the sectors, from j sectors behind."""

    natural: FloatArray  # (mode,)
    damping: FloatArray
    ports: FloatArray  # (mode, port), sector after sector
    renumber: FloatArray  # (mode, mode)

    def selected(self, which: npt.NDArray[np.bool_]) -> RingModes:
        """The modes marked by which (mode,)."""
        renumber = np.ascontiguousarray(self.renumber[np.ix_(which, which)])
        return RingModes(self.natural[which], self.damping[which], self.ports[which], renumber)


class RingMultipliers(Multipliers):
    """Computes multipliers of solutions of one sector of a ring."""

    def __init__(
        self, system: System, highest: float, last: bool = False, options: StabilityOptions = STABILITY
    ) -> None:
        self.options = options
        self.system, self.highest, self.last, self.further = system, highest, last, None
        linear, ring = system.linear, system.scene.ring
        assert isinstance(linear, RingLinear) and ring is not None
        n = ring.period
        self.contacts = len(system.scene.contacts)
        of_one = np.array([[c.mu, c.k_u, c.k_v, c.n_0] for c in system.scene.contacts]).reshape(-1, 4)
        contact = np.tile(of_one, (n, 1))
        harmonics = [int(h) for h in system.harmonics]
        spectrum = system.options.spectrum
        finer = enriched_harmonics(harmonics, spectrum)
        self.unknown = bool(stability_unknown(system, highest, self.options))
        around = modes_around(linear, ring)
        far = quasi_static_modes(around.natural, highest, harmonics, system.scene.planar, self.options)
        self.has_rigid_body_modes = int(np.count_nonzero(linear.adrift))
        seen = linear.receptance(np.array(finer, dtype=np.float64))
        self.finer = EnrichedMotion(seen, system.exact_laws(tuple(finer)), harmonics, spectrum)
        self.ring, self.planar = ring, system.scene.planar
        near, modes = around.selected(~far), PortModes(around.ports, around.natural, around.damping, far)
        source = np.roll(np.arange(n * self.contacts), sector_shifts(ring) * self.contacts)
        turned = 2.0 * np.pi / n, near.renumber, source
        if self.planar:
            self.fine, self.plain = (
                VariationalProblem(states, RingPlanarMonodromy(modes, states, *turned, self._poll))
                for states in (
                    PlanarSequence(contact, tuple(numbers), options.planar) for numbers in (finer, harmonics)
                )
            )
        else:
            soft = modes.flexibility if far.any() else None
            stiffness = Stiffness(near.ports, near.natural, near.damping, soft, contact)
            self.fine, self.plain = (
                VariationalProblem(states, RingMonodromy(stiffness, states, *turned))
                for states in (BalancedSequence(contact, numbers) for numbers in (finer, harmonics))
            )
        self.shifts = {
            len(numbers): np.exp(1j * np.outer(np.arange(n), _phases(ring, numbers)))
            for numbers in (finer, harmonics)
        }

    def _matrix(self, followed: VariationalProblem, omega: float) -> FloatArray | None:
        """The monodromy matrix of the motion whose states were found last.

        None if modes are missing, or there are too many.
        """
        return None if self.unknown else Multipliers._matrix(self, followed, omega)

    def find_states(self, states: BalancedSequence | PlanarSequence, x: FloatArray) -> bool:
        """Find the states of the contacts in the motion x of one sector; see `Multipliers.find_states`."""
        d = 3 if self.planar else 2
        count = (states.width // d - 1) // 2
        blocks = np.asarray(x)[: self.contacts * states.width].reshape(self.contacts, states.width)
        shift = self.shifts[count]
        pairs = np.ascontiguousarray(blocks[:, d:]).view(np.complex128).reshape(self.contacts, count, d)
        shifted = pairs[None] * shift[:, None, :, None]  # (sector, contact, harmonic, direction)
        whole = np.empty((len(shift), self.contacts, states.width))
        whole[..., :d] = blocks[:, :d]
        whole[..., d:] = shifted.reshape(len(shift), self.contacts, d * count).view(np.float64)
        return bool(states.find_events(whole.ravel()))

    def classify_all(
        self,
        z: Sequence[FloatArray],
        at_fold: Sequence[bool],
        without_neighbour: Sequence[bool],
        sufficient: Sequence[float] = (),
    ) -> list[Classification]:
        """Classifications of several solutions, as `Multipliers.classify_all` gives them.

        The angle to a flip is that of the whole period, n times that of its n-th part.
        """
        found = Multipliers.classify_all(self, z, at_fold, without_neighbour, sufficient)
        n = self.ring.period
        return [one._replace(angle_to_flip=min(one.angle_to_flip * n, np.pi)) for one in found]

    def of_period(self, values: list[complex]) -> list[complex]:
        """Multipliers with the magnitudes of a whole period and the angles of its n-th part."""
        return [abs(value) ** (self.ring.period - 1) * value for value in values]


def _phases(ring: Ring, harmonics: list[int]) -> FloatArray:
    """Phase lead [rad] of each harmonic of a sector over the same harmonic of the sector before."""
    return 2.0 * np.pi / ring.sectors * np.array([ring.waves(h) for h in harmonics])


def sector_shifts(ring: Ring) -> int:
    """Number j of sectors that the wave passes in 1 / n of a period: j engine_order = gcd, modulo sectors.

    >>> none = np.zeros(0)
    >>> ring = Ring(8, 3, none, none, np.zeros((0, 0), complex), none, none)
    >>> sector_shifts(ring)  # 3 * 3 = 9
    3
    """
    n = ring.period
    order = ring.engine_order // (ring.sectors // n)
    return pow(order, -1, n) if n > 1 else 0


def modes_around(linear: RingLinear, ring: Ring) -> RingModes:
    """The modes of n sectors; those of a nodal diameter other than 0 and sectors / 2 as cosine and sine."""
    n, places = ring.period, _places(ring)
    step = 2.0 * np.pi * ring.diameter[places] / ring.sectors
    second = np.concatenate(([False], np.diff(places) == 0))  # the sine of a pair
    first = np.concatenate((second[1:], [False]))
    shift = np.exp(1j * np.outer(step, np.arange(n)))[..., None]
    wave = ((ring.shapes[places] @ linear.directions)[:, None, :] * shift).reshape(places.size, -1)
    ports = (
        np.where(second[:, None], wave.imag, wave.real)
        * np.sqrt(np.where(first | second, 2.0, 1.0) / n)[:, None]
    )
    by = step * sector_shifts(ring)
    renumber = np.diag(np.cos(by))
    at = np.flatnonzero(first)
    renumber[at, at + 1], renumber[at + 1, at] = -np.sin(by[at]), np.sin(by[at])
    return RingModes(ring.frequency[places], ring.damping[places], ports, renumber)


def _places(ring: Ring) -> npt.NDArray[np.intp]:
    """Indices of the ring's modes in the disturbances; twice for those with a cosine and a sine."""
    repeats = ring.diameter % (ring.sectors // ring.period) == 0
    single = (ring.diameter == 0) | (2 * ring.diameter == ring.sectors)
    return np.repeat(np.arange(ring.diameter.size), np.where(repeats, np.where(single, 1, 2), 0))
