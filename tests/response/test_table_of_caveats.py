"""Analyses times caveats: what is in doubt is said by every analysis of the same place, in its own words."""

import json

import netCDF4
import pytest

from fcm.accuracy.options import RefinementOptions, ValidityOptions
from fcm.branches.options import FoldOptions, LevelCurveOptions
from fcm.continuation.options import StepOptions
from fcm.harmonic_balance.options import HarmonicBalanceOptions, WorkOptions
from fcm.response.options import ResponseOptions
from fcm.shooting.options import BalanceOptions, ShootingOptions
from fcm.stability.options import ConfirmationOptions, StabilityOptions

from .test_doubts_of_analyses import CREEPING

PAIR = """
[modal]
dofs = ["u", "v", "d"]
frequency = [1.0, 4.0]
damping = [0.02, 0.02]
shapes = [[0.8, 0.6, 5.5e-17], [0.6, -0.8, -5.5e-17]]
[[contact]]
name = "shroud"
tangential = "u"
normal = "v"
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 2.0
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [0.9, 1.6]
"""
OPTIMUM = '[optimum]\nvary = ["contact.shroud.n_0"]\nbounds = [[1.5, 2.5]]\nminimise = "peak.u"\n'
DRAWS = '[sweep]\n"contact.shroud.n_0" = { normal = [2.0, 0.1], count = 3 }\n'
SCHEDULE = "[[schedule]]\nfrequency = 1.2\ncycles = 40\n"
ANALYSES = {  # what the scene has besides, and options
    "curve": ("", ()),
    "peaks only": ("", ("--peaks-only",)),
    "sensitivity": ("", ("--sensitivity",)),
    "draws": (DRAWS, ()),
    "optimum": (OPTIMUM, ()),
    "level": ("", ("--level", "0.5:1.5", "--at", 1.2)),
    "mode": ("", ("--mode", 1, "--level", "0.05:3")),
    "peaks tracked": ("", ("--track", "peaks", "--over", "contact.shroud.n_0", "--from", 1.9, "--to", 2.1)),
    "exact": ("", ("--method", "exact")),
    "exact peaks": ("", ("--method", "exact", "--only", "peaks")),
    "visited": ("", ("--method", "exact", "--at", 1.2)),
    "schedule": (SCHEDULE, ()),
}
FEW = ("--harmonics", 1)


def run(fcm, tmp_path, text, analysis, *more, **settings):
    extra, options = ANALYSES[analysis]
    (tmp_path / "s.toml").write_text(text + extra)
    chosen = () if "exact" in options else more
    done = fcm("respond", "s.toml", "--json", "-o", "a.nc", *options, *chosen, **settings)
    return done, json.loads(done.out)


@pytest.mark.parametrize("analysis", ANALYSES)
def test_what_moves_by_rounding_alone_is_at_rest(fcm, tmp_path, analysis):
    """d is 5e-17 of a motion that is 1: it has no peak, no error, and nothing is tracked of it."""
    done, found = run(fcm, tmp_path, PAIR, analysis, *FEW)
    assert done.code == 0, done.err
    if analysis == "peaks tracked":
        assert {one["what"] for one in found["tracked"]["curves"]} == {"peak of u", "peak of v"}
        return
    if analysis == "mode":
        with netCDF4.Dataset(tmp_path / "a.nc") as data:
            amplitude = dict(zip(data["dof"][:], data["amplitude"][0].max(axis=0), strict=True))
        assert amplitude["d"] == 0.0 < amplitude["u"]
        return
    for curve in found["curves"]:
        peak = curve["peak"]["d"]
        assert peak["amplitude"] == 0.0 and peak["error"] is peak["frequency"] is None
        assert curve["peak"]["u"]["amplitude"] > 0.5
        if analysis == "sensitivity":
            numbers = curve["sensitivity"]["d"]["numbers"].values()
            assert all(one["relative"] is None for one in numbers)
    if analysis == "draws":
        (scatter,) = found["scatter"]
        assert scatter["peak"]["d"]["amplitude"]["50"] == 0.0
        assert scatter["peak"]["d"]["amplitude_range"] == [0.0, 0.0]
    if analysis == "schedule":
        (phase,) = found["histories"][0]["phases"]
        assert phase["amplitude"]["d"] == 0.0 < phase["amplitude"]["u"]


def of_branches(options):
    """Options of the branches of a balance, by itself and where exact motions begin near it."""
    shooting = ShootingOptions(balance=BalanceOptions(others=(options,)))
    return ResponseOptions(others=(options,), shooting=shooting)


LOST = {  # analyses that trace branches over the range, and where they say it
    "curve": "curves", "peaks only": "curves", "sensitivity": "curves", "draws": "curves",
    "optimum": "curves", "exact": "curves", "exact peaks": "curves", "peaks tracked": "tracked",
}  # fmt: skip


@pytest.mark.parametrize("analysis", LOST)
def test_where_folds_of_the_level_are_lost_branches_may_be_missing(fcm, tmp_path, analysis):
    """From 1.2072 rad/s on, the middle between two resonances: the level of the forces turns back there."""
    none = of_branches(FoldOptions(work_fraction=0.0, min_seconds=0.0))
    text = PAIR.replace("n_0 = 2.0", "n_0 = 3.0")  # of which the level turns back with more harmonics, too
    done, found = run(fcm, tmp_path, text, analysis, *FEW, response=none)
    assert done.code == 0, done.err
    assert "may be missing" in done.err and "1.2072" in done.err
    if LOST[analysis] == "curves":
        assert all(curve["folds_unsure_at"] == [pytest.approx(1.2072, abs=1e-4)] for curve in found["curves"])
    else:
        assert all(at == pytest.approx(1.2072, abs=1e-4) for _, at in found["tracked"]["branches_unsure_at"])


@pytest.mark.parametrize("analysis", [*LOST, "visited"])
def test_where_levels_are_not_followed_to_their_end_branches_may_be_missing(fcm, tmp_path, analysis):
    short = of_branches(LevelCurveOptions(step=StepOptions(max_steps=3)))
    done, found = run(fcm, tmp_path, PAIR, analysis, *FEW, response=short)
    assert "may be missing" in done.err and "was not followed to its end" in done.err
    if LOST.get(analysis) != "tracked":
        assert all(curve["branches_unsure_at"] for curve in found["curves"])
    else:
        assert found["tracked"]["branches_unsure_at"]


MISSED = ("curve", "peaks only", "sensitivity", "draws", "optimum", "level", "mode", "peaks tracked")


@pytest.mark.parametrize("analysis", ["curve", "peaks only", "level", "peaks tracked", "exact"])
def test_what_creeps_is_no_steady_state(fcm, tmp_path, analysis):
    """Friction on a body that nothing holds: its load varies, so that it is pushed one way on average."""
    extra, options = ANALYSES[analysis]
    names = {"peaks": "separation", "contact.shroud.n_0": "contact.slide.n_0", 1.9: 0.2, 2.1: 0.5}
    options = [names.get(one, one) for one in options]
    (tmp_path / "s.toml").write_text(CREEPING + extra)
    done = fcm("respond", "s.toml", "--json", *options)
    assert done.code == 3, done.err
    said = json.loads(done.out)
    every = [*said["curves"], *said.get("tracked", {}).get("curves", ())]
    assert every and not any(one["complete"] for one in every)
    if analysis != "exact":
        assert all("pushes the structure one way" in one["reason"] for one in every)


@pytest.mark.parametrize("analysis", [*MISSED])
def test_what_misses_the_accuracy_says_so(fcm, tmp_path, analysis):
    work = WorkOptions(max_seconds=0.0, max_seconds_repeated=0.0)
    none = ResponseOptions(
        HarmonicBalanceOptions(work=work), RefinementOptions(max_seconds_without_progress=0.0)
    )
    done, found = run(fcm, tmp_path, PAIR, analysis, "--accuracy", 1e-7, response=none)
    assert "the accuracy that was asked for" in done.err, done.err
    if analysis == "peaks tracked":
        assert "remains at contact.shroud.n_0" in found["tracked"]["short_of_accuracy"]
    else:
        assert all(curve["short_of_accuracy"] for curve in found["curves"])


@pytest.mark.slow
@pytest.mark.parametrize("analysis", [one for one in MISSED if one != "mode"])
def test_where_stability_is_not_told_no_peak_is_without_that_word(fcm, tmp_path, analysis):
    unconfirmed = StabilityOptions(confirmation=ConfirmationOptions(max_addition=-1.0))
    strict = ResponseOptions(others=(ValidityOptions(max_error=0.0), unconfirmed))
    extra, options = ANALYSES[analysis]
    (tmp_path / "s.toml").write_text(PAIR + extra)
    said = fcm("respond", "s.toml", *FEW, *options, response=strict).out
    found = json.loads(fcm("respond", "s.toml", "--json", *FEW, *options, response=strict).out)
    assert "unknown" in said
    if analysis == "peaks tracked":
        assert all(one["stability_untold"] for one in found["tracked"]["curves"])
        return
    assert all(curve["peak"]["u"]["stable"] is None for curve in found["curves"])
    if analysis == "optimum":
        assert found["optimum"][0]["at"][0]["stable"] is None and ", stability unknown" in said
