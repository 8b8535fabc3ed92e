"""The design of a blade in the guide: its commands are those of `make design`, its numbers are true."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fcm.branches.trace import traced
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene
from fcm.scene.draft import number_of

from .program import shell

ROOT = Path(__file__).parents[1]
SCENES = ROOT / "src/fcm/scenes"
PAGE = (ROOT / ".github/guide/tutorials/best-preload.md").read_text(encoding="utf-8")
SECTION = re.search(r"^## Design\n(.*?)^## ", PAGE, re.M | re.S)[1]
COMMANDS = re.findall(r"^(fcm .*)$", SECTION, re.M)
LESS = {  # of what takes minutes
    "[220.0, 470.0]": "[400.0, 430.0]",
    "[[5.0, 60.0]]": "[[7.5, 8.5]]",
    "count = 8": "count = 2",
}


def test_make_runs_the_commands_that_are_shown():
    done = shell("make -n design", ROOT)
    assert re.findall(r"^cd build/design && \S*/(fcm .*)$", done.out, re.M) == COMMANDS
    assert len(COMMANDS) == 6


@pytest.mark.slow
def test_the_commands_run(tmp_path):
    for name in ("blade", "blade-scatter"):
        text = (SCENES / f"{name}.toml").read_text(encoding="utf-8")
        for old, new in LESS.items():
            text = text.replace(old, new)
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    for matrix in SCENES.glob("blade-*.mtx"):
        (tmp_path / matrix.name).write_bytes(matrix.read_bytes())
    for command in COMMANDS:
        words = [f"{word}.toml" if word in ("blade", "blade-scatter") else word for word in command.split()]
        done = shell(" ".join(words), tmp_path)
        assert done.code == 0, f"{command}\n{done.out}{done.err}"
    pictures = {path.name for path in tmp_path.glob("*.png")}
    assert len(pictures) == 4 and pictures == set(re.findall(r"-o (\S+\.png)", SECTION))


def test_an_ordinary_run_has_the_two_equal_peaks_that_are_printed():
    (shown,) = re.findall(r"least peak.40y: (\S+) \(error [^)]*\) with \S+ = ([\d.]+), where", SECTION)
    height, preload = map(float, shown)
    frequencies = [float(one) for one in re.findall(r"40y at (\S+) Hz", SECTION)]
    scene = load_scene("blade")
    there = replace(number_of(scene, "contact.*.n_0").put(scene, preload), max_step=0.05)
    (path,) = traced(System(there, (1, 2, 3))).branches.paths
    amplitude = reported_quantities(System(there, (1, 2, 3)), path).amplitude[
        :, scene.modal.dofs.index("40y")
    ]
    tops = 1 + np.flatnonzero((amplitude[1:-1] > amplitude[:-2]) & (amplitude[1:-1] >= amplitude[2:]))
    highest = np.sort(tops[np.argsort(-amplitude[tops])][:2])
    assert amplitude[highest] == pytest.approx([height, height], rel=2e-5)  # as printed
    assert path.parameter[highest] / (2.0 * np.pi) == pytest.approx(frequencies, rel=1e-4)
