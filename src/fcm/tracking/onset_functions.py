r"""Onset functions: signed functions of the state of a contact over a cycle, for any number of harmonics.

With p = k_u u and the load n = n_0 + k_v v, here also negative:

    separation  min n                               negative where the contact opens at some time
    closing     max n                               negative where it is open throughout
    slip        min(p + mu n) - max(p - mu n)       negative where a contact that is closed must slip

A slider that rests at k_u w needs |p - k_u w| <= mu n at all times; such a w exists while "slip" is not
negative. Two more functions matter only for corners, at contacts that do not slip. A slider that began at 0
rests there while

    upper limit  min(p + mu n)                      is positive, and
    lower limit  max(p - mu n)                      negative; else at the limit

In a plane the slider must be in the discs about p of radius mu n. Let t be the least growth of their radii
with which they have a common point. Then -2 t corresponds to "slip" on a line, and a slider that began at 0
rests there while

    start        min(mu n - |p|)                    is positive.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.contact.plane.margins import PlanarMargins
from fcm.harmonic_balance.contact_law import KernelLaw, Law
from fcm.model.scene import FloatArray
from fcm.structure.layout import layout_of
from fcm.tracking.options import TRACKING, TrackingOptions

KINDS = ("separation", "closing", "slip")
LIMITS = ("upper limit", "lower limit")
START = "start"  # in a plane, instead of LIMITS
NORMAL = -1  # index of the normal among the directions of a contact

ComplexArray = npt.NDArray[np.complex128]


class Onset(NamedTuple):
    """Value of an onset function, and its derivatives by the contact's unknowns and by mu, k_u, k_v, n_0."""

    value: float
    slope: FloatArray
    by_number: FloatArray


def _discs(law: Law) -> PlanarMargins | None:
    """The discs that bound the slider of a contact in a plane; None on a line."""
    bounds = law.bounds if isinstance(law, KernelLaw) else None
    return bounds if isinstance(bounds, PlanarMargins) else None


def onset(
    law: Law, x: FloatArray, kind: str, harmonics: tuple[int, ...], options: TrackingOptions = TRACKING
) -> Onset:
    """One of the onset functions of a contact at its unknowns, see `kinds_of`."""
    discs = _discs(law)
    if discs is not None and kind in ("slip", START):
        return _in_plane(law, discs, x, kind, harmonics)
    load = _polynomial(x, law, NORMAL) * law.k_v
    load[0] += law.n_0
    if kind == "slip" or kind in LIMITS:
        push = _polynomial(x, law, 0) * law.k_u
        parts = [(push + law.mu * load, 1.0, law.mu), (law.mu * load - push, -1.0, law.mu)]
        parts = parts if kind == "slip" else [parts[LIMITS.index(kind)]]
    else:
        sign = 1.0 if kind == "separation" else -1.0
        parts = [(sign * load, 0.0, sign)]
    value, slope, numbers = 0.0, np.zeros(x.size), np.zeros(4)
    sign = -1.0 if kind in ("closing", "lower limit") else 1.0  # max n = -min(-n)
    least, angles = _least(np.array([c for c, _, _ in parts]), harmonics, options)
    for lowest, theta, (_, of_push, of_load) in zip(least.tolist(), angles.tolist(), parts, strict=True):
        value += sign * lowest
        at = _waves(theta, harmonics)  # of a displacement's own numbers, at the extreme
        along, across = _places(law, x, 0), _places(law, x, NORMAL)
        slope[along] += sign * of_push * law.k_u * at
        slope[across] += sign * of_load * law.k_v * at
        u, v = x[along] @ at, x[across] @ at
        numbers[1] += sign * of_push * u
        numbers[2] += sign * of_load * v
        numbers[3] += sign * of_load
        if of_push:
            numbers[0] += sign * (law.n_0 + law.k_v * v)
    return Onset(value, slope, numbers)


def values(
    laws: list[Law], x: FloatArray, harmonics: tuple[int, ...], options: TrackingOptions = TRACKING
) -> FloatArray:
    """Values of the onset functions of all contacts: separation, closing, slip, and the two limits.

    The limits of a contact that slips are replaced by 1 and -1. Contacts that cannot slip, or whose load does
    not vary, are included, as a number may pass the value at which that is so. Their functions are then
    negative, or change sign together with another one.
    """
    if not laws:
        return np.zeros(0)
    if _discs(laws[0]) is not None:
        return np.concatenate([_values_in_plane(law, x, i, harmonics, options) for i, law in enumerate(laws)])
    blocks = x[: len(laws) * laws[0].width].reshape(len(laws), -1)
    numbers = np.array([(law.mu, law.k_u, law.k_v, law.n_0) for law in laws])
    mu, k_u, k_v, n_0 = numbers.T
    u, v = (
        np.array([_polynomial(block, law, part) for block, law in zip(blocks, laws, strict=True)])
        for part in (0, NORMAL)
    )
    load, push = v * k_v[:, None], u * k_u[:, None]
    load[:, 0] += n_0
    limit = mu[:, None] * load
    open_, shut, upper, lower = np.split(
        _least(np.concatenate((load, -load, push + limit, limit - push)), harmonics, options)[0], 4
    )
    rests = upper + lower > 0.0
    return np.concatenate(
        (open_, -shut, upper + lower, np.where(rests, upper, 1.0), np.where(rests, -lower, -1.0))
    )


def _least(
    c: ComplexArray, harmonics: tuple[int, ...], options: TrackingOptions
) -> tuple[FloatArray, FloatArray]:
    """Least value (row,) of c_0 + Re sum c_h exp(i h theta) for each row of c, and the angle there."""
    h, wave = np.array(harmonics), c[:, 1:]
    if h.size == 1:
        return c[:, 0].real - np.abs(wave[:, 0]), np.pi - np.angle(wave[:, 0])
    samples = options.onset.samples_per_period * h[-1]
    theta = 2.0 * np.pi * np.arange(samples) / samples
    at = theta[(wave @ np.exp(1j * np.outer(h, theta))).real.argmin(axis=1)]
    for _ in range(options.onset.max_iterations):
        turned = np.exp(1j * np.outer(at, h)) * wave
        bend = (h * h * turned).real.sum(axis=1)
        step = (h * turned).imag.sum(axis=1) / np.where(bend < 0.0, bend, 1.0)
        at = at - np.where(bend < 0.0, step, 0.0)
    return c[:, 0].real + (np.exp(1j * np.outer(at, h)) * wave).real.sum(axis=1), at


def _values_in_plane(
    law: Law, x: FloatArray, i: int, harmonics: tuple[int, ...], options: TrackingOptions = TRACKING
) -> FloatArray:
    """Values of the onset functions of contact number i in a plane."""
    block = np.ascontiguousarray(x[i * law.width : (i + 1) * law.width])
    open_, shut, slip, start = (onset(law, block, kind, harmonics, options).value for kind in (*KINDS, START))
    return np.array([open_, shut, slip, start if slip > 0.0 else 1.0])


def _in_plane(law: Law, discs: PlanarMargins, x: FloatArray, kind: str, harmonics: tuple[int, ...]) -> Onset:
    """The onset function of the discs that bound a slider in a plane, with its derivatives.

    The active discs of the point that misses all discs least have weights with which the sum of their
    directions vanishes. With these weights the sum of their changes gives the derivative: the motion of the
    point itself has no effect.
    """
    grown = discs.overlap(np.ascontiguousarray(x), law, kind == START)
    resting, motion = discs.resting, discs.motion
    if kind == START:
        angles, place = np.array([resting.angle]), -np.array([motion.mean_x, motion.mean_y])
    else:
        angles = np.asarray(resting.basis)[: resting.held, 3]
        place = np.array([resting.w_x, resting.w_y])
    along = [_places(law, x, direction) for direction in range(3)]
    waves = np.array([_waves(theta, harmonics) for theta in angles])
    means = np.zeros(3) if kind == START else x[:2].tolist()
    u = [waves @ x[along[0]] - means[0], waves @ x[along[1]] - means[1]]
    v = waves @ x[along[2]]
    d = law.k_u * np.stack(u, axis=1) - motion.scale * (place if kind != START else 0.0)
    size = np.linalg.norm(d, axis=1)
    e = d / np.where(size > 0.0, size, 1.0)[:, None]
    weight = _weights(e)
    times = -1.0 if kind == START else -2.0
    slope, by = np.zeros(x.size), np.zeros(4)
    for one, at, (e_x, e_y), load in zip(weight, waves, e, v, strict=True):
        for direction, factor in ((0, e_x * law.k_u), (1, e_y * law.k_u), (2, -law.mu * law.k_v)):
            slope[along[direction]] += times * one * factor * at
        of_u = e_x * (at @ x[along[0]]) + e_y * (at @ x[along[1]])
        by += times * one * np.array([-(law.n_0 + law.k_v * load), of_u, -law.mu * load, -law.mu])
    if kind != START:  # a shift by the mean of u does not change whether the discs have a common point
        slope[:2] = 0.0
    return Onset(times * grown, slope, by)


def _weights(e: FloatArray) -> FloatArray:
    """Weights (disc,) of sum 1 with which the weighted sum of directions (disc, 2) vanishes."""
    matrix = np.vstack((e.T, np.ones(len(e))))
    found: FloatArray = np.linalg.lstsq(matrix, np.array([0.0, 0.0, 1.0]), rcond=None)[0]
    return found if len(e) > 1 else np.ones(len(e))


def kinds_of(law: Law) -> tuple[str, ...]:
    """The kinds of onset functions that a contact has."""
    if _discs(law) is not None:
        return (*(KINDS[:2] if law.k_v > 0.0 else ()), *(("slip", START) if law.mu * law.k_u > 0.0 else ()))
    return (*(KINDS[:2] if law.k_v > 0.0 else ()), *((*KINDS[2:], *LIMITS) if law.mu * law.k_u > 0.0 else ()))


def _places(law: Law, x: FloatArray, direction: int) -> npt.NDArray[np.intp]:
    """Indices of the numbers of a displacement among the unknowns: mean, then Re, Im of each harmonic."""
    layout = layout_of(1, law.directions, (x.size // law.directions - 1) // 2)
    return layout.places[direction]


def _polynomial(x: FloatArray, law: Law, direction: int) -> ComplexArray:
    """Mean and complex amplitudes of the displacement along a direction."""
    numbers = x[_places(law, x, direction)]
    found: ComplexArray = np.concatenate((numbers[:1], numbers[1::2] + 1j * numbers[2::2]))
    return found


def _waves(theta: float, harmonics: tuple[int, ...]) -> FloatArray:
    """Derivatives of a displacement at an angle by its coefficients: mean, then Re, Im of each harmonic."""
    h = np.array(harmonics) * theta
    return np.concatenate(([1.0], np.stack((np.cos(h), -np.sin(h)), axis=1).ravel()))
