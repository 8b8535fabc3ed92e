"""What a run has while it looks for more harmonics: it is told, and kept where the run is interrupted."""

from dataclasses import replace

import numpy as np
import pytest

from fcm import load_scene
from fcm.branches.shared_levels import clear
from fcm.response import trace
from fcm.response.curve_batches import CurveTask, fits
from fcm.response.options import RESPONSE, SWEEP, InterruptedOptions
from fcm.response.request import Request
from fcm.response.trace import traced_curve
from fcm.run import Interrupted
from fcm.run.tasks import Report
from fcm.scene import scene_from_dict

from ..harmonic_balance.strips import elastic_strip
from ..harmonic_balance.truth import scene

FINE = Request(None, 1e-5)


class _Stops:
    """Told what there is; interrupts when it has been told so often."""

    def __init__(self, often):
        self.told, self.often = [], often

    def __call__(self, text):
        if "; now " not in text:  # there is no curve yet
            assert text.startswith("now the level of the forces, ")
            return
        self.told.append(text)
        if len(self.told) == self.often:
            raise KeyboardInterrupt


def test_the_first_curve_is_kept_with_its_error():
    """Its error by the pair is that to the curve of 15 harmonics."""
    one, stops = scene("yang1998", 5), _Stops(1)
    with pytest.raises(Interrupted) as stopped:
        traced_curve(one, FINE, tell=stops)
    (curve,) = stopped.value.results
    true = traced_curve(one, Request(tuple(range(1, 16)))).peaks["u"].amplitude
    peak = curve.peaks["u"]
    assert curve.harmonics == (1,) and not curve.complete
    off = abs(true / peak.amplitude - 1.0)
    assert off > 0.03 and off / 2.0 < peak.error < 2.0 * off
    assert "interrupted" in curve.reason and "1 harmonic, error 6" in curve.reason
    assert np.isnan(curve.stable).all()


def test_the_last_of_several_is_kept_and_each_is_told():
    one, stops = scene("yang1998", 5), _Stops(4)
    with pytest.raises(Interrupted) as stopped:
        traced_curve(one, FINE, tell=stops)
    (curve,) = stopped.value.results
    assert len(curve.harmonics) > 3
    assert stops.told[0].startswith("1 harmonic, error 6")


def test_given_harmonics_leave_the_curve_of_fewer():
    with pytest.raises(Interrupted) as stopped:
        traced_curve(scene("yang1998", 5), Request(tuple(range(1, 12))), tell=_Stops(1))
    (curve,) = stopped.value.results
    assert curve.harmonics == (1,) and "before it was traced with 11" in curve.reason


def _stopping(looks):
    """Interrupts at a look after so many."""
    left = iter(range(looks))

    def poll():
        if next(left, None) is None:
            raise KeyboardInterrupt

    return poll


@pytest.mark.slow
@pytest.mark.parametrize("name", ["yang1998", "isola"])
def test_the_first_curve_is_kept_as_far_as_it_has_come(name):
    """Its points are those of the whole curve, which has no other before them."""
    one = scene(name, 5) if name == "yang1998" else scene(name)
    polls = []
    clear()
    whole = traced_curve(one, Request((1,)), lambda: polls.append(1))
    known = set(zip(*_points(whole), strict=True))
    parts = []
    for looks in range(0, len(polls), max(len(polls) // 100, 1)):
        clear()  # levels that are known take no looks
        try:
            traced_curve(one, Request((1,)), _stopping(looks))
        except Interrupted as stopped:
            parts += stopped.results
        except KeyboardInterrupt:
            assert not parts  # once there is something it stays
    cut = [part for part in parts if "before it came to its end" in part.reason]
    assert cut and not any(part.complete for part in parts)
    lengths = [len(part.frequency) for part in parts]
    assert lengths == sorted(lengths) and lengths[0] < lengths[-1]
    for part in cut:
        assert "this is the part up to there with 1 harmonic" in part.reason
        assert len(known.intersection(zip(*_points(part), strict=True))) >= len(part.frequency) - 1
    if name == "yang1998":  # nothing folds: the branch from the low end is whole before further levels
        assert cut[-1].frequency[[0, -1]].tolist() == list(one.frequency_range)
        assert cut[-1].peaks["u"].amplitude == pytest.approx(whole.peaks["u"].amplitude, rel=1e-9)


def _points(curve):
    """Frequencies and amplitudes, as far as rounding leaves them."""
    there = np.isfinite(curve.frequency)
    return (
        curve.frequency[there].round(9).tolist(),
        curve.amplitude[there, 0].round(7).tolist(),
    )


def test_before_the_errors_the_curve_of_given_harmonics_is_kept():
    """And it is said that these come next."""
    stops = _Stops(1)
    with pytest.raises(Interrupted) as stopped:
        traced_curve(scene("yang1998", 5), Request((1,)), tell=stops)
    (curve,) = stopped.value.results
    assert stops.told == ["1 harmonic, error not estimated yet; now its errors"]
    assert curve.harmonics == (1,) and "before its stability was known" in curve.reason
    assert curve.peaks["u"].amplitude == pytest.approx(15.831, abs=1e-3)


def _interrupted(request, **where):
    with pytest.raises(Interrupted) as stopped:
        traced_curve(scene("yang1998", 5), request, **where)
    (curve,) = stopped.value.results
    return curve


def test_errors_that_take_long_are_not_begun_after_an_interruption():
    """Those that are known then stay."""
    limits = InterruptedOptions(max_seconds_of_errors=0.0)
    request = Request((1,), options=replace(RESPONSE, interrupted=limits))
    short, whole = (_interrupted(one, tell=_Stops(1)) for one in (request, Request((1,))))
    assert np.isnan(short.peaks["u"].error) and np.isnan(short.error).all()
    assert np.isfinite(whole.peaks["u"].error)
    assert _points(short) == _points(whole)
    assert np.isfinite(_interrupted(request, tell=_Stops(2)).peaks["u"].error)


@pytest.mark.parametrize("at", [1, 2])
def test_of_many_points_an_interrupted_curve_has_those_that_are_special_and_some_between(at):
    """Before its errors are told, and when they are: then they stay."""
    limits = InterruptedOptions(max_states=40, min_points=10)
    requests = Request((1,), options=replace(RESPONSE, interrupted=limits)), Request((1,))
    thin, whole = (_interrupted(one, tell=_Stops(at)) for one in requests)
    assert thin.harmonics == whole.harmonics and 10 < len(thin.frequency) < len(whole.frequency) / 2
    known = set(zip(*_points(whole), strict=True))
    assert known.issuperset(zip(*_points(thin), strict=True))
    for dof, peak in whole.peaks.items():
        assert thin.peaks[dof].amplitude == pytest.approx(peak.amplitude, rel=1e-9)
        assert thin.peaks[dof].frequency == pytest.approx(peak.frequency, rel=1e-9)
        assert np.isnan(thin.peaks[dof].error) if at == 1 else thin.peaks[dof].error == peak.error
    assert thin.folds == whole.folds


@pytest.mark.slow
def test_stability_that_is_known_is_kept():
    """While more harmonics confirm it, which many contacts take long for."""
    one, calls = elastic_strip((11.3, 20.0)), 0

    def poll():
        nonlocal calls
        calls += 1

    whole = traced_curve(one, Request((1,)), poll)
    with pytest.raises(Interrupted) as stopped:
        traced_curve(one, Request((1,)), _stopping(calls - 1))
    (curve,) = stopped.value.results
    known = np.isfinite(curve.stable)
    assert 0.8 < known.mean() < np.isfinite(whole.stable).mean() and set(curve.stable[known]) == {0.0, 1.0}
    np.testing.assert_array_equal(curve.stable[known], whole.stable[known])
    assert "before its stability was confirmed" in curve.reason and not curve.complete


def test_before_the_first_curve_there_is_nothing():
    """As the level of the forces is followed, to where it begins."""
    with pytest.raises(KeyboardInterrupt) as stopped:
        traced_curve(scene("isola"), FINE, _stopping(0))
    assert not isinstance(stopped.value, Interrupted)


def test_a_group_hands_over_the_curve_that_is_not_finished_and_saves_it_not():
    saved, told = [], []

    def show(_, text):
        told.append(text)
        if "; now " in text:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as stopped:
        CurveTask(FINE)((scene("yang1998", 5),), Report(show, save=saved.append))
    (curve,) = stopped.value.results
    assert curve.peaks["u"].amplitude > 10.0 and not curve.complete
    assert not saved and told[-1].startswith("1 harmonic, error")


@pytest.mark.parametrize(
    "name", ["frequency", "stable", "truncation_error", "amplitude", "regime", "cycle_error"]
)
def test_a_curve_of_another_kind_is_not_gone_on_with(name):
    """As of unfinished work that something else has written."""
    scene = replace(load_scene("yang1998-n5"), max_step=0.5, harmonics=(1,), curves=())
    (curve,) = trace(scene).curves
    assert fits(scene, curve)
    array = getattr(curve, name)
    other = np.zeros(array.shape) if array.dtype.kind == "U" else array.astype("U3")
    for wrong in (other, array[:-1], array[..., None], None):
        assert not fits(scene, replace(curve, **{name: wrong}))


def _joint():
    """Twenty contacts along a beam of three modes."""
    x, count = np.linspace(0.0, 1.0, 20), 20
    along = [np.sin((m + 1) * np.pi * x / 2.0 + 0.3) for m in range(3)]
    across = [0.3 * np.cos((m + 1) * np.pi * x / 2.0) for m in range(3)]
    shapes = [np.ravel(both, order="F").tolist() for both in zip(along, across, strict=True)]
    common = {"mu": 0.4, "k_u": 0.1, "k_v": 0.1, "n_0": 0.3}
    return scene_from_dict(
        {
            "modal": {
                "dofs": [f"{axis}{k}" for k in range(count) for axis in "uv"],
                "frequency": [1.0, 3.1, 6.3], "damping": [0.02, 0.02, 0.02], "shapes": shapes,
            },
            "contact": [
                {"name": f"c{k}", "tangential": f"u{k}", "normal": f"v{k}", **common} for k in range(count)
            ],
            "force": [{"dof": "u19", "amplitude": 0.3}],
            "response": {"frequency": [0.8, 2.2]},
        }
    )  # fmt: skip


@pytest.fixture(scope="module")
def whole():
    """How often a whole run of many contacts looks for an interruption, and what it has said before which."""
    told, calls = [], 0

    def poll():
        nonlocal calls
        calls += 1

    traced_curve(_joint(), Request(None, 1e-2), poll, lambda text: told.append((calls, text)))
    return calls, [(at, text) for at, text in told if "; now " in text]


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.2, 0.75, 0.95])
def test_many_contacts_stopped_at_any_time_leave_the_best_curve_that_there_was(whole, share):
    """What the whole run has at that time is written, with its error; of the first curve what there is."""
    calls, told = whole
    known = [text for at, text in told if at <= int(share * calls)]
    with pytest.raises(Interrupted) as stopped:
        traced_curve(_joint(), Request(None, 1e-2), _stopping(int(share * calls)))
    (curve,) = stopped.value.results
    assert not curve.complete and len(curve.frequency) > 1
    if known:
        assert known[-1].split(";")[0] in curve.reason
        assert np.isfinite([peak.error for peak in curve.peaks.values()]).all()
    else:
        assert "before it came to its end" in curve.reason


def test_the_progress_moves_while_the_errors_are_sought(monkeypatch):
    """Of one harmonic the curve alone is half of the progress; what is shown then never goes back."""
    monkeypatch.setattr("fcm.response.best_so_far.SWEEP", replace(SWEEP, progress_interval=0.0))
    shares = []
    traced_curve(scene("yang1998", 5), Request((1,)), progress=shares.append)
    between = [share for share in shares if 0.5 < share < 0.75]
    assert between and shares == sorted(shares) and shares[-1] < 1.0
