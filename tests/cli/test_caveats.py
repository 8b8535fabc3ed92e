"""What may be missing in curves that are complete: what a run says of it."""

import json
from pathlib import Path

import netCDF4
import numpy as np
import pytest

import fcm
from fcm.branches.options import FoldOptions
from fcm.cli.caveats import linear, maybe_not_unique, nothing_stable, peaks_not_followed, short_of_accuracy
from fcm.model.scene import InTime
from fcm.response.exact import trace_exact
from fcm.response.options import ResponseOptions
from fcm.response.request import ResponseError
from fcm.results.result import Response
from fcm.results.summary import summary
from fcm.scene import load_scene

COMPUTED = {"exact_motion": InTime.COMPUTED.value}
SCENE = Path(__file__).parents[1] / "shooting/scenes/two_periods.toml"

GAP = """
[modal]
dofs = ["u", "v"]
frequency = [1.0, 10.0]
damping = 0.05
shapes = [[0.7, 0.7], [1.0, -0.5]]
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [0.8, 1.6]
[[contact]]
name = "c"
tangential = "u"
normal = "v"
mu = 0.4
k_u = 1.0
k_v = {k_v}
{n_0}
"""


@pytest.mark.slow
def test_where_nothing_that_was_found_is_stable_the_run_says_so(fcm, tmp_path):
    """Sweeps of the exact motion end there, and there alone, on one that repeats after two periods."""
    scene = tmp_path / "a.toml"
    scene.write_text(SCENE.read_text().replace("[0.75, 2.4593]", "[1.97, 2.08]"))
    run = fcm("respond", scene, "--harmonics", "3", "--json", "-o", "a.nc")
    (curve,) = json.loads(run.out)["curves"]
    ((low, high),) = curve["no_stable_motion"]
    assert f"no stable motion was found between {low:.6g} and {high:.6g} rad/s, so no steady" in run.err
    at = [0.5 * (low + high), high + 0.02]
    visited = trace_exact(load_scene(scene), at).curves[0]
    assert visited.orbits.repeats.tolist() == [2, 1, 1, 2] and visited.complete
    assert "no_stable_motion" not in visited.summary()
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        assert json.loads(data.summary)["curves"][0]["no_stable_motion"] == [[low, high]]


class Spring(fcm.ContactLaw):
    def forces(self, x, dx):
        return 2.0 * x, 2.0 * dx


def with_a_law():
    return load_scene("yang1998-n5").with_laws({"shroud": Spring()})


SCENES = {
    InTime.COMPUTED: lambda: load_scene("yang1998-n5"),
    InTime.RING: lambda: load_scene("bladed-disk"),
    InTime.PLANE: lambda: load_scene("platform-damper"),
    InTime.OWN_LAW: with_a_law,
}


@pytest.mark.parametrize("kind", InTime)
def test_the_exact_motion_is_offered_where_it_is_not_refused(kind):
    scene = SCENES[kind]().in_use()
    said = summary(Response.of(scene, [], "table"))
    said["curves"] = [{"parameters": {}, "may_not_be_unique": 3}]
    offered = maybe_not_unique(said).endswith("--method exact --at F computes how far the motions range")
    try:
        trace_exact(scene, [scene.frequency_range[0]])
    except ResponseError:
        assert kind is not InTime.COMPUTED and not offered
    else:
        assert kind is InTime.COMPUTED and offered
    said["curves"] = [{"parameters": {}, "may_not_be_unique": 3, "mode": 1}]
    assert "--method exact" not in maybe_not_unique(said)  # a nonlinear mode has no forces
    said["curves"] = [{"parameters": {}, "may_not_be_unique": 3, "contacts": dict.fromkeys("abcdefghijklm")}]
    assert "--method exact" not in maybe_not_unique(said)  # of many contacts it takes long


def test_of_many_stretches_without_a_stable_motion_the_widest_are_named():
    ways = [[1.0, 1.5], [2.0, 2.1], [3.0, 3.2], [4.0, 4.3], [5.0, 5.05]]
    curves = [
        {"parameters": {"contact.a.n_0": 7.0}},
        {"parameters": {"contact.a.n_0": 0.5}, "no_stable_motion": ways},
    ]
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert "between 1 and 1.5, between 3 and 3.2, between 4 and 4.3 Hz and in 2 narrower ranges" in said
    assert "(contact.a.n_0 = 0.5; on 1 of 2 curves)" in said and said.endswith(
        "--method exact --at F shows the motion there"
    )
    curves[1]["no_stable_motion"] = ways[:2]
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert "between 1 and 1.5 and between 2 and 2.1 Hz (" in said
    curves[1]["no_stable_motion"] = [*ways[2:], [6.0, 6.04]]
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert "and in 1 narrower range (" in said
    curves[1]["may_not_be_unique"] = 3  # another member of the family of motions may be stable
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert "not found, or has another residual friction. " in said
    curves[1]["no_stable_motion_not_looked_at"] = ways[3:]
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert ". No branch was looked for in 2 of these ranges, the widest between 4 and 4.3. --method" in said
    curves[1]["no_stable_motion_not_looked_at"] = ways[4:]
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert ". No branch was looked for between 5 and 5.05. --method" in said
    del curves[1]["may_not_be_unique"], curves[1]["no_stable_motion_not_looked_at"]
    curves[1]["may_wedge"] = True
    said = nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED})
    assert ", or sticks by friction that slip has left, as friction may press its contacts together. " in said
    del curves[1]["may_wedge"]
    ring = nothing_stable(
        {"curves": curves[1:], "frequency_unit": "Hz", "method": "table", "exact_motion": InTime.RING.value}
    )
    assert "--method" not in ring and ring.endswith(
        "More harmonics may find one"
    )  # the exact motion of a ring is not visited


def test_stretches_too_narrow_to_be_seen_are_counted():
    run = {"frequency_unit": "Hz", "method": "table", "range": [1.0, 6.0], **COMPUTED}
    hook, wide = [2.0, 2.001], [4.0, 4.3]
    said = nothing_stable({"curves": [{"parameters": {}, "no_stable_motion": [hook]}], **run})
    assert (
        said
        == "no stable motion was found in 1 range narrower than 0.005 Hz, too narrow to be seen in a sweep"
    )
    said = nothing_stable({"curves": [{"parameters": {}, "no_stable_motion": [hook, wide, hook]}], **run})
    assert "found between 4 and 4.3 Hz and in 2 ranges narrower than 0.005 Hz, so no steady" in said


@pytest.mark.parametrize(
    ("loads", "which"), [([1000.0], "within the range"), ([2e3, 1e3], "on any curve"), ([1e3, 1.0], "")]
)
def test_curves_on_which_no_contact_slips_are_said_to_be_linear(fcm, scene, loads, which):
    scene.write_text(scene.read_text() + f'[sweep]\n"contact.0.n_0" = {loads}\n')
    run = fcm("respond", scene)
    said = f"no contact slips or opens {which}: the response is linear. Friction reaches "
    assert run.code == 0 and (said in run.err if which else "no contact slips" not in run.err)
    assert ("With less preload or more force it is not" in run.err) == bool(which)


def test_how_near_to_slip_stuck_contacts_are_is_said_with_the_units():
    loads = {
        name: {"greatest_friction_force": {"greatest": f}, "greatest_normal_force": {"greatest": n}}
        for name, f, n in (("a", 3.0, 4e6), ("b", 2.0, 1e3), ("c", None, None), ("d", 0.0, 0.0))
    }
    curve = {"parameters": {}, "all_stick": True, "contacts": loads}
    said = linear({"curves": [curve], "units": {"force": "N"}})
    assert "Friction reaches 2 N beside a normal force of 1000 N (b). With less preload" in said
    assert "With greater modal amplitudes, by --level, it" in linear({"curves": [curve | {"mode": {}}]})


@pytest.mark.parametrize(
    ("loads", "said"),
    [
        ([-1e3], "no contact touches within the range: the response is linear. With a smaller gap"),
        ([-1e3], "it is not. Are gap and n_0 in the units of the structure?"),
        ([-1e3, 1e3], "each contact sticks, or is open, and none"),
    ],
)
def test_curves_on_which_no_contact_touches_are_said_to_be_linear(fcm, scene, loads, said):
    """Nothing was said of contacts that stay open."""
    scene.write_text(scene.read_text() + f'[sweep]\n"contact.0.n_0" = {loads}\n')
    run = fcm("respond", scene)
    assert run.code == 0 and said in run.err and ": the response is linear. With " in run.err


@pytest.mark.parametrize("n_0", ["gap = 5.0", "gap = 0.0", "n_0 = -5.0"])
def test_contacts_that_no_motion_loads(fcm, tmp_path, n_0):
    """With k_v = 0 neither a smaller gap nor more force closes a contact, and both were recommended."""
    written = tmp_path / "scene.toml"
    written.write_text(GAP.format(n_0=n_0, k_v="0.0"))
    run = fcm("respond", written)
    asked = (
        'warning: contact "c": is k_v = 0 right? The normal force is then n_0 whatever moves, and here none'
    )
    assert run.code == 0 and run.err.count(asked) == 1
    said = (
        "the response is linear. No motion loads contacts with k_v = 0: give k_v > 0, or n_0 > 0 as a const"
    )
    assert said in run.err and "more force" not in run.err and "smaller gap" not in run.err


@pytest.mark.parametrize("n_0, k_v, sweep, closed", [
    ("n_0 = 1.0", "0.0", "", True),
    ("gap = 1.0", "0.0", '"contact.c.k_v" = [0.0, 1.0]', True),
    ("n_0 = 1.0", "0.0", '"contact.c.n_0" = [-1.0, 1.0]', True),
    ("gap = 1.0", "0.0", '"contact.c.gap" = [1.0, 0.1]', False),
])  # fmt: skip
def test_a_constant_load_is_asked_about_where_it_is_none_on_every_curve(tmp_path, n_0, k_v, sweep, closed):
    written = tmp_path / "scene.toml"
    written.write_text(GAP.format(n_0=n_0, k_v=k_v) + (f"[sweep]\n{sweep}\n" if sweep else ""))
    assert any("is k_v = 0 right?" in note for note in load_scene(written).notes) is not closed


def test_beside_a_contact_that_touches_each_open_one_has_its_remedy(fcm, tmp_path):
    written, contact = tmp_path / "scene.toml", GAP[GAP.index("[[contact]]") :]
    others = [contact.replace('"c"', f'"{name}"') for name in ("never", "far")]
    text = GAP.format(n_0="n_0 = 1.0", k_v="1.0")
    never, far = others[0].format(n_0="gap = 1.0", k_v="0.0"), others[1].format(n_0="gap = 1e6", k_v="1.0")
    gap, load = (
        "A smaller gap (a higher n_0) or more force helps",
        "No motion loads contacts with k_v = 0: give",
    )
    for more, said in (
        ([never], f'1 contact never touches within the range: "never". {load}'),
        ([never, far], f'2 contacts never touch within the range: "never", "far". {gap}. {load}'),
        ([far], f'1 contact never touches within the range: "far". {gap}\n'),
    ):
        written.write_text("\n".join([text, *more]))
        assert said in fcm("respond", written).err


@pytest.mark.parametrize("curves", [[], [{"parameters": {}}]])
def test_nothing_is_said_where_something_is_stable_throughout(curves):
    assert nothing_stable({"curves": curves, "frequency_unit": "Hz", "method": "table", **COMPUTED}) == ""


@pytest.mark.parametrize(("short", "said"), [(1, "1 of 3 curves misses"), (2, "2 of 3 curves miss")])
def test_one_curve_has_and_two_have_not_the_accuracy(short, said):
    curves = [{"short_of_accuracy": "why"}] * short + [{}] * (3 - short)
    assert short_of_accuracy({"curves": curves}).startswith(said)


def test_of_many_curves_that_fall_short_the_worst_is_told():
    curves = [
        {
            "parameters": {"mu": mu},
            "short_of_accuracy": f"why {mu}",
            "peak": {"u": {"amplitude": 1.0, "error": e}},
        }
        for mu, e in ((0.1, 0.02), (0.2, 0.3), (0.3, 0.1))
    ]
    said = "3 of 3 curves miss the accuracy that was asked for. The worst, mu = {}: Why {}"
    assert short_of_accuracy({"curves": curves}) == said.format(0.2, 0.2)
    curves[2]["peak"]["u"]["error"] = None  # unknown
    assert short_of_accuracy({"curves": curves}) == said.format(0.3, 0.3)


@pytest.mark.parametrize(("harmonics", "said"), [("1", True), ("9", False)])
def test_with_few_harmonics_branches_of_more_are_said_not_to_be_looked_for(fcm, harmonics, said):
    """With one harmonic the peak is off by 6 %, with nine by 2.5e-4; with an accuracy they are looked for."""
    text = "Branches that only more harmonics have were not looked for: --accuracy 0.01 looks for them"
    assert (text in fcm("respond", "yang1998-n5", "--harmonics", harmonics).err) is said
    assert text not in fcm("respond", "yang1998-n5", "--accuracy", "0.3").err


def test_where_folds_of_the_level_were_lost_a_run_says_once_that_branches_may_be_missing(
    fcm, scene, tmp_path
):
    text = scene.read_text().replace("damping = 0.05", "damping = 0.01")
    scene.write_text(text + '[sweep]\n"contact.0.n_0" = [1.0, 2.0, 3.0]\n')
    none = ResponseOptions(others=(FoldOptions(work_fraction=0.0, min_seconds=0.0),))
    run = fcm("respond", scene, "--harmonics", "1", "--json", "-o", "a.nc", response=none)
    said = (
        "isolated branches may be missing beyond 1.207 rad/s (contact.0.n_0 = 1; on 2 of 3 curves): from "
        "there a fold of the level of the forces was not followed to its end. "
        "--level 0:4 --at F, with F beyond 1.207, or a sweep up and down by --method exact --at "
        "FROM:TO:COUNT, looks there. All of them: folds_unsure_at of --json"
    )
    assert (
        run.code == 0 and run.err.count(said) == 1 and run.err.count("isolated branches may be missing") == 1
    )
    assert run.err.splitlines()[-1].startswith("result: complete, but branches may be missing; ")
    curves = json.loads(run.out)["curves"]
    there = [1.20695]
    told = [curve.get("folds_unsure_at", []) for curve in curves]
    assert told == [pytest.approx(there, abs=1e-5), [], pytest.approx(there, abs=1e-5)]
    fcm("respond", scene, "--harmonics", "1", "--peaks-only", "-o", "b.nc", response=none)
    with netCDF4.Dataset(tmp_path / "b.nc") as data:
        kept = np.ma.filled(data["folds_unsure_at"][:], np.nan)
    assert kept == pytest.approx(np.array([there, [np.nan], there], dtype=float), abs=1e-5, nan_ok=True)


@pytest.mark.parametrize(
    ("reached", "said"),
    [
        ([[0.1, 15.0]], "no peak of u was followed with n_0 above 15. "),
        ([[2.0, 30.0]], "no peak of u was followed with n_0 below 2. "),
        ([[0.1, 15.0], [12.0, 30.0]], ""),  # two peaks, one after the other
    ],
)
def test_an_optimum_says_for_which_numbers_no_peak_lies_within_the_frequencies(reached, said):
    curves = [{"what": "peak of u", "parameters": {}, "number": ends} for ends in reached]
    tracked = {"what": "optimum", "over": "n_0", "span": [0.1, 30.0], "curves": curves}
    text = peaks_not_followed({"tracked": tracked})
    assert text.startswith(said) if said else text == ""
    assert peaks_not_followed({"tracked": tracked | {"what": "peaks"}}) == ""
    higher = {
        "what": "peak of v",
        "parameters": {},
        "number": [0.1, 30.0],
    }  # beside which no lower one matters
    assert peaks_not_followed({"tracked": tracked | {"curves": [*curves, higher]}}) == ""


@pytest.mark.parametrize(
    ("gaps", "said"), [([1e3, 2e3], "on any curve"), ([1e3], "within the range"), ([1e3, 1e-3], "")]
)
def test_a_contact_that_never_touches_beside_another_that_slips_is_named(fcm, scene, gaps, said):
    stop = '[[contact]]\nname = "stop"\ntangential = "u"\nnormal = "v"\n'
    stop += "mu = 0.1\nk_u = 1.0\nk_v = 1.0\ngap = 1.0\n"
    scene.write_text(scene.read_text() + stop + f'[sweep]\n"contact.stop.gap" = {gaps}\n')
    run = fcm("respond", scene, "--harmonics", 1)
    assert run.code == 0 and ("never touches" in run.err) == bool(said)
    assert not said or f'1 contact never touches {said}: "stop". A smaller gap' in run.err


FOLDS_OF_MORE = """
frequency_unit = "Hz"
[modal]
dofs = ["drive", "u", "v"]
frequency = [52.93, 173.9, 375.4]
damping = 0.004
shapes = [[0.883, 2.356, 1.087], [0.622, -1.411, 2.055], [1.984, -1.578, -0.739]]
[[contact]]
name = "tip"
tangential = "u"
normal = "v"
mu = 0.1
k_u = 18800.0
k_v = 27000.0
n_0 = 8.66
[[force]]
dof = "drive"
amplitude = 5.81
[response]
frequency = [50.0, 70.0]
output = ["u"]
"""


def test_large_errors_of_points_away_from_peaks_are_told(fcm, tmp_path):
    """A peak with two folds at 60.3 Hz takes more harmonics than the greatest peak, at 57.3 Hz."""
    scene = tmp_path / "a.toml"
    scene.write_text(FOLDS_OF_MORE)
    run = fcm("respond", scene, "--accuracy", "0.03", "--json", "-o", "a.nc")
    (curve,) = json.loads(run.out)["curves"]
    (there,) = curve["large_errors"]
    assert f"between {there['from']:.6g} and {there['to']:.6g} Hz. The accuracy is of peaks" in run.err
    assert not any(there["from"] < one < there["to"] for one in curve["folds"])
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        frequency, amplitude = data["frequency"][0], data["amplitude"][0, :, 1]
        beside = (frequency > 59.0) & (frequency < 62.0)
    exact = trace_exact(load_scene(scene), np.linspace(59.1, 60.2, 7).tolist()).curves[0]
    told = np.interp(exact.frequency / (2.0 * np.pi), frequency[beside], amplitude[beside])
    assert 0.1 < np.abs(exact.amplitude[:, 1] / told - 1.0).max() <= 1.1 * there["error"]

    fine = fcm("respond", scene, "--accuracy", "0.01", "--json", "-o", "b.nc")
    assert "large_errors" not in json.loads(fine.out)["curves"][0] and "errors of points are" not in fine.err
    assert len(json.loads(fine.out)["curves"][0]["folds"]) == len(curve["folds"]) + 2
