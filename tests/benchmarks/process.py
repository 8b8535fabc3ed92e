"""What whole commands cost beside the import of their libraries: python -m tests.benchmarks.process [RUNS]

Processor time of a process from its beginning to its end, system included; least of some runs in turn, and as
a multiple of the first row's. The aim for ``fcm respond yang1998`` is 1.2.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.oscillator import oscillator

RUNS = 10
TINY = oscillator("[response]\nfrequency = [0.7, 1.7]\n")
PROGRAM = ("-c", "from fcm.cli.__main__ import run; run()")  # as the installed script does
COMMANDS = {
    "import numpy, scipy.linalg, netCDF4": ("-c", "import numpy, scipy.linalg, netCDF4"),
    "import numpy, netCDF4": ("-c", "import numpy, netCDF4"),
    "fcm respond yang1998 -o yang1998.nc": (*PROGRAM, "respond", "yang1998", "-o", "yang1998.nc"),
    "fcm respond yang1998": (*PROGRAM, "respond", "yang1998"),
    "fcm respond tiny.toml": (*PROGRAM, "respond", "tiny.toml"),
    "fcm plot response yang1998.nc -o picture.png": (
        *(*PROGRAM, "plot", "response", "yang1998.nc"),
        *("-o", "picture.png"),
    ),
    "fcm --help": (*PROGRAM, "--help"),
}


def used(arguments: tuple[str, ...], folder: Path) -> resource.struct_rusage:
    """What a Python with these arguments took, run to its end."""
    process = subprocess.Popen(
        [sys.executable, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, found = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"process: {' '.join(arguments)} ended with {process.returncode}")
    return found


def seconds(found: resource.struct_rusage) -> float:
    """Processor time, system included."""
    return found.ru_utime + found.ru_stime


def main(runs: int) -> None:
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "tiny.toml").write_text(TINY)
        for _ in range(runs):
            for name, arguments in COMMANDS.items():
                times[name].append(seconds(used(arguments, Path(folder))))
    least = {name: min(taken) for name, taken in times.items()}
    print(f"\nwhole processes, least of {runs}\n{'':48s}{'ms':>12s}{'times the first':>18s}")
    for name, taken in least.items():
        print(f"  {name:46s}{1e3 * taken:12.0f}{taken / next(iter(least.values())):18.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else RUNS)
