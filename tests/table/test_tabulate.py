"""`fcm tabulate` as a user calls it."""

import json

import pytest

from fcm.cli.messages import Messages
from fcm.cli.table_study import write_study
from fcm.table import open_table, store
from fcm.table.arrays import encode
from fcm.table.options import StudyOptions

from ..interrupted import Interrupting

SMALL = ("--nodes", 7, 5, 9, 7, "--points", 10_000)


def test_builds_a_table_and_says_what_it_cost_and_how_wrong_it_is(fcm, tmp_path):
    done = fcm("tabulate", *SMALL)
    assert done.code == 0
    assert open_table(tmp_path / "table.nc").resolution == (7, 5, 9, 7)
    last = done.err.strip().splitlines()[-1]
    assert all(word in last for word in ("wrote table.nc", "MB", " s;", "at most", "rms"))
    assert "separation F_b" in done.out and "worst at" in done.out
    assert [path.name for path in tmp_path.iterdir()] == ["table.nc"]


def test_json_is_the_same_that_the_file_records(fcm, tmp_path):
    done = fcm("tabulate", *SMALL, "-o", "mine.nc", "--json")
    result = json.loads(done.out)
    assert result["resolution"] == [7, 5, 9, 7]
    assert result["bytes"] == (tmp_path / "mine.nc").stat().st_size
    assert result["error"] == open_table("mine.nc").error


def test_verify_agrees(fcm):
    fcm("tabulate", *SMALL)
    done = fcm("tabulate", "--verify", "table.nc", "--json")
    assert done.code == 0
    assert json.loads(done.out)["true"] is True
    assert "as recorded" in done.err


def test_verify_finds_an_error_that_is_not_true(fcm, tiny_file):
    separation, slip, error, _ = store.load(tiny_file)
    better = {**error, "max": 0.5 * error["max"]}
    store.write("lie.nc", encode(separation, slip), better, "test")
    done = fcm("tabulate", "--verify", "lie.nc")
    assert done.code == 3
    assert "the recorded error is not true: max" in done.err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--nodes", 3, 9, 9, 9), "from 5 to"),
        (("--nodes", 1000, 1000, 1000, 1000), "more than"),
        (("--nodes", "a", 9, 9, 9), "not a valid integer"),
        (("--nodes", 9, 9), "requires 4 arguments"),
        (("--points", 3), "10000"),
        (("--preset", "none"), "none"),
        (("-o", "none/table.nc"), "no folder"),
        (("-o", "table.txt"), "has to end in .nc"),
        (("--verify", "none.nc"), "no such file"),
        (("--verify", "table.nc", "--preset", "fast"), "of no use with --verify"),
        (("--study", "study.csv", "--points", 20000), "of no use with --study"),
        (("--study", "study.txt"), "has to end in .csv"),
    ],
)
def test_wrong_input_is_one_clear_message(fcm, tmp_path, options, message):
    done = fcm("tabulate", *options)
    assert done.code == 2
    assert message in done.err
    assert not list(tmp_path.iterdir())


def test_damaged_file_is_not_verified(fcm, tmp_path):
    (tmp_path / "bad.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + b"\0" * 100)
    done = fcm("tabulate", "--verify", "bad.nc")
    assert done.code == 2
    assert "damaged" in done.err


def test_interruption_leaves_the_old_file_and_says_what_remains(fcm, tmp_path):
    (tmp_path / "table.nc").write_bytes(b"old")

    done = fcm("tabulate", *SMALL, messages=Interrupting("measuring the error"))
    assert done.code == 3
    assert "interrupted at" in done.err and "nothing was written, table.nc is as it was" in done.err
    assert (tmp_path / "table.nc").read_bytes() == b"old"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.slow
def test_study_compares_layouts(tmp_path, capsys):
    options = StudyOptions(shares=(0.2, 0.3), points=3000)
    write_study(Messages(), tmp_path / "study.csv", to_json=True, options=options)
    rows = json.loads(capsys.readouterr().out)
    assert len(rows) == 9
    assert len((tmp_path / "study.csv").read_text().splitlines()) == 10
    assert (tmp_path / "study.png").read_bytes().startswith(b"\x89PNG")
    rms = {(row["layout"], row["interpolation"]): row["rms"] for row in rows}
    assert rms["regimes", "cubic"] < 0.2 * rms["rectilinear", "cubic"]
    assert rms["regimes", "linear"] < rms["rectilinear", "linear"]
    assert rms["closed form", ""] == 0.0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["study.csv", "study.png"]
