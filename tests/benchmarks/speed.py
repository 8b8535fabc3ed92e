"""Run times beside one another, in one process: ``make bench`` prints them as tables.

Processor times: they depend on the machine, and less than others on what else it does. So each is given also
as a multiple of the time that `numpy.sin` takes for a value, measured in turn with it, and as the time that
would be on a machine where that is 10 ns. The multiples carry over to other machines.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from unit import SINE, seconds, sine

import fcm
from fcm.contact.closed_form import __file__ as kernel
from fcm.contact.periodic.cycle import PeriodicContact
from fcm.contact.plane.cycle import PlanarContact
from fcm.model.scene import Scene
from fcm.response import trace
from fcm.run import Execution
from fcm.table import Table
from fcm.table.tabulated import locate

REPEATS = 7
DIFFERENTIATED = 30  # motions whose derivatives are marched, in memory
Row = tuple[str, Callable[[], object], int]  # what, the call, elements that it handles


def block(title: str, rows: list[Row], repeats: int = 0) -> None:
    """Median times per element; the rows take turns, and each is divided by the sines of its turn."""
    times: list[list[tuple[float, float]]] = [[] for _ in rows]
    for _ in range(repeats or REPEATS):
        for samples, (_, call, elements) in zip(times, rows, strict=True):
            of_a_sine = sine()
            taken = seconds(call) / elements
            samples.append((taken, taken / of_a_sine))
    print(f"\n{title}\n{'':48s}{'us':>12s}{'sines':>10s}{'us scaled':>12s}")
    for (what, _, _), samples in zip(rows, times, strict=True):
        taken, multiple = np.median(samples, axis=0)
        print(f"  {what:46s}{taken * 1e6:12.3f}{multiple:10.1f}{multiple * SINE:12.3f}")


def contact_points(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Random contacts, of which most slip and more than half separate."""
    rng = np.random.default_rng(0)
    b_bar = rng.uniform(0.0, 3.0, count)
    return rng.uniform(-1.0, 1.5, count) * b_bar, b_bar, rng.uniform(0.0, 2.0 * np.pi, count)


def rectilinear() -> RegularGridInterpolator:
    """The usual way: a grid over a box, interpolated linearly."""
    axes = np.linspace(-4.0, 4.0, 81), np.linspace(0.0, 3.0, 61), np.linspace(0.0, 2.0 * np.pi, 61)
    values = np.stack(fcm.fourier_coefficients(*np.meshgrid(*axes, indexing="ij", sparse=True)), axis=-1)
    return RegularGridInterpolator(axes, values, bounds_error=False)


def coefficients(many: int = 1_000_000, calls: int = 2000) -> None:
    """Three coefficients of each of many contacts, and of one at a time."""
    table, box = fcm.open_table(), rectilinear()
    x = contact_points(many)
    cells = locate(np.stack(x), table.resolution).q.astype(int)
    by_cell = tuple(part[np.lexsort(cells[::-1])] for part in x)
    count, points = x[0].size, np.column_stack(x)
    block(
        f"three coefficients, {many} points, a point",
        [
            ("closed form", lambda: fcm.fourier_coefficients(*x), count),
            ("closed form with derivatives", lambda: fcm.fourier_gradients(*x), count),
            ("table", lambda: table(*x), count),
            ("table with derivatives", lambda: table.gradients(*x), count),
            ("table with derivatives, sorted by cell", lambda: table.gradients(*by_cell), count),
            ("scipy RegularGridInterpolator, linear", lambda: box(points), count),
        ],
    )
    one = tuple(map(float, (part[0] for part in x)))
    block(
        "three coefficients, one point, a call from Python",
        [
            ("closed form with derivatives", lambda: repeat(fcm.fourier_gradients, one, calls), calls),
            ("table with derivatives", lambda: repeat(table.gradients, one, calls), calls),
            ("scipy RegularGridInterpolator, linear", lambda: repeat(box, (points[:1],), calls), calls),
        ],
    )


def periodic(count: int = 2000) -> None:
    """The kernel alone, in one thread: random motions, of which nearly all slip and most separate."""
    rng = np.random.default_rng(2)
    parameters = np.tile([0.6, 1.0, 1.0, 0.5, 0.0], (count, 1))  # mu, k_u, k_v, n_0, start
    rows: list[Row] = []
    for highest in (1, 3, 9, 15):
        harmonics = list(range(1, highest + 1))
        contact = PeriodicContact(harmonics, harmonics)
        forces, jacobians = np.empty((count, contact.equations)), np.empty((count, *contact.jacobian.shape))
        for decay in (1, 2):
            size = np.concatenate(([0.0, 0.0], np.repeat(np.arange(1.0, highest + 1.0) ** -decay, 4)))
            x = rng.standard_normal((count, contact.unknowns)) * size
            for what, room in (("", jacobians[:0]), (", derivatives", jacobians)):
                call = partial(contact.all, x, parameters, forces, room)
                rows.append((f"{highest} harmonics as h**-{decay}{what}", call, count))
    block("forces of any periodic motion, a motion", rows)


def planar(count: int = 300, each: Sequence[int] = (1, 3, 9)) -> None:
    """The kernel in a plane beside that on a line, and beside radial return with an error of 1e-4."""
    rng = np.random.default_rng(2)
    parameters = np.tile([0.6, 1.0, 1.0, 0.5, 0.0, 0.0], (count, 1))  # mu, k_u, k_v, n_0, start
    for highest in each:
        harmonics = list(range(1, highest + 1))
        plane, line = PlanarContact(harmonics, harmonics), PeriodicContact(harmonics, harmonics)
        size = np.concatenate(([0.0, 0.0, 0.0], np.repeat(np.arange(1.0, highest + 1.0) ** -2, 6)))
        x = rng.standard_normal((count, plane.unknowns)) * size
        others = [1, *(3 + 6 * k + i for k in range(highest) for i in (2, 3))]
        along = np.ascontiguousarray(np.delete(x, others, axis=1))
        forces, jacobians = np.empty((count, plane.equations)), np.empty((count, *plane.jacobian.shape))
        f, J = np.empty((count, line.equations)), np.empty((count, *line.jacobian.shape))
        plane.all(x, parameters, forces, jacobians)
        samples = samples_of_radial_return(x, parameters[0], forces)
        rows: list[Row] = [
            ("in a plane", partial(plane.all, x, parameters, forces, jacobians[:0]), count),
            ("in a plane, derivatives", partial(plane.all, x, parameters, forces, jacobians), count),
            ("on a line, derivatives", partial(line.all, along, parameters[:, :5].copy(), f, J), count),
            (f"radial return, {samples} samples", partial(radial_return, x, parameters[0], samples), count),
        ]
        few = x[:DIFFERENTIATED]
        call = partial(derivatives_of_radial_return, few, parameters[0], samples)
        rows.append((f"radial return, {samples} samples, derivatives", call, len(few)))
        block(f"forces of {highest} harmonics as h**-2 in a plane, a motion", rows, repeats=3)


def radial_return(x: np.ndarray, parameters: np.ndarray, samples: int) -> np.ndarray:
    """Coefficients (point, harmonic, 2) of f_x and f_y: trial force, then back to the circle; two cycles."""
    mu, k_u, k_v, n_0 = parameters[:4]
    rest = x[:, 3:].copy().view(complex).reshape(len(x), -1, 3)
    X = np.concatenate((x[:, None, :3] + 0j, rest), axis=1)
    wave = np.exp(2j * np.pi / samples * np.outer(np.arange(samples), np.arange(X.shape[1])))
    u_x, u_y, v = (np.ascontiguousarray((wave @ X[:, :, i].T).real) for i in range(3))
    limit = mu * np.maximum(n_0 + k_v * v, 0.0)
    u_x, u_y = k_u * u_x, k_u * u_y
    w_x, w_y, f = np.zeros(len(x)), np.zeros(len(x)), np.empty((2, *u_x.shape))
    for step in range(2 * samples):
        i = step % samples
        f_x, f_y = u_x[i] - w_x, u_y[i] - w_y
        back = np.minimum(1.0, limit[i] / np.maximum(np.hypot(f_x, f_y), 1e-300))
        f[0, i], f[1, i] = back * f_x, back * f_y
        w_x, w_y = u_x[i] - f[0, i], u_y[i] - f[1, i]
    F: np.ndarray = np.einsum("sh,isp->phi", wave.conj(), f) * (2.0 / samples)
    F[:, 0] *= 0.5
    return F


def derivatives_of_radial_return(x: np.ndarray, parameters: np.ndarray, samples: int) -> np.ndarray:
    """Of its coefficients (point, harmonic, 2, unknown) by the unknowns: each step differentiated."""
    mu, k_u, k_v, n_0 = parameters[:4]
    rest = x[:, 3:].copy().view(complex).reshape(len(x), -1, 3)
    X = np.concatenate((x[:, None, :3] + 0j, rest), axis=1)
    wave = np.exp(2j * np.pi / samples * np.outer(np.arange(samples), np.arange(X.shape[1])))
    u_x, u_y, v = (np.ascontiguousarray((wave @ X[:, :, i].T).real) for i in range(3))
    load = n_0 + k_v * v
    by = np.zeros((samples, 3, x.shape[1]))  # of u_x, u_y and v by the unknowns
    for i in range(3):
        by[:, i, i] = 1.0
        by[:, i, 3 + 2 * i :: 6], by[:, i, 4 + 2 * i :: 6] = wave[:, 1:].real, -wave[:, 1:].imag
    w, dw = np.zeros((2, len(x))), np.zeros((2, len(x), x.shape[1]))
    df = np.empty((samples, *dw.shape))
    for step in range(2 * samples):
        i = step % samples
        trial = k_u * np.stack((u_x[i], u_y[i])) - w
        size = np.maximum(np.hypot(*trial), 1e-300)
        limit, e = mu * np.maximum(load[i], 0.0), trial / size
        slips = limit < size
        back = np.where(slips, limit / size, 1.0)
        change = k_u * by[i, :2, None] - dw
        along = e[0, :, None] * change[0] + e[1, :, None] * change[1]
        grown = np.where(load[i] > 0.0, mu * k_v, 0.0)[:, None] * by[i, 2] - back[:, None] * along
        df[i] = back[:, None] * change + np.where(slips[:, None], grown, 0.0) * e[..., None]
        w, dw = k_u * np.stack((u_x[i], u_y[i])) - back * trial, k_u * by[i, :2, None] - df[i]
    J: np.ndarray = np.tensordot(wave.conj(), df, (0, 0)).transpose(2, 0, 1, 3) * (2.0 / samples)
    J[:, 0] *= 0.5
    return J


def samples_of_radial_return(x: np.ndarray, parameters: np.ndarray, forces: np.ndarray) -> int:
    """A power of two with which half of the motions err by 1e-4 of their greatest amplitude or less."""
    exact = np.concatenate(
        (forces[:, None, :2] + 0j, forces[:, 3:].copy().view(complex).reshape(len(x), -1, 3)[:, :, :2]),
        axis=1,
    )
    samples = 64
    while samples < 2**17:
        error = np.abs(radial_return(x, parameters, samples) - exact).max(axis=(1, 2))
        if np.median(error / np.abs(x).max(axis=1)) <= 1e-4:
            break
        samples *= 2
    return samples


def repeat(call: Callable[..., object], arguments: tuple[object, ...], times: int) -> None:
    for _ in range(times):
        call(*arguments)


def curves() -> None:
    table = fcm.open_table()
    scene = fcm.load_scene("yang1998")
    singles = [replace(curve, curves=()) for curve in scene.curves]
    points = sum(curve.points for curve in trace(scene, method=table).curves)
    rows: list[Row] = [
        ("ten curves together", lambda: trace(scene, method=table), points),
        ("ten curves together, closed form", lambda: trace(scene, "closed-form"), points),
        ("a loop over single curves", lambda: [trace(single, method=table) for single in singles], points),
    ]
    block("the ten curves of yang1998, everything included, a point", rows)
    one = fcm.load_scene("yang1998-n5")
    block(
        "one curve of yang1998-n5, everything included, a point",
        [harmonics_row(one, table, highest) for highest in (1, 3, 9)],
    )


def harmonics_row(scene: Scene, table: Table, highest: int) -> Row:
    """A curve of all harmonics up to one."""
    call = partial(trace, scene, method=table, harmonics=highest)
    name = f"{highest} harmonic{'s' if highest > 1 else ''}"
    return name, call, sum(curve.points for curve in call().curves)


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
    points = sum(curve.points for curve in trace(scene, method=table, execution=Execution(jobs=1)).curves)
    rows: list[Row] = [
        ("together", lambda: trace(scene, method=table, execution=Execution(jobs=1)), points),
        ("together, closed form", lambda: trace(scene, "closed-form", execution=Execution(jobs=1)), points),
    ]
    block(f"{count} curves of random mu and n_0, everything included, a point", rows, repeats=1)


def main() -> None:
    mode = "run as Python" if kernel.endswith(".py") else "compiled"
    print(f"fcm {fcm.__version__}, kernels {mode}, Python {sys.version.split()[0]}, numpy {np.__version__}")
    print("processor time; the median of 7 runs in turn, one run of the thousand curves")
    coefficients()
    periodic()
    planar()
    curves()
    many_curves()


if __name__ == "__main__":
    main()
