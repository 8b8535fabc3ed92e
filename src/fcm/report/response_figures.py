"""Numbers of the figures of the oscillator: responses (13, 14) and the jump in time (15)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray

from fcm.contact.surface import boundaries
from fcm.report.rows import Row

PRELOAD, CONTACT = "contact.shroud.n_0", "shroud"
PRELOADS = [100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 0.0, -5.0, -20.0, -60.0]


def stuck_above(curve: Any) -> float:
    """The preload above which a contact sticks at every frequency, from the curve of one that does.

    Where it sticks the motion does not depend on the preload, and (25) gives the limit at each point.
    """
    known = np.isfinite(curve.n0_bar.values)
    n0_bar, b_bar, phi = (curve[name].values[known] for name in ("n0_bar", "b_bar", "phi"))
    limit = [boundaries(np.array([b]), p)["slip"][0] for b, p in zip(b_bar, phi, strict=True)]
    return float(curve[PRELOAD] * np.max(np.array(limit) / n0_bar))


def open_below(curve: Any) -> float:
    """The preload, negative for a gap, below which a contact never closes; from the curve of an open one."""
    return float(-np.abs(curve[PRELOAD]) * np.nanmax(np.abs(curve.b_bar / curve.n0_bar)))


def figure_13(folder: Path) -> list[Row]:
    """From fully stuck to fully separate; the best preload; which way the peaks bend."""
    with xarray.open_dataset(folder / "figure13.nc") as file:
        data = file.sel(contact=CONTACT, dof="u").load()
    curves = {float(n): data.isel(curve=i) for i, n in enumerate(data[PRELOAD].values)}
    peaks = {n: float(curve.peak_amplitude) for n, curve in curves.items()}
    at = {n: float(curve.peak_frequency) for n, curve in curves.items()}
    best = min(peaks, key=lambda n: peaks[n])
    stuck, opened = max(curves), min(curves)
    above, below = stuck_above(curves[stuck]), open_below(curves[opened])
    least = f"{best:g}: peak {peaks[best]:.3f} at {at[best]:.3f} rad/s"
    between = all(at[opened] <= at[n] <= at[stuck] for n in curves)
    folds = {n: curve.fold_frequency.values[np.isfinite(curve.fold_frequency)] for n, curve in curves.items()}
    return [
        Row("stuck at every frequency", "above about 90", f"above {above:.2f}", abs(above - 90.0) < 2.0),
        Row("separate at every frequency", "below −50", f"below −{-below:.2f}", abs(below + 50.0) < 0.5),
        Row("preload of the least response", "10", least, best == 10.0),
        Row("peaks lie between those of the two linear cases", "yes",
            f"{at[opened]:.3f} to {at[stuck]:.3f} rad/s", between),
        Row("n₀ = −20, a gap: hardening, the peak bends to higher frequencies", "yes",
            _bend(at[-20.0], folds[-20.0]), at[-20.0] > at[opened] and len(folds[-20.0]) == 2),
        Row("n₀ = 5, a preload: softening, the peak bends to lower frequencies", "yes",
            _bend(at[5.0], folds[5.0]), at[5.0] < at[stuck] and len(folds[5.0]) == 2),
    ]  # fmt: skip


def _bend(peak: float, folds: Any) -> str:
    return f"peak at {peak:.3f}, folds at {', '.join(f'{f:.4f}' for f in sorted(folds))} rad/s"


def figure_15(folder: Path) -> list[Row]:
    """Amplitude at the end of each phase: the upper branch, then the lower and never back."""
    with xarray.open_dataset(folder / "figure15.nc") as file:
        data = file.isel(curve=0).sel(dof="u").load()
    phase = data.cycle_phase.values
    ends = [float(data.cycle_amplitude.values[phase == i][-1]) for i in range(3)]
    error = float(np.max(np.abs(data.energy_error.values)))
    upper, lower = ends[0] > 10.0, 3.0
    stated = ("upper branch", "lower branch, after a jump", "still the lower branch")
    good = (upper, ends[1] < lower, ends[2] < lower)
    schedule = zip(data.schedule_frequency.values, data.schedule_cycles.values, strict=True)
    rows = [
        Row(f"phase {name}: {cycles:g} cycles at {omega:.3f} rad/s", text, f"amplitude of u {end:.4f}", fits)
        for name, (omega, cycles), text, end, fits in zip(
            ("I", "II", "III"), schedule, stated, ends, good, strict=True
        )
    ]
    balance = Row("work of the force less energy dissipated and stored", "0", f"{error:.1g}", error < 1e-9)
    return [*rows, balance]
