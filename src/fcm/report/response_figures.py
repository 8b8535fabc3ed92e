"""Numbers of the figures of the oscillator: responses (13, 14) and the jump in time (15)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from fcm.report.rows import Row
from fcm.response import trace
from fcm.scene import load_scene

PRELOAD = "contact.shroud.n_0"
SEARCHED = (20.0, 120.0)  # preloads, of either sign, between which the response becomes linear
IN_A_SWEEP, SPACING = 11, 0.02  # preloads that are tried together; how closely the limit is found


def stuck_above() -> float:
    """The least preload at which the contact sticks throughout the range of frequencies, to SPACING."""
    return _limit("E", sticking=1.0)


def open_below() -> float:
    """The greatest preload, a gap being negative, at which the contact never closes, to SPACING."""
    return _limit("S", sticking=-1.0)


@cache
def _limit(state: str, sticking: float) -> float:
    """Beyond which preload, of those in SEARCHED, one state is all that occurs; in ever finer sweeps."""
    scene = load_scene("yang1998-n5")
    low, high = (sticking * end for end in SEARCHED)
    while abs(high - low) > SPACING:
        preloads = np.linspace(low, high, IN_A_SWEEP)
        contacts = (replace(scene.contacts[0], n_0=float(n_0)) for n_0 in preloads)
        curves = tuple(replace(scene, contacts=(contact,)) for contact in contacts)
        only = [set(curve.regime.ravel()) == {state} for curve in trace(replace(scene, curves=curves)).curves]
        last = max(i for i, alone in enumerate(only) if not alone)
        low, high = float(preloads[last]), float(preloads[last + 1])
    return high


def figure_13(folder: Path) -> list[Row]:
    """From fully stuck to fully separate; the best preload; which way the peaks bend."""
    with xarray.open_dataset(folder / "figure13.nc") as file:
        data = file.sel(dof="u").load()
    curves = {float(n): data.isel(curve=i) for i, n in enumerate(data[PRELOAD].values)}
    peaks = {n: float(curve.peak_amplitude) for n, curve in curves.items()}
    at = {n: float(curve.peak_frequency) for n, curve in curves.items()}
    best = min(peaks, key=lambda n: peaks[n])
    stuck, opened = max(curves), min(curves)
    above, below = stuck_above(), open_below()
    least = f"{best:g}: peak {peaks[best]:.3f} at {at[best]:.3f} rad/s"
    between = all(at[opened] <= at[n] <= at[stuck] for n in curves)
    folds = {n: curve.fold_frequency.values[np.isfinite(curve.fold_frequency)] for n, curve in curves.items()}
    return [
        Row("stuck at every frequency", "above about 90", f"above {above:.2f}", abs(above - 90.0) < 5.0),
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
    balance = Row(
        "work of the force less energy dissipated and stored", "not stated", f"{error:.1g}", error < 1e-9
    )
    return [*rows, balance]
