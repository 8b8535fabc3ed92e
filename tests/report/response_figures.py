"""Numbers of the figures of the oscillator: responses (13, 14) and the jump in time (15)."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from fcm.contact.limits import FloatArray
from fcm.response import trace
from fcm.scene import load_scene

from .rows import Row

PRELOAD = "contact.shroud.n_0"
SEARCHED = (20.0, 120.0)  # preloads, of either sign, between which the response becomes linear
TWO_STATES = (1.195, 1.235)  # [rad/s] printed in section 4.4
APART, SLIGHT = 0.01, 0.1  # relative: amplitudes that are two states; what may be called a slight difference
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
    data, marks = _read(folder / "figure13.nc"), _read(folder / "figure13-points.nc")
    count = range(data.sizes["curve"])
    off = np.concatenate([off_the_curve(data.isel(curve=i), marks.isel(curve=i)) for i in count])
    half, most = np.quantile(off, (0.5, 0.9))
    above, below = stuck_above(), open_below()
    return [
        Row("stuck at every frequency", "above about 90", f"above {above:.2f}", abs(above - 90.0) < 5.0),
        Row("separate at every frequency", "below −50", f"below −{-below:.2f}", abs(below + 50.0) < 0.5),
        *peaks_of(data),
        Row("simulated points lie on the curves", "yes",
            f"{off.size} points: half of them within {half:.1g}, nine tenths within {most:.1g} of their "
            "amplitude", bool(most < SLIGHT)),
    ]  # fmt: skip


def peaks_of(data: Any) -> list[Row]:
    """The least of the peaks, where they lie, and how they bend."""
    curves = {float(n): data.isel(curve=i) for i, n in enumerate(data[PRELOAD].values)}
    peaks = {n: float(curve.peak_amplitude) for n, curve in curves.items()}
    at = {n: float(curve.peak_frequency) for n, curve in curves.items()}
    folds = {n: curve.fold_frequency.dropna("fold").values for n, curve in curves.items()}
    best, low, high = min(peaks, key=lambda n: peaks[n]), at[min(at)], at[max(at)]
    return [
        Row("preload of the least response", "10",
            f"{best:g}: peak {peaks[best]:.3f} at {at[best]:.3f} rad/s", best == 10.0),
        Row("peaks lie between those of the two linear cases", "yes",
            f"{low:.3f} to {high:.3f} rad/s", all(low <= one <= high for one in at.values())),
        Row("n₀ = −20, a gap: hardening, the peak bends to higher frequencies", "yes",
            _bend(at[-20.0], folds[-20.0]), at[-20.0] > low and len(folds[-20.0]) == 2),
        Row("n₀ = 5, a preload: softening, the peak bends to lower frequencies", "yes",
            _bend(at[5.0], folds[5.0]), at[5.0] < high and len(folds[5.0]) == 2),
    ]  # fmt: skip


def _bend(peak: float, folds: Any) -> str:
    return f"peak at {peak:.3f}, folds at {', '.join(f'{f:.4f}' for f in sorted(folds))} rad/s"


def crossings(frequency: FloatArray, amplitude: FloatArray, at: float) -> FloatArray:
    """Amplitudes at which a curve crosses a frequency, linear between its points.

    >>> crossings(np.array([1.0, 3.0, 2.0]), np.array([0.0, 2.0, 3.0]), 2.5)
    array([1.5, 2.5])
    """
    start, end = frequency[:-1] - at, frequency[1:] - at
    here = np.flatnonzero((start * end <= 0.0) & (start != end))
    share = start[here] / (start[here] - end[here])
    found: FloatArray = amplitude[:-1][here] + share * np.diff(amplitude)[here]
    return found


def off_the_curve(curve: Any, points: Any) -> FloatArray:
    """Relative distance of simulated points from the nearest solution of a curve at their frequency."""
    frequency, amplitude = curve.frequency.values, curve.amplitude.values
    known = np.isfinite(points.frequency.values)
    pairs = zip(points.frequency.values[known], points.amplitude.values[known], strict=True)
    return np.array([np.min(np.abs(crossings(frequency, amplitude, at) / own - 1.0)) for at, own in pairs])


def several_states(points: Any) -> FloatArray:
    """The frequencies at which an upward and a downward sweep come to different amplitudes."""
    found: dict[float, list[float]] = {}
    for at, amplitude in zip(points.frequency.values, points.amplitude.values, strict=True):
        if np.isfinite(at):
            found.setdefault(float(at), []).append(float(amplitude))
    return np.array([at for at, both in sorted(found.items()) if max(both) > (1.0 + APART) * min(both)])


def figure_14(folder: Path) -> list[Row]:
    """Where the simulation has two states, where the single harmonic has three; how far they are apart."""
    curve, points = (
        _read(folder / f"figure14{name}.nc").isel(curve=0).dropna("point", subset=["frequency"])
        for name in ("", "-points")
    )
    several = several_states(points)
    folds = sorted(curve.fold_frequency.values)
    unstable = curve.frequency.values[curve.stable.values == 0.0]
    middle = unstable.size > 0 and folds[0] <= unstable.min() and unstable.max() <= folds[-1]
    peaks = float(curve.peak_amplitude), float(np.max(points.amplitude.values))
    apart = peaks[0] / peaks[1] - 1.0
    return [
        Row("two states of the simulation", "1.195 to 1.235 rad/s",
            f"{several[0]:g} to {several[-1]:g} rad/s, of points {_step(points):g} apart",
            (round(several[0], 6), round(several[-1], 6)) == TWO_STATES),
        Row("three solutions of harmonic balance, one of them unstable", "a dashed part of the curve",
            f"{folds[0]:.4f} to {folds[-1]:.4f} rad/s", bool(len(folds) == 2 and middle)),
        Row("difference from the simulation near the resonance", "slight",
            f"peak {peaks[0]:.2f}, simulated {peaks[1]:.2f}: {apart:.1%}", abs(apart) < SLIGHT),
    ]  # fmt: skip


def _step(points: Any) -> float:
    return float(np.round(np.diff(np.unique(points.frequency.values)).min(), 6))


def _read(path: Path) -> Any:
    """A response file at the first degree of freedom, u."""
    with xarray.open_dataset(path) as file:
        return file.isel(dof=0).load()


def figure_15(folder: Path) -> list[Row]:
    """Amplitude at the end of each phase: the upper branch, then the lower and never back."""
    data = _read(folder / "figure15.nc").isel(curve=0)
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
    balance = Row("work of the force less energy dissipated and stored", "not stated", f"{error:.1g}", None)
    return [*rows, balance]
