"""Four contacts on the bundled blade: from its matrices, with few modes and all, beside the exact motion."""

from __future__ import annotations

import re
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

import fcm
from fcm.scene import scene_from_dict

FOLDER = Path(str(files("fcm") / "scenes"))


def four(preload, **structure):
    data = tomllib.loads((FOLDER / "blade.toml").read_text(encoding="utf-8"))
    del data["optimum"]
    for contact, nodes in zip(data["contact"], ([[40], [293]], [[545], [836]]), strict=True):
        contact |= {"nodes": nodes, "n_0": preload}
    data["structure"] |= structure
    data["response"] |= {"frequency": [195.0, 230.0]}
    return scene_from_dict(data, "four", FOLDER)


@pytest.mark.slow
@pytest.mark.parametrize("preload", [20.0, 24.0])
def test_curves_are_complete_and_their_peaks_those_of_the_exact_motion(preload):
    scene = four(preload)
    found = fcm.respond(scene)
    assert found.complete.item() == 1 and found.contact.size == 4
    at = found.peak_frequency.sel(dof="40y").item()
    assert 195.0 < at < 230.0
    exact = fcm.respond(scene, "exact", at=[at])
    expected = exact.amplitude.sel(dof="40y").max().item()
    error = found.peak_error.sel(dof="40y").item()
    assert error < 0.03 and found.peak_amplitude.sel(dof="40y").item() == pytest.approx(
        expected, rel=2.0 * error
    )


@pytest.mark.slow
def test_few_modes_with_their_flexibility_are_as_good_as_all():
    """To the bounds that are stated; without it by far not."""
    few, every, stiff = (four(20.0, **more) for more in ({}, {"modes": 41}, {"flexibility": False}))
    bounds = [float(one) for one in re.findall(r"at most (\S+?)(?:,|$)", few.notes[0])]
    assert len(bounds) == 2 and "all that there are" in every.notes[0]
    off = []
    for scene in (few, every, stiff):
        found = fcm.respond(scene, "closed-form", harmonics=1).sel(dof="40y")
        off.append((found.peak_amplitude.item(), found.peak_frequency.item()))
    height, frequency = (abs(one / true - 1.0) for one, true in zip(off[0], off[1], strict=True))
    assert height < sum(bounds) and frequency < bounds[0]
    assert abs(off[2][0] / off[1][0] - 1.0) > 10.0 * height
