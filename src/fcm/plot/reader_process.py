"""Read files of results in a separate process, because the HDF5 library can crash on a damaged file.

Whatever happens to the reader process, its caller gets the data or `PlotError`. Meanwhile the caller imports
matplotlib, so that a picture takes no longer.
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
    """Run a function that reads a file, its first argument, in a separate process.

    The options limit its processor time. Arguments, return value and exceptions are pickled.

    Raises
    ------
    PlotError
        Also if the process ended without an answer.
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
    """Whether the file was read, with the data, or else the exception."""
    places = [str(Path(fcm.__file__).parents[1]), *filter(None, sys.path)]
    given = {"PYTHONPATH": os.pathsep.join(places), "OPENBLAS_NUM_THREADS": "1", _NAMED: "1"}
    with subprocess.Popen(
        [sys.executable, "-P", "-c", _CODE],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,  # the C library reports damaged memory there
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
    """Read a file and write the pickled data to standard output; the process may die while it reads."""
    faulthandler.disable()
    seconds, module, name, args, named = pickle.loads(sys.stdin.buffer.read())
    _limit_time(seconds)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of invalid numbers, which are reported for the file
            answer = pickle.dumps((True, getattr(import_module(module), name)(*args, **named)), protocol=5)
    except Exception as error:
        if not isinstance(error, PlotError | OSError | MemoryError):
            error.add_note("".join(traceback.format_exception(error)))
        answer = pickle.dumps((False, error), protocol=5)
    sys.stdout.buffer.write(answer)
    sys.stdout.buffer.flush()
    os._exit(0)  # without cleaning up the library's possibly damaged memory


def _seconds(path: Any, options: ReadOptions) -> int:
    """Processor time in which a file has to be read."""
    size = Path(path).stat().st_size if Path(path).is_file() else 0
    return math.ceil(options.seconds + options.seconds_of_megabyte * size / 1e6)


def _limit_time(seconds: int) -> None:
    """Limit the processor time of this process, if the system has such a limit."""
    with suppress(ImportError):
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, hard))
