"""Measure the time a program takes before it solves anything: interpreter, imports, table."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from fcm.compare.options import COMPARE, StartupOptions

_IMPORTS = {"exact": "import fcm.scene, fcm.response.exact"}
_PROGRAM = """
import time
{imports}
begin = time.perf_counter()
{opening}
print(time.perf_counter() - begin)
"""


class Startup(NamedTuple):
    """Times [s]; not a number where they could not be measured."""

    total: float  # from the start of the interpreter to its end
    table: float  # part of `total` to open the table


UNKNOWN = Startup(float("nan"), float("nan"))


def startup(method: str, table: Path | None, options: StartupOptions = COMPARE.startup) -> Startup:
    """Least times of some programs that start up for this method, and then end."""
    imports = _IMPORTS.get(method, "import fcm.scene, fcm.response")
    opening = f"import fcm; fcm.open_table({str(table)!r})" if table else "pass"
    program = _PROGRAM.format(imports=imports, opening=opening)
    tries = (_one(program, options.timeout) for _ in range(options.repeats))
    return min((one for one in tries if one is not None), default=UNKNOWN)


def _one(program: str, timeout: float) -> Startup | None:
    begin = time.perf_counter()
    try:
        done = subprocess.run(
            [sys.executable, "-c", program], capture_output=True, text=True, timeout=timeout, check=True
        )
        return Startup(time.perf_counter() - begin, float(done.stdout))
    except (subprocess.SubprocessError, OSError, ValueError):
        return None
