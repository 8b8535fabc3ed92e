"""Sweeps killed at random instants: nothing is lost, nothing left, and the end the same to the last bit.

Ten of them by default; FCM_KILLS=50, or `make kills`, for more.
"""

import os
import random
import signal
import time

import pytest

from ..program import Program
from .conftest import FEW, SIGNALS, SWEEP, session, variables

KILLS = int(os.environ.get("FCM_KILLS", "10"))
FORMER = b"the result of an earlier run, which nothing but a whole one may replace"
# which groups are taken from what is kept, of which a part is, and which are computed
NOTED = (
    FEW
    + """
import fcm.response.curve_batches as module
real = module.compute_batches
def sweep(compute, batches, at, kept, progress):
    taken, begun = set(kept.finished), set(kept.states)
    outcome = real(compute, batches, at, kept, progress)
    for name, numbers in (("taken", taken), ("begun", begun), ("computed", set(outcome.results) - taken)):
        with open(name, "w") as file:
            file.write(" ".join(map(str, numbers)))
    return outcome
module.compute_batches = sweep
"""
)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """An uninterrupted run on one core: its variables, and how long one on two cores takes."""
    program = Program(tmp_path_factory.mktemp("whole"))
    program.write("sweep.toml", SWEEP)
    assert program("respond", "sweep.toml", "-o", "a.nc", "--jobs", "1", before=FEW).returncode == 0
    begin = time.monotonic()
    assert program("respond", "sweep.toml", "-o", "b.nc", "--jobs", "2", before=FEW).returncode == 0
    first, second = (variables(program.folder / name) for name in ("a.nc", "b.nc"))
    program.close()
    assert first == second
    return first, time.monotonic() - begin


@pytest.mark.slow
@pytest.mark.parametrize("number", range(KILLS))
def test_a_killed_sweep_loses_nothing(program, whole, number):
    reference, seconds = whole
    kind = SIGNALS[number % len(SIGNALS)]
    after = random.Random(number).uniform(0.0, seconds)
    former = program.folder / "a.nc"
    former.write_bytes(FORMER)
    args = ("respond", "sweep.toml", "-o", "a.nc", "--jobs")
    run = program.start(*args, 2, before=FEW.replace("\nimport", "\nprint('begun', flush=True)\nimport", 1))
    assert run.stdout.readline() == "begun\n"  # until then the interpreter itself begins
    time.sleep(after)
    os.kill(run.pid, kind)
    killed = time.monotonic()
    _, said = run.communicate(timeout=60)
    program.until(lambda: not session(run.pid), max(2.0 - (time.monotonic() - killed), 0.0))
    assert "Traceback" not in said and run.returncode in (0, 3, -signal.SIGKILL)
    if run.returncode == 0 or former.read_bytes() != FORMER:  # or it came after the file, before the end
        assert variables(former) == reference
    resumed = program(*args, 1, "--resume", before=NOTED)
    assert resumed.returncode == 0, resumed.err
    assert variables(former) == reference
    taken, begun, again = (
        {*map(int, (program.folder / name).read_text().split())} for name in ("taken", "begun", "computed")
    )
    assert not taken & again and taken | again == set(range(6))
    assert program.files == ["a.nc", "begun", "computed", "one.toml", "sweep.toml", "taken"]
    if "continue with --resume" in said:
        assert taken or begun


@pytest.mark.slow
@pytest.mark.parametrize("kind", SIGNALS)
def test_a_sweep_killed_just_after_its_file_is_there_leaves_it_whole(program, whole, kind):
    program.folder.joinpath("a.nc").write_bytes(FORMER)
    late = f"""
import os, pathlib
real = pathlib.Path.replace
def replace(path, target):
    real(path, target)
    os.kill(os.getpid(), {int(kind)})
pathlib.Path.replace = replace
"""
    args = ("respond", "sweep.toml", "-o", "a.nc", "--jobs", "1")
    killed = program(*args, before=FEW + late)
    assert killed.returncode == (-signal.SIGKILL if kind == signal.SIGKILL else 3), killed.err
    assert variables(program.folder / "a.nc") == whole[0]
    resumed = program(*args, "--resume", before=NOTED)
    assert resumed.returncode == 0, resumed.err
    assert variables(program.folder / "a.nc") == whole[0]
    assert {*(program.folder / "taken").read_text().split()} == {*map(str, range(6))}
