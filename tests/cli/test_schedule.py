"""``fcm respond`` on scenes with a [[schedule]]: what it prints and writes, keeps, and refuses."""

import csv
import json
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray

import fcm as package
from fcm.response import ResponseError

SCHEDULE = """
[[schedule]]
frequency = 1.3
cycles = 30
[[schedule]]
frequency = 1.1
cycles = 2.5
"""
WORDS = ["amplitude", "u", "amplitude", "v"]
OTHERS = ("displacement v", "state shroud")
SWEEP = '[sweep]\n"contact.shroud.n_0" = [5, 0]\n'


@pytest.fixture
def both(scene):
    """A range and a schedule."""
    scene.write_text(scene.read_text() + SCHEDULE)
    return scene


@pytest.fixture
def alone(both):
    """A schedule, and no range."""
    both.write_text(both.read_text().replace("[response]\nfrequency = [0.8, 1.6]\n", ""))
    return both


def test_the_phases_follow_the_curves(fcm, both):
    done = fcm("respond", both)
    curves, phases = done.out.split("\n\n")
    header, first, second, *note = (line.split() for line in phases.splitlines())
    assert done.code == 0 and "peak u" in curves
    assert header == ["phase", "rad/s", "cycles", *WORDS, "transitions", "shroud", "settled"]
    assert first[:3] == ["1", "1.3", "30"] and second[:3] == ["2", "1.1", "2.5"]
    assert second[-1] == "no" and (first[-1] == "yes" or first[-4:-2] == ["no,", "by"])
    assert (first[-1] == "yes") == (not note)
    assert "schedule: 32.5 cycles, " in done.err and "error of the energy balance: " in done.err
    assert "kept: 64 displacements of every cycle" in done.err


def test_friction_of_a_start_needs_no_schedule(fcm, scene):
    """It is of contacts that stick: nothing of it is said where it is one that a contact can carry."""
    scene.write_text(scene.read_text() + "[start]\nfriction = [1.0]\n")
    done = fcm("respond", scene, "--harmonics", 1)
    assert done.code == 0 and "start" not in done.err


def test_a_start_beyond_what_a_contact_can_carry_is_said(fcm, scene):
    """The limit is 0.4 * 5, or 0.4 * 6.35 where the scene starts displaced along v; none at n_0 = 0."""
    text = scene.read_text()
    for start, count in (("friction = [1.0]", 1), ("friction = [-2.1]", 2)):
        scene.write_text(text + SCHEDULE + SWEEP + f"[start]\n{start}\n")
        done = fcm("respond", scene)
        assert done.code == 0 and f"in {count} of 2 curves, the first with contact.shroud.n_0 = " in done.err
        assert "start.friction[0]: " in done.err and "A [[schedule]] starts from the limit" in done.err
    for start in ("friction = [1.9]", "friction = [2.1]\ndisplacement = [1.0, -1.293]"):
        scene.write_text(text + SCHEDULE + f"[start]\n{start}\n")
        assert "start.friction" not in fcm("respond", scene).err


def test_a_schedule_alone_has_no_curves(fcm, alone):
    done = fcm("respond", alone, "--json")
    result = json.loads(done.out, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert done.code == 0 and result["curves"] == [] and "curve" not in done.err
    (history,) = result["histories"]
    assert [phase["cycles"] for phase in history["phases"]] == [30, 2.5]
    assert history["complete"] and history["energy"]["error"] < 1e-12
    assert set(history["phases"][0]["amplitude"]) == {"u", "v"}
    assert history["phases"][0]["regime"] == {"shroud": "E"} and history["phases"][1]["unsettled"] is None
    assert fcm("respond", alone).out.startswith("phase ")


@pytest.mark.parametrize("sweep", ["", SWEEP])
@pytest.mark.parametrize("kind", ["both", "alone"])
def test_the_file_is_what_python_gives(fcm, request, tmp_path, kind, sweep):
    scene = request.getfixturevalue(kind)
    scene.write_text(scene.read_text() + sweep)
    assert fcm("respond", scene, "-o", "a.nc").code == 0
    ours = package.respond(package.load_scene(scene))
    with xarray.open_dataset(tmp_path / "a.nc") as data:
        theirs = data.load()
    assert set(theirs.variables) == set(ours.variables) and set(theirs.coords) == set(ours.coords)
    for name in set(ours.variables) - {"table_error"}:
        assert theirs[name].dims == ours[name].dims
        assert np.array_equal(theirs[name], ours[name], equal_nan=ours[name].dtype.kind == "f")
    assert ours.sizes["curve"] == (2 if sweep else 1) and ours.sizes["schedule_phase"] == 2
    assert ours.displacement.dims == ("curve", "instant", "dof") and "time" in ours.displacement.coords
    assert ("frequency" in ours) == (kind == "both")


def test_the_history_as_csv(fcm, both):
    done = fcm("respond", both, "--csv", "a.csv", "--history-csv", "b.csv", "-o", "a.nc")
    assert done.code == 0
    with Path("a.csv").open(newline="") as file:
        assert "amplitude u" in next(csv.reader(file))
    with Path("b.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    with netCDF4.Dataset("a.nc") as data:
        assert len(rows) == data.dimensions["instant"].size == 32.5 * 64 + 1
        assert [float(row["displacement v"]) for row in rows] == data["displacement"][0, :, 1].tolist()
    assert set(rows[0]) == {"curve", "phase", "cycles", "time [s]", "displacement u", *OTHERS}
    assert {row["phase"] for row in rows} == {"1", "2"}
    assert {row["state shroud"] for row in rows} <= set("SEPN")
    assert float(rows[-1]["cycles"]) == 32.5


def test_python_refuses_what_has_no_meaning(alone):
    scene = package.load_scene(alone)
    for arguments in ({"method": "magic"}, {"at": [1.0]}, {"method": "exact", "at": [-1.0]}):
        with pytest.raises(ResponseError):
            package.respond(scene, **arguments)
    assert "frequency" not in package.respond(scene, "exact")
    assert package.respond(scene, "exact", at=[1.2]).frequency.values.tolist() == [[1.2, 1.2]]


def test_without_curves_csv_is_the_history(fcm, alone):
    assert fcm("respond", alone, "--csv", "a.csv", "--history-csv", "b.csv").code == 0
    assert Path("a.csv").read_text() == Path("b.csv").read_text() != ""


@pytest.mark.parametrize(
    "args", [["--method", "closed-form"], ["--table", "t.nc"], ["--max-step", "0.1"], ["--keep-all"]]
)
def test_options_for_curves_are_refused_where_there_are_none(fcm, alone, args):
    done = fcm("respond", alone, *args)
    assert (
        done.code == 2 and f"{args[0]} is of no use: {alone} has a [[schedule]] and no [response]" in done.err
    )


def test_a_history_needs_a_schedule(fcm, scene):
    done = fcm("respond", scene, "--history-csv", "b.csv")
    assert done.code == 2 and "--history-csv is of no use" in done.err and "[[schedule]]" in done.err


def test_a_swept_schedule_has_lines_for_each_curve(fcm, alone):
    alone.write_text(alone.read_text() + SWEEP)
    header, *lines, note = fcm("respond", alone).out.splitlines()
    assert header.split()[0] == "n_0" and note.startswith("settled, no: by this share the amplitudes")
    assert [line.split()[:2] for line in lines] == [["5", "1"], ["5", "2"], ["0", "1"], ["0", "2"]]


def test_frequencies_are_in_the_unit_of_the_scene(fcm, alone):
    alone.write_text('frequency_unit = "Hz"\n' + alone.read_text())
    data = package.respond(package.load_scene(alone))
    assert data.schedule_frequency.values.tolist() == pytest.approx([1.3, 1.1], rel=1e-14)
    assert data.schedule_frequency.units == "Hz"
    assert float(data.time[-1]) == pytest.approx(30 / 1.3 + 2.5 / 1.1, rel=1e-14)


def test_a_frequency_out_of_all_proportion_says_so(fcm, alone):
    alone.write_text(alone.read_text().replace("frequency = 1.3\ncycles", "frequency = 1e-9\ncycles"))
    done = fcm("respond", alone, "-o", "a.nc")
    assert done.code == 3 and "Traceback" not in done.err
    assert done.out.startswith("no cycle of the schedule: a cycle at 1e-09 rad/s lasts ")
    assert "the schedule stopped early" in done.err


def test_without_force_there_is_no_motion(fcm, alone):
    alone.write_text(alone.read_text().replace("amplitude = 1.0", "amplitude = 0.0"))
    (history,) = json.loads(fcm("respond", alone, "--json").out)["histories"]
    assert history["phases"][0]["amplitude"] == {"u": 0.0, "v": 0.0} and history["phases"][0]["settled"]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "left"), [("both", True), ("alone", False)])
@pytest.mark.parametrize("finished", [0, 7])
def test_an_interruption_keeps_what_is_finished(request, program, tmp_path, kind, left, finished):
    request.getfixturevalue(kind)
    code = f"""
import os, signal, fcm.time_domain.schedule_record as record
real, calls = record.measure, []
def measure(*args):
    calls.append(0)
    if len(calls) > {finished}:
        os.kill(os.getpid(), signal.SIGINT)
        signal.pause()
    return real(*args)
record.measure = measure"""
    done = program("respond", "scene.toml", "-o", "a.nc", "--json", before=code)
    assert done.returncode == 3 and "Traceback" not in done.err
    if not (left or finished):
        assert done.out == "" and done.err.splitlines() == [
            "fcm: ending, which may take some seconds",
            "fcm: warning: nothing is finished, so nothing is kept",
            "fcm: interrupted: the calculation was not completed",
        ]
        assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"]
        return
    (history,) = json.loads(done.out)["histories"]
    assert history["cycles"] == finished and "interrupted" in history["reason"]
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        assert np.isfinite(data["cycle_amplitude"][0, :, 0].filled(np.nan)).sum() == finished
        assert ("frequency" in data.variables) == left


@pytest.mark.slow
def test_the_motion_is_drawn_from_its_file(fcm, alone, tmp_path):
    alone.write_text(alone.read_text() + SWEEP)
    assert fcm("respond", alone, "-o", "a.nc").code == 0
    for args, name in [
        ((), "a-history.png"),
        (("--dof", "v", "--against", "time", "-o", "b.svg"), "b.svg"),
        (("--window", "28", "31", "--curve", "1", "-o", "c.pdf"), "c.pdf"),
    ]:
        done = fcm("plot", "history", "a.nc", *args)
        assert done.code == 0 and done.err == f"wrote {name}\n" and (tmp_path / name).stat().st_size > 5000


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--curve", "2"], "the file has 1 curve, number 0"),
        (["--curve", "-1"], "-1 is not in the range"),
        (["--window", "40", "50"], "shows nothing; the motion is from 0 to 32.5 cycles"),
        (["--window", "nan", "5"], "shows nothing"),
        (["--dof", "w"], 'no degree of freedom "w"; the file has "u", "v"'),
        (["-o", "a.txt"], "the name has to end in"),
    ],
)
def test_what_cannot_be_drawn_is_refused(fcm, alone, tmp_path, args, said):
    fcm("respond", alone, "-o", "a.nc")
    done = fcm("plot", "history", "a.nc", *args)
    assert done.code == 2 and said in done.err and "Traceback" not in done.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.nc", "scene.toml"]


def test_the_wrong_kind_of_file_names_the_right_command(fcm, scene):
    fcm("respond", scene, "-o", "curves.nc")
    assert "try fcm plot response" in fcm("plot", "history", "curves.nc").err
    scene.write_text(scene.read_text().replace("[response]\nfrequency = [0.8, 1.6]\n", SCHEDULE))
    fcm("respond", scene, "-o", "motion.nc")
    assert "try fcm plot history" in fcm("plot", "response", "motion.nc").err
