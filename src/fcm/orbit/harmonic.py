"""A state to start from, from a point of single-harmonic balance."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact import hysteresis_loop
from fcm.contact.closed_form import ClosedForm
from fcm.harmonic.single import OPENS, SLIPS, SingleHarmonic
from fcm.motion.errors import SimulationError
from fcm.motion.state import State
from fcm.motion.system import System, has_friction
from fcm.scene.model import Contact, FloatArray, Scene


def harmonic_state(
    scene: Scene,
    frequency: float,
    amplitude: npt.ArrayLike,
    phase: npt.ArrayLike,
    mean: npt.ArrayLike,
) -> State:
    """The state at the forces' angle 0 of the motion mean + amplitude sin(omega t + phase) (section 4.3).

    The motion is known at the degrees of freedom, of which there may be fewer than modes: the contacts'
    balanced forces (27), (29) follow from it, and the modes from these.

    Parameters
    ----------
    scene : Scene
    frequency : float
        [rad/s]
    amplitude, phase, mean : (dof,)
        As in a point of a response curve; phase in rad.

    Returns
    -------
    State
        A guess for `periodic`, with the friction forces of the steady hysteresis loops.

    Raises
    ------
    SimulationError
        If the point is not finite, or a mode has no stiffness, or no damping at its own frequency.

    Examples
    --------
    >>> import fcm
    >>> from fcm.orbit import periodic
    >>> scene = fcm.load_scene("yang1998-n5")
    >>> point = fcm.respond(scene, "closed-form").isel(curve=0, point=-1)
    >>> guess = harmonic_state(scene, float(point.frequency), point.amplitude, point.phase, point["mean"])
    >>> periodic(scene, float(point.frequency), guess).stable
    True
    """
    x = np.asarray(amplitude) * np.exp(1j * np.asarray(phase, dtype=np.float64))
    average = np.asarray(mean, dtype=np.float64)
    if not (np.isfinite(x).all() and np.isfinite(average).all()):
        raise SimulationError("the point of the response curve to start from is not finite")
    system = System(scene, frequency)
    wave, steady = system.wave, system.static.copy()
    friction = np.zeros(len(scene.contacts))
    for j, contact in enumerate(scene.contacts):
        along, across = contact.tangential, contact.normal
        at = float(along @ average), float(across @ average)
        pair, means, friction[j] = _forces(contact, along @ x, across @ x, *at)
        wave = wave - system.tangential[j] * pair[0] - system.normal[j] * pair[1]
        steady -= system.tangential[j] * means[0] + system.normal[j] * means[1]
    return _modal(system, wave, steady, friction)


def balanced_state(scene: Scene, frequency: float) -> State | None:
    """A guess from the scene's own harmonic balance at a frequency [rad/s]; None if it has none there."""
    if not scene.modal.frequency.all():
        return None
    from fcm.harmonic.record import amplitudes_at
    from fcm.harmonic.start import solutions
    from fcm.harmonic.system import System as Balanced

    balanced = Balanced(scene)
    found = solutions(balanced, frequency).solutions
    if not found:
        return None
    X, mean = amplitudes_at(balanced, found[0][None])
    return harmonic_state(scene, frequency, np.abs(X[0, 0]), np.angle(1j * X[0, 0]), mean[0])


def _modal(
    system: System, wave: npt.NDArray[np.complex128], steady: FloatArray, friction: FloatArray
) -> State:
    """The modes' answer to harmonic and steady modal forces, at the angle 0."""
    modal, omega = system.scene.modal, system.omega
    stiffness = modal.frequency**2
    dynamic = (modal.frequency - omega) * (modal.frequency + omega) + (
        2j * modal.damping * modal.frequency * omega
    )
    if not (stiffness.all() and dynamic.all()):
        raise SimulationError(
            "a mode without stiffness, or without damping at its own frequency, has no harmonic balance; "
            "start from a simulated state"
        )
    q = wave / (modal.mass * dynamic)
    return State(steady / (modal.mass * stiffness) + q.imag, omega * q.real, friction)


def _forces(
    contact: Contact, u: complex, v: complex, u_mean: float, v_mean: float
) -> tuple[tuple[complex, complex], tuple[float, float], float]:
    """Balanced friction and normal force: their fundamentals, their means; the friction at the angle 0."""
    law = SingleHarmonic(ClosedForm(), ClosedForm(), contact.mu, contact.k_u, contact.k_v, contact.n_0)
    x = np.array([u_mean, v_mean, u.real, u.imag, v.real, v.imag])
    law.evaluate(x, 0)
    mean_u, mean_v, *parts = (float(f) for f in law.force)
    pair = complex(*parts[:2]), complex(*parts[2:])
    a, load = abs(u), contact.n_0 + contact.k_v * v_mean
    if not has_friction(contact) or a == 0.0 or _stuck(law, x):
        return pair, (mean_u, mean_v), mean_u + pair[0].imag
    stiff = contact.k_u * a
    arguments = contact.mu * load / stiff, contact.mu * contact.k_v * abs(v) / stiff, _angle(v) - _angle(u)
    start = stiff * float(hysteresis_loop(*arguments).force(_angle(u)))
    return pair, (mean_u, mean_v), start


def _stuck(law: SingleHarmonic, x: FloatArray) -> bool:
    """Whether the contact never slips nor opens."""
    law.bound(x, 0)
    return bool(law.margin[SLIPS] > 0.0 and law.margin[OPENS] > 0.0)


def _angle(z: complex) -> float:
    return float(np.angle(z))
