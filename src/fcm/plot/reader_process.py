"""Files of results, read by a process of its own: on a damaged one the HDF5 library can end its process.

Whatever becomes of that process, here there is what was read, or `PlotError`. While it reads, this one loads
what it will draw with, so that a picture takes no longer.
"""

from __future__ import annotations

import faulthandler
import math
import os
import pickle
import subprocess
import sys
import traceback
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import fcm
from fcm.plot.errors import PlotError
from fcm.plot.options import READ, ReadOptions

P = ParamSpec("P")
T = TypeVar("T")

_CODE = "from fcm.plot.reader_process import child; child()"
_NAMED = "FCM_READS_APART"  # set in the environment of the process that reads


def apart(reader: Callable[P, T], options: ReadOptions = READ) -> Callable[P, T]:
    """A function that reads a file, which is its first argument, done by a process of its own.

    It has the processor time of the options. What it is given and what it returns are pickled; so are the
    exceptions that it raises.

    Raises
    ------
    PlotError
        Also if that process ended without an answer.
    """

    @wraps(reader)
    def read(*args: P.args, **named: P.kwargs) -> T:
        if _NAMED in os.environ:
            return reader(*args, **named)
        done, value = _answer(
            _seconds(args[0], options), (reader.__module__, reader.__qualname__), args, named
        )
        if not done:
            raise value
        found: T = value
        return found

    return read


def _answer(seconds: int, reader: tuple[str, str], args: Any, named: Any) -> tuple[bool, Any]:
    """Whether it was read, and what was; else the exception."""
    places = [str(Path(fcm.__file__).parents[1]), *filter(None, sys.path)]
    given = {"PYTHONPATH": os.pathsep.join(places), "OPENBLAS_NUM_THREADS": "1", _NAMED: "1"}
    with subprocess.Popen(
        [sys.executable, "-P", "-c", _CODE],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,  # where the C library says that its memory is damaged
        env=os.environ | given,
    ) as process:
        try:
            asked = pickle.dumps((seconds, *reader, args, named), protocol=5)
            assert process.stdin is not None
            with suppress(BrokenPipeError), process.stdin:
                process.stdin.write(asked)
            process.stdin = None
            import matplotlib.figure  # noqa: F401  # meanwhile

            answer, _ = process.communicate()
        except BaseException:
            process.kill()
            raise
    try:
        found: tuple[bool, Any] = pickle.loads(answer)
    except (EOFError, pickle.UnpicklingError):
        raise PlotError(f"{args[0]}: damaged: what it says of itself does not fit together") from None
    return found


def child() -> None:
    """Read a file and write what was read to standard output, in a process that may die of it."""
    faulthandler.disable()
    seconds, module, name, args, named = pickle.loads(sys.stdin.buffer.read())
    _limit_time(seconds)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of numbers that are none, which are said of the file
            answer = pickle.dumps((True, getattr(import_module(module), name)(*args, **named)), protocol=5)
    except Exception as error:
        if not isinstance(error, PlotError | OSError | MemoryError):
            error.add_note("".join(traceback.format_exception(error)))
        answer = pickle.dumps((False, error), protocol=5)
    sys.stdout.buffer.write(answer)
    sys.stdout.buffer.flush()
    os._exit(0)  # the memory of a damaged library is not tidied up


def _seconds(path: Any, options: ReadOptions) -> int:
    """Processor time in which a file has to be read."""
    size = Path(path).stat().st_size if Path(path).is_file() else 0
    return math.ceil(options.seconds + options.seconds_of_megabyte * size / 1e6)


def _limit_time(seconds: int) -> None:
    """End this process after so much processor time; where the system has no such limit, never."""
    with suppress(ImportError):
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, hard))
