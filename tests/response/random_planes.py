"""Random scenes of contacts in a plane against marches in time: ``make study-plane`` prints what came of it.

One to three contacts in a plane, two to six modes. Of each scene the highest peak is sought with the
harmonics that an accuracy takes. The whole motion of all scenes at once is marched, at three frequencies
around it, by central differences with radial return. Of three steps the errors of first and second order are
extrapolated; a parabola has the top. Beside it a motion from a disturbed state is marched: whether both come
together tells stability.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fcm.model.scene import FloatArray, Scene
from fcm.response import trace
from fcm.results.result import Curve
from fcm.scene import scene_from_dict

if __package__:
    from .in_time import in_time
else:  # run as a program
    sys.path.append(str(Path(__file__).parent))
    from in_time import in_time

ACCURACY = 1e-2
SMALLEST = 1e-4  # error, below which an estimate is not compared with it
SECONDS = 20  # of a processor, for a scene
STEPS, PERIODS = 100, 80  # of a period, of the longest of three; periods that are marched
LITTLE = 1e-4  # of the motion, a disturbance
ASIDE = 2e-3  # relative, frequencies beside the peak
MODES, CONTACTS = 6, 3  # at most


class Traced(NamedTuple):
    """The highest peak of a scene, the degree of freedom that has it, and the state of the modes there."""

    amplitude: float
    frequency: float
    estimate: float
    stable: float
    shape: FloatArray  # (mode,) of that degree of freedom
    q: FloatArray
    p: FloatArray


def random_plane(seed: int) -> Scene:
    """Contacts between the ground and three degrees of freedom each; the lowest mode is at 1."""
    rng = np.random.default_rng(seed)
    contacts, modes = int(rng.integers(1, 4)), int(rng.integers(2, 7))
    dofs = [f"{axis}{c}" for c in range(contacts) for axis in "xyz"]
    dofs += [f"e{i}" for i in range(modes - len(dofs))]  # so that displacements tell how all modes move
    shapes = rng.normal(size=(modes, len(dofs)))
    frequency = np.concatenate(([1.0], np.sort(rng.uniform(1.0, 3.0, modes - 1))))
    data = {
        "modal": {
            "dofs": dofs, "mass": [1.0] * modes, "frequency": frequency.tolist(),
            "damping": (10.0 ** rng.uniform(-2.0, -1.0, modes)).tolist(), "shapes": shapes.tolist(),
        },
        "contact": [
            {
                "name": f"c{c}", "tangential": [f"x{c}", f"y{c}"], "normal": f"z{c}",
                "mu": float(rng.uniform(0.1, 1.0)), "k_u": float(10.0 ** rng.uniform(-1.0, 0.5)),
                "k_v": float(10.0 ** rng.uniform(-1.0, 0.5)), "n_0": float(10.0 ** rng.uniform(-1.0, 1.0)),
            }
            for c in range(contacts)
        ],
        "force": [
            {"dof": dof, "amplitude": 1.0, "phase": float(rng.uniform(0.0, 2.0 * pi))}
            for dof in rng.choice(dofs, 2, replace=False)
        ],
        "response": {"frequency": [0.6, 1.6], "harmonics": 1},
    }  # fmt: skip
    return replace(scene_from_dict(data), harmonics=None)


def traced(seed: int) -> Traced:
    scene = random_plane(seed)
    curve = trace(scene, method="closed-form", accuracy=ACCURACY).curves[0]
    names = [name for name, one in curve.peaks.items() if np.isfinite(one.amplitude)]
    name = max(names, key=lambda one: curve.peaks[one].amplitude)
    top, d = curve.peaks[name], scene.modal.dofs.index(name)
    state = _start(scene, curve, int(np.nanargmax(curve.amplitude[:, d])))
    return Traced(top.amplitude, top.frequency, top.error, top.stable, scene.modal.shapes[:, d], *state)


def _start(scene: Scene, curve: Curve, row: int) -> tuple[FloatArray, FloatArray]:
    """Displacements and velocities of the modes at the beginning of a period."""
    omega = curve.frequency[row]
    if curve.harmonic is None:
        X = (curve.amplitude[row] * np.exp(1j * curve.phase[row]))[None]
        order = np.ones(1)
    else:
        X, order = curve.harmonic[row], np.array(curve.harmonics)
    x, rate = curve.mean[row] + X.imag.sum(axis=0), omega * (order @ X.real)
    back = np.linalg.pinv(scene.modal.shapes.T)
    return back @ x, back @ rate


def padded(rows: list[FloatArray], *shape: int) -> FloatArray:
    """Arrays in the first places of an array of zeros each, (row, *shape)."""
    found = np.zeros((len(rows), *shape))
    for into, one in zip(found, rows, strict=True):
        into[tuple(slice(n) for n in one.shape)] = one
    return found


class March:
    """Scenes (scene,) with several motions each, one behind the other in time."""

    def __init__(self, scenes: list[Scene], shape: FloatArray) -> None:
        modal = [one.modal for one in scenes]
        self.frequency = padded([one.frequency for one in modal], MODES)[:, None]
        self.damping = padded([one.damping for one in modal], MODES)[:, None]
        self.shape, self.scenes = shape[:, None], scenes
        ports = [
            np.stack([(one.modal.shapes @ np.array(c.directions).T) for c in one.contacts], axis=1)
            for one in scenes
        ]
        self.ports = padded(ports, MODES, CONTACTS, 3).reshape(len(scenes), MODES, 3 * CONTACTS)
        self.k_u, self.k_v, self.mu, self.n_0 = (
            padded([np.array([getattr(c, key) for c in one.contacts]) for one in scenes], CONTACTS)[:, None]
            for key in ("k_u", "k_v", "mu", "n_0")
        )

    def push(self, steps: int) -> FloatArray:
        """Forces on the modes (step, scene, 1, mode): of each amplitude sin(omega t + phase)."""
        turn = np.exp(2j * pi * np.arange(steps) / steps)
        found = np.zeros((steps, len(self.scenes), 1, MODES))
        for i, scene in enumerate(self.scenes):
            for one in scene.forces:
                wave = one.amplitude * (turn * np.exp(1j * one.phase)).imag
                found[:, i, 0, : len(scene.modal.mass)] += np.outer(wave, scene.modal.shapes @ one.direction)
        return found

    def run(
        self, omega: FloatArray, steps: int, q: FloatArray, p: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """From states (scene, motion, mode): half the peak-to-peak of the last period (scene, motion), and
        states and sliders at the beginning of each, (period, scene, motion, mode or contact)."""
        h = 2.0 * pi / omega[..., None] / steps
        damped, stiff = self.damping * self.frequency * h, self.frequency**2
        push, back = self.push(steps), np.swapaxes(self.ports, 1, 2).copy()
        divisor = np.where(self.k_u > 0.0, self.k_u, 1.0)[..., None]
        force = np.empty((*q.shape[:2], CONTACTS, 3))
        w = (q @ self.ports).reshape(force.shape)[..., :2].copy()
        path, places, sliders = np.empty((steps, *omega.shape)), [], []

        def contact(q: FloatArray) -> FloatArray:
            nonlocal w
            u = (q @ self.ports).reshape(force.shape)
            n = np.maximum(self.n_0 + self.k_v * u[..., 2], 0.0)
            f = self.k_u[..., None] * (u[..., :2] - w)
            size = np.sqrt(f[..., 0] ** 2 + f[..., 1] ** 2)
            f *= np.minimum(1.0, self.mu * n / np.maximum(size, 1e-300))[..., None]
            w = u[..., :2] - f / divisor
            force[..., :2], force[..., 2] = f, n - np.maximum(self.n_0, 0.0)
            return force.reshape(*q.shape[:2], 3 * CONTACTS) @ back

        g = push[0] - stiff * q - contact(q)
        for _ in range(PERIODS):
            places.append(q)
            sliders.append(w)
            for k in range(steps):
                p = p * (1.0 - damped) + 0.5 * h * g
                q = q + h * p
                g = push[(k + 1) % steps] - stiff * q - contact(q)
                p = (p + 0.5 * h * g) / (1.0 + damped)
                path[k] = (q * self.shape).sum(axis=-1)
        top = np.zeros(omega.shape)
        for x in (path, -path):
            k = x.argmax(axis=0)[None]
            low, here, high = (np.take_along_axis(x, np.mod(k + i, steps), axis=0)[0] for i in (-1, 0, 1))
            bend = 2.0 * here - low - high
            top += 0.5 * (
                here + np.where(bend > 0.0, (high - low) ** 2 / (8.0 * np.maximum(bend, 1e-300)), 0.0)
            )
        return top, np.array(places), np.array(sliders)


def marched(seeds: list[int], found: list[Traced]) -> tuple[FloatArray, FloatArray]:
    """True errors (scene,), NaN where no top is beside the peak, and whether disturbances died out."""
    frequency, amplitude = (
        np.array([getattr(one, key) for one in found]) for key in ("frequency", "amplitude")
    )
    omega = frequency[:, None] * np.array([1.0 - ASIDE, 1.0, 1.0 + ASIDE, 1.0])
    shape, q, p = (padded([getattr(one, key) for one in found], MODES) for key in ("shape", "q", "p"))
    march = March([random_plane(seed) for seed in seeds], shape)
    q, p = np.repeat(q[:, None], 4, axis=1), np.repeat(p[:, None], 4, axis=1)
    q[:, 3] += LITTLE * q[:, 3] * np.random.default_rng(0).standard_normal(q[:, 3].shape)
    heights, apart = [], np.empty(0)
    for times in (1, 2, 4):
        top, places, sliders = march.run(omega, times * STEPS, q, p)
        heights.append(top[:, :3])
        apart = np.abs(places[:, :, 3] - places[:, :, 1]).max(axis=-1)
        apart = apart + np.abs(sliders[:, :, 3] - sliders[:, :, 1]).max(axis=(-2, -1))
    first = 2.0 * heights[1] - heights[0], 2.0 * heights[2] - heights[1]
    low, middle, high = ((4.0 * first[1] - first[0]) / 3.0).T
    bend = 2.0 * middle - low - high
    true = middle + np.where(bend > 0.0, (high - low) ** 2 / (8.0 * np.maximum(bend, 1e-300)), 0.0)
    error = np.abs(amplitude / true - 1.0)
    beside = (np.abs(high - low) <= 2.0 * bend) & (error < 0.5)
    return np.where(beside, error, np.nan), apart[-5:].max(axis=0) < apart[:5].max(axis=0)


def percent(which: FloatArray) -> str:
    return f"{100.0 * np.mean(which):.0f} % of {which.size}" if which.size else "-"


def main(count: int = 200, at_once: int = 2) -> None:
    done = dict(in_time(traced, range(count), SECONDS, at_once))
    seeds = sorted(seed for seed, one in done.items() if one is not None)
    found = [one for seed in seeds if (one := done[seed]) is not None]
    error, returns = marched(seeds, found)
    told, stable = (np.array([getattr(one, key) for one in found]) for key in ("estimate", "stable"))
    beside, known = np.isfinite(error), np.isfinite(stable)
    both = beside & np.isfinite(told)
    compared = both & (np.maximum(error, told) > SMALLEST)
    ratio = told[compared] / np.maximum(error[compared], 1e-300)
    print(
        f"The highest peaks of {count} random scenes of contacts in a plane, accuracy {ACCURACY:g}, marched"
    )
    print(f"{beside.sum():5d}  with a marched peak beside; median error {np.median(error[beside]):.1e}")
    print(f"       within the accuracy: {percent(error[beside] <= ACCURACY)}")
    print(f"       within it, of those whose error is told: {percent(error[both] <= ACCURACY)}")
    print(f"       errors told true within a factor of two: {percent((ratio >= 0.5) & (ratio <= 2.0))}")
    low = both & (error > np.maximum(3.0 * told, SMALLEST))
    print(f"       low by more than three (seed, told, true): "
          f"{[(seeds[i], told[i].item(), error[i].item()) for i in np.flatnonzero(low)]}")  # fmt: skip
    agree = (stable > 0.5) == returns
    print(f"       stability as the march says: {percent(agree[known])}")
    print(f"       of another: {[seeds[i] for i in np.flatnonzero(known & ~agree)]}")
    late = sorted(set(range(count)) - set(seeds))
    print(f"{len(late):5d}  not done within {SECONDS} s of a processor, or failed: {late}")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
