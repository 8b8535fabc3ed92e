"""Around the calculation: the impossible asked for, streams closed, disks full, names that command."""

import json
import os
import random
import resource
import shutil
import signal
import sys
import time

import netCDF4
import numpy as np
import pytest

from fcm.cli.terminal import plain

from ..oscillator import oscillator
from ..program import ended, python
from .conftest import ONE

# What would not end


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("frequency = [1.2, 1.200000000000002]", "response.frequency: is too narrow"),
        ("frequency = [1.2, 1.2000000000000002]", "response.frequency: is too narrow"),
        ("frequency = [0.8, 1.6]\nmax_step = 1e-9", "response.max_step: must be at least 1e-05"),
    ],
)
def test_a_run_without_end_is_refused(program, line, said):
    program.write("scene.toml", oscillator(f"[response]\n{line}\n"))
    done = program("respond", "scene.toml")
    assert done.returncode == 2 and said in done.err and done.out == ""


def test_a_step_without_end_is_refused_on_the_command_line(program):
    done = program("respond", "one.toml", "--max-step", "1e-9")
    assert done.returncode == 2 and "1e+09 points" in done.err


def test_a_narrow_range_that_can_be_followed_is_not(program):
    program.write("scene.toml", oscillator("[response]\nfrequency = [1.2, 1.2000000013]\nmax_step = 0.5\n"))
    assert program("respond", "scene.toml").returncode == 0


@pytest.mark.slow
def test_many_points_are_announced(program):
    stopped = "import fcm.response as response\nresponse.trace = None\n"
    done = program("respond", "one.toml", "--max-step", "2e-5", before=stopped)
    assert done.err.splitlines()[0] == "at least 50000 points: 1 curve in steps of 2e-05 at most"
    done = program("respond", "one.toml", "--max-step", "2e-3", before=stopped)
    assert "at least" not in done.err


# Two outputs in one file


@pytest.mark.parametrize("other", ["./x.csv", "link.csv"])
def test_two_outputs_in_one_file_are_refused(program, other):
    program.write("scene.toml", ONE + "[[schedule]]\nfrequency = 1.2\ncycles = 3\n")
    (program.folder / "link.csv").symlink_to("x.csv")
    done = program("respond", "scene.toml", "--csv", "x.csv", "--history-csv", other)
    assert done.returncode == 2 and "--csv and --history-csv name the same file" in done.err
    assert not (program.folder / "x.csv").exists()


# What creeps away; frequencies in hertz

ADRIFT = """
[modal]
dofs = ["u", "v"]
frequency = [0.0, 1.0, 3.0]
damping = 0.02
shapes = [[1.0, 0.0], [0.7, 0.7], [0.6, -0.8]]
[[contact]]
name = "shroud"
tangential = "u"
normal = "v"
mu = 0.3
k_u = 1.0
k_v = 1.0
n_0 = 0.5
[[force]]
dof = "u"
amplitude = 1.0
[[force]]
dof = "v"
amplitude = 1.0
phase = 0.7
[response]
frequency = [0.5, 2.0]
max_step = 0.2
"""


@pytest.mark.slow
def test_what_creeps_away_is_not_stable(program):
    program.write("scene.toml", ADRIFT)
    done = program("respond", "scene.toml", "-o", "a.nc", "--json")
    (curve,) = json.loads(done.out)["curves"]
    assert done.returncode == 3 and "there is no steady state" in curve["reason"] and curve["points"] > 10
    assert not curve["stable"] and curve["jumps"] == []
    with netCDF4.Dataset(program.folder / "a.nc") as data:
        assert not np.ma.compressed(data["stable"][:]).any()


@pytest.mark.slow
@pytest.mark.parametrize("at", ["52", "33.3"])
def test_a_frequency_in_hertz_is_the_one_that_was_given(program, at):
    scene = oscillator("[response]\nfrequency = [1, 2]\n", n_0=1e9)
    program.write("scene.toml", 'frequency_unit = "Hz"' + scene)
    args = ("respond", "scene.toml", "--method", "exact", "--at", at, "-o", "a.nc", "--csv", "a.csv")
    done = program(*args)
    assert done.returncode == 0, done.err
    with netCDF4.Dataset(program.folder / "a.nc") as data:
        assert data["frequency"][0].tolist() == [float(at)] * 2
    rows = (program.folder / "a.csv").read_text().splitlines()[1:]
    assert [row.split(",")[2] for row in rows] == [repr(float(at))] * 2


def test_every_frequency_of_15_digits_survives():
    from fcm.units import UNIT, in_unit

    rng = np.random.default_rng(0)
    exact = np.array([float(f"{x:.15g}") for x in 10.0 ** rng.uniform(-6, 6, 20_000)])
    omega = exact * UNIT["Hz"]
    assert (omega / UNIT["Hz"] != exact).any()  # or there would be nothing to mend
    np.testing.assert_array_equal(in_unit(omega, "Hz"), exact)
    whatever = rng.uniform(1.0, 100.0, 20_000)
    np.testing.assert_allclose(in_unit(whatever, "Hz") * UNIT["Hz"], whatever, rtol=2.0**-52)
    odd = np.array([np.nan, 0.0, -1.0, 1e-300, 1e300, np.inf])
    np.testing.assert_array_equal(in_unit(odd, "rad/s"), odd)
    np.testing.assert_allclose(in_unit(odd, "Hz"), odd / UNIT["Hz"], rtol=1e-15)


# Streams that are closed, a backend of the environment, files without anything in them


@pytest.mark.parametrize("closed", [[2], [1, 2], [0, 1, 2]])
def test_closed_streams_are_no_reason_to_write_nothing(program, closed):
    def close():
        for number in closed:
            os.close(number)

    run = program.start("respond", "one.toml", "-o", "a.nc", stdout=None, stderr=None, preexec_fn=close)
    assert run.wait(timeout=60) == 0
    with netCDF4.Dataset(program.folder / "a.nc") as data:
        assert data["complete"][:].tolist() == [1]


@pytest.mark.parametrize("backend", ["module://matplotlib_inline.backend_inline", "nonsense"])
def test_the_backend_of_the_environment_is_of_no_interest(program, backend):
    done = program("plot", "normal", "-o", "a.png", env={"MPLBACKEND": backend})
    assert done.returncode == 0 and (program.folder / "a.png").stat().st_size > 1000, done.err


@pytest.mark.slow
def test_a_file_without_degrees_of_freedom_is_refused(program):
    with netCDF4.Dataset(program.folder / "a.nc", "w") as data:
        for name, size in (("curve", 1), ("point", 3), ("dof", 0)):
            data.createDimension(name, size)
        data.createVariable("dof", str, ("dof",))
        data.createVariable("frequency", "f8", ("curve", "point"))[:] = [[1.0, 2.0, 3.0]]
        data.createVariable("amplitude", "f8", ("curve", "point", "dof"))
    for what in ("response", "peak"):
        done = program("plot", what, "a.nc", "-o", "a.png")
        assert done.returncode == 2 and "a.nc" in done.err and "defect" not in done.err


# Small disks, small files, little memory

UNSHARED = ("unshare", "-rm")
SMALL = shutil.which("unshare") and ended(*UNSHARED, "mount", "-t", "tmpfs", "none", "/mnt").code == 0


@pytest.mark.slow
@pytest.mark.skipif(not SMALL, reason="no disk can be made here")
def test_a_full_disk_is_named(program):
    """A disk of 500 kB: too small for the table; and one that something fills while curves are traced."""
    program.write(
        "full.sh",
        f"""
mkdir small; mount -t tmpfs -o size=500k none small; cd small; cp ../*.toml .
{sys.executable} -m fcm.cli tabulate --preset fast --points 10000 -o t.nc; echo $?
cat > fill.py <<END
import fcm.results.output as output
real = output.write_netcdf
def full(*args):
    with open("fill", "wb", buffering=0) as file:
        try:
            while True:
                file.write(bytes(512))
        except OSError:
            pass
    real(*args)
output.write_netcdf = full
from fcm.cli.__main__ import run
run()
END
{sys.executable} fill.py respond one.toml -o a.nc >/dev/null; echo $?; rm fill
{sys.executable} -m fcm.cli respond one.toml -o a.nc --resume >/dev/null; echo $?; ls -A
""",
    )
    done = ended(*UNSHARED, "bash", "full.sh", cwd=program.folder)
    disk = f"No space left on device (the disk of {program.folder / 'small'})"
    assert done.out.split() == ["3", "3", "0", "a.nc", "fill.py", "one.toml", "sweep.toml"], done.err
    errors = [line for line in done.err.splitlines() if line.startswith("fcm:")]
    assert errors == [
        f"fcm: error: t.nc: {disk}",
        "fcm: warning: what is finished is kept in a.nc.unfinished: continue with --resume",
        f"fcm: error: a.nc: {disk}",
    ]


@pytest.mark.skipif(not SMALL, reason="no disk can be made here")
@pytest.mark.slow
def test_a_picture_on_a_full_disk_is_one_sentence(program):
    """In each format, of which PDF packs what it writes."""
    endings = ("png", "pdf", "svg", "html")
    lines = [f"{sys.executable} -m fcm.cli plot response a.nc -o small/a.{one}; echo $?" for one in endings]
    assert program("respond", "one.toml", "-o", "a.nc").returncode == 0
    mount = "mkdir small; mount -t tmpfs -o size=4k none small"
    program.write("full.sh", "\n".join((mount, *lines, "ls -A small")))
    done = ended(*UNSHARED, "bash", "full.sh", cwd=program.folder)
    assert done.out.split() == ["3"] * 4, done.err
    disk = f"No space left on device (the disk of {program.folder / 'small'})"
    assert done.err.splitlines() == [f"fcm: error: small/a.{one}: {disk}" for one in endings]


def test_a_file_that_may_not_grow_is_no_defect(program):
    """The limit of a shell, `ulimit -f`, which netCDF calls an HDF error."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))  # noqa: E731
    done = program("tabulate", "--preset", "fast", "--points", 10_000, "-o", "t.nc", preexec_fn=limit)
    assert done.returncode == 3 and done.err.endswith("fcm: error: t.nc: File too large\n")
    assert program.files == ["one.toml", "sweep.toml"]


@pytest.mark.parametrize("megabytes", [150, 200])
def test_little_memory_is_called_so(program, megabytes):
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20,) * 2)  # noqa: E731
    for args in (("respond", "one.toml", "-o", "a.nc"), ("plot", "normal", "-o", "a.png")):
        done = program(*args, preexec_fn=limit)
        assert done.returncode == 3
        assert done.err == "fcm: error: not enough memory to complete the calculation\n"
    assert program.files == ["one.toml", "sweep.toml"]


# Signals from the first import to after the end

EARLY = """
import os, signal, sys, threading
class Finder:
    left = int(os.environ["AFTER"])
    def find_spec(self, *_):
        Finder.left -= 1
        if Finder.left == 0:
            os.kill(os.getpid(), signal.SIGINT)
"""


@pytest.mark.parametrize("after", [1, 10, 30, 60, 120, 300, 600])
def test_ctrl_c_while_it_begins_is_one_line(program, after):
    """At the import with this number, of some five hundred; at the last there is a curve, or all is done."""
    begin = EARLY + "from fcm import signals\nsignals.take()\nsys.meta_path.insert(0, Finder())\n"
    done = program("respond", "one.toml", "-o", "a.nc", before=begin, env={"AFTER": str(after)})
    if done.returncode == 0:
        assert after > 250
    else:
        assert_interrupted(done, program.files, begun=after > 250)


def assert_interrupted(done, files, begun):
    """A run of one.toml said that it stopped; with the curve that it had, where that may have begun."""
    assert done.returncode == 3
    if begun and "a.nc" in files:
        stopped = "fcm: error: the curve stopped early; what was traced is reported and written\n"
        assert done.err.endswith(stopped)
    else:
        nothing = "fcm: warning: nothing is finished, so nothing is kept\n"
        assert done.err.removeprefix(nothing) == "fcm: interrupted: the calculation was not completed\n"
        assert files == ["one.toml", "sweep.toml"]


HANDLED = """
class Library:
    def find_spec(self, name, *_):
        if name == "fcm.response":
            try:
                os.kill(os.getpid(), signal.SIGINT)
            except BaseException as error:
                {then}
"""


@pytest.mark.parametrize("then", ["pass", "raise RuntimeError('not found') from None"])
def test_ctrl_c_in_an_import_comes_after_it(program, then):
    """A library that is being imported could swallow the interruption, or make another error of it.

    It waits for the import's end; on a slow machine the curve has begun by then.
    """
    begin = EARLY + HANDLED.format(then=then) + "from fcm import signals\nsignals.take()\n"
    begin += "sys.meta_path.insert(0, Library())\n"
    done = program("respond", "one.toml", "-o", "a.nc", before=begin, env={"AFTER": "0"})
    assert_interrupted(done, program.files, begun=True)


SLOW_LIBRARY = """
import time
class Library:
    def find_spec(self, name, *_):
        if name == "fcm.response":
            try:
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(1.3)
                {second}
            except BaseException as error:
                raise RuntimeError('not found') from None
"""


@pytest.mark.slow
def test_ctrl_c_waits_for_an_import_however_long(program):
    """A busy machine takes its time to load a library."""
    begin = EARLY + SLOW_LIBRARY.format(second="") + "from fcm import signals\nsignals.take()\n"
    begin += "sys.meta_path.insert(0, Library())\n"
    done = program("respond", "one.toml", "-o", "a.nc", before=begin, env={"AFTER": "0"})
    assert_interrupted(done, program.files, begun=True)


@pytest.mark.slow
def test_ctrl_c_once_more_does_not_wait_for_an_import(program):
    """A library that never ends would hold the program for ever."""
    second = "os.kill(os.getpid(), signal.SIGINT); time.sleep(60.0)"
    begin = EARLY + SLOW_LIBRARY.format(second=second) + "from fcm import signals\nsignals.take()\n"
    begin += "sys.meta_path.insert(0, Library())\n"
    start = time.monotonic()
    done = program("respond", "one.toml", "-o", "a.nc", before=begin, env={"AFTER": "0"})
    assert_interrupted(done, program.files, begun=True)
    assert time.monotonic() - start < 60.0


def test_ctrl_c_is_not_lost_in_the_traceback_of_compiled_code():
    """Cython clears what is raised there, as `memory[:] = 0.0` raises and catches an error of its own."""
    cleared = """
import functools, os, signal, time
from fcm import signals
signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job has it ignored
signals.take()
signals.works()
code = compile("_getframe()", "kernel.py", "eval")  # as Cython makes a frame for a traceback
try:
    try:
        eval(code, {"_getframe": functools.partial(os.kill, os.getpid(), signal.SIGINT)})
    except KeyboardInterrupt:
        print("cleared")
    time.sleep(30.0)
except KeyboardInterrupt:
    print("heeded")
"""
    assert python("-c", cleared).out == "heeded\n"


def test_ctrl_c_before_there_is_anyone_to_say_so_ends_in_silence():
    """While the very module is loaded that takes signals: it is the first that the script loads."""
    early = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job has it ignored
class Finder:
    def find_spec(self, name, *_):
        if name == "fcm.signals":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Finder())
from fcm.cli.__main__ import run
assert "fcm.signals" not in sys.modules
run()
"""
    done = python("-c", early)
    assert done.code == -signal.SIGINT and done.err == ""


@pytest.mark.slow
def test_ctrl_c_at_random_instants_is_never_a_traceback(program):
    """Once Python itself has begun, which is not this program's to mend."""
    rng = random.Random(1)
    for _ in range(4):
        run = program.start("respond", "one.toml", "-o", "a.nc", before="print('begun', flush=True)")
        assert run.stdout.readline() == "begun\n"
        time.sleep(0.05 + rng.uniform(0.0, 0.25))
        os.kill(run.pid, signal.SIGINT)
        _, said = run.communicate(timeout=60)
        assert run.returncode in (0, 3) and "Traceback" not in said and "Exception" not in said


WAITS = "import threading\nthreading.Thread(target=threading.main_thread().join).start()"  # for the end


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("thread", ["", WAITS])
def test_a_signal_after_the_end_changes_nothing(program, number, thread):
    """While the process ends, by itself or by the interpreter that takes itself apart."""
    late = f"""
import atexit, os, sys
class Late:
    def __del__(self, kill=os.kill, process=os.getpid()):
        kill(process, {int(number)})
sys.late = Late()
atexit.register(Late().__del__)
{thread}
"""
    done = program("plot", "normal", "-o", "a.svg", before=late)
    assert done.returncode == 0 and done.err == "wrote a.svg\n"


def test_what_is_to_be_done_at_the_end_is_done(program):
    """Functions that wait for the exit of the process, and threads that go on after the program."""
    after = """
import atexit, pathlib, threading
atexit.register(pathlib.Path("at_exit").touch)
def last():
    threading.main_thread().join()
    pathlib.Path("by_thread").touch()
"""
    start = "threading.Thread(target=last).start()\n"
    assert program("--help", before=after).returncode == 0
    assert program.files == ["at_exit", "one.toml", "sweep.toml"]
    assert program("--bad", before=after + start).returncode == 2
    assert program.files == ["at_exit", "by_thread", "one.toml", "sweep.toml"]


def test_what_is_told_to_ignore_a_signal_ignores_it(program):
    """As `nohup` does."""
    deaf = lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)  # noqa: E731
    run = program.start(
        "respond", "one.toml", "-o", "a.nc", preexec_fn=deaf, before="print('begun', flush=True)"
    )
    assert run.stdout.readline() == "begun\n"
    for _ in range(5):
        os.kill(run.pid, signal.SIGHUP)
        time.sleep(0.05)
    assert run.wait(timeout=60) == 0 and "a.nc" in program.files


NAUGHTY = "\x1b]0;owned\x07\x1b[31m\u202e"


# Names that command a terminal, or are no text


@pytest.mark.slow
def test_names_do_not_command_the_terminal(program):
    program.write("scene.toml", ONE.replace('"a sweep"', json.dumps(NAUGHTY + "title")))
    program.write("names.toml", ONE.replace('"u"', json.dumps(NAUGHTY + "u")))
    runs = [
        program("respond", "scene.toml", "-o", "a.nc", "-v"),
        program("respond", "names.toml"),
        program("respond", f"{NAUGHTY}.toml"),
        program("respond", "one.toml", f"--{NAUGHTY}"),
        program("respond", "one.toml", "-o", f"{NAUGHTY}.nc"),
        program("respond", "one.toml", "-o", "a\nfcm: error: forged.nc"),
        program("plot", "response", f"{NAUGHTY}.nc", "--dof", NAUGHTY),
        program("tabulate", "--verify", f"{NAUGHTY}.nc"),
        program(NAUGHTY),
    ]
    assert [run.returncode for run in runs] == [0, 2, 2, 2, 0, 0, 2, 2, 2]
    for run in runs:
        said = run.out + run.err
        assert said and not any(c in said for c in "\x1b\x07\x9b\u202e") and "Traceback" not in said
        assert "\nfcm: error: forged" not in said
    assert r"\x1b]0;owned\x07" in runs[0].err


def test_what_is_escaped_and_what_is_not():
    assert plain("blade 3, n̄₀ = 5 µm, 位 ü") == "blade 3, n̄₀ = 5 µm, 位 ü"
    assert plain("a\tb\rc\x7fd\x85e\u2028f\u200bg\udcff") == r"a\tb\rc\x7fd\x85e\u2028f\u200bg\udcff"
    assert plain("a\nb", several_lines=True) == "a\nb"


@pytest.mark.parametrize("command", [["tabulate", "--for"], ["respond"], ["tabulate", "--verify"]])
def test_a_name_that_is_no_text_is_wrong_input_or_none(program, command):
    done = program(*command, b"\xff.toml".decode("utf-8", "surrogateescape"))
    assert done.returncode == 2 and r"\udcff.toml" in done.err and "Error" not in done.err


def test_a_scene_whose_name_is_no_text_makes_a_table(program):
    name = b"\xff.toml".decode("utf-8", "surrogateescape")
    program.write(name, ONE)
    args = ("tabulate", "--nodes", 9, 9, 9, 9, "--points", 10_000, "--for", name, "-o", "t.nc")
    done = program(*args)
    assert done.returncode == 0, done.err
    with netCDF4.Dataset(program.folder / "t.nc") as data:
        assert r"--for \udcff.toml" in data.history
