"""The motions at the level 1 that a curve of the level of the forces passes are those of the response."""

import json

import numpy as np
import pytest

from fcm.response import trace
from fcm.scene import load_scene


def test_motions_at_the_level_1_are_where_the_response_passes_the_frequency(fcm):
    run = fcm("respond", "yang1998-jump", "--level", "0:4", "--at", 1.2, "--json")
    (curve,) = json.loads(run.out)["curves"]
    found = [one["amplitude"]["u"] for one in curve["at_level_1"]]
    (response,) = trace(load_scene("yang1998-jump")).curves
    off, amplitude = response.frequency - 1.2, response.amplitude[:, 0]
    at = np.flatnonzero(off[:-1] * off[1:] < 0.0)
    part = off[at] / (off[at] - off[at + 1])
    passed = amplitude[at] + part * (amplitude[at + 1] - amplitude[at])
    assert found == pytest.approx(sorted(passed), rel=5e-3)
    assert [one["stable"] for one in curve["at_level_1"]] == [True, False, True]


def test_a_peak_over_the_level_has_its_level_and_is_marked_at_an_end(fcm):
    """It had the frequency, which is given, and no mark at the end of the span."""
    options = ("yang1998-jump", "--level", "0:4", "--at", 1.2)
    (curve,) = json.loads(fcm("respond", *options, "--json").out)["curves"]
    peak = curve["peak"]["u"]
    assert peak["level"] == 4.0 and peak["at_edge"] is True and peak["frequency"] == pytest.approx(1.2)
    said = fcm("respond", *options).out
    assert "at level" in said.splitlines()[0] and "4.00000*" in said.splitlines()[1]
    assert fcm("respond", *options).err.splitlines()[-1].startswith("result: complete; ")
    assert "* at an end of the range: beyond it the curve may rise further\n" in said


def test_motions_at_the_level_1_are_a_table(fcm):
    said = fcm("respond", "yang1998-jump", "--level", "0:4", "--at", 1.2).out
    title, _, *rows = said.partition("motions that are passed at the level 1")[2].splitlines()
    assert title == ", ! unstable:" and len(rows) == 3
    assert [row.split()[1].endswith("!") for row in rows] == [False, True, False]
    assert (
        "motions that are passed" not in fcm("respond", "yang1998-jump", "--level", "0:0.5", "--at", 1.2).out
    )
