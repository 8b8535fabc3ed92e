"""A search for optima that is interrupted: what was found is not sought again, and comes out the same."""

import json
import tomllib

import netCDF4
import numpy as np
import pytest

from fcm import respond
from fcm.cli.track import as_table
from fcm.response.least_peak import PeakTask
from fcm.response.optimum import optima, optimise
from fcm.response.options import OPTIMUM
from fcm.response.track import TrackRequest, track
from fcm.results.output import write_netcdf
from fcm.results.tracked import Optimal
from fcm.run import CheckpointFile
from fcm.scene import load_scene
from fcm.scene.load import scene_from_dict
from fcm.tracking.options import SEARCH
from fcm.tracking.peak_envelope import PieceHeight
from fcm.tracking.trials import by_trials

from ..interrupted import Interrupting
from ..oscillator import oscillator

SCENE = oscillator("[response]\nfrequency = [0.8, 1.6]\n", damping=0.05) + (
    '\n[optimum]\nvary = ["contact.shroud.n_0"]\nbounds = [[2.0, 20.0]]\nminimise = "peak.u"\n'
    '[sweep]\n"contact.shroud.mu" = [0.4, 0.8]\n'
)
COMMAND = ("respond", "scene.toml", "--harmonics", "1", "-o")


@pytest.fixture
def scene(tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE)
    return tmp_path / "scene.toml"


@pytest.mark.slow
def test_an_interrupted_search_goes_on_from_the_optima_that_it_has_found(fcm, tmp_path, scene):
    assert fcm(*COMMAND, "whole.nc").code == 0
    second = Interrupting("optimum", fraction=0.5 * OPTIMUM.search_share)
    done = fcm(*COMMAND, "a.nc", messages=second)
    assert done.code == 3 and len(second.shown) > 2
    assert "kept in a.nc.unfinished: continue with --resume" in done.err
    never = Interrupting("never")
    assert fcm(*COMMAND, "a.nc", "--resume", messages=never).code == 0
    assert never.shown[0] == second.shown[-1] and not (tmp_path / "a.nc.unfinished").exists()
    with netCDF4.Dataset("a.nc") as a, netCDF4.Dataset("whole.nc") as whole:
        assert set(a.variables) == set(whole.variables)
        for name in a.variables:
            np.testing.assert_array_equal(a[name][...], whole[name][...])


@pytest.mark.slow
def test_optima_are_kept_until_the_response_with_them_is_written(fcm, scene):
    done = fcm(*COMMAND, "a.nc", messages=Interrupting(fraction=OPTIMUM.search_share))
    assert done.code == 3 and "continue with --resume" in done.err
    never = Interrupting("never")
    assert fcm(*COMMAND, "a.nc", "--resume", messages=never).code == 0
    assert never.shown and not any(text.startswith("optimum") for _, text in never.shown)


@pytest.mark.slow
def test_the_progress_of_a_search_moves_with_its_work(fcm, scene):
    """It stood still for minutes, from one response that was traced to the next."""
    shown = Interrupting("never")
    assert fcm(*COMMAND, "a.nc", messages=shown).code == 0
    search = [(share, text) for share, text in shown.shown if text.startswith("optimum with 1 harmonic")]
    first = [share for share, _ in search if share < 0.5 * OPTIMUM.search_share]  # of two curves
    assert np.diff(np.maximum.accumulate(first)).max() < 0.1 and len(set(first)) > 20
    assert any(text.endswith(": 2 responses traced") for _, text in search)
    assert max(share for share, _ in search) < OPTIMUM.search_share


class Known(PeakTask):
    """As a search would: the first of the scenes takes one harmonic, the second takes two.

    left: how many searches are finished before the next is interrupted; begun: how many are.
    """

    left = begun = 0

    def optimum(self, harmonics, progress):
        Known.begun += 1
        if Known.begun > Known.left:
            raise KeyboardInterrupt
        chosen = harmonics or ((1,) if self.scene.parameters["contact.shroud.mu"] == 0.4 else (1, 2))
        return Optimal(self.scene.parameters, {"n": 3.0}, ("peak.u",), 2.0, (), "smooth", chosen), []

    def needed(self, found, harmonics):
        return harmonics


def sought(scene, left, harmonics=None, **kept):
    """The optima of so many searches, whether the next was interrupted, and how many were begun."""
    Known.left, Known.begun = left, 0
    tasks = [Known(curve, [], 1e-3) for curve in load_scene(scene).each_curve()]
    with CheckpointFile(scene.with_name("kept"), **kept) as checkpoint:
        return *optima(tasks, harmonics, checkpoint, None), Known.begun


def test_what_is_sought_again_with_the_harmonics_of_all_is_kept_too(scene):
    first, stopped, begun = sought(scene, 2)
    assert stopped and [one.harmonics for one, _ in first] == [(1,), (1, 2)] and begun == 3
    for finished in (1, 0):  # the last is sought, and then known
        every, stopped, begun = sought(scene, finished, resume=True)
        assert not stopped and [one.harmonics for one, _ in every] == [(1, 2), (1, 2)]
        assert begun == finished


def test_optima_of_another_aim_are_sought_anew(scene):
    sought(scene, 9, (1,))
    scene.write_text(SCENE.replace("20.0]]", "19.0]]"))
    with pytest.warns(UserWarning, match="it is of another scene"):
        *_, begun = sought(scene, 2, (1,), resume=True)
    assert begun == 2


def test_where_the_forces_may_vanish_they_do(fcm, tmp_path):
    """All amplitudes are 0 there, the greatest of which is one of them."""
    aim = '\n[optimum]\nvary = ["level"]\nbounds = [[0.0, 0.5]]\nminimise = "greatest.u"\n'
    text = oscillator("[response]\nfrequency = [1.1, 1.3]\n", damping=0.05) + aim
    (tmp_path / "scene.toml").write_text(text)
    done = fcm(*COMMAND, "a.nc")
    assert (
        done.code == 0
        and "least greatest.u: 0 " in done.out + done.err
        and "with level = 0" in done.out + done.err
    )


FLAT = '[optimum]\nvary = {}\nbounds = {}\nminimise = "greatest.u"\n'


def of_range(vary, bounds):
    rest = "[response]\nfrequency = [0.7, 0.9]\n" + FLAT.format(vary, bounds).replace("'", '"')
    return scene_from_dict(tomllib.loads(oscillator(rest)))


def dynamic_stiffness(omega):
    """Of the structure and the spring across the contact, in u and v."""
    inverse, own = np.linalg.inv(np.array([[0.707, 0.707], [1.0, -0.5]])), np.array([1.0, 10.0])
    modal = own**2 + 2j * 0.01 * own * omega - omega**2
    return inverse @ np.diag(modal) @ inverse.T + np.diag([0.0, 1.0])


def stuck():
    """Displacements u and v at the upper end of the range of a contact that sticks."""
    return np.linalg.solve(dynamic_stiffness(0.9) + np.diag([1.0, 0.0]), [1.0, 0.0])


def test_a_peak_that_does_not_depend_on_the_number_over_a_part_of_its_range():
    """It was said to be at a corner of the response, at one of the values, by chance.

    The contact sticks while -mu (n + v) < u + f < mu (n + v) in all of a cycle, with some mean force f of
    friction. The last that does is half of |u + mu v| - |u - mu v|, with mu n half of their sum. That force
    moves v, so that n is not n_0.
    """
    u, v = stuck()
    less, more = abs(u - 0.4 * v), abs(u + 0.4 * v)
    _, moved = np.linalg.solve(dynamic_stiffness(0.0).real, [-(more - less) / 2, 0.0])
    onset = (less + more) / (2 * 0.4) - moved
    (found,) = optimise(of_range(["contact.shroud.n_0"], [[0.2, 40.0]]), harmonics=1).tracking.optima
    assert found.kind == "flat" and found.value == pytest.approx(abs(u), rel=1e-12)
    low, high = found.flat["contact.shroud.n_0"]
    assert low == pytest.approx(onset, rel=1e-5) and high == 40.0
    assert found.values["contact.shroud.n_0"] == pytest.approx((low + high) / 2)


@pytest.mark.slow
def test_a_least_peak_in_a_millionth_of_the_bounds_is_that_of_narrower_ones():
    """All of the rest is flat: the contact sticks. There the peak is 1.9 times as high."""
    one = SCENE.replace("[0.4, 0.8]", "[0.4]")
    scenes = (scene_from_dict(tomllib.loads(text)) for text in (one, one.replace("[2.0, 20.0]", "[0, 1e6]")))
    near, wide = (optimise(one, harmonics=1).tracking.optima[0] for one in scenes)
    assert wide.value == pytest.approx(near.value, rel=1e-9) and wide.kind == near.kind != "flat"
    assert wide.values["contact.shroud.n_0"] == pytest.approx(near.values["contact.shroud.n_0"], rel=1e-6)


def test_a_peak_that_depends_on_none_of_several_numbers(fcm, tmp_path):
    scene = of_range(["contact.shroud.n_0", "contact.shroud.mu"], [[5.0, 40.0], [0.2, 0.6]])
    response = optimise(scene, harmonics=1)
    (found,) = response.tracking.optima
    assert found.kind == "flat" and found.value == pytest.approx(abs(stuck()[0]), rel=1e-9)
    assert found.flat == {"contact.shroud.n_0": (5.0, 40.0), "contact.shroud.mu": (0.2, 0.6)}
    said = as_table({"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}, "rad/s")
    assert (
        "; it does not depend on contact.shroud.n_0 from 5 to 40, nor on contact.shroud.mu from 0.2 to 0.6\n"
        in said
    )
    write_netcdf(response, tmp_path / "flat.nc")
    with netCDF4.Dataset(tmp_path / "flat.nc") as data:
        assert data["optimum_flat"][0].tolist() == [[5.0, 40.0], [0.2, 0.6]]


def test_trials_as_high_say_that_the_number_does_not_matter():
    heights = {0.0: 2.0, 0.25: 1.0, 0.5: 1.0, 0.75: 1.0, 1.0: 3.0}

    class Tried:
        span, options, visited_values = (0.0, 1.0), SEARCH, {}

        def greatest_at(self, value):
            self.visited_values[value] = PieceHeight(heights.get(value, 1.0), 0.0, np.zeros(0), 0)

    found = by_trials(Tried())
    ((number, low, high),) = found.flat
    assert (found.kind, number) == ("flat", 0) and 0.0 < low <= 0.25 and 0.75 <= high < 1.0


@pytest.mark.slow
def test_a_curve_that_runs_along_the_frequency_at_the_end_of_its_range_has_ended_there():
    """It was said to have stopped where no further point could be found."""
    scene = scene_from_dict(tomllib.loads(oscillator("[response]\nfrequency = [0.7, 1.7]\n")))
    tracked = track(scene, TrackRequest("slip", "contact.shroud.n_0", (2.0, 200.0)), harmonics=1).tracking
    assert [one.reason for one in tracked.curves] == [""] and tracked.complete


LEAVES = (
    'title = "blade"\nfrequency_unit = "Hz"\n[modal]\ndofs = ["tip", "rad"]\nfrequency = [100.0, 260.0]\n'
    "damping = [0.003, 0.002]\nshapes = [[20.0, 3.0], [-14.0, 9.0]]\n"
    '[[contact]]\nname = "left"\ntangential = "tip"\nnormal = "rad"\nmu = 0.3\nk_u = 1500.0\n'
    'k_v = 2000.0\nn_0 = 30.0\n[[force]]\ndof = "tip"\namplitude = 10.0\n'
)  # a peak that leaves the range of frequencies as the preload grows


def test_numbers_beside_the_least_without_a_peak_in_the_range(fcm, tmp_path):
    """Above 39 N the curve rises to the end of the range: a traceback."""
    (tmp_path / "scene.toml").write_text(
        LEAVES + "[response]\nfrequency = [104.0, 112.0]\nharmonics = 1\n"
        '[optimum]\nvary = ["contact.left.n_0"]\nbounds = [[20, 120]]\nminimise = "peak.tip"\n'
    )
    done = fcm("respond", "scene.toml")
    assert done.code == 0 and "least peak" in done.err + done.out


def test_a_peak_that_leaves_the_range_is_followed_with_more_harmonics_too(fcm, tmp_path):
    """The greatest peak of the span, 0.047 at n_0 = 0, was told as the least."""
    (tmp_path / "scene.toml").write_text(
        LEAVES + "[response]\nfrequency = [89.15, 119.08]\n"
        '[optimum]\nvary = ["contact.left.n_0"]\nbounds = [[0, 60]]\nminimise = "peak.rad"\n'
    )
    found = json.loads(fcm("respond", "scene.toml", "--json").out)["optimum"][0]
    swept = LEAVES + "[response]\nfrequency = [89.15, 119.08]\nharmonics = 4\n"
    curves = respond(scene_from_dict(tomllib.loads(swept + '[sweep]\n"contact.left.n_0" = [21, 30, 33]\n')))
    least = float(curves.peak_amplitude.sel(dof="rad").min())
    assert found["value"] < least
