"""The program as the tests start it, by no other way: called here, as a process or by a shell."""

import os
import signal
import subprocess
import sys
import sysconfig
import time
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from click.testing import CliRunner

from fcm.cli import main
from fcm.cli.messages import Messages
from fcm.cli.settings import Settings

AS_A_MODULE = ("-m", "fcm.cli")


class Run(NamedTuple):
    """How a run ended, and what it printed on standard output and on standard error."""

    code: int
    out: str
    err: str


def called(*args, messages=None, **settings):
    """The program called in this process, with settings of its own or messages; a defect is raised."""
    messages = messages or Messages(settings=Settings(**settings))
    words = [str(arg) for arg in args]
    done = CliRunner().invoke(main, words, obj=messages, prog_name="fcm", catch_exceptions=False)
    assert "Traceback" not in done.output
    return Run(done.exit_code, done.stdout, done.stderr)


def ended(*command, **options):
    """Any command, run to its end; options are those of subprocess.run."""
    options = {"capture_output": True, "text": True, "timeout": 300, "stdin": subprocess.DEVNULL} | options
    done = subprocess.run([str(word) for word in command], **options)
    return Run(done.returncode, done.stdout, done.stderr)


def python(*args, **options):
    """A Python of its own: ``python("-c", CODE)``, ``python(*AS_A_MODULE, "respond", ...)``."""
    return ended(sys.executable, *args, **options)


def shell(line, folder=None, **options):
    """A line as a user types it, with fcm on the path."""
    path = os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]])
    return ended("bash", "-euc", line, cwd=folder, env={**os.environ, "PATH": path}, **options)


@contextmanager
def heeding_signals():
    """What is started heeds Ctrl-C, also where these tests are told to ignore it: as `make &` is."""
    ignored = [one for one in (signal.SIGINT, signal.SIGHUP) if signal.getsignal(one) is signal.SIG_IGN]
    for one in ignored:
        signal.signal(one, signal.SIG_DFL)
    try:
        yield
    finally:
        for one in ignored:
            signal.signal(one, signal.SIG_IGN)


class Program:
    """In a folder of its own: ``program(*args)`` runs it to its end, ``program.start(*args)`` lets it run."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.running = folder, []

    def start(self, *args, before="", env=None, **more):
        """Begin a run, in a session of its own; before: Python that is executed first in its
        process; `messages` of it are those of the command."""
        code = f"{before}\nfrom fcm.cli.__main__ import run\nrun(globals().get('messages'))"
        command = ["-c", code] if before else AS_A_MODULE
        return self.python(*command, *args, env={**os.environ, **(env or {})}, **more)

    def python(self, *args, **more):
        """Begin a Python of its own, in a session of its own."""
        more = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | more
        with heeding_signals():
            run = subprocess.Popen(
                [sys.executable, *map(str, args)], cwd=self.folder, start_new_session=True, **more
            )
        self.running.append(run)
        return run

    def __call__(self, *args, **more):
        run = self.start(*args, **more)
        run.out, run.err = run.communicate(timeout=120)
        return run

    def close(self):
        """End what still runs."""
        for run in self.running:
            if run.poll() is None:
                run.kill()
                run.wait()
            for stream in (run.stdout, run.stderr):
                if stream is not None:
                    stream.close()

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
