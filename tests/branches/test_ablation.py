"""Each mechanism that looks for branches, peaks or harmonics is needed for an answer."""

from dataclasses import replace
from pathlib import Path

import pytest

from fcm.scene import load_scene, scene_from_dict

from ..response.test_leading import masses
from ..response.test_narrow import around, with_mode
from ..response.test_shakedown import wedged
from .ablation import OFF, answer, changes, without
from .relatives import KINDS
from .test_further_levels import ONE_MODE
from .test_low_harmonics import beyond

SCENES, KNOWN = Path(__file__).parent / "scenes", Path(__file__).parents[1] / "harmonic_balance/scenes"


def one(folder, name, span=None):
    scene = load_scene(folder / f"{name}.toml").each_curve()[0]
    return scene if span is None else replace(scene, frequency_range=span)


LOST = [
    ("folds followed", one(KNOWN, "far_isola"), 5, "branches 2 -> 1"),
    ("branch points", one(SCENES, "equal_stops"), 3, "peak x1"),
    ("symmetry in the level", KINDS["stops"](16), 5, "branches 5 -> 4"),
    ("friction raised from none", wedged(300), 3, "peak d0"),
    ("prolongation", one(KNOWN, "missed"), 8, "branches 4 -> 3"),
    ("levels in gaps", one(KNOWN, "between_resonances"), 3, "peak 30y"),
    ("levels at lost peaks", one(KNOWN, "isolated_by_harmonics"), 3, "peak 9x"),
    ("levels near peaks without preload", one(SCENES, "large_motions"), 3, "peak u"),
    ("levels below peaks", scene_from_dict(ONE_MODE).each_curve()[0], 5, "branches 4 -> 3"),
    ("levels where nothing is stable", one(KNOWN, "chaos", (1.23, 1.6)), 3, "peaks of unknown"),
    ("narrow resonances", replace(around(with_mode(-60.0, 1.31, 1e-5, 0.005)), max_step=0.1), 3, "peak u"),
    ("peaks between points", masses(["*"], 6, 2.0), 3, "peak m"),
    ("stages that ask for more harmonics", one(SCENES, "equal_stops"), 0, "peak x1"),
    ("low harmonics", beyond().scene, 0, "peak v"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("mechanism", "scene", "harmonics", "lost"), LOST, ids=[one[0] for one in LOST])
def test_without_a_mechanism_an_answer_is_lost(mechanism, scene, harmonics, lost):
    whole = answer(scene, harmonics)
    with without(OFF[mechanism]):
        found = list(changes(whole, answer(scene, harmonics)))
    assert any(one.startswith(lost) for one in found)


def test_each_mechanism_is_tried():
    assert [one[0] for one in LOST] == list(OFF)
