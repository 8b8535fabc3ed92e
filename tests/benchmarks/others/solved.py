"""What both comparisons with other packages share: problems in, one result a curve out, a limit of time."""

from __future__ import annotations

import contextlib
import json
import platform
import signal
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

SAMPLES = (64, 256, 1024, 4096, 16384)  # of a cycle
OF_RANDOM = 256  # samples for the random scenes
PER_PEAK = 40.0  # the longest step is the greatest displacement divided by this
ANGLES = 4096  # at which the displacement of a point is looked at for its amplitude
AROUND = 2  # points on each side of the highest that the polynomial for the peak goes through

Problem = dict[str, Any]


@dataclass
class Solved:
    """One curve: unknowns of each point (mean, cosines, sines, ... of every mode), frequencies, its end."""

    unknowns: Any  # (point, unknown): of the mean all modes, then of cos, sin of the first harmonic, ...
    omega: Any  # (point,)
    state: str = ""  # why it ended early


@dataclass
class Result:
    """What is kept of a curve."""

    name: str
    harmonics: int
    samples: int
    points: int
    seconds: float  # of processor time
    peak: float | None
    folds: int
    state: str


class OutOfTimeError(Exception):
    """A curve took longer than its limit."""


@contextlib.contextmanager
def limited(seconds: float) -> Iterator[None]:
    """Ends what is inside after so much processor time."""

    def stop(*_: object) -> None:
        raise OutOfTimeError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)


def unknowns_to_amplitude(problem: Problem, unknowns: Any) -> Any:
    """Half the peak-to-peak displacement of the output at each point."""
    parts = unknowns.reshape(len(unknowns), -1, len(problem["natural"])) @ np.array(problem["output"])
    theta = np.linspace(0.0, 2.0 * np.pi, ANGLES, endpoint=False)
    harmonics = np.arange(1, (parts.shape[1] - 1) // 2 + 1)[:, None] * theta
    x = parts[:, 1::2] @ np.cos(harmonics) + parts[:, 2::2] @ np.sin(harmonics)
    return 0.5 * np.ptp(x, axis=1)


def summit(omega: Any, amplitude: Any) -> float:
    """The greatest value of a polynomial through the highest point and those around.

    In the frequency, or where the curve turns there in the length along it.

    >>> at = np.linspace(-3.0, 3.03, 60)
    >>> abs(summit(at, 1.0 / (1.0 + at**2)) - 1.0) < 1e-5
    True
    """
    top = int(amplitude.argmax())
    near = slice(max(top - AROUND, 0), top + AROUND + 1)
    along = omega[near]
    if not np.all(np.diff(along) > 0.0):
        w, a = omega[near] / np.ptp(omega), amplitude[near] / np.ptp(amplitude)
        along = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(w), np.diff(a)))))
    here = int(np.argmax(amplitude[near]))
    if not 0 < here < along.size - 1 or not np.all(np.diff(along) > 0.0):
        return float(amplitude[top])
    fitted = np.polynomial.Polynomial.fit(along, amplitude[near], along.size - 1)
    return float(fitted(np.linspace(along[here - 1], along[here + 1], 2001)).max())


def result(problem: Problem, samples: int, limit: float, solve: Callable[[], Solved]) -> Result:
    """One curve under a limit of time, and what is kept of it."""
    begin = time.process_time()
    found = solve()
    seconds = time.process_time() - begin
    omega, state = found.omega, found.state
    if not state and (omega.size == 0 or omega[-1] < 0.99 * problem["range"][1]):
        state = f"ended at {omega[-1]:.4f} rad/s" if omega.size else "no point"
    peak = summit(omega, unknowns_to_amplitude(problem, found.unknowns)) if omega.size > 1 else None
    turns = int(np.count_nonzero(np.diff(np.sign(np.diff(omega))) != 0.0))
    return Result(problem["name"], problem["harmonics"], samples, omega.size, seconds, peak, turns, state)


def run(versions: str, curve: Callable[[Problem, int, float], Result]) -> None:
    """All problems of a file by a package, to another file: ``with_PACKAGE.py PROBLEMS RESULTS LIMIT``.

    A number of samples whose first curve takes longer than the limit is not tried on the others.
    """
    problems, output, limit = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2]), float(sys.argv[3])
    found: list[Result] = []
    for problem in problems["problems"]:
        for samples in SAMPLES if problem["group"] == "preloads" else (OF_RANDOM,):
            sizes = (problem["harmonics"], samples)
            stopped = any((r.harmonics, r.samples) == sizes and r.state.startswith("stopped") for r in found)
            if problem["group"] == "preloads" and stopped:
                continue
            found.append(curve(problem, samples, limit))
            print(f"\r{len(found)} curves", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    text = {
        "versions": f"{versions}, Python {platform.python_version()}, numpy {np.__version__}",
        "limit": limit,
        "results": [asdict(one) for one in found],
    }
    output.write_text(json.dumps(text), encoding="utf-8")
