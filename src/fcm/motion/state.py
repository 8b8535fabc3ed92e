"""The state of a scene at an instant: what a simulation starts from and ends with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fcm.harmonic.rest import RestError, rest_of
from fcm.motion.combination import Codes
from fcm.motion.errors import SimulationError
from fcm.motion.pool import NEGATIVE, OPEN, POSITIVE, STICK
from fcm.motion.system import System, has_friction
from fcm.scene.model import FloatArray, Scene


@dataclass(frozen=True)
class State:
    """Everything that the motion from an instant on depends on.

    The slip motion of each contact is w = u - friction / k_u (2); its normal load follows from the
    displacements. A friction force beyond the limit mu n is brought back to it.

    Examples
    --------
    >>> import fcm
    >>> State.rest(fcm.load_scene("yang1998-n5"))
    State(q=array([0., 0.]), velocity=array([0., 0.]), friction=array([0.]), angle=0.0)
    """

    q: FloatArray  # (mode,) modal displacements
    velocity: FloatArray  # (mode,) modal velocities [1/s]
    friction: FloatArray  # (contact,) friction forces
    angle: float = 0.0  # omega t of the external forces [rad]

    @staticmethod
    def rest(scene: Scene) -> State:
        """The structure at rest in equilibrium with its preloads and static loads, which alone strain it.

        Raises
        ------
        SimulationError
            If there is no equilibrium with the static loads.
        """
        still = State.unloaded(scene)
        if not scene.loads:
            return still
        try:
            displacement, friction = rest_of(scene)
        except RestError as error:
            raise SimulationError(str(error)) from None
        return State(displacement, still.velocity, friction)

    @staticmethod
    def unloaded(scene: Scene) -> State:
        """The structure at rest without static loads."""
        modes = scene.modal.mass.size
        return State(np.zeros(modes), np.zeros(modes), np.zeros(len(scene.contacts)))

    @staticmethod
    def start(scene: Scene) -> State:
        """Where the scene's schedule starts from: rest, unless the scene says otherwise."""
        given = scene.start
        if given is None:
            return State.rest(scene)
        return State(given.displacement, given.velocity, given.friction, given.angle)


def entry(system: System, state: State) -> tuple[FloatArray, Codes]:
    """The state vector of a state, and a combination of contact states for the march to begin with."""
    y = np.zeros(system.size)
    try:
        y[system.q], y[system.p], y[system.f] = state.q, state.velocity, state.friction
    except ValueError:
        raise SimulationError(
            f"a state of this scene has {system.modes} modes and {len(system.contacts)} contacts"
        ) from None
    set_angle(y, state.angle)
    if not np.isfinite(y).all():
        raise SimulationError("the state to start from has numbers that are not finite")
    y[system.n] = system.stiffness * (system.normal @ y[system.q])
    states = np.array([_initial(system, y, j) for j in range(len(system.contacts))], dtype=np.int8)
    return y, states


def _initial(system: System, y: FloatArray, j: int) -> int:
    """The state of a contact, by its load and its friction force, which is brought into its limits."""
    contact, load, force = system.contacts[j], system.preload[j] + y[system.n.start + j], system.f.start + j
    if load < 0.0 or (load == 0.0 and contact.k_v == 0.0):
        y[force] = 0.0
        return OPEN
    if not has_friction(contact):
        y[force] = 0.0
        return STICK
    limit = contact.mu * load
    if abs(y[force]) <= limit:
        return STICK
    y[force] = np.copysign(limit, y[force])
    return POSITIVE if y[force] > 0.0 else NEGATIVE


def leave(system: System, y: FloatArray, angle: float) -> State:
    """The state of a state vector, at an angle of the forces."""
    return State(y[system.q].copy(), y[system.p].copy(), y[system.f].copy(), angle)


def set_angle(y: FloatArray, angle: float) -> None:
    """Set the constant, and the phase angle of the forces."""
    y[-3:] = 1.0, np.sin(angle), np.cos(angle)
