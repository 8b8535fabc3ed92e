"""The loops that ``fcm plot loop`` draws, from parameters or from points of a response."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import field
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.columns import ranges
from fcm.cli.drawing import not_at, shorten
from fcm.cli.limits import SENTENCES
from fcm.cli.loop_names import Harmonic, Name, named, phase_of, unit_of
from fcm.frozen import Frozen
from fcm.rotational_dofs import dof_unit

if TYPE_CHECKING:
    from fcm.contact import Loop, PeriodicLoop
    from fcm.contact.plane.loop import PlanarLoop
    from fcm.plot.loop_file import LinePoint, LoopFile, LoopPoint, NormalPoint, PlaceOnCurve, PlanePoint


class Case(Frozen):
    """A loop, with its parameters as named in a picture, and further data on it."""

    loop: Loop | PeriodicLoop  # dimensionless: displacements divided by a, forces by k_u a
    ratios: tuple[float, float, float]  # n0_bar, b_bar [-] and phi [rad]; with harmonics, of the fundamental
    names: tuple[Name, ...]  # one for each parameter, the same in every case
    note: str = ""
    amplitude: float = 1.0  # a
    force: float = 1.0  # k_u a
    facts: dict[str, Any] = field(default_factory=dict)  # for --json
    units: tuple[str, str] | None = None  # of length and force, if both are known

    def record(self, from_greatest: bool) -> dict[str, Any]:
        """Output of ``--json`` for the loop; displacements and forces are divided by a and k_u a."""
        from fcm.contact.sampled import shown_degrees, transitions

        loop = self.loop
        return {
            **self.facts,
            **dict(zip(("n0_bar", "b_bar", "phi"), self.ratios, strict=True)),
            "sequence": loop.sequence,
            "transitions": [
                {
                    "from": one.states[0],
                    "to": one.states[1],
                    "degrees": shown_degrees(one.theta, from_greatest),
                    "displacement": one.displacement,
                    "force": one.force,
                }
                for one in transitions(loop)
            ],
            **dict(zip(("F_b", "F_s", "F_c"), self._coefficients(), strict=True)),
        }

    def _coefficients(self) -> tuple[float, float, float]:
        from fcm.contact import PeriodicLoop, fourier_coefficients, periodic_forces

        loop = self.loop
        if isinstance(loop, PeriodicLoop):
            f, _ = periodic_forces(loop.u, loop.v, loop.mu, loop.k_u, loop.k_v, loop.n_0)
            return f[0].real, -f[1].imag, f[1].real
        F_b, F_s, F_c = map(float, fourier_coefficients(*self.ratios))
        return F_b, F_s, F_c


class PlanarCase(Frozen):
    """The loop of a contact that slides in a plane."""

    loop: PlanarLoop
    directions: tuple[str, str]
    names: tuple[Name, ...]
    note: str
    facts: dict[str, Any]
    units: tuple[str, str] | None
    start: tuple[float, float] = (0.0, 0.0)  # displacements at which it starts unstressed

    def dimensionless(self) -> PlanarLoop:
        """The loop with displacements in units of the amplitude a and forces in units of k_u a."""
        from fcm.contact import planar_loop

        loop, a, force = self.loop, self.facts["a"], self.facts["k_u a"]
        if not (a > 0.0 and force > 0.0):
            raise click.UsageError("--dimensionless: k_u or the motion in the plane is zero.")
        motion = (loop.u_x / a, loop.u_y / a, loop.v / a)
        x, y = self.start
        return planar_loop(
            *motion, loop.mu, 1.0, loop.k_v / loop.k_u, loop.n_0 / force, start_x=x / a, start_y=y / a
        )

    def record(self, _from_greatest: bool) -> dict[str, Any]:
        """Output of ``--json`` for the loop in a plane."""
        import numpy as np

        loop = self.loop
        return {
            **self.facts,
            "directions": dict(zip("xy", self.directions, strict=True)),
            "sequence": loop.sequence,
            "transitions": [
                {"to": state, "degrees": math.degrees(theta)}
                for state, theta in zip(loop.sequence, loop.angles.tolist(), strict=False)
            ],
            "dissipated_energy": loop.dissipation,
            "slip_path": loop.slip_path,
            "greatest_friction_force": float(np.float64(loop.greatest_force)),
        }


class NormalCase(Frozen):
    """The normal force of a contact without friction."""

    loop: PeriodicLoop  # without tangential motion; it sticks while the contact is closed
    names: tuple[Name, ...]
    note: str
    facts: dict[str, Any]
    units: tuple[str, str] | None

    def record(self, _from_greatest: bool) -> dict[str, Any]:
        """Output of ``--json`` for the normal force."""
        loop = self.loop
        return {
            **self.facts,
            "sequence": self.states(),
            "transitions": [
                {"to": "open" if state == "S" else "closed", "degrees": math.degrees(theta)}
                for state, theta in zip(loop.sequence, loop.angles.tolist(), strict=False)
            ],
            "k_v": loop.k_v,
            "n_0": loop.n_0,
            "least_normal_force": max(loop.least_load, 0.0),
            "greatest_normal_force": max(loop.greatest_load, 0.0),
        }

    def states(self) -> list[str]:
        """States of the cycle in order."""
        return ["open" if state == "S" else "closed" for state in self.loop.sequence]


def of_ratios(n0_bars: Iterable[float], b_bars: Iterable[float], phases: Iterable[float]) -> list[Case]:
    """Every combination of dimensionless parameters."""
    from fcm.contact import hysteresis_loop

    cases = []
    for n0_bar, b_bar, phi in product(n0_bars, b_bars, phases):
        names = (named("n0_bar", n0_bar), named("b_bar", b_bar), phase_of(phi))
        cases.append(Case(hysteresis_loop(n0_bar, b_bar, phi), (n0_bar, b_bar, phi), names))
    return cases


def of_contact(
    values: dict[str, Sequence[float]],
    phases: Iterable[float],
    harmonics: Sequence[Harmonic],
    units: tuple[str, str] | None,
) -> list[Case]:
    """Every combination of mu, k_u, k_v, n_0, a, b and phase of one contact; all with the same harmonics."""
    cases, length = [], units[0] if units else ""
    for *numbers, phi in product(*values.values(), phases):
        one = dict(zip(values, numbers, strict=True))
        force = one["k_u"] * one["a"]
        n0_bar, b_bar = (
            one["mu"] * load / force if force else math.inf for load in (one["n_0"], one["k_v"] * one["b"])
        )
        if not (math.isfinite(n0_bar) and math.isfinite(b_bar)):
            raise click.UsageError(
                f"mu n_0 / (k_u a) = {n0_bar:g} and mu k_v b / (k_u a) = {b_bar:g} have to be finite."
            )
        names = (
            *(named(key, value, unit_of(key, units)) for key, value in one.items()),
            phase_of(phi),
            *(h.name(length) for h in harmonics),
        )
        facts = {**one, "harmonics": [h._asdict() for h in harmonics]} if harmonics else one
        loop = _loop(one, (n0_bar, b_bar, phi), harmonics)
        cases.append(Case(loop, (n0_bar, b_bar, phi), names, amplitude=one["a"], force=force, facts=facts))
    return cases


def _loop(
    one: dict[str, float], ratios: tuple[float, float, float], harmonics: Sequence[Harmonic]
) -> Loop | PeriodicLoop:
    """The dimensionless loop of a contact; in closed form if there are no harmonics."""
    import cmath

    from fcm.contact import hysteresis_loop, periodic_loop

    if not harmonics:
        return hysteresis_loop(*ratios)
    a, k_u = one["a"], one["k_u"]
    stiffness, preload = one["k_v"] / k_u, one["n_0"] / (k_u * a)
    first = Harmonic("u", 1, a, 0.0), Harmonic("v", 1, one["b"], ratios[2])
    motion = {name: [0j] * (1 + max(h.order for h in harmonics)) for name in "uv"}
    for h in (*first, *harmonics):
        if not math.isfinite(h.amplitude / a + stiffness + preload):
            raise click.UsageError("amplitudes / a, k_v / k_u and n_0 / (k_u a) have to be finite.")
        # amplitude sin(h theta + phase) is the real part of -i amplitude exp(i phase) exp(i h theta)
        motion[h.motion][h.order] = cmath.rect(h.amplitude / a, h.phase - 0.5 * math.pi)
    return periodic_loop(motion["u"], motion["v"], one["mu"], 1.0, stiffness, preload)


def of_file(
    path: Path,
    curves: Sequence[int | None],
    contact: str | None,
    places: Sequence[PlaceOnCurve | None],
    solution: int | None,
    tell: Callable[[str], None],
) -> list[Case] | list[PlanarCase] | list[NormalCase]:
    """The loops of a contact at places of curves of a response file.

    A message tells which contact was chosen by default.
    """
    from fcm.plot.loop_file import NormalPoint, PlanePoint, busiest, points_at, read_loops
    from fcm.plot.read import read

    file = read_loops(path)
    told = [busiest(file)[1]] if contact is None else []
    cases: list[Case] = []
    planar: list[PlanarCase] = []
    normal: list[NormalCase] = []
    for curve, place in product(curves, places):
        points = points_at(file, curve, contact, place, solution)
        if place is not None:
            unit = "" if place.modal else file.unit
            told.append(not_at(place.value, [place.of(one) for one in points], unit))
        for point in points:
            with read(path, "its loops cannot be drawn"):
                asked = _asked(point, place, file)
                if isinstance(point.motion, NormalPoint):
                    normal.append(_without_friction(point, point.motion, file, asked))
                elif isinstance(point.motion, PlanePoint):
                    planar.append(_in_plane(point, point.motion, file, asked))
                else:
                    cases.append(_on_a_line(point, point.motion, file, asked))
    for said in filter(None, told):  # only after all checks
        tell(said)
    return normal or planar or cases


def _asked(point: LoopPoint, place: PlaceOnCurve | None, file: LoopFile) -> Name:
    """The requested place, for the picture, if the drawn point is not at it; for messages see `not_at`."""
    from fcm.plot.read import asked_beside

    if place is None:
        return Name("", "")
    digits, unit = (4, "") if place.modal else (5, file.unit)
    text = asked_beside(place.value, place.of(point), unit, digits)
    return Name(text, text, in_message=False)


def _said(point: LoopPoint, file: LoopFile, asked: Name) -> tuple[tuple[Name, ...], str, dict[str, Any]]:
    """The names of a point in a picture, further text on it, and its data for --json."""
    from fcm.plot.labels import curve_label

    unit, modal = file.unit, point.modal_amplitude
    symbol = {"Hz": "$f$", "level": "level"}.get(unit, r"$\omega$")
    at = f"{point.frequency:.5g}" if unit == "level" else f"{point.frequency:.5g} {unit}"
    swept = ", ".join(
        f"{key} = {value:g} {file.units.get(key, '')}".rstrip() for key, value in point.parameters.items()
    )
    names: tuple[Name, ...] = (
        Name(shorten(point.contact, SENTENCES.contact_name).replace("$", r"\$"), point.contact),
        Name(curve_label(point.parameters, units=file.units), swept),
        *((_peak(point, file),) if point.peak else ()),
        *(() if modal is None else (Name(f"modal amplitude {modal:.4g}", f"modal amplitude {modal:.4g}"),)),
        Name(f"{symbol} = {at}", f"level {at}" if unit == "level" else at),
        asked,
    )
    if point.fundamental:
        names += (Name("fundamental alone", f"fundamental alone of harmonics {ranges(point.harmonics)}"),)
    stable = {True: "stable", False: "unstable", None: ""}[point.stable]
    facts = {
        "curve": point.curve, "parameters": point.parameters, "contact": point.contact,
        ("level" if unit == "level" else "frequency"): point.frequency,
        **({} if modal is None else {"modal_amplitude": modal}),
        "solution": point.solution.number, "solutions": point.solution.among,
        "output": point.output, "output_amplitude": point.displacement, "peak": point.peak,
        "stable": point.stable, "a": point.amplitude, "k_u a": point.force,
        "harmonics": point.harmonics, "states": point.states,
    }  # fmt: skip
    return names, ", ".join(filter(None, (str(point.solution), stable))), facts


def _peak(point: LoopPoint, file: LoopFile) -> Name:
    """The degree of freedom whose peak it is, and its amplitude."""
    unit = dof_unit(point.output, file.dimensions[0] if file.dimensions else "")
    text = f"peak of {point.output} = {point.displacement:.4g} {unit}".rstrip()
    return Name(text.replace("$", r"\$"), text)


def _in_plane(point: LoopPoint, plane: PlanePoint, file: LoopFile, asked: Name) -> PlanarCase:
    from fcm.contact import planar_loop

    names, note, facts = _said(point, file, asked)
    u_x, u_y, v = plane.motion
    mu, k_u, k_v, n_0 = plane.law
    start_x, start_y = plane.start
    loop = planar_loop(u_x, u_y, v, mu, k_u, k_v, n_0, start_x=start_x, start_y=start_y)
    return PlanarCase(loop, plane.directions, names, note, facts, file.dimensions, plane.start)


def _without_friction(point: LoopPoint, normal: NormalPoint, file: LoopFile, asked: Name) -> NormalCase:
    from fcm.contact import periodic_loop

    names, note, facts = _said(point, file, asked)
    k_v, n_0 = normal.law
    loop = periodic_loop([0.0], normal.motion, 1.0, 1.0, k_v, n_0)
    own = {key: value for key, value in facts.items() if key not in ("a", "k_u a")}
    return NormalCase(loop, names, note, own, file.dimensions)


def _on_a_line(point: LoopPoint, motion: LinePoint | None, file: LoopFile, asked: Name) -> Case:
    from fcm.contact import hysteresis_loop, periodic_loop

    names, note, facts = _said(point, file, asked)
    ratios, a, force = (point.n0_bar, point.b_bar, point.phi), point.amplitude, point.force
    loop: Loop | PeriodicLoop
    if motion is None or not force > 0.0:
        loop = hysteresis_loop(*ratios)
    else:
        mu, k_u, k_v, n_0 = motion.law
        u, v = motion.motion / a
        loop = periodic_loop(u, v, mu, 1.0, k_v / k_u, n_0 / force)
    return Case(loop, ratios, names, note, a, force, facts, file.dimensions)
