"""Options of `fcm respond` that make no sense, and accuracies that cannot be had."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fcm
from fcm.response import ResponseError, trace

from ..program import called


@pytest.mark.parametrize(
    "options, words",
    [
        (["--harmonics", "9" * 30], "is not a number of harmonics from 1 to 50"),
        (["--harmonics", "1000000000"], "is not a number of harmonics from 1 to 50"),
        (["--harmonics", f"1,{'9' * 30}"], "is not a number of harmonics from 1 to 50"),
        (["--at", "1.2", "--level", "0:1e7"], "a level beyond 1e+06 is a mistake of units"),
        (["--at", "1.2", "--level", "0:inf"], "a level beyond 1e+06 is a mistake of units"),
        (["--at", "1.2", "--level", "0:1e-5"], "up to a level of 0.001 there is but rest"),
        (["--at", "1.2", "--level", "0:nan"], "the levels must rise"),
        (["--method", "exact", "--at", "1e12"], "is a mistake of units. The scene has no natural frequency"),
        (["--method", "exact", "--at", "1e200"], "is a mistake of units. The scene has no natural frequency"),
        (["--leave-out-tolerance", "nan"], "nan is not a finite number"),
        (["--leave-out-tolerance", "inf"], "inf is not a finite number"),
        (["--keep-all", "--leave-out-tolerance", "0.1"], "is of no use with --keep-all"),
        (["--mode", "1", "--level", "0:1", "--force-level", "nan"], "nan is not a finite number"),
        (["--largest-file", "nan"], "nan is not a finite number"),
    ],
)
def test_options_that_are_nonsense_are_refused(options, words, tmp_path):
    done = called("respond", "yang1998-n5", "-o", tmp_path / "a.nc", *options)
    assert done.code == 2 and done.out == "" and words in " ".join(done.err.split())
    assert not list(tmp_path.iterdir())


def test_so_many_harmonics_are_refused_in_python_too():
    with pytest.raises(ResponseError, match="whole numbers from 1 to 50"):
        fcm.respond(fcm.load_scene("yang1998-n5"), harmonics=10**30)


@pytest.mark.parametrize("harmonics", [3.0, "3", True, [1, 2.0], [2, 3], [], np.array([[1, 2]])])
def test_harmonics_that_are_none_are_refused_in_one_line(harmonics):
    with pytest.raises(ResponseError, match="harmonics must be whole numbers from 1 to 50, rising"):
        fcm.respond(fcm.load_scene("yang1998-n5"), harmonics=harmonics)


@pytest.mark.parametrize("accuracy", ["1e-2", 1.0, np.nan, 1j])
def test_an_accuracy_that_is_none_is_refused_in_one_line(accuracy):
    with pytest.raises(ResponseError, match="but it is a relative error between 0 and 1"):
        fcm.respond(fcm.load_scene("yang1998-n5"), accuracy=accuracy)


@pytest.mark.parametrize("harmonics", [np.int64(2), np.arange(1, 3), (np.int32(1), 2)])
def test_integers_of_numpy_are_harmonics(harmonics):
    scene = replace(fcm.load_scene("yang1998-n5"), frequency_range=(1.4, 1.5))
    assert fcm.respond(scene, harmonics=harmonics).harmonic.values.tolist() == [1, 2]


def test_the_name_of_a_scene_is_no_scene():
    with pytest.raises(TypeError, match="scene is a str; "):
        fcm.respond("yang1998")


@pytest.mark.slow
def test_an_accuracy_that_fifty_harmonics_do_not_reach_is_not_said_to_be():
    """Their error is what the harmonics beyond them do."""
    scene = replace(fcm.load_scene("yang1998-n5"), frequency_range=(1.1, 1.25))
    (curve,) = trace(scene, accuracy=1e-9).curves
    exact = float(fcm.respond(scene, "exact").amplitude.sel(dof="u").max())
    peak = curve.peaks["u"]
    off = abs(peak.amplitude / exact - 1.0)
    assert curve.harmonics[-1] == 50 and off > 1e-9
    assert "with 50 harmonics an estimated error of" in curve.short_of
    assert curve.short_of.endswith("remains. For smaller errors try --method exact")
    assert 1.0 / 3.0 < peak.error / off < 3.0 and np.isfinite(peak.error)
