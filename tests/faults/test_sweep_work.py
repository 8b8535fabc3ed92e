"""What a sweep has finished: whose it is, where it is, and when it may go."""

import importlib
import os
import pickle
import re
import signal
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response import curve_batches, trace
from fcm.response.level import LevelRequest, trace_levels
from fcm.response.mode import ModeRequest, trace_modes
from fcm.run import (
    CheckpointError,
    CheckpointFile,
    Execution,
    ExecutorPlace,
    Lost,
    compute_batches,
    fingerprint,
    place_for,
)
from fcm.run.fingerprint import installed
from fcm.run.fingerprint import program as of_program
from fcm.run.options import RunOptions
from fcm.run.records import Record, packed

from ..interrupted import interrupted_beyond
from .conftest import FEW, ONE, SWEEP, end, session, variables

ALONE = FEW.replace("batch=2", "batch=1")
SLOW = (
    ALONE
    + """
import fcm.response.curve_batches as curve_batches, time
real = curve_batches.traced_curve
def slow(*args, **more):
    time.sleep(0.2)
    return real(*args, **more)
curve_batches.traced_curve = slow
"""
)


def interrupted(program, *args, before=SLOW):
    """A run that has finished some curves when Ctrl-C comes."""
    run = program.start("respond", "sweep.toml", "-o", "a.nc", "--jobs", "1", *args, before=before)
    program.until(program.kept)
    return end(run, signal.SIGINT)


# Whose it is: of what scene, options and program


@pytest.mark.slow
def test_another_scene_takes_nothing_and_loses_nothing(program):
    assert interrupted(program).returncode == 3
    kept = (program.folder / "a.nc.unfinished").read_bytes()
    program.write("sweep.toml", SWEEP.replace("amplitude = 1.0", "amplitude = 1.5"))
    assert program("respond", "sweep.toml", "-o", "whole.nc").returncode == 0
    (program.folder / "a.nc").unlink()
    done = program("respond", "sweep.toml", "-o", "a.nc", "--resume")
    assert done.returncode == 0
    assert "a.nc.unfinished: it is of another scene" in done.err and "moved to a.nc.unfinished.1" in done.err
    assert variables(program.folder / "a.nc") == variables(program.folder / "whole.nc")
    assert (program.folder / "a.nc.unfinished.1").read_bytes()[64:] == kept[64:]


@pytest.mark.slow
def test_a_second_run_on_the_same_output_is_refused_and_the_first_named(program):
    first = program.start(
        "respond", "sweep.toml", "-o", "a.nc", "--jobs", "1", before=SLOW.replace("0.2", "1.0")
    )
    program.until(program.kept)
    second = program("respond", "one.toml", "-o", "./a.nc")
    assert second.returncode == 2 and second.out == ""
    assert re.fullmatch(rf"fcm: error: a.nc: process {first.pid} on \S+ is at work on it; .*\n", second.err)
    assert program("respond", "one.toml", "-o", "b.nc").returncode == 0
    assert end(first, signal.SIGTERM).returncode == 3


def test_every_record_says_of_what_it_is(tmp_path):
    """Records of two scenes in one file: each takes its own."""
    path, one, two = tmp_path / "kept", bytes(32), bytes([1] * 32)
    with CheckpointFile(path) as kept:
        for mark, number, value in ((one, 0, 1.0), (two, 0, 2.0), (one, 1, 3.0), (two, 2, 4.0)):
            kept.append(mark, number, [value])
    with CheckpointFile(path, resume=True) as kept:
        assert kept.results(one, (), lambda *_: True).finished == {0: [1.0], 1: [3.0]}
        assert kept.results(two, (), lambda *_: True).finished == {0: [2.0], 2: [4.0]}


def test_changed_sources_are_another_program(tmp_path, monkeypatch):
    for name, text in (("a.py", "x = 1"), ("b/c.py", "y = 2"), ("b/d.so", "binary"), ("table.nc", "t" * 99)):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    seen = [of_program.__wrapped__(tmp_path)]
    assert seen == [of_program.__wrapped__(tmp_path)]
    for name, text in (
        ("b/c.py", "y = 3"),
        ("b/d.so", "changed"),
        ("table.nc", "t" * 98 + "u"),
        ("e.py", ""),
    ):
        (tmp_path / name).write_text(text)
        seen.append(of_program.__wrapped__(tmp_path))
    monkeypatch.setattr(fcm, "__version__", "0.1.1")
    seen.append(of_program.__wrapped__(tmp_path))
    assert len(set(seen)) == 6


def test_what_is_installed_is_known_by_sizes_and_times(tmp_path):
    (tmp_path / "b").mkdir()
    one, other = tmp_path / "a.py", tmp_path / "b" / "c.so"
    one.write_text("x = 1")
    other.write_text("binary")
    seen = [installed.__wrapped__(tmp_path)]
    (tmp_path / "__pycache__").mkdir()
    (tmp_path / "__pycache__" / "a.py").write_text("")  # decides nothing
    (tmp_path / "notes.txt").write_text("")
    assert seen == [installed.__wrapped__(tmp_path)]
    changes = (
        lambda: os.utime(other, ns=(1, 1)),
        lambda: one.write_text("x = 10"),
        lambda: one.rename(tmp_path / "d.py"),
        lambda: (tmp_path / "e.nc").write_text(""),
    )
    for change in changes:
        change()
        seen.append(installed.__wrapped__(tmp_path))
    assert len(set(seen)) == 5


def test_a_fingerprint_is_of_what_decides_the_curves():
    scene = fcm.load_scene("yang1998-n5")
    contact = scene.contacts[0]
    others = [
        replace(scene, contacts=(replace(contact, n_0=np.nextafter(contact.n_0, 6.0)),)),
        replace(scene, modal=replace(scene.modal, shapes=scene.modal.shapes[:, ::-1])),
        replace(scene, max_step=0.04),
        replace(scene, parameters={"n_0": 5.0}),
        replace(scene, frequency_range=(0.7, 1.6)),
    ]
    marks = {fingerprint(curve_batches.anonymous([one])) for one in (scene, *others)}
    assert len(marks) == 6
    moved = replace(scene, name="elsewhere/scene.toml", title="renamed")
    assert fingerprint(curve_batches.anonymous([scene])) == fingerprint(curve_batches.anonymous([moved]))


# An end while the result is written, or none


@pytest.mark.slow
def test_killed_while_it_writes_nothing_is_computed_again(program):
    deadly = (
        FEW
        + """
import fcm.results.output as output, os
output.write_netcdf = lambda *_: os.kill(os.getpid(), 9)
"""
    )
    args = ("respond", "sweep.toml", "-o", "a.nc", "--jobs", "1")
    assert program(*args, before=deadly).returncode == -signal.SIGKILL
    nothing = FEW + "import fcm.response.curve_batches as curve_batches\ncurve_batches.traced_curve = None\n"
    done = program(*args, "--resume", before=nothing)
    assert done.returncode == 0 and program.files == ["a.nc", "one.toml", "sweep.toml"]
    assert program(*args[:3], "b.nc", before=FEW).returncode == 0
    assert variables(program.folder / "a.nc") == variables(program.folder / "b.nc")


@pytest.mark.slow
def test_ctrl_c_while_it_writes_keeps_all_and_says_so(program):
    stopped = (
        FEW
        + """
import fcm.results.output as output, os, signal, time
output.write_netcdf = lambda *_: (os.kill(os.getpid(), signal.SIGINT), time.sleep(9))
"""
    )
    done = program("respond", "sweep.toml", "-o", "a.nc", "--jobs", "1", before=stopped)
    assert done.returncode == 3 and "Traceback" not in done.err
    assert "kept in a.nc.unfinished: continue with --resume" in done.err
    assert "peak  at rad/s" in done.out  # the result is printed all the same


@pytest.mark.parametrize("length", [230, 240, 244, 252])
def test_a_name_too_long_is_refused_before_anything_is_computed(program, length):
    name = "x" * (length - 3) + ".nc"
    done = program("respond", "one.toml", "-o", name, before=FEW + "sweep.traced_curve = None\n")
    if done.returncode == 0:  # short enough for every name that was used meanwhile
        assert name in program.files
    else:
        assert done.returncode == 2 and "File name too long" in done.err
    assert done.returncode == (0 if length == 230 else 2)
    assert all(file in (name, "one.toml", "sweep.toml") for file in program.files)


# It stays until there is something better


@pytest.mark.slow
def test_killed_just_after_the_start_what_was_kept_is_still_there(program):
    assert interrupted(program).returncode == 3
    path = program.folder / "a.nc.unfinished"
    kept = path.read_bytes()
    at_once = (
        ALONE
        + """
import fcm.response.curve_batches as module, os
module.compute_batches = lambda *_: os.kill(os.getpid(), 9)
"""
    )
    for _ in range(2):
        run = program("respond", "sweep.toml", "-o", "a.nc", "--resume", before=at_once)
        assert run.returncode == -signal.SIGKILL
        assert path.read_bytes()[64:] == kept[64:]
    assert program.files == ["a.nc", "a.nc.unfinished", "one.toml", "sweep.toml"]


@pytest.mark.slow
def test_a_plain_rerun_moves_aside_what_was_kept_and_says_so(program):
    assert interrupted(program).returncode == 3
    kept = (program.folder / "a.nc.unfinished").read_bytes()
    done = program("respond", "one.toml", "-o", "a.nc")
    assert done.returncode == 0 and "moved to a.nc.unfinished.1" in done.err
    assert (program.folder / "a.nc.unfinished.1").read_bytes()[64:] == kept[64:]
    assert "a.nc.unfinished" not in program.files


def test_what_was_moved_aside_goes_when_its_work_is_written_and_not_before(tmp_path):
    """Work of the same scene is in the result; that of another scene, and other files, are somebody's."""
    path, own, other = tmp_path / "kept", bytes(range(32)), bytes(range(1, 33))
    asides = [tmp_path / f"kept.{number}" for number in (1, 2, 3)]

    def run(mark, ends):
        with CheckpointFile(path) as kept:
            kept.results(mark, (), lambda *_: True).add(0, [1.0])
            return kept.done() if ends else None

    run(other, ends=False)
    with pytest.warns(UserWarning, match=r"without --resume it is not continued; moved to kept\.1"):
        run(own, ends=False)
    with pytest.warns(UserWarning, match=r"moved to kept\.2"):
        run(own, ends=False)
    asides[2].write_bytes(b"a novel, " * 50)
    assert path.exists() and all(aside.exists() for aside in asides)
    with pytest.warns(UserWarning, match=r"moved to kept\.4"):
        removed = run(own, ends=True)
    assert removed == [asides[1], tmp_path / "kept.4"]
    assert sorted(one.name for one in tmp_path.iterdir()) == ["kept.1", "kept.3"]


@pytest.mark.slow
def test_a_plain_rerun_of_the_same_scene_leaves_only_its_result(program):
    assert interrupted(program).returncode == 3
    done = program("respond", "sweep.toml", "-o", "a.nc", before=ALONE)
    assert done.returncode == 0 and "moved to a.nc.unfinished.1" in done.err
    assert "removed a.nc.unfinished.1: all that it kept is written" in done.err
    assert program.files == ["a.nc", "one.toml", "sweep.toml"]


def test_records_are_appended_and_damage_is_passed_over(tmp_path):
    path, mark = tmp_path / "kept", bytes(range(32))
    with CheckpointFile(path) as kept:
        for number in range(3):
            kept.append(mark, number, [float(number)])
    data = path.read_bytes()
    size = (len(data) - 64) // 3

    def found():
        with CheckpointFile(path, resume=True) as kept:
            return sorted(kept.results(mark, (), lambda *_: True).finished)

    for length in range(64 + size, len(data) + 1, 7):
        path.write_bytes(data[:length])
        assert found() == list(range((length - 64) // size))
    for at in range(64, len(data), 11):
        path.write_bytes(data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])
        assert found() == sorted({0, 1, 2} - {(at - 64) // size})
    path.write_bytes(data[: len(data) - 5])
    with CheckpointFile(path, resume=True) as kept:
        kept.append(mark, 7, [7.0])
    assert path.read_bytes()[64 : len(data) - 5] == data[64:-5]
    assert found() == [0, 1, 7]


def test_a_file_of_which_nothing_can_be_read_is_kept_beside_and_said(program):
    """It was said that no unfinished run is kept, and the file was removed in the end."""
    kept = program.folder / "a.nc.unfinished"
    with CheckpointFile(kept) as one:
        one.append(bytes(range(32)), 0, [0.0] * 100)
    damaged = kept.read_bytes()[:200]
    kept.write_bytes(damaged)
    done = program("respond", "one.toml", "-o", "a.nc", "--resume")
    assert done.returncode == 0 and "no unfinished run is kept" not in done.err
    assert "a.nc.unfinished: it is damaged: an unfinished run is there, and nothing of it can" in done.err
    assert "moved to a.nc.unfinished.1, and this run begins anew" in done.err
    assert (program.folder / "a.nc.unfinished.1").read_bytes() == damaged and not kept.exists()


# Files that are not its own, forged, or cannot be written


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["link", "dangling", "folder", "fifo"])
def test_what_is_no_file_of_its_own_is_not_written_to(program, kind):
    kept, victim = program.folder / "a.nc.unfinished", program.folder / "victim"
    victim.write_text("precious")
    {
        "link": lambda: kept.symlink_to(victim),
        "dangling": lambda: kept.symlink_to("nowhere"),
        "folder": kept.mkdir,
        "fifo": lambda: os.mkfifo(kept),
    }[kind]()
    for more in ([], ["--resume"]):
        done = program("respond", "one.toml", "-o", "a.nc", *more)
        assert done.returncode == 2 and "a.nc.unfinished: it is a link or no file" in done.err
    assert victim.read_text() == "precious"
    assert program.files == ["a.nc.unfinished", "one.toml", "sweep.toml", "victim"]


def test_a_file_of_another_program_is_moved_aside(program):
    (program.folder / "a.nc.unfinished").write_text("a novel, " * 50)
    done = program("respond", "one.toml", "-o", "a.nc", "--resume")
    assert done.returncode == 0 and "moved to a.nc.unfinished.1" in done.err
    assert (program.folder / "a.nc.unfinished.1").read_text() == "a novel, " * 50


@pytest.mark.parametrize("forged", ["empty", "short", "other", "code"])
def test_a_forged_record_does_not_count(tmp_path, forged):
    """Sealed as well as any, and yet no result."""
    one = replace(fcm.load_scene("yang1998-n5"), max_step=0.5, frequency_range=(1.3, 1.5))
    scene = replace(one, curves=tuple(replace(one, parameters={"n": n}) for n in (1.0, 2.0)))
    keep, marks = tmp_path / "kept", []

    class Marked(CheckpointFile):
        def results(self, mark, *more):
            marks.append(mark)
            return super().results(mark, *more)

    with Marked(keep) as kept:
        reference = trace(scene, "closed-form", execution=Execution(keep=kept))
        kept.done()
    curves = reference.curves
    payload = {
        "empty": pickle.dumps([]),
        "short": pickle.dumps(curves[:1]),
        "other": pickle.dumps([replace(curve, parameters={"n": 3.0}) for curve in curves]),
        "code": b"cos\nsystem\n(S'touch " + str(tmp_path / "owned").encode() + b"'\ntR.",
    }[forged]
    with CheckpointFile(keep):
        header = keep.read_bytes()
    keep.write_bytes(header + packed(Record(marks[0], 0, payload)))
    again = trace(scene, "closed-form", execution=Execution(keep=keep, resume=True))
    for one, two in zip(again.curves, curves, strict=True):
        np.testing.assert_array_equal(one.amplitude, two.amplitude)
        assert one.parameters == two.parameters
    assert not (tmp_path / "owned").exists()


@pytest.mark.slow
def test_what_cannot_be_kept_does_not_stop_the_sweep(program):
    full = (
        FEW
        + """
import fcm.run.checkpoint_file as checkpoint
def full(*_):
    raise OSError(28, "No space left on device")
checkpoint._write = full
"""
    )
    done = program("respond", "sweep.toml", "-o", "a.nc", "--jobs", "1", before=full)
    assert done.returncode == 0
    said = [line for line in done.err.splitlines() if "No space left" in line]
    assert len(said) == 1 and "a.nc.unfinished" in said[0] and "not kept" in said[0]
    assert program.files == ["a.nc", "one.toml", "sweep.toml"]


# Workers that are left alone; for kills see `test_kill`


@pytest.mark.slow
def test_workers_end_with_their_parent_in_the_middle_of_a_batch(program):
    program.write("endless.py", "def forever(batch, progress):\n    while True:\n        pass\n")
    program.write(
        "run.py",
        "from endless import forever\nfrom fcm.run import place_for, compute_batches\n"
        "compute_batches(forever, [[1], [2]], place_for(2))\n",
    )
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
        run = program.python("run.py")
        program.until(lambda run=run: len(session(run.pid)) == 3)
        time.sleep(0.3)
        os.kill(run.pid, number)
        run.communicate(timeout=30)
        program.until(lambda run=run: not session(run.pid), 2.0)


@pytest.mark.slow
def test_ctrl_c_while_workers_start_shows_no_traceback(program):
    """To all of the terminal's processes at once, as a terminal does."""
    for delay in (0.0, 0.1):
        run = program.start("respond", "sweep.toml", "-o", "a.nc", "--jobs", "2", before=SLOW)
        program.until(lambda run=run: len(session(run.pid)) > 1 or run.poll() is not None)
        time.sleep(delay)
        os.killpg(run.pid, signal.SIGINT)
        _, said = run.communicate(timeout=30)
        assert run.returncode == 3 and "Traceback" not in said and "Error" not in said
        program.until(lambda run=run: not session(run.pid), 2.0)


# What may be removed, and what must be kept, of each kind of run


def test_partial_files_of_the_dead_are_removed_and_of_the_living_not(program):
    gone = program.python("-c", "")
    gone.wait()
    for name in (f".a.{gone.pid}.partial.nc", f".a.{gone.pid:08d}.partial.nc", f".a.{os.getpid()}.partial.nc",
                 f".b.{gone.pid}.partial.nc", ".a.partial.nc"):  # fmt: skip
        (program.folder / name).write_text("a part")
    assert program("respond", "one.toml", "-o", "a.nc").returncode == 0
    left = [f".a.{os.getpid()}.partial.nc", ".a.partial.nc", f".b.{gone.pid}.partial.nc"]
    assert program.files == sorted([*left, "a.nc", "one.toml", "sweep.toml"])


def test_a_table_that_is_killed_while_it_is_written_leaves_nothing_for_ever(program):
    args = ("tabulate", "--nodes", 9, 9, 9, 9, "--points", 10000, "-o", "t.nc")
    deadly = "import fcm.table.file_checksum as seal, os\nseal.attach = lambda _: os.kill(os.getpid(), 9)\n"
    assert program(*args, before=deadly).returncode == -signal.SIGKILL
    assert program(*args).returncode == 0
    assert program.files == ["one.toml", "sweep.toml", "t.nc"]


# the paragraph after 6


@pytest.mark.slow
def test_of_120_curves_84_percent_are_kept(tmp_path):
    one = replace(fcm.load_scene("yang1998-n5"), max_step=0.5, frequency_range=(1.3, 1.5))
    scene = replace(one, curves=tuple(replace(one, parameters={"n": float(n)}) for n in range(120)))

    keep = tmp_path / "kept"
    part = trace(
        scene, "closed-form", execution=Execution(keep=keep, progress=interrupted_beyond(0.84 * 0.9))
    )
    # the first share beyond 84 % is that of 101 curves: the one beyond the last whole group is kept, too
    assert sum(curve.complete for curve in part.curves) == 101 and part.interrupted
    assert all(
        curve.complete
        for curve in trace(scene, "closed-form", execution=Execution(keep=keep, resume=True)).curves
    )


def test_there_is_one_bar_and_it_never_goes_back():
    shown = []
    scene = fcm.load_scene("yang1998")
    coarse = replace(scene, curves=tuple(replace(one, max_step=0.3) for one in scene.curves))
    trace(coarse, execution=Execution(progress=lambda share, _: shown.append(share)))
    assert shown == sorted(shown) and shown[-1] == 1.0 and shown[-2] < 1.0
    assert len(set(shown)) > 5


@pytest.mark.parametrize("harmonics", [1, None])
def test_the_progress_of_one_curve_moves_with_the_frequency(harmonics):
    """It was 0 % for half of the time, then 90 %."""
    shown = []
    scene = replace(fcm.load_scene("yang1998-n5"), max_step=0.01)
    trace(scene, harmonics=harmonics, execution=Execution(progress=lambda share, _: shown.append(share)))
    assert shown == sorted(shown) and shown[-1] == 1.0
    first = [share for share in dict.fromkeys(shown) if share < 0.45]  # of what is traced at first
    assert len(first) > 10 and max(np.diff(first)) < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("of", ["levels", "mode"])
def test_the_progress_of_one_mode_or_level_moves_with_its_span(of):
    shown = []
    scene = replace(fcm.load_scene("yang1998-n5"), max_step=0.005)
    execution = Execution(progress=lambda share, _: shown.append(share))
    if of == "mode":
        trace_modes(scene, ModeRequest(1, (0.1, 100.0)), execution, harmonics=1)
    else:
        trace_levels(scene, LevelRequest([1.2], (0.0, 2.0)), execution, harmonics=1)
    assert shown == sorted(shown) and shown[-1] <= 1.0
    first = [share for share in dict.fromkeys(shown) if share < 0.4]
    assert len(first) > 5 and max(np.diff(first)) < 0.2


@pytest.mark.slow
def test_verbose_shows_where_a_curve_was_lost(program):
    lost = "import fcm.response.curve_batches as curve_batches\n" + (
        "def broken(*_, **more):\n    raise ZeroDivisionError('of zero')\n"
        "curve_batches.traced_curve = broken\n"
    )
    quiet = program("respond", "one.toml", before=lost)
    loud = program("respond", "one.toml", "-v", before=lost)
    assert (quiet.returncode, loud.returncode) == (1, 1)
    assert "Traceback" not in quiet.err and "in broken" in loud.err and "Traceback" in loud.err


@pytest.mark.slow
def test_a_schedule_that_is_interrupted_keeps_the_curves(program):
    """And leaves a former file of both as it was."""
    program.write("one.toml", ONE + "[[schedule]]\nfrequency = 1.2\ncycles = 50\n")
    stopped = (
        ALONE
        + """
import fcm.response.scheduled
def stop(*_):
    raise KeyboardInterrupt
fcm.response.scheduled.histories = stop
"""
    )
    former = program.folder / "a.csv"
    former.write_text("former")
    done = program("respond", "one.toml", "--csv", "a.csv", before=stopped)
    assert done.returncode == 3 and former.read_text() == "former"
    assert "kept in a.csv.unfinished: continue with --resume" in done.err
    nothing = (
        ALONE + "import fcm.response.curve_batches as curve_batches\ncurve_batches.traced_curve = None\n"
    )
    assert program("respond", "one.toml", "--csv", "a.csv", "--resume", before=nothing).returncode == 0
    assert former.read_text().startswith("curve,") and program.files == ["a.csv", "one.toml", "sweep.toml"]


AT = ("respond", "sweep.toml", "--method", "exact", "--at", "1.15:1.3:12", "-o", "a.nc")
VISITED = """
import fcm.response.stepped_sweep as visit, time
real = visit.SteppedSweep._step_to
def go(self, omega, sweep):
    with open("visits", "a") as file:
        file.write(f"{sweep} {omega} {self.scene.parameters}\\n")
    time.sleep(0.02)
    real(self, omega, sweep)
visit.SteppedSweep._step_to = go
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_of_exact_runs_every_finished_point_is_kept(program, number):
    """Of two curves at twelve frequencies, interrupted twice; a former result stays what it was."""
    program.write("sweep.toml", SWEEP.replace("count = 12", "count = 2"))
    assert program(*AT[:-1], "whole.nc", "--jobs", "1", before=VISITED).returncode == 0
    visits = program.folder / "visits"
    every = visits.read_text().splitlines()
    visits.unlink()
    (program.folder / "a.nc").write_text("former")
    size = 0
    for _ in range(2):
        run = program.start(*AT, "--resume", "--jobs", "1", before=VISITED)
        program.until(lambda size=size: program.kept(more_than=size + 6000))
        end(run, number)
        assert "Traceback" not in run.err and (program.folder / "a.nc").read_text() == "former"
        size = (program.folder / "a.nc.unfinished").stat().st_size
    assert program(*AT, "--resume", "--jobs", "1", before=VISITED).returncode == 0
    again = visits.read_text().splitlines()
    assert (
        set(again) == set(every) and len(again) <= len(every) + 3
    )  # only those in the middle of which it was
    assert variables(program.folder / "a.nc") == variables(program.folder / "whole.nc")


@pytest.mark.slow
def test_points_of_workers_are_kept_as_well(program):
    program.write("sweep.toml", SWEEP.replace("count = 12", "count = 2"))
    assert program(*AT[:-1], "whole.nc", "--jobs", "1").returncode == 0
    run = program.start(*AT, "--jobs", "2")
    program.until(lambda: program.kept(more_than=8000))
    end(run, signal.SIGKILL)
    assert program(*AT, "--resume", "--jobs", "2").returncode == 0
    assert variables(program.folder / "a.nc") == variables(program.folder / "whole.nc")


# places to compute


SQUARES = """
def square(batch, progress):
    for k, item in enumerate(batch):
        progress(k / len(batch), "")
        if item < 0:
            raise ValueError("negative")
    return [item * item for item in batch]
"""


@pytest.mark.parametrize("place", ["here", "processes", "elsewhere"])
def test_every_place_gives_the_same_and_loses_what_fails_alone(tmp_path, monkeypatch, place):
    (tmp_path / "squares.py").write_text(SQUARES)
    monkeypatch.syspath_prepend(tmp_path)
    square = importlib.import_module("squares").square
    with ThreadPoolExecutor(2) as executor:
        at = {
            "here": place_for(1),
            "processes": place_for(2),
            "elsewhere": lambda compute, _: ExecutorPlace(compute, executor),
        }[place]
        results = compute_batches(square, [[1, 2], [3], [4, -5, 6]], at).results
    assert [results[0], results[1], results[2][::2]] == [[1, 4], [9], [16, 36]]
    lost = results[2][1]
    assert isinstance(lost, Lost) and lost.reason == "ValueError: negative" and "in square" in lost.defect


ENDLESS = """
import pathlib, time
def endless(batch, progress):
    begun = pathlib.Path(__file__).with_name("begun")
    if batch[0] == 0:
        while batch[1] and not begun.exists():
            time.sleep(0.01)
        time.sleep(batch[1])
        return [0]
    begun.touch()
    while True:
        progress(0.5, "")
        time.sleep(0.01)
"""


@pytest.mark.parametrize("late", [0.0, 0.3])
def test_processes_hand_over_what_is_finished_when_they_are_interrupted(tmp_path, monkeypatch, late):
    """What is finished only then, too; the progress of that would interrupt again."""
    (tmp_path / "endless_batch.py").write_text(ENDLESS)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "endless_batch", raising=False)
    endless = importlib.import_module("endless_batch").endless

    def show(_share, _text):
        if (tmp_path / "begun").exists():
            raise KeyboardInterrupt

    done = compute_batches(endless, [[0, late], [1], [2]], place_for(2), progress=show)
    assert done.interrupted and done.results == {0: [0]}


def test_the_lock_goes_with_the_process(program):
    path = program.folder / "kept"
    code = (
        "import sys, time\nfrom pathlib import Path\nfrom fcm.run import CheckpointFile\n"
        f"kept = CheckpointFile(Path({str(path)!r}))\nprint('locked', flush=True)\ntime.sleep(60)\n"
    )
    run = program.python("-c", code)
    assert run.stdout.readline() == "locked\n"
    with pytest.raises(CheckpointError, match=f"process {run.pid} on"):
        CheckpointFile(path)
    run.kill()
    run.communicate()
    with CheckpointFile(path, resume=True):
        assert path.exists()
    assert not path.exists()


def test_checkpoints_have_a_limit_aside(tmp_path):
    three = RunOptions(max_set_aside=3)
    path = Path(tmp_path / "kept")
    for number in range(3):
        path.write_text("foreign")
        if number == 2:
            with pytest.raises(CheckpointError, match="remove some"):
                CheckpointFile(path, options=three)
        else:
            with pytest.warns(UserWarning, match="moved to"):
                CheckpointFile(path, options=three).close()


def test_an_import_that_an_interruption_made_fail_is_one():
    """A library of C that is interrupted while it is loaded says that it could not be."""

    def compute(batch, _report):
        if batch == (2,):
            try:
                raise KeyboardInterrupt
            except KeyboardInterrupt as error:
                raise ImportError("initialization failed") from error
        return list(batch)

    outcome = compute_batches(compute, [(1,), (2,), (3,)])
    assert outcome.interrupted and outcome.results == {0: [1]}
    assert not compute_batches(compute, [(1,), (3,)]).interrupted
