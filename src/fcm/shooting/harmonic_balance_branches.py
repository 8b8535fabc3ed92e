"""Guesses for further branches of exact motions, from branches of the balance over the range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from fcm.continuation import Path
from fcm.continuation.corrector import Newton
from fcm.continuation.options import PATH
from fcm.model.scene import FloatArray, Scene
from fcm.shooting.harmonic_balance_state import computed_state
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.shooting.periodic_orbit import Poll
from fcm.shooting.problem import OrbitProblem, correct_at_frequency
from fcm.time_domain.state import State

if TYPE_CHECKING:
    from fcm.accuracy.unchecked_response import UncheckedResponse
    from fcm.harmonic_balance.system import System

Place = tuple[float, State]  # frequency [rad/s], and a guess there


def passes(path: Path, z: FloatArray, problem: OrbitProblem) -> bool:
    """Whether a path passes through the motion z, even between its points."""
    before, after = path.z[:-1], path.z[1:]
    rise, ahead = after[:, -1] - before[:, -1], z[-1] - before[:, -1]
    across = np.flatnonzero(ahead * (z[-1] - after[:, -1]) <= 0.0)
    if not across.size:
        return False
    problem.evaluate_scale(z)
    scale, newton = np.array(problem.scale), Newton(problem)
    share = np.divide(ahead, rise, out=np.zeros_like(rise), where=rise != 0.0)[across, None]
    guesses = before[across] + share * (after[across] - before[across])
    width = np.linalg.norm((after[across] - before[across]) / scale, axis=1)
    off = np.linalg.norm((guesses - z) / scale, axis=1)
    return any(
        _leads_to(newton, guess, z, scale) for guess in guesses[off <= width + PATH.solution_tolerance]
    )


def _leads_to(newton: Newton, guess: FloatArray, z: FloatArray, scale: FloatArray) -> bool:
    """Whether Newton's method converges from a guess to the motion z, at the frequency of z."""
    there = correct_at_frequency(newton, np.append(guess[:-1], z[-1]))
    return there and bool(np.linalg.norm((np.asarray(newton.z) - z) / scale) < PATH.solution_tolerance)


def is_stable(found: UncheckedResponse, z: FloatArray) -> bool:
    """Whether a solution (unknown + 1,) of a balance is stable."""
    from fcm.stability.floquet import multipliers_of

    of = multipliers_of(found.system, found.system.scene.frequency_range[1])
    return bool(of.classify(z, sufficient=(1.0,)).stable == 1.0)


def states_of_branches(
    scene: Scene, found: UncheckedResponse, options: ShootingOptions = SHOOTING
) -> Iterator[tuple[float, FloatArray, Iterator[Place]]]:
    """Yield each end and top of a balance's branches: its height, the point, and guesses around it.

    The nearest guesses come first.
    """
    for path, quantities in zip(found.traced.branches.paths, found.quantities, strict=True):
        around_tops = [
            (top, _around(even, top, options)) for top, even in _tops(path, quantities.amplitude, options)
        ]
        for top, points in [(0, iter([0])), (-1, iter([-1])), *around_tops]:
            guesses = (path.z[i] for i in points)
            yield (
                float(quantities.amplitude[top].max()),
                path.z[top],
                _guesses_at(scene, found.system.harmonics, guesses, options),
            )


def _tops(
    path: Path, amplitude: FloatArray, options: ShootingOptions = SHOOTING
) -> Iterator[tuple[int, npt.NDArray[np.bool_]]]:
    """Yield points inside a path where degrees of freedom are highest, with the mask they are chosen from.

    The mask (point,) has the points with an even number of real multipliers above 1.
    """
    even = path.parity > 0.0
    inside = (path.parameter > path.parameter.min()) & (path.parameter < path.parameter.max())
    places = np.flatnonzero(even & inside)
    if not places.size:
        return
    highest = np.unique(places[amplitude[places].argmax(axis=0)])
    apart = np.append(True, np.diff(highest) > options.balance.peak_spacing)
    for top in highest[apart].tolist():
        yield top, even


def _around(even: npt.NDArray[np.bool_], top: int, options: ShootingOptions = SHOOTING) -> Iterator[int]:
    """Yield a top and the points around it without a fold between, the nearest first."""
    for i in (top, *(top + way * step for step in options.balance.peak_offsets for way in (-1, 1))):
        if 0 <= i < len(even) and even[min(i, top) : max(i, top) + 1].all():
            yield i


def _guesses_at(
    scene: Scene,
    harmonics: tuple[int, ...],
    points: Iterator[FloatArray],
    options: ShootingOptions = SHOOTING,
) -> Iterator[Place]:
    """Guesses for exact motions from points of a balance."""
    for z in points:
        yield float(z[-1]), computed_state(scene, harmonics, z, options)


def converged_balance(
    scene: Scene, apart: bool, poll: Poll, options: ShootingOptions = SHOOTING
) -> Iterator[UncheckedResponse]:
    """Yield the response of the balance with every branch, from which branches of exact motions are found.

    With many contacts the balance has one harmonic. It is then used only if apart: the balance is known to
    have more solutions than motions were found.
    """
    from fcm.harmonic_balance.static_equilibrium import RestError

    whole = scene.whole()
    if not (whole.modal.frequency.all() and whole.contacts) or (
        len(whole.contacts) >= options.balance.many_contacts and not apart
    ):
        return
    with suppress(RestError):
        yield every_balance(whole, poll, options)


def every_balance(whole: Scene, poll: Poll, options: ShootingOptions = SHOOTING) -> UncheckedResponse:
    """The response of the balance with every branch, and as many harmonics as its accuracy needs.

    These include the harmonics with which symmetric motions lose their symmetry. With many contacts the
    balance has one harmonic.
    """
    from fcm.accuracy.further_levels import with_levels_below_peaks
    from fcm.accuracy.refinement import refined_response, retrace
    from fcm.accuracy.unchecked_response import unchecked_response
    from fcm.branches.symmetry_loss import symmetry_loss

    single = _single_harmonic(whole, poll, options)
    if len(whole.contacts) >= options.balance.many_contacts:
        return unchecked_response(single)
    found = refined_response(single, options.balance.accuracy)
    if not found.quantities:
        return found
    found = with_levels_below_peaks(found, options.balance.accuracy)
    every = found.with_every_branch()
    lost = symmetry_loss(every.system, every.traced).harmonics
    if lost:
        more = tuple(sorted({*found.system.harmonics, *lost}))
        again = retrace(found, more, options.balance.accuracy)
        every = again.with_every_branch() if again else every
    return every


def states_across(
    scene: Scene, frequencies: Sequence[float], poll: Poll, options: ShootingOptions = SHOOTING
) -> dict[float, list[State]]:
    """Guesses where branches of the balance cross frequencies [rad/s] within the scene's range."""
    from fcm.harmonic_balance.static_equilibrium import RestError

    whole, (low, high) = scene.whole(), scene.frequency_range
    inside = [omega for omega in frequencies if low <= omega <= high]  # empty without a range
    if not (inside and whole.contacts and whole.modal.frequency.all()):
        return {}
    try:
        found = _branches_with_few_harmonics(_single_harmonic(whole, poll, options), options)
    except RestError:
        return {}
    harmonics, paths = found.system.harmonics, found.traced.branches.paths
    return {
        omega: [computed_state(scene, harmonics, z, options) for z in _crossings(paths, omega)]
        for omega in inside
    }


def _crossings(paths: Sequence[Path], omega: float) -> Iterator[FloatArray]:
    """Yield the points of paths at a frequency, by linear interpolation."""
    for path in paths:
        before, after = path.z[:-1], path.z[1:]
        ahead, rise = omega - before[:, -1], after[:, -1] - before[:, -1]
        for k in np.flatnonzero(ahead * (omega - after[:, -1]) <= 0.0):
            share = ahead[k] / rise[k] if rise[k] else 0.0
            yield np.append((before[k] + share * (after[k] - before[k]))[:-1], omega)


def _single_harmonic(whole: Scene, poll: Poll, options: ShootingOptions) -> System:
    """The system with one harmonic."""
    from fcm.harmonic_balance.system import System

    one = System(whole, (1,), other_options=options.balance.others)
    one.work.poll = poll
    return one


def _branches_with_few_harmonics(one: System, options: ShootingOptions = SHOOTING) -> UncheckedResponse:
    """The branches with a few harmonics, or with one for many contacts."""
    from fcm.accuracy.unchecked_response import unchecked_response

    return unchecked_response(
        one
        if len(one.scene.contacts) >= options.balance.many_contacts
        else one.with_harmonics(options.balance.harmonics)
    )
