"""Initial states for shooting, from points of the harmonic balance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.contact import hysteresis_loop, periodic_forces
from fcm.contact.closed_form import ClosedForm
from fcm.harmonic_balance.contact_law import SingleHarmonicLaw
from fcm.model.scene import Contact, FloatArray, Scene, has_friction
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.errors import SimulationError
from fcm.time_domain.state import State


def harmonic_state(
    scene: Scene, frequency: float, amplitude: npt.ArrayLike, phase: npt.ArrayLike, mean: npt.ArrayLike
) -> State:
    """The state at the forces' angle 0 of the motion mean + amplitude sin(omega t + phase) (section 4.3).

    The motion is known at the degrees of freedom, which may be fewer than the modes. The contacts' balanced
    forces (27), (29) follow from it, and the modes from these.

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
    >>> from fcm.shooting import periodic
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
    system = EquationsOfMotion(scene, frequency)
    wave, steady = system.wave[0], system.static.copy()
    friction = np.zeros(len(scene.contacts))
    for j, contact in enumerate(scene.contacts):
        along, across = contact.tangential, contact.normal
        start = sum(contact.slider)  # at most one entry for a contact on a line
        at = float(along @ average) - start, float(across @ average)
        pair, means, friction[j] = _forces(contact, along @ x, across @ x, *at)
        wave = wave - system.tangential[j] * pair[0] - system.normal[j] * pair[1]
        steady -= system.tangential[j] * means[0] + system.normal[j] * means[1]
    return _modal(system, wave, steady, friction)


def balanced_states(
    scene: Scene,
    frequency: float,
    poll: Callable[[], None] | None = None,
    options: ShootingOptions = SHOOTING,
) -> list[State]:
    """Guesses from the scene's harmonic balance at a frequency [rad/s]; empty without a solution.

    poll is called regularly.
    """
    return balance_solutions(scene, frequency, poll, options)[0]


def balance_solutions(
    scene: Scene,
    frequency: float,
    poll: Callable[[], None] | None = None,
    options: ShootingOptions = SHOOTING,
) -> tuple[list[State], bool]:
    """Guesses from the scene's balance at a frequency, and whether they are complete.

    They are complete if the curve in the level of the forces was followed to its end.
    """
    whole = scene.whole()
    if not (whole.modal.frequency.all() and whole.contacts):
        return [], True
    from fcm.branches.force_level import solutions
    from fcm.harmonic_balance.system import System

    few = len(whole.contacts) < options.balance.many_contacts
    harmonics = options.balance.guess_harmonics if few else (1,)
    balanced = System(whole, harmonics, other_options=options.balance.others)
    balanced.work.poll = poll or balanced.work.poll
    found = solutions(balanced, frequency)
    states = [computed_state(scene, balanced.harmonics, z, options) for z in found.solutions]
    return states, found.complete


def computed_state(
    scene: Scene, harmonics: tuple[int, ...], z: FloatArray, options: ShootingOptions = SHOOTING
) -> State:
    """`state_of` for the scene without held contacts, less the friction of those that are held."""
    state = state_of(scene.whole(), harmonics, z, options)
    return replace(state, friction=state.friction[scene.computed()])


def state_of(
    scene: Scene, harmonics: tuple[int, ...], z: FloatArray, options: ShootingOptions = SHOOTING
) -> State:
    """The state at the forces' angle 0 of a point z of the balance (`fcm.harmonic_balance.residual`).

    The contact forces of the balanced motion have further harmonics; the state includes the modes' response
    to these.
    """
    system, highest = EquationsOfMotion(scene, float(z[-1])), options.balance.force_harmonics * max(harmonics)
    driven = list(system.harmonics)
    width = 2 + 4 * len(harmonics)
    wave = np.zeros((highest + 1, system.modes), dtype=np.complex128)  # modal forces
    wave[0], wave[driven] = system.static, -1j * system.wave
    friction = np.zeros(len(scene.contacts))
    for j, contact in enumerate(scene.contacts):
        u, v = np.zeros((2, highest + 1), dtype=np.complex128)
        x = z[j * width : (j + 1) * width]
        u[0], v[0] = x[:2]
        u[list(harmonics)], v[list(harmonics)] = x[2::4] + 1j * x[3::4], x[4::4] + 1j * x[5::4]
        mu = contact.mu if has_friction(contact) else 0.0
        f, n = periodic_forces(u, v, mu, contact.k_u, contact.k_v, contact.n_0)
        n[0] -= max(contact.n_0, 0.0)
        wave -= np.outer(f, system.tangential[j]) + np.outer(n, system.normal[j])
        friction[j] = f.real.sum()
    modal, rates = scene.modal, system.omega * np.arange(highest + 1)[:, None]
    dynamic = modal.frequency**2 - rates**2 + 2j * modal.damping * modal.frequency * rates
    # the response of an undamped mode exactly at its natural frequency is undetermined: 0
    q = np.divide(wave, modal.mass * dynamic, out=np.zeros_like(wave), where=dynamic != 0.0)
    return State(q.real.sum(axis=0), (1j * rates * q).real.sum(axis=0), friction)


def _modal(
    system: EquationsOfMotion, wave: npt.NDArray[np.complex128], steady: FloatArray, friction: FloatArray
) -> State:
    """State of the modes at the angle 0 under harmonic and steady modal forces."""
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
    """Balanced friction and normal force of a contact: fundamentals, means, and friction at angle 0."""
    law = SingleHarmonicLaw(ClosedForm(), contact)
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


def _stuck(law: SingleHarmonicLaw, x: FloatArray) -> bool:
    """Whether the contact never slips nor opens in the motion x."""
    law.evaluate_margins(x, 0)
    return bool(law.rests())


def _angle(z: complex) -> float:
    return float(np.angle(z))
