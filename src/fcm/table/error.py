"""The error of a table: its difference from the closed form, by regime, corners included."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from fcm.contact import fourier_coefficients
from fcm.table import atlas
from fcm.table.atlas import FloatArray, b_variation, phi_phase
from fcm.table.lookup import Table
from fcm.table.options import ERROR_OPTIONS, MAP_OPTIONS

REGIMES = ("open", "separation", "slip", "stick")
NAMES = ("F_b", "F_s", "F_c")

Progress = Callable[[float], None]  # called with the share done
Sampler = Callable[[int, int], tuple[FloatArray, FloatArray, FloatArray]]  # of so many points, with a seed


class Interpolant(Protocol):
    """Protocol of tables whose error can be measured: a `Table`, or anything callable like one."""

    def __call__(
        self, n0_bar: npt.ArrayLike, b_bar: npt.ArrayLike, phi: npt.ArrayLike
    ) -> tuple[FloatArray, FloatArray, FloatArray]: ...


def sample(count: int, seed: int = ERROR_OPTIONS.seed) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Points n0_bar, b_bar, phi over all regimes, some of them crowded into every corner.

    b is uniform in b/(1+b), uniform in its logarithm from 1e-6 to 1e6, or within 1e-6 to 1 of b = 1. phi is
    uniform in (-pi, pi) or within 1e-6 to 1 of a multiple of pi. n0 lies between -b and b (uniform in the
    contact angle), between b and the slip limit, or within 1e-9 to 1 of one of the three boundaries, on
    either side.
    """
    random = np.random.default_rng(seed)
    b = _variation(count, random)
    phi = random.uniform(-np.pi, np.pi, count)
    near = random.integers(-1, 2, count) * np.pi + _small(count, -6, random)
    phi = np.where(random.random(count) < 0.25, near, phi)
    width = atlas.geometry(b, phi).width
    inner = -b * np.cos(np.pi * random.random(count))
    slip = b + width * random.random(count)
    boundary = np.choose(random.integers(0, 3, count), (-b, b, b + width))
    scale = np.where(random.random(count) < 0.5, np.maximum(width, 1e-9), 1.0)
    close = boundary + _small(count, -9, random) * scale
    kind = random.integers(0, 4, count)
    return np.choose(kind, (inner, slip, close, inner)), b, phi


def _small(count: int, decades: int, random: np.random.Generator) -> FloatArray:
    """Random numbers of either sign with magnitudes from 10^decades to 1, uniform in their logarithm."""
    size: FloatArray = 10.0 ** random.uniform(decades, 0.0, count) * random.choice((-1.0, 1.0), count)
    return size


def _variation(count: int, random: np.random.Generator) -> FloatArray:
    share = random.random(count)
    linear = share / (1.0 - share)
    logarithmic = 10.0 ** random.uniform(-6.0, 6.0, count)
    near_one = np.abs(1.0 + _small(count, -6, random))
    b: FloatArray = np.choose(random.integers(0, 3, count), (linear, logarithmic, near_one))
    return b


def regime(n0_bar: FloatArray, b_bar: FloatArray, phi: FloatArray) -> npt.NDArray[np.int64]:
    """Index into REGIMES of the regime at each point."""
    width = atlas.geometry(b_bar, phi).width
    code = np.where(n0_bar < b_bar, 1, np.where(n0_bar - b_bar < width, 2, 3))
    return np.where(n0_bar <= -b_bar, 0, code)


def error_of(
    table: Interpolant,
    points: int = ERROR_OPTIONS.points,
    seed: int = ERROR_OPTIONS.seed,
    progress: Progress | None = None,
    drawn: Sampler = sample,
) -> dict[str, Any]:
    """Error of a table at the points of `sample(points, seed)`, or of another sampler.

    Returns
    -------
    dict
        ``points``, ``seed``; ``max``, ``p999``, ``rms`` over all points; and ``regimes``. For each of REGIMES
        that has the number of points, and for each of F_b, F_s, F_c ``max``, ``p999`` (99.9 %), ``rms`` and
        ``worst``, the point [n0_bar, b_bar, phi] of the greatest error. Errors are absolute [-].
    """
    n0, b, phi = drawn(points, seed)
    error = np.empty((3, points))
    for first in range(0, points, ERROR_OPTIONS.chunk):
        part = slice(first, first + ERROR_OPTIONS.chunk)
        exact = np.stack(fourier_coefficients(n0[part], b[part], phi[part]))
        error[:, part] = np.abs(np.stack(table(n0[part], b[part], phi[part])) - exact)
        if progress is not None:
            progress(min(first + ERROR_OPTIONS.chunk, points) / points)
    code = regime(n0, b, phi)
    result: dict[str, Any] = {"points": points, "seed": seed, **_summary(error.reshape(-1)), "regimes": {}}
    for index, name in enumerate(REGIMES):
        chosen = np.flatnonzero(code == index)
        if chosen.size == 0:
            continue
        parts: dict[str, Any] = {"points": int(chosen.size)}
        for row, coefficient in enumerate(NAMES):
            worst = chosen[np.argmax(error[row, chosen])]
            point = [float(n0[worst]), float(b[worst]), float(phi[worst])]
            parts[coefficient] = {**_summary(error[row, chosen]), "worst": point}
        result["regimes"][name] = parts
    return result


def _summary(error: FloatArray) -> dict[str, float]:
    return {
        "max": float(np.max(error)),
        "p999": float(np.quantile(error, 0.999)),
        "rms": float(np.sqrt(np.mean(error * error))),
    }


SAMPLED, SAMPLED_RMS = 2.0, 1.25  # factors by which maximum and rms may be greater in another sample


def disagreement(recorded: dict[str, Any], again: dict[str, Any], fresh: dict[str, Any]) -> str:
    """How a recorded error differs from one at the same points (again) or at others (fresh); '' if not.

    At the same points a smaller error than recorded is a disagreement, too.
    """
    for path, was in _numbers(recorded):
        now = _at(again, path)
        if now is None or abs(now - was) > ERROR_OPTIONS.max_change * abs(was) + 1e-12:
            return f"{' '.join(path)} is {now if now is None else f'{now:.3g}'}, recorded {was:.3g}"
    for name, factor in (("max", SAMPLED), ("rms", SAMPLED_RMS)):
        if fresh[name] > factor * recorded[name]:
            return f"{name} at other points is {fresh[name]:.3g}, recorded {recorded[name]:.3g}"
    return ""


def _numbers(error: dict[str, Any], path: tuple[str, ...] = ()) -> list[tuple[tuple[str, ...], float]]:
    """All numbers of nested dictionaries, with the keys that lead to them."""
    found: list[tuple[tuple[str, ...], float]] = []
    for key, value in error.items():
        if isinstance(value, dict):
            found += _numbers(value, (*path, key))
        elif isinstance(value, int | float):
            found.append(((*path, key), float(value)))
    return found


def _at(error: Any, path: tuple[str, ...]) -> float | None:
    for key in path:
        error = error.get(key) if isinstance(error, dict) else None
    return None if error is None else float(error)


def seam(table: Table) -> FloatArray:
    """The greatest jumps of F_b, F_s, F_c (3,) at the onset of separation, n0_bar = b_bar.

    The splines of two charts meet there: of F / beta, and of (F - F_edge) / E, see `table.atlas`. At nodes
    both give the same F; between nodes their errors differ. The closed form has no jump.
    """
    _, _, nodes_x, nodes_z = table.resolution
    x, z = (
        np.linspace(0.0, 1.0, MAP_OPTIONS.points_of_cell * (nodes - 1) + 1) for nodes in (nodes_x, nodes_z)
    )
    phi = phi_phase(z)[None, :] + np.zeros((x.size, 1))
    b = b_variation(x[:, None] + np.zeros(z.size), phi)
    before, beyond = (np.array(table(n0, b, phi)) for n0 in (np.nextafter(b, 0.0), b))
    jumps: FloatArray = np.abs(beyond - before).reshape(3, -1).max(axis=1)
    return jumps
