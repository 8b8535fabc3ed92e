"""The state of a scene at an instant, from which a simulation starts or with which it ends."""

from __future__ import annotations

import numpy as np

from fcm.frozen import Frozen
from fcm.harmonic_balance.static_equilibrium import RestError, rest_of
from fcm.model.scene import FloatArray, Scene
from fcm.scene.errors import counted
from fcm.time_domain.contact_states import Codes
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.integrator import March


class State(Frozen):
    """The state at an instant: everything that the later motion depends on.

    The slip motion of each contact is w = u - friction / k_u (2); the displacements determine its normal
    load. A friction force beyond the limit mu n is reduced to the limit.

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
        """The structure at rest in equilibrium, strained only by its preloads and static loads.

        Raises
        ------
        SimulationError
            If there is no equilibrium with the static loads.
        """
        still = State.unloaded(scene)
        if not scene.loads:
            return still
        try:
            displacement, friction = rest_of(scene.whole().unstressed())
        except RestError as error:
            raise SimulationError(str(error)) from None
        return State(displacement, still.velocity, friction[scene.computed()])

    @staticmethod
    def unloaded(scene: Scene) -> State:
        """The structure at rest without static loads."""
        modes = scene.modal.mass.size
        return State(np.zeros(modes), np.zeros(modes), np.zeros(len(scene.contacts)))

    @staticmethod
    def start(scene: Scene) -> State:
        """The state in which the scene's schedule begins: rest, unless the scene says otherwise."""
        given = scene.start
        if given is None:
            return State.rest(scene)
        friction = given.friction[scene.computed()]
        return State(given.displacement, given.velocity, friction, given.angle)


def entry(system: EquationsOfMotion, state: State) -> tuple[FloatArray, Codes]:
    """The state vector of a state, and the contact states with which a march begins."""
    x = np.zeros(system.unknowns)
    try:
        x[system.q], x[system.p], x[system.f] = state.q, state.velocity, state.friction
    except ValueError:
        raise SimulationError(
            f"a state of this scene has {counted(system.modes, 'mode')} and "
            f"{counted(len(system.contacts), 'contact')}"
        ) from None
    march = entered(system, x, state.angle)
    return np.array(march.y)[0], np.array(march.states)[0]


def entered(system: EquationsOfMotion, x: FloatArray, angle: float = 0.0) -> March:
    """The march of a system, ready to continue from x = (q, q', f) at an angle of the forces."""
    march = system.march()
    if not march.enters(x, angle, system.level):
        raise SimulationError("the state to start from has numbers that are not finite")
    return march


def leave(system: EquationsOfMotion, y: FloatArray, angle: float) -> State:
    """The `State` of a state vector, at an angle of the forces."""
    return State(y[system.q].copy(), y[system.p].copy(), y[system.f].copy(), angle)


def set_angle(system: EquationsOfMotion, y: FloatArray, angle: float) -> None:
    """Sets the phases of the forces in a state vector to an angle [rad]."""
    angles = angle * np.array(system.harmonics)
    y[system.linear :: 2], y[system.linear + 1 :: 2] = np.sin(angles), np.cos(angles)
