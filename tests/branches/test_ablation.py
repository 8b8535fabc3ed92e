"""Each mechanism that looks for branches is needed for an answer."""

from pathlib import Path

import pytest

from fcm.scene import load_scene

from .ablation import OFF, answer, changes, without

SCENES = Path(__file__).parent / "scenes"


@pytest.mark.parametrize(
    ("mechanism", "name", "harmonics", "lost"),
    [
        ("folds followed", "closed_impact", 4, "branches 3 -> 2"),
        ("branch points", "equal_stops", 3, "peak x1"),
    ],
)
def test_without_a_mechanism_an_answer_is_lost(mechanism, name, harmonics, lost):
    scene = load_scene(SCENES / f"{name}.toml").each_curve()[0]
    whole = answer(scene, harmonics)
    with without(OFF[mechanism]):
        found = list(changes(whole, answer(scene, harmonics)))
    assert any(one.startswith(lost) for one in found)
