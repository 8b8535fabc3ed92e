"""Run times beside one another, in one process: ``make bench`` prints them as a table with their ratios.

Processor times: they depend on the machine, and less than others on what else it does; the ratios within a
block depend on it least.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.interpolate import RegularGridInterpolator

import fcm
from fcm.response import trace

REPEATS = 5
Row = tuple[str, Callable[[], object], int]  # what, the call, elements that it handles


def block(title: str, rows: list[Row], unit: float, name: str, repeats: int = REPEATS) -> None:
    """Median times per element, and the ratio to the first row; the rows take turns."""
    times: list[list[float]] = [[] for _ in rows]
    for _ in range(repeats):
        for samples, (_, call, elements) in zip(times, rows, strict=True):
            begin = time.process_time()
            call()
            samples.append((time.process_time() - begin) / elements)
    medians = [float(np.median(samples)) for samples in times]
    print(f"\n{title}")
    for (what, _, _), median in zip(rows, medians, strict=True):
        print(f"  {what:46s} {median / unit:10.3f} {name}  {median / medians[0]:9.2f}")


def contact_points(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    b_bar = rng.uniform(0.0, 3.0, count)
    return rng.uniform(-1.0, 1.5, count) * b_bar, b_bar, rng.uniform(0.0, 2.0 * np.pi, count)


def rectilinear() -> RegularGridInterpolator:
    """The usual way: a grid over a box, interpolated linearly."""
    axes = np.linspace(-4.0, 4.0, 81), np.linspace(0.0, 3.0, 61), np.linspace(0.0, 2.0 * np.pi, 61)
    values = np.stack(fcm.fourier_coefficients(*np.meshgrid(*axes, indexing="ij", sparse=True)), axis=-1)
    return RegularGridInterpolator(axes, values, bounds_error=False)


def coefficients() -> None:
    table, box = fcm.open_table(), rectilinear()
    for count in (1, 10, 1000, 1_000_000):
        x = contact_points(count)
        points = np.column_stack(x)
        calls = max(1000 // count, 1)

        def row(what: str, call: Callable[..., object], *arguments: np.ndarray, calls: int = calls) -> Row:
            def many() -> None:
                for _ in range(calls):
                    call(*arguments)

            return what, many, arguments[0].shape[0] * calls

        rows = [
            row("np.sin", np.sin, x[2]),
            row("closed form", fcm.fourier_coefficients, *x),
            row("closed form with derivatives", fcm.fourier_gradients, *x),
            row("table", table, *x),
            row("table with derivatives", table.gradients, *x),
            row("scipy RegularGridInterpolator, linear", box, points),
        ]
        block(f"three coefficients, {count} points at a time", rows, 1e-6, "us a point")


def curves() -> None:
    table = fcm.open_table()
    scene = fcm.load_scene("yang1998")
    singles = [replace(curve, curves=()) for curve in scene.curves]
    points = sum(curve.points for curve in trace(scene, table=table).curves)
    rows: list[Row] = [
        ("ten curves together", lambda: trace(scene, table=table), points),
        ("ten curves together, closed form", lambda: trace(scene, "closed-form"), points),
        ("a loop over single curves", lambda: [trace(single, table=table) for single in singles], points),
    ]
    block("the ten curves of yang1998, everything included", rows, 1e-3, "ms a point")


def many_curves(count: int = 1000) -> None:
    table = fcm.open_table()
    base = fcm.load_scene("yang1998-n5")
    rng = np.random.default_rng(1)
    draws = zip(rng.normal(0.4, 0.05, count), rng.uniform(-20.0, 50.0, count), strict=True)
    drawn = tuple(
        replace(base, contacts=(replace(base.contacts[0], mu=mu, n_0=n_0),), parameters={"n_0": n_0})
        for mu, n_0 in draws
    )
    scene = replace(base, curves=drawn)
    points = sum(curve.points for curve in trace(scene, table=table, jobs=1).curves)
    rows: list[Row] = [
        ("together", lambda: trace(scene, table=table, jobs=1), points),
        ("together, closed form", lambda: trace(scene, "closed-form", jobs=1), points),
    ]
    block(f"{count} curves of random mu and n_0, everything included", rows, 1e-3, "ms a point", repeats=1)


def main() -> None:
    print(f"fcm {fcm.__version__}, Python {sys.version.split()[0]}, numpy {np.__version__}")
    print(
        "processor time, the median of 5 runs in turn (one run of the thousand curves); "
        "the last column is the ratio to the first row of the block"
    )
    coefficients()
    curves()
    many_curves()


if __name__ == "__main__":
    main()
