"""Scenes for the program as a process of its own, and what it leaves behind."""

import os
import signal
from pathlib import Path

import netCDF4
import numpy as np
import pytest

from ..oscillator import oscillator

TITLE = 'title = "a sweep"'
SWEEP = TITLE + oscillator("""
[response]
frequency = [1.1, 1.4]
max_step = 0.5
[sweep]
"contact.shroud.n_0" = { from = 3, to = 9, count = 12 }
""")
ONE = TITLE + oscillator("[response]\nfrequency = [0.8, 1.6]\nmax_step = 0.2\n")
# groups of few curves, so that a short sweep is worth interrupting
FEW = (
    "from fcm import signals\nsignals.take()\n"  # as the program does, before anything is imported
    "import fcm.response.options as options, fcm.response.sweep as sweep\n"
    "def messages():\n"
    "    from fcm.cli.messages import Messages\n    from fcm.cli.settings import Settings\n"
    "    few = options.ResponseOptions(sweep=options.SweepOptions(batch=2))\n"
    "    return Messages(settings=Settings(response=few))\n"
)
TIMED = {"seconds"}  # parts of a summary that differ from run to run


@pytest.fixture
def program(program):
    """With two scenes in its folder."""
    program.write("sweep.toml", SWEEP)
    program.write("one.toml", ONE)
    return program


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
