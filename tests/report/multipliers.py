"""Floquet multipliers of the paper's oscillator without preload, balanced, exact (``make multipliers``)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import click
import numpy as np

from fcm.branches.force_level import solutions
from fcm.cli.messages import Messages, pass_messages
from fcm.harmonic_balance.system import System
from fcm.model.scene import Scene
from fcm.scene.load import load_scene
from fcm.shooting import periodic
from fcm.stability.floquet import ComplexArray, multipliers

from .measured import write_measured
from .multipliers_picture import Way, draw_multipliers

HARMONICS = (1, 3, 9)
SPAN, POINTS = (0.70, 0.80), 81
MODES = 2


@click.command("multipliers")
@click.argument("output", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--picture", type=click.Path(dir_okay=False, path_type=Path), required=True, metavar="FILE")
@pass_messages
def multipliers_page(messages: Messages, output: Path, picture: Path) -> None:
    """Write the multipliers as JSON to OUTPUT and draw them."""
    scene = load_scene("yang1998-n5")
    scene = replace(scene, contacts=tuple(replace(one, n_0=0.0) for one in scene.contacts))
    ways = ways_of(scene, np.linspace(*SPAN, POINTS).tolist(), HARMONICS)
    write_measured(output, ways, picture, draw_multipliers(ways))
    messages.info(f"wrote {output} and {picture}")


def ways_of(scene: Scene, frequencies: Sequence[float], harmonics: Sequence[int]) -> list[Way]:
    """Those of the balance with harmonics 1 to each number, and of the exact motion."""
    names = ["1 harmonic" if highest == 1 else f"{highest} harmonics" for highest in harmonics]
    found = [_balanced(scene, highest, frequencies) for highest in harmonics]
    exact = [periodic(scene, omega).multipliers for omega in frequencies]
    return [_way(*one, frequencies) for one in zip([*names, "exact"], [*found, exact], strict=True)]


def _balanced(scene: Scene, highest: int, frequencies: Sequence[float]) -> list[ComplexArray]:
    system = System(scene, tuple(range(1, highest + 1)))
    return [multipliers(system, solutions(system, omega).solutions[0]) for omega in frequencies]


def _way(name: str, found: Sequence[ComplexArray], frequencies: Sequence[float]) -> Way:
    """As many of each as two for each mode: a slider that forgets has none, or 0."""
    rows = [one[: 2 * MODES] for one in found]
    real, imaginary = [one.real.tolist() for one in rows], [one.imag.tolist() for one in rows]
    return Way(name, list(frequencies), real, imaginary)
