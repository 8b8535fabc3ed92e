"""Steady motion by exact periodic solutions beside fixed steps: ``make bench-time`` prints times and errors.

The fixed-step method is the classical fourth-order Runge-Kutta method with the friction force as a state
that follows its spring and is cut off at the limit mu n. All frequencies and preloads take their steps
together, in arrays, which is the most that numpy gives such a method. As every method that steps across
transitions it is of low order, so its steps are halved until its convergence can be seen.
"""

from __future__ import annotations

import itertools
import time
import timeit
from collections.abc import Callable
from typing import Any

import numpy as np
from unit import SINE, sine

import fcm
from fcm.response import Response
from fcm.response.exact import trace_exact
from fcm.scene import Contact, Force, Modal, Scene
from fcm.shooting import Shooting, periodic
from fcm.shooting.period_derivative import derivative_at
from fcm.time_domain.cycle_measures import measure
from fcm.time_domain.equations_of_motion import EquationsOfMotion
from fcm.time_domain.simulation import march
from fcm.time_domain.state import entry

FREQUENCIES = np.linspace(0.7, 1.7, 40)
STEPS = (100, 200, 400)  # in a cycle
CYCLES = 300  # until transients of a damping ratio 0.01 are below 1e-6
REPEATS = 5
SAME = (1e-6, 1e-8)  # errors at which the two kinds are compared, by extrapolation


class Rates:
    """q', q'' and f' of the paper's oscillator for arrays of preloads and frequencies."""

    def __init__(self, scene: Scene, preload: np.ndarray, omega: np.ndarray) -> None:
        modal, contact = scene.modal, scene.contacts[0]
        self.preload, self.omega, self.contact = preload, omega, contact
        self.tangential = (modal.shapes @ contact.tangential)[:, None]
        self.normal = (modal.shapes @ contact.normal)[:, None]
        push = sum(force.amplitude * (modal.shapes @ force.direction) for force in scene.forces)
        self.push = np.asarray(push)[:, None]
        self.damping = (2.0 * modal.damping * modal.frequency)[:, None]
        self.stiffness = (modal.frequency**2)[:, None]

    def limit(self, q: np.ndarray) -> np.ndarray:
        """mu n, never negative."""
        load = self.preload + self.contact.k_v * (self.normal * q).sum(axis=0)
        return self.contact.mu * np.maximum(load, 0.0)

    def __call__(self, t: np.ndarray, y: np.ndarray) -> np.ndarray:
        q, p, f = y[:2], y[2:4], y[4]
        limit = self.limit(q)
        friction = np.clip(f, -limit, limit)
        load = limit / self.contact.mu - np.maximum(self.preload, 0.0)
        force = self.push * np.sin(self.omega * t) - self.tangential * friction - self.normal * load
        rate = self.contact.k_u * (self.tangential * p).sum(axis=0)
        stuck = (np.abs(f) < limit) | (f * rate < 0.0)
        acceleration = force - self.damping * p - self.stiffness * q
        return np.concatenate((p, acceleration, [np.where(stuck, rate, 0.0)]))


def fixed_steps(rates: Rates, steps: int, cycles: int) -> np.ndarray:
    """Half the peak-to-peak of u in the last cycle, from rest, by `steps` Runge-Kutta steps a cycle."""
    h = 2.0 * np.pi / rates.omega / steps
    y = np.zeros((5, rates.omega.size))
    greatest, least = np.full(rates.omega.size, -np.inf), np.full(rates.omega.size, np.inf)
    for i in range(steps * cycles):
        t = i * h
        a = rates(t, y)
        b = rates(t + 0.5 * h, y + 0.5 * h * a)
        c = rates(t + 0.5 * h, y + 0.5 * h * b)
        d = rates(t + h, y + h * c)
        y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        limit = rates.limit(y[:2])
        y[4] = np.clip(y[4], -limit, limit)
        if i >= steps * (cycles - 1):
            u = (rates.tangential * y[:2]).sum(axis=0)
            greatest, least = np.maximum(greatest, u), np.minimum(least, u)
    return 0.5 * (greatest - least)


def seconds(call: Callable[[], Any], repeats: int = 1) -> tuple[float, Any]:
    """Median processor time of a call, and what it returned last."""
    times, result = [], None
    for _ in range(repeats):
        begin = time.process_time()
        result = call()
        times.append(time.process_time() - begin)
    return float(np.median(times)), result


def amplitudes(response: Response) -> np.ndarray:
    """Amplitude of u at each preload and frequency, of the upward and of the downward sweep."""
    out = np.empty((2, len(response.curves), FREQUENCIES.size))
    for k, curve in enumerate(response.curves):
        for i, way in enumerate(("up", "down")):
            chosen = curve.orbits.sweep == way
            order = np.argsort(curve.frequency[chosen])
            out[i, k] = curve.amplitude[chosen][order, 0]
    return out


def ten_preloads() -> None:
    scene = fcm.load_scene("yang1998")
    took, response = seconds(lambda: trace_exact(scene, FREQUENCIES))
    exact = amplitudes(response)  # of both sweeps; fixed steps from rest come to one of the two
    open_by = max(np.nanmax(curve.orbits.closure_error) for curve in response.curves)
    each = took / exact.size
    print(f"\namplitude of u at {FREQUENCIES.size} frequencies for each of {exact.shape[1]} preloads")
    print(
        f"  exact, upward and downward sweep     {took:8.2f} s   "
        f"{1e3 * each:6.1f} ms a motion; closed to {open_by:.1e}"
    )
    preloads = [curve.contacts[0].n_0 for curve in scene.each_curve()]
    preload, omega = np.meshgrid(preloads, FREQUENCIES, indexing="ij")
    rates = Rates(scene, preload.ravel(), omega.ravel())
    errors: list[float] = []
    for steps in STEPS:
        slow, amplitude = seconds(lambda steps=steps: fixed_steps(rates, steps, CYCLES))
        relative = np.abs(amplitude.reshape(exact.shape[1:]) / exact - 1.0).min(axis=0)
        errors.append(float(np.median(relative)))
        print(
            f"  {steps} steps a cycle, {CYCLES} cycles, all at once {slow:6.2f} s   "
            f"{1e3 * slow / omega.size:6.1f} ms a motion, {slow / omega.size / each:4.1f} times as long; "
            f"error {errors[-1]:.1e} median, {np.quantile(relative, 0.95):.1e} at 95 %"
        )
    order = np.log2(errors[-2] / errors[-1])
    print(f"  order of the median error: {order:.1f}")
    for same in SAME:
        times = (errors[-1] / same) ** (1.0 / order)
        print(
            f"  to a median error of {same:g}: {STEPS[-1] * times:.0f} steps a cycle, "
            f"{slow / omega.size / each * times:.0f} times as long"
        )


def one_frequency(omega: float = 1.3) -> None:
    """The same for one case alone, where arrays are of no help."""
    scene = fcm.load_scene("yang1998-n5")
    took, orbit = seconds(lambda: periodic(scene, omega), REPEATS)
    rates = Rates(scene, np.array([5.0]), np.array([omega]))
    slow, found = seconds(lambda: fixed_steps(rates, STEPS[0], CYCLES))
    error = abs(found[0] / orbit.measure.amplitude[0] - 1.0)
    print(f"\none steady motion, n_0 = 5, {omega} rad/s, from rest")
    print(f"  exact periodic solution {1e3 * took:29.1f} ms")
    print(
        f"  fixed steps, {STEPS[0]} a cycle, {CYCLES} cycles {1e3 * slow:14.0f} ms   "
        f"{slow / took:.0f} times as long, error {error:.1e}"
    )


def large(contacts: int = 4, modes: int = 50) -> Scene:
    """A structure of many modes with several contacts that slip and open, drawn at random."""
    rng = np.random.default_rng(0)
    dofs = 2 * contacts + 1
    shapes = rng.normal(size=(modes, dofs)) / np.sqrt(modes)
    frequency = np.sort(rng.uniform(1.0, 20.0, modes))
    names = tuple(f"x{i}" for i in range(dofs))
    unit = np.eye(dofs)
    made = tuple(
        Contact(f"c{j}", unit[2 * j], unit[2 * j + 1], 0.4, 1.0, 1.0, rng.uniform(0.0, 0.2))
        for j in range(contacts)
    )
    modal = Modal(names, np.ones(modes), frequency, np.full(modes, 0.01), shapes)
    return Scene("large", modal, made, (Force(unit[-1] + 0.3 * unit[1], 10.0, 0.0),), (0.8, 3.0), 0.05)


def of_a_period(name: str, scene: Scene, omega: float) -> None:
    """One period, the flows of a new frequency, the derivative, all that Newton's method needs."""
    orbit, problem = periodic(scene, omega), Shooting(scene)
    system, frequencies = EquationsOfMotion(scene, omega), itertools.count()
    y, states = entry(system, orbit.state)
    segments, _, _ = march(system, y, states, system.period)
    kernel, last = system.march(), len(segments) - 1
    x, end = problem.unknowns(orbit.state), segments.length[last]

    def period() -> None:
        kernel.begins(y, states, system.period, 10_000)
        assert kernel.go() == 0

    def elsewhere() -> None:
        system.flows.at(omega * (1.0 + 1e-9 * next(frequencies)))
        period()

    def newton() -> None:
        shot = problem.residual(x, omega * (1.0 + 1e-9 * next(frequencies)))
        assert shot.by_state.size and shot.by_parameter.size

    calls = {
        "a period": period,
        "with the flows of a new frequency": elsewhere,
        "its derivative": lambda: derivative_at(system, segments, last, end),
        "residual and derivatives, as an orbit needs": newton,
        "multipliers": lambda: problem.residual(x, omega).multipliers,
        "amplitudes, mean and fundamental": lambda: measure(orbit.cycle),
    }
    unit = sine()
    print(f"\n{name}: {len(segments)} segments, {' '.join(orbit.states)}")
    for what, call in calls.items():
        timer = timeit.Timer(call, timer=time.process_time)
        number, _ = timer.autorange()
        took = min(timer.repeat(REPEATS, number)) / number / unit
        print(f"  {what:44s} {took:10.0f} np.sin, {SINE * took:10.1f} us at 10 ns each")


def periods() -> None:
    of_a_period("the paper's oscillator, n_0 = 5", fcm.load_scene("yang1998-n5"), 1.3)
    of_a_period("4 contacts and 50 modes", large(), 1.5)


def aims() -> None:
    """One periodic solution: from a neighbouring one, and from nothing."""
    print("\none periodic solution, where np.sin takes 10 ns")
    scaled = 1e-3 * SINE / sine()  # [ms] of a second here
    for name, scene, omega in (
        ("the paper's oscillator, n_0 = 5", fcm.load_scene("yang1998-n5"), 1.3),
        ("4 contacts and 50 modes", large(), 1.5),
    ):
        beside = periodic(scene, omega - 0.01).state
        near, _ = seconds(lambda: periodic(scene, omega, beside), REPEATS)  # noqa: B023
        alone, orbit = seconds(lambda: periodic(scene, omega), REPEATS)  # noqa: B023
        print(
            f"  {name:34s} {scaled * near:8.2f} ms beside a known one, {scaled * alone:8.2f} ms from rest; "
            f"{' '.join(orbit.states)}"
        )


def main() -> None:
    print("processor times of one core; ratios carry over to other machines better than times")
    periods()
    aims()
    one_frequency()
    ten_preloads()


if __name__ == "__main__":
    main()
