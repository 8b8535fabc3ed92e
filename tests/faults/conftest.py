"""The program as a process of its own, in a folder of its own, and what it leaves behind."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import netCDF4
import numpy as np
import pytest

HEAD = """
title = "a sweep"
[modal]
dofs = ["u", "v"]
frequency = [1.0, 10.0]
damping = 0.01
shapes = [[0.707, 0.707], [1.0, -0.5]]
[[contact]]
name = "shroud"
tangential = "u"
normal = "v"
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "u"
amplitude = 1.0
"""
SWEEP = (
    HEAD
    + """
[response]
frequency = [1.1, 1.4]
max_step = 0.5
[sweep]
"contact.shroud.n_0" = { from = 3, to = 9, count = 12 }
"""
)
ONE = HEAD + "[response]\nfrequency = [0.8, 1.6]\nmax_step = 0.2\n"
# groups of few curves, so that a short sweep is worth interrupting
FEW = (
    "from fcm import signals\nsignals.take()\n"  # as the program does, before anything is imported
    "import fcm.response.sweep as sweep; sweep.BATCH = 2\n"
)
TIMED = {"seconds"}  # parts of a summary that differ from run to run


class Program:
    """``program(*args)`` runs it to its end; ``program.start(*args)`` lets it run."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.running = folder, []

    def start(self, *args, before="", env=None, **more):
        """Begin a run, in a session of its own; before: Python that is executed first in its process."""
        code = f"{before}\nfrom fcm.cli.__main__ import run\nrun()"
        command = [sys.executable, "-c", code] if before else [sys.executable, "-m", "fcm.cli"]
        more = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | more
        run = subprocess.Popen(
            [*command, *map(str, args)], cwd=self.folder, start_new_session=True,
            env={**os.environ, **(env or {})}, **more,
        )  # fmt: skip
        self.running.append(run)
        return run

    def __call__(self, *args, **more):
        run = self.start(*args, **more)
        run.out, run.err = run.communicate(timeout=120)
        return run

    def write(self, name, text):
        (self.folder / name).write_text(text)

    @property
    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def until(self, condition, seconds=60.0):
        """Wait for something; the test fails if it does not come about."""
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, f"in vain; there is {self.files}"
            time.sleep(0.005)

    def kept(self, name="a.nc.unfinished", more_than=100):
        """Whether finished work is on disk."""
        path = self.folder / name
        return path.is_file() and path.stat().st_size > more_than


@pytest.fixture
def program(tmp_path):
    one = Program(tmp_path)
    one.write("sweep.toml", SWEEP)
    one.write("one.toml", ONE)
    yield one
    for run in one.running:
        if run.poll() is None:
            run.kill()
            run.wait()
        for stream in (run.stdout, run.stderr):
            if stream is not None:
                stream.close()


def session(leader):
    """The processes of a session that live."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                fields = (entry / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if int(fields[3]) == leader and fields[0] not in "ZX":
                found.append(int(entry.name))
    return found


def variables(path):
    """The bytes of every variable of a file; what is timed is left out."""
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        return {
            name: np.asarray(variable[...]).tobytes() if variable.dtype is not str else variable[...].tolist()
            for name, variable in data.variables.items()
            if name not in TIMED
        }


def end(run, number):
    """Send a signal, and what the run then says."""
    os.kill(run.pid, number)
    run.out, run.err = run.communicate(timeout=60)
    return run


SIGNALS = [signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGKILL]
