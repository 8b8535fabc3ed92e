"""Numbers of the figures of one contact: hysteresis loops (5, 6, 8) and coefficients (10, 11, 12)."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from fcm.contact import fourier_coefficients, normal_coefficients
from fcm.contact.limits import FloatArray
from fcm.contact.loop import sequences
from fcm.contact.surface import B_RANGE, N0_RANGE, boundaries

from .rows import Row, near

SLIP_ENDS = (22.9, 159.7)  # [degree] printed for figure 5
FIGURE_7 = {"SEP", "SEN", "SP", "SN", "SNEP", "SPEN", "SEPEN", "SENEP", "SPENEP", "SNEPEN"}
CONTACTS = 200_000  # drawn at random to see which sequences occur
STEPS = 201  # of a coefficient along an axis

LoopRecord = dict[str, Any]  # one of what ``fcm plot loop --json`` prints


def read_loops(path: Path) -> list[LoopRecord]:
    """What ``fcm plot loop --json`` has printed."""
    loops: list[LoopRecord] = json.loads(path.read_text(encoding="utf-8"))["loops"]
    return loops


def slip_ends(loop: LoopRecord) -> tuple[float, float]:
    """Where positive and where negative slip end in a stick [degree]."""
    ends = {t["from"]: t["degrees"] for t in loop["transitions"] if t["to"] == "E"}
    return ends["P"], ends["N"]


def motion_of_ends(positive: float, negative: float) -> tuple[float, float]:
    """b_bar [-] and phi [degree] at which slip ends at these angles from the greatest displacement [degree].

    (A4) and (A5) with theta = angle + 90 degrees, solved: b sin(phi) = (1 - b cos(phi)) tan(positive) and
    b sin(phi) = (1 + b cos(phi)) tan(180 - negative).
    """
    first, second = math.tan(math.radians(positive)), math.tan(math.radians(180.0 - negative))
    along, across = (first - second) / (first + second), 2.0 * first * second / (first + second)
    return math.hypot(along, across), math.degrees(math.atan2(across, along))


def figure_5(folder: Path) -> list[Row]:
    """The two ends of slip, and the motion that they belong to."""
    (loop,) = read_loops(folder / "figure5.json")
    ends = slip_ends(loop)
    b_bar, phi = motion_of_ends(*SLIP_ENDS)
    names = ("end of positive slip, after the reversal at 0°", "end of negative slip, before that at 180°")
    rows = [
        near(name, stated, end, within=0.05, form=".2f", unit="°")
        for name, stated, end in zip(names, SLIP_ENDS, ends, strict=True)
    ]
    drawn = f"b̄ = {loop['b_bar']:g}, φ = {math.degrees(loop['phi']):g}°"
    solved = Row(
        "motion that (A4) and (A5) give for these two angles", "not printed",
        f"b̄ = {b_bar:.4f}, φ = {phi:.2f}°; drawn: {drawn}", None,
    )  # fmt: skip
    four = Row(
        "alternating regions of stick and slip", "4", str(len(loop["sequence"])), loop["sequence"] == "EPEN"
    )
    return [*rows, four, solved]


def slip_limit(b_bar: float, phi: float) -> float:
    """The n0_bar above which nothing slips, equation (25)."""
    return float(boundaries(np.array([b_bar]), phi)["slip"][0])


def starts_in_phase(n0_bar: float, b_bar: float) -> tuple[float, float]:
    """Where negative and positive slip begin in phase [degree], by the formulas of figure 4's caption.

    Their angles count from the greatest displacement; mu gamma is b_bar. The first is printed with the
    denominator 1 - mu gamma; -n = f at the end of the stick gives 1 + mu gamma.
    """
    first = math.acos((1.0 - 2.0 * n0_bar - b_bar) / (1.0 + b_bar))
    second = 2.0 * math.pi - math.acos((2.0 * n0_bar - b_bar - 1.0) / (1.0 - b_bar))
    return math.degrees(first) + 90.0, math.degrees(second) + 90.0


def figure_6(folder: Path) -> list[Row]:
    """Slip without separation at every phase; in phase, slip ends where the motion reverses."""
    loops = read_loops(folder / "figure6.json")
    inside = all(loop["b_bar"] < loop["n0_bar"] < slip_limit(loop["b_bar"], loop["phi"]) for loop in loops)
    states = {loop["sequence"] for loop in loops}
    in_phase = next(loop for loop in loops if loop["phi"] == 0.0)
    ends = slip_ends(in_phase)
    starts = {t["to"]: t["degrees"] for t in in_phase["transitions"] if t["from"] == "E"}
    negative, positive = starts_in_phase(in_phase["n0_bar"], in_phase["b_bar"])
    others = [slip_ends(loop)[0] - 90.0 for loop in loops if loop["phi"] != 0.0]
    return [
        Row("preload between the limits of (26)", "yes", "at every phase" if inside else "no", inside),
        Row("states in order", "stick, slip, stick, slip", ", ".join(sorted(states)), states == {"EPEN"}),
        near("in phase, end of positive slip: at the reversal", 90.0, ends[0], 1e-9, ".1f", "°"),
        near("in phase, end of negative slip: at the reversal", 270.0, ends[1], 1e-9, ".1f", "°"),
        near("in phase, start of positive slip: θ₂ of figure 4", positive, starts["P"], 1e-9, ".3f", "°"),
        near("in phase, start of negative slip: θ₁ of figure 4, its denominator read as 1 + μγ",
             negative, starts["N"], 1e-9, ".3f", "°"),
        Row(
            "at other phases, from the reversal to the end of positive slip", "not zero",
            ", ".join(f"{end:.1f}°" for end in others), min(map(abs, others)) > 1.0,
        ),
    ]  # fmt: skip


def sequences_with_separation(count: int = CONTACTS, seed: int = 0) -> set[str]:
    """The sequences in which random contacts separate and close again."""
    draw = np.random.default_rng(seed)
    b_bar = np.exp(draw.uniform(-3.0, 3.0, count))
    found = sequences(draw.uniform(-1.0, 1.0, count) * b_bar, b_bar, draw.uniform(-np.pi, np.pi, count))
    return {str(name) for name in np.unique(found)}


def figure_8(folder: Path) -> list[Row]:
    """Separation at every phase; the ten sequences of figure 7."""
    loops = read_loops(folder / "figure8.json")
    shown = [loop["sequence"] for loop in loops]
    found = sequences_with_separation()
    return [
        Row("separation within the cycle", "yes", ", ".join(shown), all("S" in s for s in shown)),
        Row(
            f"sequences with separation (of {CONTACTS} random contacts)", "10, listed in figure 7",
            f"{len(found)}: {', '.join(sorted(found, key=lambda s: (len(s), s)))}", found == FIGURE_7,
        ),
    ]  # fmt: skip


def constant_load(n0_bar: FloatArray) -> tuple[FloatArray, FloatArray]:
    """F_s and F_c of a contact under constant load, the classical result for the bilinear loop.

    With cos(beta) = 1 - 2 n0_bar: F_s = (beta - sin(2 beta) / 2) / pi, F_c = sin(beta)^2 / pi.
    """
    beta = np.arccos(np.clip(1.0 - 2.0 * n0_bar, -1.0, 1.0))
    return (beta - 0.5 * np.sin(2.0 * beta)) / np.pi, np.sin(beta) ** 2 / np.pi


def damping_beyond_one(phi: float) -> float:
    """Greatest F_c where the load varies so much that b_bar > 1, over the plane that is drawn."""
    n0_bar = np.linspace(*N0_RANGE, STEPS)[:, None]
    b_bar = np.linspace(1.0, B_RANGE[1], STEPS)[1:]
    return float(np.max(fourier_coefficients(n0_bar, b_bar, phi)[2]))


def figure_10(folder: Path) -> list[Row]:
    """No damping in phase beyond b_bar = 1; constant load at b_bar = 0."""
    n0_bar = np.linspace(0.0, N0_RANGE[1], STEPS)
    _, *found = fourier_coefficients(n0_bar, 0.0, 0.0)
    error = max(
        float(np.max(np.abs(F - known))) for F, known in zip(found, constant_load(n0_bar), strict=True)
    )
    largest = damping_beyond_one(0.0)
    return [
        Row("greatest damping F_c for b̄ > 1", "0", f"{largest:.1g}", abs(largest) < 1e-12),
        Row(
            "edge b̄ = 0: difference from the classical constant-load result",
            "0",
            f"{error:.1g}",
            error < 1e-12,
        ),
    ]


def figure_11(folder: Path) -> list[Row]:
    """Damping beyond b_bar = 1 once there is a phase."""
    in_phase = float(np.max(fourier_coefficients(np.linspace(0.0, 1.0, STEPS), 0.0, 0.0)[2]))
    rows = []
    for degrees in (15.0, 30.0):
        largest = damping_beyond_one(math.radians(degrees))
        share = f"{largest:.3f}, {largest / in_phase:.0%} of the most under constant load"
        rows.append(
            Row(f"φ = {degrees:g}°: greatest F_c for b̄ > 1", "significant", share, largest > 0.1 * in_phase)
        )
    return rows


def figure_12(folder: Path) -> list[Row]:
    """The limits of the stiffness N_s: 1 without separation, 0 without contact, 1/2 for large motion."""
    closed, large, opened = (float(normal_coefficients(x)[1]) for x in (1.0, 1e-9, -1.0))
    large_gap = float(normal_coefficients(-1e-9)[1])
    return [
        near("N_s of a preloaded contact under small motion, n₀* > 1", 1.0, closed, 1e-12),
        near("N_s of a gap under small motion, n₀* < −1", 0.0, opened, 1e-12),
        near("N_s of a preloaded contact under large motion", 0.5, large, 1e-8),
        near("N_s of a gap under large motion", 0.5, large_gap, 1e-8),
    ]
