"""Random scenes of contacts in a plane against marches in time: ``make study-plane`` prints what came of it.

One to three contacts in a plane, two to six modes. Of each scene the highest peak is sought with the
harmonics that an accuracy takes. The whole motion is marched by central differences, of all scenes at once.
In a step the sliders are moved by radial return, once and in two halves, which errs by the first order, and
the two are extrapolated to the second. Steps are halved twice, and the changes say how far the march errs:
the last, or half the one before, as openings fall between steps, where the order is the first.

The march begins with the balance's state, sliders too. It has the peak by a parabola through three
frequencies, the middle one where the balance has its own, and by another one half as wide: where these differ
the peak is a corner. Where one of the three is on another branch, and at the ends of the range, its motion at
the balance's peak is compared.

A contact that never slips may rest at any place of a range, and the motion is another with each. What the
motion pushes its slider before it is steady is therefore undone, in the first half of the periods.

A peak is stable by the march where the motion that begins with the balance's state stays there, and one that
is disturbed comes back to it.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from itertools import pairwise
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fcm.contact.plane.loop import planar_loop
from fcm.model.scene import FloatArray, Scene
from fcm.response import trace
from fcm.results.result import Curve
from fcm.scene import scene_from_dict

if __package__:
    from .in_time import in_time
    from .random_peaks import ACCURACY, SAME, Peak, report
else:  # run as a program
    sys.path.append(str(Path(__file__).parent))
    from in_time import in_time
    from random_peaks import ACCURACY, SAME, Peak, report

SECONDS = 60  # of a processor, for a scene
STEPS = 200  # of a period, at first; they are halved twice
PERIODS = 80  # that are marched with each of the steps
LITTLE = 1e-3  # of the motion, a disturbance
LEFT = 0.1  # relative change of an amplitude, from which on a motion has left its solution
ASIDE = 2e-3  # relative, from a frequency to the next
JUMPS = 0.05  # relative, from one of three amplitudes to the next, if it is on another branch
TIMES = 2.0  # an error that is smaller than so many changes by the last steps is not known
SPAN = (0.7, 2.2)  # of the response
MODES, CONTACTS = 6, 3  # at most


class Traced(NamedTuple):
    """The highest peak of a scene, and the state of the modes and sliders there."""

    amplitude: float
    frequency: float
    estimate: float
    stable: float
    shape: FloatArray  # (mode,) of the degree of freedom that has it
    q: FloatArray
    p: FloatArray
    w: FloatArray  # (contact, 2), the sliders
    rests: FloatArray  # (contact,), 1 of one that never slips


def random_plane(seed: int, contacts: int = CONTACTS) -> Scene:
    """At most so many contacts between the ground and three degrees of freedom each; without them the lowest
    mode is at 1."""
    rng = np.random.default_rng(seed)
    contacts, modes = int(rng.integers(1, contacts + 1)), int(rng.integers(2, MODES + 1))
    dofs = [f"{axis}{c}" for c in range(contacts) for axis in "xyz"]
    dofs += [f"e{i}" for i in range(modes - len(dofs))]  # so that displacements tell how all modes move
    shapes = 0.6 * rng.normal(size=(modes, len(dofs)))
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
                "k_v": float(10.0 ** rng.uniform(-1.0, 0.5)), "n_0": float(10.0 ** rng.uniform(-1.5, 0.5)),
            }
            for c in range(contacts)
        ],
        "force": [
            {"dof": dof, "amplitude": 1.0, "phase": float(rng.uniform(0.0, 2.0 * pi))}
            for dof in rng.choice(dofs, 2, replace=False)
        ],
        "response": {"frequency": list(SPAN), "harmonics": 1},
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


def _start(scene: Scene, curve: Curve, row: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Displacements and velocities of the modes as a period begins, places of the sliders, and which rest."""
    omega = curve.frequency[row]
    if curve.harmonic is None:
        X = (curve.amplitude[row] * np.exp(1j * curve.phase[row]))[None]
        order = [1]
    else:
        X, order = curve.harmonic[row], list(curve.harmonics)
    x, rate = curve.mean[row] + X.imag.sum(axis=0), omega * (np.array(order) @ X.real)
    back = np.linalg.pinv(scene.modal.shapes.T)
    # x = mean + Im sum X_h exp(i h theta) = Re sum X_h / i exp(i h theta)
    whole = np.zeros((max(order) + 1, X.shape[1]), complex)
    whole[0], whole[order] = curve.mean[row], X / 1j
    motions = [(whole @ np.array(c.directions).T).T for c in scene.contacts]
    loops = [planar_loop(*u, c.mu, c.k_u, c.k_v, c.n_0) for u, c in zip(motions, scene.contacts, strict=True)]
    rests = np.array([float(loop.sequence == "E") for loop in loops])
    return back @ x, back @ rate, np.array([loop.slider(0.0) for loop in loops]), rests


def padded(rows: list[FloatArray], *shape: int) -> FloatArray:
    """Arrays in the first places of an array of zeros each, (row, *shape)."""
    found = np.zeros((len(rows), *shape))
    for into, one in zip(found, rows, strict=True):
        into[tuple(slice(n) for n in one.shape)] = one
    return found


class State(NamedTuple):
    """Displacements and velocities of the modes, and the sliders, (scene, motion, ...)."""

    q: FloatArray
    p: FloatArray
    w: FloatArray

    def of(self, motion: int, times: int) -> State:
        """So often that of one motion."""
        return State(*(np.repeat(one[:, motion][:, None], times, axis=1) for one in self))


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
        self, omega: FloatArray, steps: int, state: State, place: FloatArray
    ) -> tuple[FloatArray, list[State]]:
        """From a state at omega (scene, motion): half the peak-to-peak of the last period (scene, motion),
        and the states at the beginnings of all and at the end of the last. Sliders are brought back to their
        place (scene, 1, contact, 2), if it is not NaN, in the first half of the periods."""
        q, p, w = state
        h = 2.0 * pi / omega[..., None] / steps
        damped, stiff = self.damping * self.frequency * h, self.frequency**2
        push, back = self.push(steps), np.swapaxes(self.ports, 1, 2).copy()
        divisor = np.where(self.k_u > 0.0, self.k_u, 1.0)[..., None]
        force = np.empty((*q.shape[:2], CONTACTS, 3))
        before = (q @ self.ports).reshape(force.shape)
        path, states = np.empty((steps, *omega.shape)), []

        def held(u: FloatArray, w: FloatArray) -> tuple[FloatArray, FloatArray]:
            """The friction, back on its disc, and where the slider is then."""
            n = np.maximum(self.n_0 + self.k_v * u[..., 2], 0.0)
            f = self.k_u[..., None] * (u[..., :2] - w)
            size = np.sqrt(f[..., 0] ** 2 + f[..., 1] ** 2)
            f *= np.minimum(1.0, self.mu * n / np.maximum(size, 1e-300))[..., None]
            return f, u[..., :2] - f / divisor

        def contact(q: FloatArray) -> FloatArray:
            nonlocal w, before
            u = (q @ self.ports).reshape(force.shape)
            _, once = held(u, w)
            _, twice = held(u, held(0.5 * (before + u), w)[1])
            f, w = held(u, 2.0 * twice - once)
            before = u
            n = np.maximum(self.n_0 + self.k_v * u[..., 2], 0.0)
            force[..., :2], force[..., 2] = f, n - np.maximum(self.n_0, 0.0)
            return force.reshape(*q.shape[:2], 3 * CONTACTS) @ back

        g = push[0] - stiff * q - contact(q)
        for period in range(PERIODS):
            if period < PERIODS // 2:
                w = np.where(np.isnan(place), w, place)
            states.append(State(q, p, w))
            for k in range(steps):
                p = p * (1.0 - damped) + 0.5 * h * g
                q = q + h * p
                g = push[(k + 1) % steps] - stiff * q - contact(q)
                p = (p + 0.5 * h * g) / (1.0 + damped)
                path[k] = (q * self.shape).sum(axis=-1)
        return 0.5 * (crest(path) + crest(-path)), [*states, State(q, p, w)]


def crest(x: FloatArray) -> FloatArray:
    """The greatest of x (step, ...) over a period, between the steps by a parabola."""
    k = x.argmax(axis=0)[None]
    low, here, high = (np.take_along_axis(x, np.mod(k + i, len(x)), axis=0)[0] for i in (-1, 0, 1))
    return here + beyond(low, here, high)


def beyond(low: FloatArray, here: FloatArray, high: FloatArray) -> FloatArray:
    """By how much the top of a parabola through three points is above the middle one."""
    bend = 2.0 * here - low - high
    return np.where(bend > 0.0, (high - low) ** 2 / (8.0 * np.maximum(bend, 1e-300)), 0.0)


def halved(march: March, omega: FloatArray, state: State, place: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Amplitudes (scene, motion) of steps halved twice, and how far they err."""
    heights = []
    for times in (1, 2, 4):
        height, states = march.run(omega, times * STEPS, state, place)
        heights.append(height)
        state = states[-1]
    before, last = (np.abs(b - a) for a, b in pairwise(heights))
    return heights[2], np.maximum(last, 0.5 * before)


def marched(seeds: list[int], found: list[Traced]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """True errors (scene,), NaN where the march has no such peak; how far it errs, and 1 if it is stable."""
    told, amplitude = (np.array([getattr(one, key) for one in found]) for key in ("frequency", "amplitude"))
    shape, q, p = (padded([getattr(one, key) for one in found], MODES) for key in ("shape", "q", "p"))
    w = padded([one.w for one in found], CONTACTS, 2)
    rests = padded([one.rests for one in found], CONTACTS)
    place = np.where(rests[..., None] > 0.0, w, np.nan)[:, None]
    march = March([random_plane(seed) for seed in seeds], shape)
    balance = State(q[:, None], p[:, None], w[:, None])

    # at the frequency of the peak, and disturbed; and beside it
    beside = np.clip(told[:, None] * (1.0 + ASIDE * np.array([-1.0, 1.0, -0.5, 0.5])), *SPAN)
    omega = np.concatenate((told[:, None], told[:, None], beside), axis=1)
    state, rng = balance.of(0, omega.shape[1]), np.random.default_rng(0)
    for one in state[:2]:
        one[:, 1] *= 1.0 + LITTLE * rng.standard_normal(one[:, 1].shape)
    height, change = halved(march, omega, state, place)
    # the longest step may be unstable by itself
    _, states = march.run(omega[:, :2], 2 * STEPS, State(*(one[:, :2] for one in state)), place)
    apart = np.array([np.abs(one.q[:, 1] - one.q[:, 0]).max(axis=-1) for one in states])
    apart += np.array([np.abs(one.w[:, 1] - one.w[:, 0]).max(axis=(-2, -1)) for one in states])
    middle = height[:, 0]
    stays = np.abs(middle / amplitude - 1.0) < LEFT
    stable = stays & (apart[-5:].max(axis=0) < apart[:5].max(axis=0))

    end = (np.abs(told - SPAN[0]) < 1e-9) | (np.abs(told - SPAN[1]) < 1e-9)
    wide, narrow = (middle + np.where(end, 0.0, over(middle, *height[:, i : i + 2].T)) for i in (2, 4))
    error = np.abs(amplitude / narrow - 1.0)
    uncertain_at = (change[:, 0] + np.abs(wide - narrow)) / middle
    return np.where(error < SAME, error, np.nan), uncertain_at, stable.astype(np.float64)


def over(middle: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """By how much the top of a parabola is above the middle of three amplitudes of one branch; else 0."""
    one_branch = np.maximum(np.abs(low - middle), np.abs(high - middle)) < JUMPS * middle
    inside = np.abs(high - low) <= 4.0 * (2.0 * middle - low - high)
    return np.where(one_branch & inside, beyond(low, middle, high), 0.0)


def main(count: int = 200, at_once: int = 2, first: int = 0) -> None:
    done = dict(in_time(traced, range(first, count), SECONDS, at_once))
    told({seed: one for seed, one in sorted(done.items()) if one is not None})
    late = sorted(seed for seed, one in done.items() if one is None)
    print(f"not done within {SECONDS} s of a processor, or failed: {len(late)}: {late}")


def told(done: dict[int, Traced]) -> None:
    """Print what became of scenes."""
    seeds, found = list(done), list(done.values())
    error, change, stable = marched(seeds, found)
    print(
        f"The highest peaks of {len(seeds)} random scenes in the plane, accuracy {ACCURACY:g}, and marches;"
    )
    estimate = np.array([one.estimate for one in found])
    known = np.maximum(np.nan_to_num(error, nan=1.0), np.nan_to_num(estimate)) >= TIMES * change
    report(
        [
            Peak(seed, len(random_plane(seed).contacts), one.estimate, true)
            for seed, one, true, so in zip(seeds, found, error.tolist(), known.tolist(), strict=True)
            if so
        ]
    )
    print(f"of less than the march errs by: {[seeds[i] for i in np.flatnonzero(~known)]}")
    verdict = np.array([one.stable for one in found])
    known = np.isfinite(verdict)
    same = (verdict > 0.5) == (stable > 0.5)
    print(f"stability as the march says: {same[known].sum()} of {known.sum()} that tell it")
    print(f"of another: {[seeds[i] for i in np.flatnonzero(known & ~same)]}")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:]))
