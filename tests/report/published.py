"""Numbers that others have published of scenes that are bundled, beside those obtained (``make report``)."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import click
import numpy as np

from fcm.cli.messages import Messages, pass_messages
from fcm.files import replacing
from fcm.harmonic_balance.system import System
from fcm.nonlinear_modes.backbone import nonlinear_mode
from fcm.response.sweep import trace
from fcm.results.result import Curve
from fcm.scene.load import load_scene
from fcm.shooting.initial_orbits import solution_at
from fcm.structure.ring import nodal_diameters

from .page import Section, Table
from .rows import Row

TMDSIMPY = "tmdsimpy, 2dof_eldry_fric"  # github.com/tmd-lab/tmdsimpy, 1024 samples a cycle
NLVIB = "NLvib, beam with friction"
PYHARM = "pyHarm, lumped bladed disk"  # its sixth tutorial, after Laxalde and others (2007)
DEN_HARTOG = "Den Hartog (1931)"
ONE = {25: 10.499584, 50: 17.202195, 80: 32.168471, 100: 45.539025, 200: 124.093857, 300: 206.469541}
DISK = {0: 88.26374399, 1: 169.3441295, 2: 189.3018526}  # Hz, the first of a nodal diameter
LIFTING = {1: 40.019506, 3: 38.8184, 8: 38.83219}  # by the number of harmonics
SAMPLED = 5e-6  # relative, what 1024 samples a cycle may be off: (2 pi / 1024)^2 / 8
FINE = 0.01  # longest step, where the greatest fundamental is taken from a parabola between points
STIFF = (1e4, 1e6)  # contact stiffnesses, from which the rigid limit is extrapolated by their root
COLUMNS = ("source", "quantity", "published", "obtained")
ABOUT = (
    "Bundled scenes dry-friction, dry-friction-lift-off, beam, bladed-disk and den-hartog; tests/published "
    "asserts the same and more. The peaks of tmdsimpy, of the fundamental, are sampled at 1024 times a "
    "cycle, which may be off by 5e-6; damping and frequencies of the sliding beam are read to 1 %; the "
    "rigid limit is known in closed form.",
)


def greatest_fundamental(curve: Curve) -> float:
    """Of the first degree of freedom, by the parabola through the highest point and its neighbours."""
    top = int(np.nanargmax(curve.fundamental[:, 0]))
    near = slice(top - 1, top + 2)
    a, b, c = np.polyfit(curve.frequency[near] - curve.frequency[top], curve.fundamental[near, 0], 2)
    return float(c - b * b / (4.0 * a))


def _row(source: str, quantity: str, stated: float, obtained: float, within: float) -> tuple[str, Row]:
    agrees = abs(obtained / stated - 1.0) <= within
    return source, Row(quantity, f"{stated:.8g}", f"{obtained:.8g}", agrees)


def dry_friction() -> Iterator[tuple[str, Row]]:
    """Two degrees of freedom with elastic friction and a variable normal load."""
    curves = trace(load_scene("dry-friction")).curves
    for curve in curves:
        force = int(curve.parameters["force.tangent.amplitude"])
        peak = curve.peaks["tangent"].amplitude
        yield _row(TMDSIMPY, f"peak at a force of {force}, one harmonic", ONE[force], peak, SAMPLED)
    fine = replace(load_scene("dry-friction").curves[0], max_step=FINE, curves=())
    (eight,) = trace(fine, harmonics=8).curves
    yield _row(
        TMDSIMPY, "peak at a force of 25, eight harmonics", 10.52245, greatest_fundamental(eight), SAMPLED
    )
    lifting = replace(load_scene("dry-friction-lift-off"), max_step=FINE)
    for harmonics, stated in LIFTING.items():
        (curve,) = trace(lifting, harmonics=harmonics).curves
        name = f"with lift-off, peak with {harmonics} harmonic{'s' if harmonics > 1 else ''}"
        yield _row(TMDSIMPY, name, stated, greatest_fundamental(curve), SAMPLED)


def beam() -> Iterator[tuple[str, Row]]:
    """The first nonlinear mode of a clamped beam with a friction contact, seven harmonics."""
    mode = nonlinear_mode(System(load_scene("beam").in_use(), tuple(range(1, 8))), 1, (1e-6, 1e-2), 0.05)
    top = int(mode.damping.argmax())
    yield _row(NLVIB, "frequency, stuck [rad/s]", 707.955, float(mode.omega[0]), 2e-6)
    yield _row(NLVIB, "frequency, sliding [rad/s]", 427.007, float(mode.system.linear.natural[0]), 2e-6)
    yield _row(NLVIB, "greatest damping ratio", 0.186, float(mode.damping[top]), 0.01)
    yield _row(NLVIB, "frequency at that [rad/s]", 519.0, float(mode.omega[top]), 0.01)
    after = slice(top, None)
    for omega, damping in ((503.4, 0.184), (429.6, 0.0331)):
        found = float(np.interp(omega, mode.omega[after][::-1], mode.damping[after][::-1]))
        yield _row(NLVIB, f"damping ratio at {omega} rad/s", damping, found, 0.01)


def bladed_disk() -> Iterator[tuple[str, Row]]:
    """The first frequency of each nodal diameter of a disk of 24 sectors."""
    diameters = nodal_diameters(load_scene("bladed-disk"))
    for number, stated in DISK.items():
        found = float(diameters[number].opened[0] / (2.0 * np.pi))
        yield _row(PYHARM, f"first frequency of diameter {number} [Hz]", stated, found, 5e-10)


def den_hartog() -> Iterator[tuple[str, Row]]:
    """A mass on rigid Coulomb friction of half the force, without stops: x = sqrt(Q^2 - (F U)^2)."""
    for r in (0.6, 0.7, 0.8):
        U = np.sin(np.pi / r) / (r * (1.0 + np.cos(np.pi / r)))
        rigid = float(np.sqrt(1.0 / (1.0 - r * r) ** 2 - (0.5 * U) ** 2))
        soft, stiff = (_exact_amplitude(k_u, r) for k_u in STIFF)
        limit = (10.0 * stiff - soft) / 9.0  # what is off goes by the root of the stiffness
        yield _row(DEN_HARTOG, f"exact motion at {r} of the natural frequency", rigid, limit, 2e-5)


def _exact_amplitude(k_u: float, r: float) -> float:
    scene = load_scene("den-hartog")
    contacts = (replace(scene.contacts[0], k_u=k_u),)
    scene = replace(scene, contacts=contacts, curves=(), frequency_range=(r, r + 0.01))
    return float(solution_at(scene, r).measure.amplitude[0])


@click.command()
@click.argument("output", type=click.Path(dir_okay=False, path_type=Path))
@pass_messages
def published(messages: Messages, output: Path) -> None:
    """Compute the numbers and write them beside the published ones as JSON to OUTPUT."""
    begin = time.perf_counter()
    found = [
        (source, *row) for case in (dry_friction, beam, bladed_disk, den_hartog) for source, row in case()
    ]
    with replacing(output) as partial:
        partial.write_text(json.dumps(found, indent=1), encoding="utf-8")
    agree = sum(bool(row[-1]) for row in found)
    messages.info(f"wrote {output}: {agree} of {len(found)} agree, in {time.perf_counter() - begin:.1f} s")


def section(path: Path) -> Section:
    """The rows of a file for the page."""
    rows = json.loads(path.read_text(encoding="utf-8"))
    agree = [row[-1] for row in rows]
    text = (*ABOUT, f"{sum(agree)} of {len(agree)} agree.")
    tables = (Table(COLUMNS, [tuple(row[:4]) for row in rows], agree),)
    return Section("Others' cases", text=text, commands=("make published",), tables=tables)


def failures(path: Path) -> list[tuple[str, str]]:
    """Those that differ."""
    rows = json.loads(path.read_text(encoding="utf-8"))
    return [(row[0], f"{row[1]}: {row[3]}, published {row[2]}") for row in rows if not row[4]]
