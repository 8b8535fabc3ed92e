"""Branches that a response lacks, hunted by marching from random states and by deflation; no part of a run.

usage: python -m tests.branches.hunt meets|stops [FIRST LAST [SECONDS]] [--deflate] [--exact]

A march that settles at a motion of one period, where contacts do more than stick or stay open, is at a stable
one: it has to be on a branch. Deflation (Farrell, Birkisson, Funke 2015) turns Newton's method away from the
solutions that it has found, and so finds others, stable or not.
"""

import sys
import time
from dataclasses import dataclass

import numpy as np

import fcm
from fcm.harmonic_balance.dense_jacobian import jacobian_of
from fcm.harmonic_balance.system import System
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.time_domain import State, simulate

from .relatives import EACH, KINDS

ACCURACY = 1e-2
NEAR = 0.03  # of the greatest amplitude: a march this near to a branch is on it,
TIMES = 3.0  # or within so many times the error that is told there,
UNTOLD = 0.5  # or within this, where none is
SETTLED = 1e-4  # by which the amplitudes of the last cycles of a march differ
CYCLES, LAST = 400, 4
ITERATIONS = 60  # of Newton's method
FAR = 10.0  # times the greatest displacement known, within which random states and guesses lie


@dataclass(frozen=True)
class Miss:
    """What is on no branch: the frequency [rad/s], the amplitudes (dof,), and how it was found."""

    frequency: float
    amplitude: np.ndarray
    found_by: str


def passings(curve, omega):
    """Amplitudes (passing, dof) of the branches at a frequency, and how far a motion may be from them."""
    off = curve.frequency - omega
    places = np.flatnonzero(off[:-1] * off[1:] <= 0.0)
    part = (off[places] / (off[places] - off[places + 1]))[:, None]
    error = np.maximum(curve.error[places], curve.error[places + 1])
    near = np.maximum(NEAR, np.where(np.isnan(error), UNTOLD, TIMES * error))
    return (1.0 - part) * curve.amplitude[places] + part * curve.amplitude[places + 1], near


def on_branch(curve, omega, amplitude):
    """Whether a branch has amplitudes (dof,) at a frequency: beside an antiresonance one of them is small,
    and off by much of itself between two points."""
    amplitudes, near = passings(curve, omega)
    return bool((np.abs(amplitudes - amplitude) < near * amplitude.max()).all(axis=1).any())


def marched(scene, curve, frequencies, tries, seed=0):
    """The stable motions on no branch that marches from random states settle at."""
    rng, modes = np.random.default_rng(seed), len(scene.modal.frequency)
    size = FAR * np.nanmax(curve.amplitude) / 10.0
    for omega in frequencies:
        for _ in range(tries):
            q, velocity = rng.normal(0.0, size, (2, modes))
            begin = State(q, omega * velocity, np.zeros(len(scene.contacts)))
            last = [one.amplitude for one in simulate(scene, omega, CYCLES, begin).measures(last=LAST)]
            settled = np.ptp(last, axis=0).max() < SETTLED * np.max(last)
            if settled and not on_branch(curve, omega, last[-1]):
                yield Miss(omega, last[-1], "a march")


def deflated(scene, curve, frequencies, tries, seed=0):
    """The solutions of the balance on no branch that Newton's method finds turned away from those known."""
    rng, system = np.random.default_rng(seed), System(scene, curve.harmonics)
    balance = system.new_balance()
    for omega in frequencies:
        known = list[np.ndarray]()
        for _ in range(tries):
            x = rng.normal(0.0, np.nanmax(curve.amplitude), balance.unknowns)
            x = _newton(balance, x, omega, known)
            if x is None:
                continue
            known.append(x)
            z = np.append(x, omega)
            balance.evaluate(z)
            balance.evaluate_outputs(z, np.zeros(z.size))
            amplitude = np.array(balance.output)
            if not on_branch(curve, omega, amplitude):
                yield Miss(omega, amplitude, "deflation")


def _newton(balance, x, omega, known):
    """A solution that is none of those known; None where there is none near."""
    for _ in range(ITERATIONS):
        balance.evaluate(np.append(x, omega))
        step = -np.linalg.solve(jacobian_of(balance)[:, :-1], np.array(balance.residual))
        size, slope = 1.0, np.zeros_like(x)  # of the operator prod(1 + 1/|x - x_i|^2)
        for one in known:
            square = float((x - one) @ (x - one))
            factor = 1.0 + 1.0 / square
            slope = slope * factor + size * (-2.0 * (x - one) / square**2)
            size *= factor
        share = 1.0 / (1.0 - float(slope @ step) / size) if known else 1.0
        length = abs(share) * np.linalg.norm(step) or 1.0
        x = x + step * share * min(1.0, max(np.linalg.norm(x), 1.0) / length)
        if np.linalg.norm(step) < 1e-10 * max(np.linalg.norm(x), 1.0):
            return x
    return None


class ExactCurve:
    """What a response of exact motions has of a curve."""

    def __init__(self, scene):
        found = fcm.respond(scene, method="exact").isel(curve=0)
        self.frequency = found.frequency.values
        self.amplitude = found.amplitude.transpose("point", "dof").values
        self.error = np.zeros_like(self.amplitude)


def hunt(scene, looks=5, tries=6, deflate=False, exact=False):
    """What the response of a scene by default, or by exact motions, lacks at some frequencies."""
    curve = ExactCurve(scene) if exact else traced_curve(scene, Request(None, ACCURACY))
    low, high = scene.frequency_range
    frequencies = np.linspace(low, high, looks + 2)[1:-1]
    yield from marched(scene, curve, frequencies, tries)
    if deflate:
        yield from deflated(scene, curve, frequencies, 3 * tries)


def main(arguments):
    """Hunt in scenes of a kind, and say what was found."""
    kind, *numbers = (one for one in arguments if not one.startswith("--"))
    if {"--deflate", "--exact"} <= {*arguments}:
        sys.exit("--deflate looks for solutions of the balance: leave out --exact")
    first, last, seconds = (*map(int, numbers), *(0, EACH, sys.maxsize)[len(numbers) :])
    count, seed = 0, first - 1
    for seed in range(first, last):
        if time.process_time() > seconds:
            seed -= 1
            break
        ways = {way: f"--{way}" in arguments for way in ("deflate", "exact")}
        for miss in hunt(KINDS[kind](seed), **ways):
            count += 1
            at = f"{miss.amplitude} at {miss.frequency:.6g} by {miss.found_by}"
            print(f"{kind} {seed}: {at}", flush=True)
    print(f"{count} missed in {kind} {first} to {seed}, {time.process_time():.0f} s")


if __name__ == "__main__":
    main(sys.argv[1:])
