"""The tables of a run: which degrees of freedom they show, peaks at an end of the range, jumps to nowhere."""

from __future__ import annotations

from dataclasses import replace

import click
import netCDF4
import pytest

from fcm.cli.balance import harmonics
from fcm.cli.caveats import kept_friction, linear, maybe_not_unique, residual_friction
from fcm.cli.columns import ranges
from fcm.cli.curves import as_table, cost_and_error
from fcm.model.scene import InTime
from fcm.plot.peak import draw_peak, read_peaks
from fcm.plot.read import read_response
from fcm.plot.response import draw_response

from ..oscillator import oscillator


def curve(peaks, jumps=(), edge=()):
    found = {
        dof: {"amplitude": peak, "frequency": 1.5, "at_edge": dof in edge} for dof, peak in peaks.items()
    }
    state = {"points": 7, "complete": True, "seconds": 0.1, "folds": [], "jumps": list(jumps)}
    return {"parameters": {}, "peak": found} | state


def test_the_greatest_peaks_of_all_curves_are_shown_in_the_order_of_the_file():
    one = {"a": 1.0, "b": 5.0, "c": 3.0, "d": 2.0, "e": 4.0, "f": 0.5}
    two = {"a": 9.0, "b": 1.0, "c": 1.0, "d": 1.0, "e": 1.0, "f": 0.1}
    _, *rows = as_table({"curves": [curve(one), curve(two)]}, "Hz").splitlines()
    assert [row.split()[0] for row in rows[:-1]] == ["a", "b", "c", "e"] * 2
    assert rows[-1] == "shown: the 4 of 6 degrees of freedom with the greatest peaks"


def test_what_the_scene_asks_for_is_shown():
    """And what is minimised; the others are in the files."""
    peaks = {"a": 1.0, "b": 5.0, "c": 3.0}
    asked = {"curves": [curve(peaks)], "output": ["a"]}
    header, _, said = as_table(asked, "Hz").splitlines()
    assert [word for word in header.split() if word in peaks] == ["a"]
    assert said == "shown: those of output; 3 degrees of freedom are in the results"
    header, _, said = as_table(asked | {"optimum": [{"minimise": ["peak.c"]}]}, "Hz").splitlines()
    assert [word for word in header.split() if word in peaks] == ["a", "c"]
    assert "and what is minimised" in said
    assert "shown" not in as_table(asked | {"output": list(peaks)}, "Hz")


def test_pictures_show_what_the_scene_asks_for(fcm, tmp_path):
    """As the table does, though another degree of freedom moves more, or comes first."""
    text = SCENE.replace("RANGE", "1.2")
    for name in ("u", "v"):
        (tmp_path / "scene.toml").write_text(text.replace("[response]", f'[response]\noutput = ["{name}"]'))
        done = fcm("respond", tmp_path / "scene.toml", "-o", tmp_path / "out.nc")
        assert f"peak {name}" in done.out
        assert "peak " + ("v" if name == "u" else "u") not in done.out
        drawn, peaks = read_response(tmp_path / "out.nc"), read_peaks(tmp_path / "out.nc")
        assert drawn.dofs[drawn.column(None)] == name
        assert peaks.asked == (name,)


def test_curves_that_an_interruption_left_out_are_counted():
    left = curve({"a": None}) | {"complete": False, "points": 0, "reason": "interrupted before it was traced"}
    broken = curve({"a": 1.0}) | {"complete": False, "reason": "interrupted at 3 rad/s"}
    each = [curve({"a": 1.0}), broken, left, left]
    each = [one | {"parameters": {"contact.c.n_0": 2.0 + k}} for k, one in enumerate(each)]
    _, *rows = as_table({"curves": each}, "Hz").splitlines()
    assert len(rows) == 4 and rows[1].split()[-2:] == ["NOT", "COMPLETE"]
    assert rows[2] == "n_0 = 3 NOT COMPLETE: interrupted at 3 rad/s"
    assert rows[3] == "2 more curves NOT COMPLETE: interrupted before they were traced"
    said = cost_and_error({"curves": each, "seconds": 1.0, "method": "balance"})
    assert said.startswith("2 of 4 curves, ")


def test_what_is_minimised_is_shown_however_small():
    one = curve({"a": 1.0, "b": 5.0, "c": 3.0, "d": 2.0, "e": 4.0, "f": 0.5})
    _, *rows = as_table({"curves": [one], "optimum": [{"minimise": ["peak.f"]}]}, "Hz").splitlines()
    assert [row.split()[0] for row in rows[:4]] == ["b", "c", "e", "f"]
    assert rows[-1].endswith("greatest peaks, and what is minimised")


def test_rotations_are_in_radians_and_come_after_displacements():
    peaks = {"7x": 1e-6, "7rz": 3.0, "8x": 2e-6, "8:5": 2.0, "9rx": 4.0, "tip": 5e-6}
    header, *rows = as_table({"curves": [curve(peaks)], "units": {"length": "m"}}, "Hz").splitlines()
    assert header.split()[:2] == ["dof", "peak"]
    assert [" ".join(row.split()[:2]) for row in rows[:4]] == ["7x [m]", "8x [m]", "9rx [rad]", "tip [m]"]
    assert rows[-1].endswith("greatest peaks, displacements before rotations")


def test_where_a_peak_does_not_stay_the_greatest_motion_that_does_is_shown():
    one, two = curve({"u": 3.0, "v": 2.0}), curve({"u": 4.0, "v": 1.0})
    one["peak"]["u"] |= {
        "stable": False,
        "greatest_stable": {"amplitude": 1.25, "frequency": 1.5, "error": 0.01},
    }
    _, table = as_table({"curves": [one, two]}, "Hz").split("\n\n")
    said, header, *rows = table.splitlines()
    assert said == (
        "greatest stable motions where a peak is not known to be stable; others may be greater. Errors are "
        "at that frequency:"
    )
    assert header.split() == ["stable", "u", "at", "Hz", "error", "stable", "v", "at", "Hz", "error"]
    assert [row.split() for row in rows] == [["1.25000", "1.50000", "1.0e-02"]]
    assert "to stay, where" not in as_table({"curves": [two]}, "Hz")


def test_an_error_greater_than_the_peak_is_said_to_be_so_and_what_helps():
    """It stood there with its digits, as 3.4e+05, which tell nothing."""
    one = curve({"u": 1.0, "v": 2.0}) | {"harmonics": [1]}
    one["peak"]["u"]["error"], one["peak"]["v"]["error"] = 3.4e5, 1.0
    _, row, said = as_table({"curves": [one]}, "Hz").splitlines()
    assert "> 100 %" in row and "1.0e+00" in row and "e+05" not in row
    assert said.startswith("> 100 % the error is more than the peak") and "--harmonics" in said
    one["peak"]["u"]["error"] = 0.5
    assert "100 %" not in as_table({"curves": [one]}, "Hz")
    worse = one | {"truncation_error": 9.0, "points": 3}
    worse["peak"]["u"]["error"] = 3.0
    assert (
        "more than 100 % of peaks and more than 100 % of the greatest amplitude at any point"
        in cost_and_error({"curves": [worse], "seconds": 1.0, "method": "table"})
    )


def test_a_peak_where_the_range_ends_is_marked():
    text = as_table({"curves": [curve({"u": 1.0, "v": 2.0}, edge=("v",))]}, "Hz")
    assert text.splitlines()[1].split()[:6] == ["1.00000", "1.50000", "-", "2.00000", "1.50000*", "-"]
    assert (
        text.splitlines()[-1]
        == "* at an end of the range: beyond it the curve may rise further. fcm plot modes SCENE lists "
        "the resonances"
    )


def test_where_the_error_of_a_balanced_peak_is_not_told_it_says_why():
    one = curve({"u": 1.0}) | {"harmonics": [1, 2, 3]}
    assert (
        as_table({"curves": [one]}, "Hz").splitlines()[-1].startswith("- unknown error: with more harmonics")
    )
    broken = one | {
        "complete": False,
        "reason": "interrupted before its stability was known",
        "cause": "interrupted",
    }
    assert "unknown" not in as_table({"curves": [broken]}, "Hz")  # it was not sought
    one["peak"]["u"]["error"] = 0.01
    assert "unknown" not in as_table({"curves": [one]}, "Hz")
    assert "unknown" not in as_table({"curves": [curve({"u": 1.0})]}, "Hz")  # of the exact motion


def test_where_only_the_error_at_the_frequency_of_a_peak_is_known_it_is_told_as_that():
    """It was a dash, with points beside it of which the error was told."""
    one = curve({"u": 1.0, "v": 2.0}) | {"harmonics": [1, 2, 3]}
    one["peak"]["u"] |= {"error": None, "error_at_frequency": 0.018}
    one["peak"]["v"]["error"] = 0.03
    told = as_table({"curves": [one]}, "Hz").splitlines()
    assert "1.8e-02~" in told[1] and "3.0e-02 " in told[1]
    assert told[-1].startswith("~ the error of the motion at that frequency. Of the peak it is unknown")
    one["peak"]["v"]["error"] = None
    assert as_table({"curves": [one]}, "Hz").splitlines()[-1].startswith("- unknown error")


def test_a_range_with_residual_friction_that_is_not_known_is_a_dash_and_says_so():
    one = curve({"u": 1.0, "v": 2.0}) | {"may_not_be_unique": 3}
    for dof, change in (("u", 0.034), ("v", 0.0)):
        one["peak"][dof]["residual_change"] = change
    told = as_table({"curves": [one]}, "Hz").splitlines()
    assert "3.4 %" in told[1] and told[-1].endswith("share of it") and told[0].count("residual") == 1
    one["peak"]["u"]["residual_change"] = None
    assert as_table({"curves": [one]}, "Hz").endswith("up to this share of it, - unknown")


def test_residual_friction_is_told_of_those_curves_alone_of_which_it_is_known():
    known, unknown = (curve({"u": 1.0}) | {"may_not_be_unique": 3} for _ in range(2))
    known["peak"]["u"]["residual_change"], unknown["peak"]["u"]["residual_change"] = 0.0, None
    run = {"method": "exact", "exact_motion": InTime.COMPUTED.value}
    told = [residual_friction({"curves": ones} | run) for ones in ([known], [known, unknown])]
    assert "decides: it changes none of the greatest peaks" in told[0]
    assert "decides: on 1 of 2 curves it changes none of the greatest peaks" in told[1]


def test_what_is_said_of_residual_friction_agrees_with_its_column():
    """The column had 10 %, and below it stood that by how much was not estimated: of a peak not shown."""
    one = curve({f"u{i}": 1.0 for i in range(9)}) | {"may_not_be_unique": 3}
    for dof, peak in one["peak"].items():
        peak["residual_change"] = 0.1 if dof in ("u0", "u1") else None
    run = {"method": "exact", "exact_motion": InTime.COMPUTED.value, "curves": [one], "output": ["u0", "u1"]}
    assert "up to 10 % of it" in residual_friction(run) and not maybe_not_unique(run)
    cut_off = one | {"cause": "interrupted", "complete": False, "reason": "interrupted"}
    assert not residual_friction(run | {"curves": [cut_off]}) and not maybe_not_unique(
        run | {"curves": [cut_off]}
    )


def test_the_peaks_whose_range_with_residual_friction_is_unknown_are_named():
    """It was said of all amplitudes, though of u and w it was known that they do not change."""
    run = {"method": "exact", "exact_motion": InTime.COMPUTED.value}
    one = curve({"u": 1.0, "v": 2.0, "w": 3.0}) | {"may_not_be_unique": 3}
    for dof, change in (("u", 0.0), ("v", None), ("w", 0.0)):
        one["peak"][dof]["residual_change"] = change
    told = maybe_not_unique({"curves": [one]} | run)
    assert 'By how much the peak of "v" may differ was not estimated' in told
    one["peak"]["u"]["residual_change"] = None
    told = maybe_not_unique({"curves": [one]} | run)
    assert 'the peaks of "u" and "v" may differ' in told
    one["peak"]["w"]["residual_change"] = None
    assert "By how much amplitudes may differ" in maybe_not_unique({"curves": [one]} | run)


def test_what_friction_keeps_is_said_once_of_peaks_and_of_other_points():
    known, unknown = (curve({"u": 1.0}) | {"may_not_be_unique": 3} for _ in range(2))
    known["peak"]["u"]["residual_change"], unknown["peak"]["u"]["residual_change"] = 0.0, None
    run = {"method": "exact", "exact_motion": InTime.COMPUTED.value}
    both, one, other = (
        kept_friction({"curves": ones} | run) for ones in ([known, unknown], [known], [unknown])
    )
    assert (
        "it changes none of the greatest peaks. Lower peaks and other points may change. "
        "At 3 points the motion may be one of many" in both
    )
    known["peak"]["u"]["residual_change"] = 0.1
    changed = kept_friction({"curves": [known, unknown]} | run)
    assert "it may change a greatest peak by up to 10 % of it" in changed
    assert changed.count("computes how far the motions range") == 1 and changed.endswith("motions range")
    known["peak"]["u"]["residual_change"] = 0.0
    assert one == residual_friction({"curves": [known]} | run) + ": --at F computes how far the motions range"
    assert other.endswith(maybe_not_unique({"curves": [unknown]} | run))
    assert all(text.count("a contact that never slips") == 1 for text in (both, one, other))


def test_contacts_that_shake_down_are_not_said_to_be_as_they_are_whatever_their_past():
    """Nor is another preload advised for slip: motions with slip may exist as it is."""
    one = curve({"u": 1.0}) | {"may_not_be_unique": 3, "all_stick": True}
    one["peak"]["u"]["residual_change"] = 0.0
    run = {"method": "closed-form", "exact_motion": InTime.COMPUTED.value, "frequency_unit": "Hz"}
    alone, shaken = {"curves": [one]} | run, {"curves": [one | {"shakedown_at": 1.25}]} | run
    assert (
        "it changes none of the greatest peaks" in residual_friction(alone)
        and residual_friction(shaken) == ""
    )
    assert "With less preload" in linear(alone) and "With less preload" not in linear(shaken)
    assert "would slip at 1.25 Hz" in linear(shaken) and "--method exact --at 1.25 looks for them" in linear(
        shaken
    )


def test_what_does_not_move_has_no_column_of_jumps():
    one = curve({"u": 1.0, "still": 0.0})
    one["jumps"] = [{"sweep": "up", "frequency": 1.0, "before": {"u": 1.0, "still": 0.0},
                     "after": {"u": 2.0, "still": 0.0}}]  # fmt: skip
    told = as_table({"curves": [one]}, "Hz")
    assert "u before" in told and "still before" not in told and "0 the degree of freedom" in told


@pytest.mark.parametrize("interrupted", [True, False])
def test_stability_that_an_interruption_left_unknown_asks_for_no_harmonics(interrupted):
    one = curve({"u": 1.0})
    one["peak"]["u"]["stable"] = None
    if interrupted:
        one |= {"cause": "interrupted", "complete": False, "reason": "interrupted"}
    told = as_table({"curves": [one]}, "Hz")
    assert ("more harmonics may show it" in told) != interrupted and (
        "interrupted before" in told
    ) == interrupted


def test_residual_friction_is_told_of_the_peaks_that_are_shown():
    """Not of what moves by rounding, as across a plane of symmetry, which may change by any part of that."""
    one = curve({"still": 1e-12} | {f"u{i}": 1.0 for i in range(20)}) | {"may_not_be_unique": 3}
    for dof, peak in one["peak"].items():
        peak["residual_change"] = 1e6 if dof == "still" else 0.02
    run = {"method": "exact", "exact_motion": InTime.COMPUTED.value, "curves": [one]}
    assert "may change a greatest peak by up to 2 %" in residual_friction(run)


def test_jumps_and_folds_that_nobody_could_see_are_counted():
    """Hooks of a hundred-thousandth of a hertz were told as folds and jumps, as those that matter are."""
    jumps = [
        {"sweep": "up", "frequency": 1.5, "before": {"u": 1.0}, "after": {"u": 0.2}},
        {"sweep": "up", "frequency": 1.2, "before": {"u": 1.0}, "after": {"u": 1.005}},
        {"sweep": "up", "frequency": 1.3, "before": {"u": 1.0}, "after": {"u": None}},
        {"sweep": "down", "frequency": 1.3001, "before": {"u": 1.004}, "after": {"u": None}},
    ]
    one = curve({"u": 1.0}, jumps) | {"no_stable_motion": [[1.3, 1.3001]]}
    one["folds"] = [1.5, 1.4, 1.2, 1.2001, 1.45, 1.4501]
    told = as_table({"curves": [one], "range": [1.0, 2.0]}, "Hz")
    assert told.count("  up") == 1 and "  down" not in told and "1.50000  1.40000, 4 in close pairs" in told
    assert "close pairs: folds less than 0.001 Hz apart, too near to be seen in a sweep" in told
    assert "3 jumps too small to be seen: by less than 1 %, or over less than 0.001 Hz without" in told
    jumps[3]["before"]["u"] = 2.0  # across the gap the amplitude doubles, which anyone sees
    seen = as_table({"curves": [one], "range": [1.0, 2.0]}, "Hz")
    assert seen.count("  up") == 2 and seen.count("  down") == 1
    one["folds"] = [1.3, 1.3001]  # at which those jumps are
    assert "1.30000  1.30010" in as_table({"curves": [one], "range": [1.0, 2.0]}, "Hz")


def test_a_peak_where_nothing_stable_was_found_says_so():
    one = curve({"u": 1.0, "v": 2.0}) | {"no_stable_motion": [[1.4, 1.6]]}
    one["peak"]["u"]["stable"], one["peak"]["v"]["stable"] = False, True
    said = "u: no stable motion was found at the frequency of the peak, so no steady amplitude is known there"
    assert said in as_table({"curves": [one]}, "Hz").splitlines()
    one["no_stable_motion"] = [[1.0, 1.2]]
    assert "the frequency of the peak" not in as_table({"curves": [one]}, "Hz")


def test_a_jump_to_no_stable_part_is_explained():
    jump = {"sweep": "up", "frequency": 1.2, "before": {"u": 1.0}, "after": {"u": None}}
    text = as_table({"curves": [curve({"u": 1.0}, [jump])]}, "Hz")
    assert text.splitlines()[-1] == "- the curve has no stable part there to land on"
    settled = as_table({"curves": [curve({"u": 1.0}, [jump | {"after": {"u": 0.5}}])]}, "Hz")
    assert "land on" not in settled


def test_a_jump_to_a_motion_of_unknown_stability_is_marked():
    jump = {"sweep": "up", "frequency": 1.2, "before": {"u": 1.0}, "after": {"u": 0.5}, "after_stable": None}
    *_, row, meaning = as_table({"curves": [curve({"u": 1.0}, [jump])]}, "Hz").splitlines()
    assert "0.500000?" in row and meaning == "? after a jump: stability is unknown there"
    known = as_table({"curves": [curve({"u": 1.0}, [jump | {"after_stable": True}])]}, "Hz")
    assert "0.500000?" not in known and "after a jump" not in known


def test_a_peak_at_which_no_motion_stays_is_marked():
    one = curve({"u": 1.0, "v": 2.0, "w": 3.0})
    for dof, stable in (("u", True), ("v", False), ("w", None)):
        one["peak"][dof]["stable"] = stable
    _header, row, *said = as_table({"curves": [one]}, "Hz").splitlines()
    assert row.split()[:9:3] == ["1.00000", "2.00000!", "3.00000?"]
    assert said == [
        "! unstable: with these harmonics the motion is not stable there, and leaves this peak",
        "? stability is unknown there: more harmonics may show it",
    ]
    assert as_table({"curves": [curve({"u": 1.0})]}, "Hz").count("\n") == 1


@pytest.mark.parametrize(
    ("cause", "said"),
    [({}, "more harmonics may show it"), ({"cause": "interrupted"}, "the run was interrupted before")],
)
def test_why_the_stability_of_a_lower_peak_is_unknown(cause, said):
    one = curve({"u": 1.0}) | cause
    lower = {"amplitude": 0.5, "frequency": 1.1, "error": 0.01, "stable": None}
    one["peaks"] = {"u": [{"amplitude": 1.0, "frequency": 1.5, "error": 0.01, "stable": True}, lower]}
    assert f"? stability is unknown there: {said}" in as_table({"curves": [one]}, "Hz").splitlines()


def test_where_stability_is_not_told_is_a_table_of_its_own():
    """It is no jump. In the order in which the sweeps come there: on the way up first what lies lower."""
    jumps = [
        {"sweep": sweep, "frequency": at, "before": {"u": 1.0}, "after": {"u": 0.5}}
        for sweep, at in (("down", 1.5), ("up", 1.6))
    ]
    unknown = [
        {"sweep": "down", "from": 1.4, "to": 1.1, "before": {"u": 0.8}},
        {"sweep": "down", "from": 1.5, "to": 1.45, "before": {"u": 0.9}},
        {"sweep": "up", "from": 1.2, "to": 1.3, "before": {"u": 0.7}},
    ]
    one = curve({"u": 1.0}, jumps) | {"stability_untold": unknown}
    _, table, other = as_table({"curves": [one]}, "Hz").split("\n\n")
    assert [row.split() for row in table.splitlines()[1:]] == [
        ["1.60000", "1.00000", "0.500000", "up"],
        ["1.50000", "1.00000", "0.500000", "down"],
    ]
    said, header, *rows = other.splitlines()
    assert said.startswith("between these frequencies stability is unknown")
    assert "jump" not in header and [row.split() for row in rows] == [
        ["1.20000", "1.30000", "0.700000", "up"],
        ["1.50000", "1.45000", "0.900000", "down"],
        ["1.40000", "1.10000", "0.800000", "down"],
    ]
    alone = as_table({"curves": [curve({"u": 1.0}) | {"stability_untold": unknown[:1]}]}, "Hz")
    assert "jump at" not in alone and "land on" not in alone and alone.count("\n\n") == 1


def test_narrow_windows_of_unknown_stability_are_counted():
    """Each would be a line of two frequencies that look alike."""
    wide = {"sweep": "up", "from": 1.0, "to": 1.1, "before": {"u": 2.0}}
    narrow = wide | {"to": 1.0005}
    down = wide | {"sweep": "down", "from": 1.5, "to": 1.4999}
    some = as_table({"curves": [curve({"u": 1.0}) | {"stability_untold": [wide, narrow, down]}]}, "Hz")
    assert some.splitlines()[-2].split() == ["1.00000", "1.10000", "2.00000", "up"]
    assert some.splitlines()[-1] == "and in 2 more windows narrower than 0.1 % of the frequency"
    alone = as_table({"curves": [curve({"u": 1.0}) | {"stability_untold": [narrow]}]}, "Hz")
    said = "stability is unknown, and a sweep may jump, in 1 window narrower than 0.1 % of the frequency"
    assert alone.splitlines()[-1] == said


UNITS = '[units]\nlength = "mm"\nforce = "N"\n'
SCENE = UNITS + oscillator("[response]\nfrequency = [0.5, RANGE]\n", damping=0.05)


@pytest.mark.parametrize("end, edge", [("1.1", True), ("1.8", False)])
def test_units_and_edges_reach_table_and_files(fcm, tmp_path, end, edge):
    (tmp_path / "s.toml").write_text(SCENE.replace("RANGE", end))
    run = fcm("respond", "s.toml", "-o", "s.nc", "--csv", "s.csv", "--method", "closed-form")
    assert run.code == 0 and "peak u [mm]" in run.out
    assert ("* at an end of the range" in run.out) == edge
    assert "amplitude u [mm],phase u [rad]," in (tmp_path / "s.csv").read_text().splitlines()[0]
    with netCDF4.Dataset(tmp_path / "s.nc") as file:
        assert file["amplitude"].units == file["peak_amplitude"].units == "mm"
        assert file["spring_force"].units == "N"


def test_a_csv_has_the_degrees_of_freedom_that_the_scene_asks_for(fcm, tmp_path):
    rows = []
    for output in ("", 'output = ["v"]\n'):
        (tmp_path / "s.toml").write_text(SCENE.replace("RANGE]\n", f"1.1]\n{output}"))
        assert fcm("respond", "s.toml", "--csv", "s.csv", "--harmonics", "1").code == 0
        rows.append([line.split(",") for line in (tmp_path / "s.csv").read_text().splitlines()])
    every, some = rows
    of_u = [k for k, name in enumerate(every[0]) if name.split(" ")[1:2] == ["u"]]
    assert len(of_u) == 6 and some == [[x for k, x in enumerate(row) if k not in of_u] for row in every]
    track = ("--track", "peaks", "--over", "contact.shroud.n_0", "--from", "4", "--to", "4.2")
    assert fcm("respond", "s.toml", *track, "--csv", "t.csv", "--harmonics", "1").code == 0
    header = (tmp_path / "t.csv").read_text().splitlines()[0].split(",")
    assert [name for name in header if name.startswith("amplitude")] == ["amplitude v [mm]"]


SWEEP = '[sweep]\n"contact.shroud.n_0" = [1, 5]\n"contact.shroud.k_u" = [1]\n"contact.shroud.mu" = [0.4]\n'


def test_numbers_of_contacts_and_energies_have_units_in_files_and_pictures(fcm, tmp_path):
    (tmp_path / "s.toml").write_text(SCENE.replace("RANGE", "1.1") + SWEEP)
    assert fcm("respond", "s.toml", "-o", "s.nc", "--csv", "s.csv", "--harmonics", "1").code == 0
    header = (tmp_path / "s.csv").read_text().split(",")
    assert header[2:5] == ["contact.shroud.n_0 [N]", "contact.shroud.k_u [N/mm]", "contact.shroud.mu"]
    with netCDF4.Dataset(tmp_path / "s.nc") as file:
        assert file["contact.shroud.n_0"].units == "N" and file["contact.shroud.k_u"].units == "N/mm"
        assert "units" not in file["contact.shroud.mu"].ncattrs()
        assert file["dissipated_energy"].units == "N mm"
    assert (
        draw_peak(read_peaks(tmp_path / "s.nc")).axes[1].get_xlabel() == "$n_{0}$ (N)  (contact.shroud.n_0)"
    )
    one = read_response(tmp_path / "s.nc")
    many = draw_response(replace(one, curves=one.curves * 13))
    assert "$n_{0}$ (N), $k_{u}$ = 1 N/mm, $\\mu$ = 0.4" in [axes.get_ylabel() for axes in many.axes]


def test_of_levels_an_error_that_is_missing_is_not_said_to_have_been_sought_nor_all_of_them_missing():
    """Of most peaks along levels the error is estimated; with one harmonic too few it cannot be."""
    one = curve({"u": 1.0}) | {"harmonics": [1], "level_folds": []}
    one["peak"]["u"]["error"] = None
    said = as_table({"curves": [one]}, "Hz").splitlines()[-1]
    assert "could not be estimated at this peak" in said and "found" not in said


@pytest.mark.parametrize(("count", "end"), [(4, "3.00000  4.00000"), (300, "300: 1.00000 to 300.000")])
def test_of_many_folds_a_line_has_their_number_and_the_first_and_last(count, end):
    """The line had all, thousands of characters, and at its end whether the curve is complete."""
    one = curve({"u": 1.0}) | {"folds": [float(k) for k in range(1, count + 1)]}
    line = as_table({"curves": [one]}, "Hz").splitlines()[1].rstrip()
    assert line.endswith(end) and len(line) <= 120


def test_what_is_wider_than_a_line_has_a_line_for_each_degree_of_freedom():
    """Tables were up to 250 characters wide, and a terminal broke their lines."""
    dofs = ("110x", "110y", "210x", "210y")
    stays = {"amplitude": 0.5, "frequency": 1.4, "error": 0.01}
    found = [curve({dof: 1.0 + d for d, dof in enumerate(dofs)}) for _ in range(2)]
    jump = {"sweep": "up", "frequency": 1.2, "before": dict.fromkeys(dofs, 1.0), "after": {"110y": 0.5}}
    for one, n_0 in zip(found, (5.0, 6.0), strict=True):
        one["parameters"] = {"contact.c.n_0": n_0, "contact.c.mu": 0.3}
        one["jumps"], one["may_not_be_unique"], one["harmonics"] = [jump, jump], 3, [1, 2, 3, 9]
        for peak in one["peak"].values():
            peak |= {"error": 0.001, "stable": False, "greatest_stable": stays, "residual_change": 0.02}
    found[0]["peak"]["110y"]["residual_change"] = 0.0
    found[1]["peak"]["110y"]["residual_change"] = 0.0
    text = as_table({"curves": found, "units": {"length": "m"}}, "Hz")
    peaks, stable, jumps = text.split("\n\n")
    assert max(map(len, text.splitlines())) <= 120
    head, *rows = (line.split() for line in peaks.splitlines()[:9])
    names = [
        "n_0",
        "mu",
        "dof",
        "peak",
        "at",
        "Hz",
        "error",
        "residual",
        "harmonics",
        "points",
        "time",
        "[s]",
    ]
    assert head == [*names, "folds", "at", "Hz"]
    assert rows[0] == [
        "5",
        "0.3",
        "110x",
        "[m]",
        "1.00000!",
        "1.50000",
        "1.0e-03",
        "2",
        "%",
        "1-3,9",
        "7",
        "0.100",
        "none",
    ]
    assert rows[1] == ["5", "0.3", "110y", "[m]", "2.00000!", "1.50000", "1.0e-03"]
    assert [row[2] for row in rows] == [*dofs, *dofs]
    assert stable.splitlines()[2].split() == ["5", "0.3", "110x", "0.500000", "1.40000", "1.0e-02"]
    assert [line.split() for line in jumps.splitlines()[:3]] == [
        ["n_0", "mu", "jump", "at", "Hz", "dof", "before", "after", "sweep"],
        ["5", "0.3", "1.20000", "110x", "1.00000", "-", "up"],
        ["5", "0.3", "1.20000", "110y", "1.00000", "0.500000"],
    ]


def test_harmonics_can_be_given_as_tables_have_them():
    for text, numbers in (("3", (1, 2, 3)), ("1-3,9", (1, 2, 3, 9)), ("1-1", (1,)), ("1,3-5", (1, 3, 4, 5))):
        assert harmonics(None, None, text) == numbers
    assert harmonics(None, None, ranges([1, 2, 3, 9, 12])) == (1, 2, 3, 9, 12)
    for text in ("1-", "-3", "3-1", "1-999999999", "1--3", "1-3-5", "2-4", "1-3,3"):
        with pytest.raises(click.BadParameter, match="harmonics"):
            harmonics(None, None, text)


def test_the_error_of_a_peaks_frequency_is_told_with_its_degree_of_freedom():
    """Where it is great, another peak of that one may be the greatest."""
    peak = {
        name: {"amplitude": 1.0, "error": 0.1, "frequency_error": off}
        for name, off in (("u", 1e-3), ("v", 0.5))
    }
    one = {"points": 3, "harmonics": [1], "truncation_error": 0.1, "peak": peak}
    summary = {"curves": [one], "seconds": 1.0, "method": "balance"}
    assert cost_and_error(summary).endswith("; 5.0e-01 in the frequency of the greatest peak of v")
    del peak["v"]
    assert cost_and_error(summary).endswith("; 1.0e-03 in the frequency of the greatest peak")


def test_an_error_of_which_nothing_is_told_is_not_said_to_be_none():
    """It was 0, that of a motion at rest, where levels of the forces begin; of no peak was it told."""
    peak = {"u": {"amplitude": 1.0, "error": None}}
    curve = {"points": 3, "harmonics": [1], "truncation_error": 0.0, "peak": peak}
    said = cost_and_error({"curves": [curve], "seconds": 1.0, "method": "level of the forces"})
    assert said.endswith("largest relative error: not known")
    peak["u"]["error"] = 0.0
    said = cost_and_error({"curves": [curve], "seconds": 1.0, "method": "level of the forces"})
    assert said.endswith("0.0e+00, by the harmonics left out")


def test_the_greatest_error_of_a_peak_stands_beside_the_greatest_of_any_point():
    """An error of 3 beside a fold is not one of the peaks that a designer reads."""
    peak = {"u": {"amplitude": 1.0, "error": 0.01}, "v": {"amplitude": 1.0, "error": 0.02}}
    curve = {"points": 3, "harmonics": [1, 3], "truncation_error": 3.0, "peak": peak, "folds": [1.0]}
    said = cost_and_error({"curves": [curve], "seconds": 1.0, "method": "table"})
    assert said.endswith(
        "2.0e-02 of peaks and more than 100 % of the greatest amplitude at any point (beside folds), by the "
        "harmonics left out"
    )


def test_an_error_of_a_lower_peak_above_those_of_the_greatest_is_said():
    peak = {"u": {"amplitude": 1.0, "error": 0.01}}
    several = {"u": [{"amplitude": 1.0, "error": 0.01}, {"amplitude": 0.1, "error": 0.75}]}
    curve = {"points": 3, "harmonics": [1], "truncation_error": 0.2, "peak": peak, "peaks": several}
    said = cost_and_error({"curves": [curve], "seconds": 1.0, "method": "table"})
    assert "1.0e-02 of the greatest peaks, 7.5e-01 of lower ones and 2.0e-01 of the greatest" in said
    several["u"][1]["error"] = 0.005
    said = cost_and_error({"curves": [curve], "seconds": 1.0, "method": "table"})
    assert "1.0e-02 of peaks and 2.0e-01 of the greatest" in said


def test_the_error_of_what_hardly_moves_is_not_that_of_the_response():
    """Across a plane of symmetry the motion is rounding, and half a million times off with more harmonics."""
    peak = {"u": {"amplitude": 1.0, "error": 0.02}} | {
        f"v{i}": {"amplitude": 0.5, "error": 0.03} for i in range(9)
    }
    peak["still"] = {"amplitude": 1e-9, "error": 5e5}
    curve = {"points": 3, "harmonics": [1], "truncation_error": 0.1, "peak": peak}
    said = cost_and_error({"curves": [curve], "seconds": 1.0, "method": "table"})
    assert "3.0e-02 of peaks and 1.0e-01 of the greatest amplitude at any point, by" in said
    peak["still"]["amplitude"] = 1e-6
    assert "5.0e-01 of the greatest amplitude" in cost_and_error(
        {"curves": [curve], "seconds": 1.0, "method": ""}
    )


def test_of_several_peaks_those_of_one_degree_of_freedom_stand_together():
    dofs = [f"a_very_long_name_of_a_degree_of_freedom_{k}" for k in range(3)]
    one = curve(dict.fromkeys(dofs, 2.0))
    lower = {"amplitude": 1.0, "frequency": 1.0, "error": None, "at_edge": False}
    one["peaks"] = {dof: [lower, one["peak"][dof]] for dof in dofs[:2]}
    _, table = as_table({"curves": [one]}, "Hz").split("\n\n")
    rows = [row.split() for row in table.splitlines()[2:]]
    assert [row[:2] for row in rows] == [[dof, at] for dof in dofs[:2] for at in ("1.00000", "2.00000")]


def test_marks_of_lower_peaks_are_explained():
    one = curve({"u": 2.0, "v": 1.0})
    lower = {"amplitude": 1.0, "frequency": 1.0, "error": 7.0, "stable": False, "at_edge": False}
    one["peaks"] = {"u": [lower, one["peak"]["u"]]}
    text, table = as_table({"curves": [one]}, "Hz").split("\n\n")
    assert "! unstable" in text and "> 100 % the error is more than the peak" in text
    said, header, *rows = table.splitlines()
    assert said == "degrees of freedom with several peaks, in order of frequency:"
    assert header.split() == ["peak", "u", "at", "Hz", "error"]
    assert [row.split() for row in rows] == [
        ["1.00000!", "1.00000", ">", "100", "%"],
        ["2.00000", "1.50000", "-"],
    ]
