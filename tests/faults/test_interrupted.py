"""Levels, modes and schedules that are interrupted go on from what is finished, or say that nothing is."""

import signal

import pytest

from ..oscillator import oscillator
from .conftest import ONE, TITLE, variables

FEW_CURVES = '[sweep]\n"contact.shroud.n_0" = [3, 4, 5, 6]\n'
SCHEDULE = "".join(
    f"[[schedule]]\nfrequency = {w}\ncycles = {n}\n" for w, n in ((1.2, 5), (1.1, 3.5), (1.3, 4))
)
OF_SCHEDULE = TITLE + oscillator(SCHEDULE)
KINDS = {  # scene, options, what begins each of the parts, and their number
    "level": (ONE, ["--level", "0.1:2", "--at", "1.15:1.3:4"], "fcm.response.level._level_curve", 4),
    "mode": (ONE + FEW_CURVES, ["--mode", "1", "--level", "0.5:5"], "fcm.response.mode._curve", 4),
    "schedule": (OF_SCHEDULE, [], "fcm.time_domain.schedule_record.cycles_from", 3),
    "schedules": (OF_SCHEDULE + FEW_CURVES, [], "fcm.time_domain.schedule_record.cycles_from", 12),
}
LIMIT = "the time limit"
# every part leaves a line in a file; the part with this number ends the run, as is said
BEGUN = """
from fcm import signals
signals.take()
import importlib, os, signal, threading, time
class Timer:
    def __init__(self, seconds, end):
        Timer.end = end
    def start(self): pass
    cancel = start
if {ends!r} == "the time limit":
    threading.Timer = Timer
place, name = {begins!r}.rpartition(".")[::2]
module = importlib.import_module(place)
real, begun = getattr(module, name), []
def noted(*args):
    begun.append(args)
    with open("begun", "a") as file:
        file.write("one\\n")
    if len(begun) == {number}:
        Timer.end() if {ends!r} == "the time limit" else os.kill(os.getpid(), {ends!r})
        time.sleep(60)
    return real(*args)
setattr(module, name, noted)
"""


def begun(program):
    """How many parts were begun since this was last asked."""
    file = program.folder / "begun"
    count = len(file.read_text().splitlines())
    file.unlink()
    return count


def before(kind, ends=0, number=0):
    ends = ends if ends == LIMIT else int(ends)
    return BEGUN.format(begins=KINDS[kind][2], ends=ends, number=number)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "ends", "number"),
    [
        ("level", signal.SIGINT, 3),
        ("level", signal.SIGKILL, 2),
        ("mode", signal.SIGTERM, 4),
        ("mode", LIMIT, 2),
        ("schedule", LIMIT, 3),
        ("schedule", signal.SIGKILL, 2),
        ("schedules", signal.SIGTERM, 8),
    ],
)
def test_what_is_finished_is_gone_on_from_to_the_same_file(program, kind, ends, number):
    scene, options, _, parts = KINDS[kind]
    program.write("one.toml", scene)
    args = ("respond", "one.toml", *options, "-o")
    assert program(*args, "whole.nc").returncode == 0
    more = ("--time-limit", "60") if ends == LIMIT else ()
    stopped = program(*args, "a.nc", *more, before=before(kind, ends, number))
    assert begun(program) == number and (program.folder / "a.nc.unfinished").exists()
    if ends == signal.SIGKILL:
        assert stopped.returncode == -signal.SIGKILL
    else:
        assert stopped.returncode == 3 and "Traceback" not in stopped.err
        kept = "interrupted; what is finished is kept in a.nc.unfinished: continue with --resume"
        assert f"fcm: warning: {kept}\n" in stopped.err
    resumed = program(*args, "a.nc", "--resume", before=before(kind))
    assert resumed.returncode == 0 and begun(program) == parts - number + 1, resumed.err
    assert variables(program.folder / "a.nc") == variables(program.folder / "whole.nc")
    assert program.files == ["a.nc", "one.toml", "sweep.toml", "whole.nc"]


@pytest.mark.parametrize(
    ("kind", "ends"), [("level", signal.SIGTERM), ("mode", signal.SIGINT), ("schedule", LIMIT)]
)
def test_where_nothing_is_finished_nothing_is_left_and_that_is_said(program, kind, ends):
    program.write("one.toml", KINDS[kind][0])
    more = ("--time-limit", "60") if ends == LIMIT else ()
    stopped = program(
        "respond", "one.toml", *KINDS[kind][1], "-o", "a.nc", *more, before=before(kind, ends, 1)
    )
    assert begun(program) == 1 and stopped.returncode == 3 and stopped.out == ""
    assert stopped.err.splitlines()[-2:] == [
        "fcm: warning: nothing is finished, so nothing is kept",
        "fcm: interrupted: the calculation was not completed",
    ]
    assert program.files == ["one.toml", "sweep.toml"]


def test_a_part_of_the_only_phase_is_written_and_no_work_is_kept(program):
    """Its first cycles are in the file; the schedule cannot go on from them."""
    program.write("one.toml", TITLE + oscillator("[[schedule]]\nfrequency = 1.2\ncycles = 9\n"))
    measured = before("schedule", signal.SIGINT, 4).replace("cycles_from", "measure")
    stopped = program("respond", "one.toml", "-o", "a.nc", before=measured)
    assert stopped.returncode == 3 and "NOT COMPLETE: interrupted" in stopped.out
    assert (
        "fcm: warning: interrupted; no finished curve is kept, so --resume would begin anew\n" in stopped.err
    )
    assert "fcm: ending, which may take some seconds\n" in stopped.err
    assert begun(program) == 4 and program.files == ["a.nc", "one.toml", "sweep.toml"]
