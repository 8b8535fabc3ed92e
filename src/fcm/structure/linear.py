"""A scene's structure as arrays: modes of mass 1, on the contacts' ports and on the degrees of freedom."""

from __future__ import annotations

import threading
from dataclasses import fields
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Scene
from fcm.structure.loads import loads_of
from fcm.structure.options import REDUCTION
from fcm.structure.receptance import DrivenModes, Receptance, dynamic_stiffness
from fcm.structure.rigid import settled

ComplexArray = npt.NDArray[np.complex128]
FROM_SINE = np.exp(-0.5j * np.pi)  # from Im(X exp(i omega t)) to Re(X exp(i omega t))


class Linear(Frozen):
    """The structure without its contacts; ports are the contacts' directions, the last of each its normal."""

    natural: FloatArray  # (mode,) [rad/s]
    damping: FloatArray  # (mode,) ratio
    ports: FloatArray  # (mode, port)
    dofs: FloatArray  # (mode, dof)
    force: ComplexArray  # (driven, mode) of x = Re(X exp(i h omega t))
    square: ComplexArray  # (driven, mode) force per omega^2, in addition to `force`
    load: FloatArray  # (mode,) static forces
    flexibility: FloatArray  # (mode, mode) of displacements under mean forces
    counted: FloatArray  # (contact,) normal stiffness that the flexibility includes
    adrift: npt.NDArray[np.bool_]  # (mode,) rigid-body modes that no closed contact holds
    driven: tuple[int, ...]  # harmonics h of the forces, the first is 1

    def receptance(self, harmonics: FloatArray, summed: bool = True) -> Receptance:
        """Receptances of the ports at some harmonics; summed: with the sums over modes."""
        modes = DrivenModes(self.ports, self.natural, self.damping, self.force, self.square, self.driven)
        return Receptance(modes, self.static, harmonics, self.counted.size, summed)

    @property
    def directions_of_contact(self) -> int:
        """Number of ports of each contact, the last of which is along its normal."""
        return self.ports.shape[1] // self.counted.size if self.counted.size else 0

    @property
    def normal(self) -> FloatArray:
        """Shapes (mode, contact) along the contacts' normals."""
        return self.ports[:, self.directions_of_contact - 1 :: self.directions_of_contact or 1]

    @cached_property
    def static(self) -> FloatArray:
        """Flexibility (port, port) of the ports for mean forces."""
        return np.ascontiguousarray(self.ports.T @ self.flexibility @ self.ports)

    @cached_property
    def static_of_dofs(self) -> FloatArray:
        """Displacements (dof, port) of the degrees of freedom by unit mean forces on the ports."""
        return np.ascontiguousarray(self.dofs.T @ self.flexibility @ self.ports)

    @cached_property
    def attached(self) -> tuple[FloatArray, npt.NDArray[np.intc]]:
        """Combination of ports that equals each degree of freedom, see `attached_to`."""
        return attached_to(self.ports, self.dofs)

    @cached_property
    def numbers(self) -> tuple[bytes, ...]:
        """Key of the structure: bytes that are equal if the structures are equal."""
        arrays = (getattr(self, field.name) for field in fields(Linear) if field.name != "driven")
        return (bytes(str(self.driven), "ascii"), *(array.tobytes() for array in arrays))

    def at(self, omega: float) -> tuple[npt.NDArray[np.complex128], npt.NDArray[np.complex128]]:
        """Receptance (driven, port, port) and response to the forces (driven, port) at a frequency."""
        seen = self._at_forces
        seen.at(omega)
        G = np.asarray(seen.G_re) + 1j * np.asarray(seen.G_im)
        return G, np.asarray(seen.X_re) + 1j * np.asarray(seen.X_im)

    @cached_property
    def _at_forces(self) -> Receptance:
        return self.receptance(np.array(self.driven, dtype=np.float64))

    def answers_with(self, springs: FloatArray, omega: FloatArray) -> ComplexArray:
        """Responses (case, point, driven, port) to the forces, with springs (case, port) instead of contacts.

        omega (point,) are the frequencies. The responses follow from the dynamic stiffness of the modes with
        the springs, a matrix as large as the number of modes, instead of the receptance, as large as the
        number of ports.
        """
        orders = np.array(self.driven, dtype=np.float64)
        stiffness = _stiffness(self.natural, self.damping, omega, orders)
        modal = self.force + self.square * omega[:, None, None] ** 2
        found = np.empty((len(springs), *modal.shape[:2], self.ports.shape[1]), dtype=np.complex128)
        for answer, held in zip(found, springs, strict=True):
            matrix = (stiffness[..., None] * np.eye(self.natural.size)) + (self.ports * held) @ self.ports.T
            answer[:] = np.linalg.solve(matrix, modal[..., None])[..., 0] @ self.ports
        return found

    def displacements(self, harmonics: FloatArray, omega: FloatArray, force: ComplexArray) -> ComplexArray:
        """Displacements (point, harmonic, dof) under forces on the ports (point, harmonic, port)."""
        modal = force @ self.ports.T
        return amplitudes(self.natural, self.damping, omega, harmonics, modal) @ self.dofs

    def stiffened(self, springs: FloatArray, harmonic: int = 1) -> FloatArray:
        """Natural frequencies (mode,) [rad/s] with springs (port,) instead of contacts, for a harmonic."""
        return with_springs(self.natural, self.ports, springs)


def attached_to(ports: FloatArray, dofs: FloatArray) -> tuple[FloatArray, npt.NDArray[np.intc]]:
    """Combination of ports (port, dof) that equals each degree of freedom, and a flag (dof,) if none does.

    ports (mode, port) and dofs (mode, dof) are shapes. A single port is taken if it moves as the degree of
    freedom: with fewer modes than ports, a combination of all ports would always exist. A combination of
    several ports is accepted only if its terms do not nearly cancel.

    >>> ports = np.array([[1.0, 2.0, 1.0], [1.0, -1.0, 0.0]])
    >>> shares, apart = attached_to(ports, 2.0 * ports[:, 1:2])
    >>> shares.T.tolist(), apart.tolist()
    ([[0.0, 2.0, 0.0]], [0])
    """
    return _attached(ports.tobytes(), ports.shape, dofs.tobytes(), dofs.shape)


@lru_cache(REDUCTION.max_cached)
def _attached(
    of_ports: bytes, ports_shape: tuple[int, ...], of_dofs: bytes, dofs_shape: tuple[int, ...]
) -> tuple[FloatArray, npt.NDArray[np.intc]]:
    """Combination of ports for `attached_to`, from the bytes of its arrays so that it can be cached."""
    ports = np.frombuffer(of_ports).reshape(ports_shape)
    dofs = np.frombuffer(of_dofs).reshape(dofs_shape)
    size = np.abs(dofs).max(axis=0, initial=0.0)
    shares = _single_shares(ports, dofs)
    combined = np.abs(ports @ shares - dofs).max(axis=0, initial=0.0) > REDUCTION.shape_tolerance * size
    if ports.size and combined.any():
        shares[:, combined] = np.linalg.lstsq(ports, dofs[:, combined], rcond=1e-10)[0]
    shares[np.abs(shares) < REDUCTION.shape_tolerance * np.abs(shares).max(axis=0, initial=1e-300)] = 0.0
    off = np.abs(ports @ shares - dofs).max(axis=0, initial=0.0)
    large = np.abs(ports).max(axis=0, initial=0.0) @ np.abs(shares) > REDUCTION.max_combination * size
    apart = (off > REDUCTION.shape_tolerance * size) | large | (size == 0.0)
    return np.ascontiguousarray(shares), apart.astype(np.intc)


def _single_shares(ports: FloatArray, dofs: FloatArray) -> FloatArray:
    """Shares (port, dof) of the single port whose shape is nearest to that of each degree of freedom.

    >>> _single_shares(np.array([[1.0, 2.0], [0.0, 4.0]]), np.array([[1.0], [2.0]])).tolist()
    [[0.0], [0.5]]
    """
    shares: FloatArray = np.zeros((ports.shape[1], dofs.shape[1]))
    if not shares.size:
        return shares
    squares = np.square(ports).sum(axis=0)
    common, squares = ports.T @ dofs, np.where(squares > 0.0, squares, np.inf)
    nearest, d = (common**2 / squares[:, None]).argmax(axis=0), np.arange(dofs.shape[1])
    shares[nearest, d] = common[nearest, d] / squares[nearest]
    return shares


def with_springs(natural: FloatArray, ports: FloatArray | ComplexArray, springs: FloatArray) -> FloatArray:
    """Natural frequencies (mode,) of modes with springs (port,) on ports (mode, port), ascending."""
    return _with_springs(natural.tobytes(), ports.tobytes(), ports.dtype.str, springs.tobytes())


@lru_cache(REDUCTION.max_cached)
def _with_springs(of_modes: bytes, of_ports: bytes, kind: str, of_springs: bytes) -> FloatArray:
    """Natural frequencies for `with_springs`, from the bytes of its arrays so that they can be cached."""
    natural, springs = np.frombuffer(of_modes), np.frombuffer(of_springs)
    ports = np.frombuffer(of_ports, dtype=kind).reshape(natural.size, springs.size)
    stiffness = np.diag(natural**2) + (ports.conj() * springs) @ ports.T
    found: FloatArray = np.sqrt(np.maximum(np.linalg.eigvalsh(stiffness), 0.0))
    found.flags.writeable = False
    return found


def amplitudes(
    natural: FloatArray, damping: FloatArray, omega: FloatArray, harmonics: FloatArray, force: ComplexArray
) -> ComplexArray:
    """Modal amplitudes (point, harmonic, mode) under modal forces, at frequencies omega (point,)."""
    return force / _stiffness(natural, damping, omega, harmonics)


def _stiffness(
    natural: FloatArray, damping: FloatArray, omega: FloatArray, harmonics: FloatArray
) -> ComplexArray:
    """Dynamic stiffness of modes (point, harmonic, mode) at harmonics of frequencies omega (point,)."""
    w = omega[:, None] * harmonics
    return dynamic_stiffness(natural, damping, w.ravel()).reshape(*w.shape, natural.size)


class _Last(threading.local):
    """The structure that each thread requested last, with its key; all curves of a sweep share it."""

    def __init__(self) -> None:
        self.key: tuple[object, ...] = ()
        self.linear: Linear | None = None


_LAST = _Last()


def linear_of(scene: Scene) -> Linear:
    """The `Linear` structure of a scene of one curve."""
    if scene.ring is not None or not scene.modal.frequency.all():  # these contain the contacts' stiffness
        return _made(scene)
    modal, forces = scene.modal, [(one.amplitude, one.phase, one.power, one.harmonic) for one in scene.forces]
    arrays = (modal.frequency, modal.damping, modal.mass, modal.shapes, *scene.directions())
    loads = [one.force for one in scene.loads]
    key = (len(scene.contacts), *forces, None, *loads, *(one.tobytes() for one in arrays))
    if _LAST.linear is None or _LAST.key != key:
        _LAST.key, _LAST.linear = key, _made(scene)
    return _LAST.linear


def _made(scene: Scene) -> Linear:
    modal, adrift = settled(scene)
    unit = 1.0 / np.sqrt(modal.mass)[:, None]
    directions = scene.directions_of_contacts()
    along = np.array(directions, dtype=np.float64).reshape(len(directions), len(modal.dofs)).T
    ports = modal.shapes @ along
    loads = loads_of(scene)
    rigid = modal.frequency == 0.0
    k_v = np.array([c.k_v if rigid.any() else 0.0 for c in scene.contacts])
    ports = ports * unit
    linear = Linear(
        natural=modal.frequency,
        damping=modal.damping,
        ports=np.ascontiguousarray(ports),
        dofs=np.ascontiguousarray(modal.shapes * unit),
        force=FROM_SINE * (loads.constant @ modal.shapes.T) * unit[:, 0],
        square=FROM_SINE * (loads.square @ modal.shapes.T) * unit[:, 0],
        load=(modal.shapes @ loads.static) * unit[:, 0],
        flexibility=_flexibility(
            modal.frequency,
            ports[:, scene.directions_of_contact - 1 :: scene.directions_of_contact],
            k_v,
            adrift,
        ),
        counted=k_v,
        adrift=adrift,
        driven=loads.harmonics,
    )
    if scene.ring is None:
        return linear
    from fcm.structure.ring import RingLinear

    own = {field.name: getattr(linear, field.name) for field in fields(Linear)}
    return RingLinear(**own, ring=scene.ring, directions=along, loads=loads)


def _flexibility(
    natural: FloatArray, normal: FloatArray, k_v: FloatArray, adrift: npt.NDArray[np.bool_]
) -> FloatArray:
    """Flexibility (mode, mode) of the modes, including normal springs; modes adrift have none.

    A rigid-body mode has no stiffness, and so no flexibility. The normal springs of the contacts are then
    added to the structure, and subtracted from the contacts' forces. The equation is the same, and its terms
    are finite as long as the closed contacts hold the structure.
    """
    if not (natural == 0.0).any():
        return np.diag(natural**-2)
    normal = np.where(adrift[:, None], 0.0, normal)
    matrix = np.diag(natural**2) + (normal * k_v) @ normal.T
    at = np.flatnonzero(adrift)
    matrix[at, at] = 1.0
    unit = 1.0 / np.sqrt(matrix.diagonal())
    inverse: FloatArray = np.linalg.inv(matrix * unit[:, None] * unit) * unit[:, None] * unit
    inverse[at, at] = 0.0
    return inverse
