"""Files of results damaged in many ways, each drawn or refused in one sentence; run by hand.

usage: python -m tests.faults.damage [KIND ...] [--each N] [--seed N]

Of each kind of picture the file of a run is taken apart and written anew with a variable left out, of another
type or shape, with numbers that are no results, with other attributes; or its bytes are changed, set to zero
or cut off. "resume" is unfinished work that a sweep goes on from, damaged or forged. Every case runs in a
process of its own, with a limit on its time and its memory. A process that the library ends by damaged bytes
is no fault: there the program reads by a process of its own.
"""

from __future__ import annotations

import io
import json
import os
import pickle
import random
import resource
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np

SECONDS, MEMORY = 20, 3 << 30  # of processor time, and bytes, for one case
NUMBERS = (1e300, -1e300, 1e99, -1e99, 1e-300, 5e-324, 0.0, -1.0, 1e20, np.inf, -np.inf, np.nan)
WORDS = ("", "Hz", "rad/s", "$x_{$", "swept value", "true", "[1]", "{}", "EP" * 50, "a\nb", "é€", "nan")

SWEPT = (
    "[response]\nfrequency = [0.7, 1.7]\nmax_step = 0.5\nharmonics = 1\n"
    '[sweep]\n"contact.shroud.n_0" = [5.0, 2.0]\n'
)
RANGE = "[response]\nfrequency = [0.7, 1.7]\nharmonics = 1\n"
OPTIMUM = '[optimum]\nvary = ["contact.shroud.n_0"]\nbounds = [[2.0, 20.0]]\nminimise = "peak.u"\n'
FIT = '[fit]\nvary = ["modal.damping.0"]\n[[fit.data]]\nfile = "data.csv"\ndof = "u"\n'
MEASURED = "frequency,amplitude\n0.8,1.3\n0.9,2.3\n1.0,7.5\n1.1,8.1\n1.2,6.2\n1.3,2.5\n1.4,1.3\n"
SCHEDULE = "[[schedule]]\nfrequency = 1.1\ncycles = 4\n[[schedule]]\nfrequency = 1.2\ncycles = 4\n"
MODEL = """[modal]
dofs = ["u", "v"]
frequency = [1.0, 10.0]
damping = [0.01, 0.01]
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


@dataclass
class Content:
    """What a netCDF file holds."""

    sizes: dict[str, int] = field(default_factory=dict)
    attributes: dict[str, Any] = field(default_factory=dict)
    variables: dict[str, tuple[Any, tuple[str, ...], Any, dict[str, Any]]] = field(default_factory=dict)

    @staticmethod
    def of(path: Path) -> Content:
        with netCDF4.Dataset(path) as data:
            data.set_auto_mask(False)
            return Content(
                {name: one.size for name, one in data.dimensions.items()},
                {key: data.getncattr(key) for key in data.ncattrs()},
                {
                    name: (
                        one.dtype,
                        one.dimensions,
                        np.array(one[...]),
                        {key: one.getncattr(key) for key in one.ncattrs() if key != "_FillValue"},
                    )
                    for name, one in data.variables.items()
                },
            )

    def write(self, path: Path) -> None:
        path.unlink(missing_ok=True)
        with netCDF4.Dataset(path, "w", format="NETCDF4") as data:
            for name, size in self.sizes.items():
                data.createDimension(name, size)
            for name, (kind, dimensions, values, described) in self.variables.items():
                one = data.createVariable(name, kind, dimensions)
                one.setncatts(described)
                if values.size:
                    one[...] = values
            data.setncatts(self.attributes)


def _drop(rng: random.Random, content: Content, name: str) -> None:
    del content.variables[name]


def _number(rng: random.Random, content: Content, name: str) -> None:
    kind, dimensions, values, described = content.variables[name]
    if values.dtype.kind == "f" and values.size:
        values = values.copy()
        where = rng.random()
        many = values.size if where < 0.2 else 1 if where < 0.7 else max(1, values.size // 3)
        for place in rng.sample(range(values.size), many):
            values.flat[place] = rng.choice(NUMBERS)
        if where > 0.9:
            values[...] = rng.choice(NUMBERS)
    elif values.dtype.kind in "iu":
        values = (values.astype(np.int64) + rng.choice((-(10**5), -1, 1, 10**5))).astype(kind)
    elif values.size:
        values = values.copy()
        values.flat[rng.randrange(values.size)] = rng.choice(WORDS)
    content.variables[name] = kind, dimensions, values, described


def _kind(rng: random.Random, content: Content, name: str) -> None:
    kind, dimensions, values, described = content.variables[name]
    if kind is str or values.dtype.kind in "OUS":
        other: Any = rng.choice(("f8", "i4"))
        values = np.arange(values.size, dtype=other).reshape(values.shape)
    else:
        other = rng.choice(("i4", "i1", "u8", "f4", str))
        with np.errstate(all="ignore"):
            values = (
                values.astype("U8").astype(object) if other is str else np.nan_to_num(values).astype(other)
            )
    content.variables[name] = other, dimensions, values, described


def _shape(rng: random.Random, content: Content, name: str) -> None:
    kind, dimensions, values, described = content.variables[name]
    way = rng.randrange(3)
    if way == 0 and len(dimensions) > 1:
        order = list(range(len(dimensions)))
        rng.shuffle(order)
        content.variables[name] = (
            kind,
            tuple(dimensions[i] for i in order),
            values.transpose(order),
            described,
        )
    elif way == 1 and dimensions and values.shape[0]:
        content.variables[name] = kind, dimensions[1:], np.asarray(values[0]), described
    else:
        content.sizes["other"] = 3
        content.variables[name] = kind, (*dimensions, "other"), np.stack([values] * 3, axis=-1), described


def _size(rng: random.Random, content: Content, name: str) -> None:
    """A dimension shorter, or empty, in everything that has it."""
    chosen = rng.choice(list(content.sizes))
    size = rng.choice((0, 1, max(0, content.sizes[chosen] - 1)))
    size = min(size, content.sizes[chosen])
    if not size:
        return
    content.sizes[chosen] = size
    for one, (kind, dimensions, values, described) in content.variables.items():
        for axis, dimension in enumerate(dimensions):
            if dimension == chosen:
                values = values.take(range(size), axis=axis)
        content.variables[one] = kind, dimensions, values, described


def _attribute(rng: random.Random, content: Content, name: str) -> None:
    held = rng.choice((content.attributes, content.variables[name][3]))
    if not held:
        return
    key = rng.choice(list(held))
    way = rng.randrange(3)
    if way == 0:
        del held[key]
    elif way == 1:
        held[key] = rng.choice((3.5, np.nan, np.arange(3), rng.choice(WORDS)))
    elif isinstance(held[key], str) and held[key]:
        text = list(held[key])
        for _ in range(rng.choice((1, 3))):
            text[rng.randrange(len(text))] = rng.choice('09{}[],":-eN')
        held[key] = "".join(text)


CHANGES: tuple[Callable[[random.Random, Content, str], None], ...] = (
    _drop, _number, _number, _number, _number, _kind, _shape, _size, _attribute, _attribute,
)  # fmt: skip


def changed(rng: random.Random, content: Content, path: Path) -> str:
    """Write what a file holds, with one to three changes; what they are."""
    one = Content(dict(content.sizes), dict(content.attributes), {})
    for name, (kind, dimensions, values, described) in content.variables.items():
        one.variables[name] = kind, dimensions, values, dict(described)
    said = []
    for _ in range(rng.choice((1, 1, 2, 3))):
        change, name = rng.choice(CHANGES), rng.choice(list(one.variables))
        change(rng, one, name)
        said.append(f"{change.__name__} {name}")
    one.write(path)
    return ", ".join(said)


def corrupted(rng: random.Random, whole: bytes, path: Path) -> str:
    """Write the bytes of a file changed, set to zero or cut off."""
    data, way = bytearray(whole), rng.randrange(4)
    if way == 0:
        data = data[: rng.randrange(len(data))]
    elif way == 1:
        begin = rng.randrange(len(data))
        data[begin : begin + 512] = bytes(len(data[begin : begin + 512]))
    else:
        for _ in range(2 ** rng.randrange(10)):
            data[rng.randrange(len(data) if way == 2 else min(4096, len(data)))] = rng.randrange(256)
    path.write_bytes(data)
    return f"bytes {way}"


def forged(rng: random.Random, whole: bytes, path: Path) -> str:
    """Write unfinished work with results that no run had, sealed as if one had."""
    from fcm.run.lock import LENGTH
    from fcm.run.records import Record, packed
    from fcm.run.records import whole as records_of

    path.write_bytes(whole)
    with path.open("r+b") as file:
        records = list(records_of(file.fileno(), len(whole), LENGTH))
    out, said = whole[:LENGTH], []
    for mark, number, payload in records:
        results = pickle.loads(payload)
        if isinstance(results, list) and results and hasattr(results[0], "__dict__"):
            name = rng.choice(
                [key for key, value in vars(results[0]).items() if isinstance(value, np.ndarray)]
            )
            content = Content({}, {}, {name: (None, (), getattr(results[0], name), {})})
            _number(rng, content, name)
            values = content.variables[name][2]
            way = rng.randrange(4)
            values = (values, values[:-1], values.astype("U3"), None)[way] if way else values
            setattr(results[0], name, values)
            said.append(f"{name} {way}")
        out += packed(Record(mark, number, pickle.dumps(results, protocol=5)))
    path.write_bytes(out)
    return f"forged {', '.join(said)}"


def unfinished(name: str, arguments: list[str]) -> None:
    """Write what is kept of a run, as if it had been ended before its file was written."""
    from fcm.run import Checkpoint

    done = Checkpoint.done
    Checkpoint.done = Checkpoint.close  # type: ignore[method-assign]
    code, words = run([*arguments, "-o", name])
    Checkpoint.done = done  # type: ignore[method-assign]
    assert code == 0 and Path(f"{name}.unfinished").exists(), words


def run(arguments: list[str]) -> tuple[int, str]:
    """How the program ends in a process of its own, and its last words."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        os.environ["FCM_READS_APART"] = "1"
        code, words = 99, io.StringIO()
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 2)
        try:
            from fcm.cli import main

            with redirect_stderr(words), redirect_stdout(io.StringIO()):
                main(arguments, prog_name="fcm")
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 98
        except BaseException as error:
            words.write(f"Traceback {error!r}")
        os.write(writing, json.dumps([code, words.getvalue()[-3000:]]).encode())
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as file:
        answer = file.read()
    status = os.waitpid(child, 0)[1]
    if not answer:
        return -os.WTERMSIG(status), f"ended by {signal.Signals(os.WTERMSIG(status)).name}"
    code, words = json.loads(answer)
    return code, words


RESPOND: dict[str, list[str]] = {
    "plain": ["SWEPT"],
    "harmonics": ["MODEL", "--harmonics", "3", "--max-step", "0.5"],
    "exact": ["MODEL", "--method", "exact", "--at", "1.1", "--at", "1.2"],
    "mode": ["MODEL", "--mode", "1", "--level", "0.1:10", "--harmonics", "1"],
    "schedule": ["SCHEDULE", "--harmonics", "1", "--max-step", "0.5"],
    "sensitivity": ["MODEL", "--sensitivity", "--harmonics", "1", "--max-step", "0.5"],
    "compare": ["MODEL", "--compare"],
    "peaks": ["SWEPT", "--peaks-only"],
    "level": ["MODEL", "--level", "0.5:2", "--at", "1.1", "--harmonics", "1"],
    "optimum": ["OPTIMUM"],
    "fit": ["FIT"],
    "track": [
        "MODEL", "--harmonics", "1", "--track", "peaks", "--over", "contact.shroud.n_0",
        "--from", "2", "--to", "5",
    ],
}  # fmt: skip
PICTURES = {  # of each kind: the file that is damaged, and how it is drawn
    "response": ("plain", ["response", "FILE"]),
    "page": ("plain", ["response", "FILE", "-o", "a.html"]),
    "points": ("exact", ["response", "harmonics.nc", "--points", "FILE"]),
    "peak": ("plain", ["peak", "FILE"]),
    "tracked": ("track", ["peak", "FILE"]),
    "level": ("level", ["response", "FILE"]),
    "peaks": ("peaks", ["peak", "FILE"]),
    "optimum": ("optimum", ["response", "FILE"]),
    "fit": ("fit", ["response", "FILE"]),
    "loop": ("harmonics", ["loop", "FILE"]),
    "history": ("schedule", ["history", "FILE"]),
    "mode": ("mode", ["mode", "FILE"]),
    "sensitivity": ("sensitivity", ["sensitivity", "FILE"]),
    "accuracy": ("compare", ["accuracy", "FILE"]),
}


def wrong(code: int, words: str, bytes_changed: bool) -> str:
    """What is wrong with how a run ended; '' where nothing is."""
    if code < 0:
        return "" if bytes_changed else words
    if code not in (0, 2, 3):
        return f"exit code {code}"
    if "Traceback" in words or "defect" in words:
        return "no sentence"
    lines = [line for line in words.splitlines() if not line.startswith(("Usage", "Try", "wrote", "warning"))]
    return "more than a sentence" if code and len([line for line in lines if line.strip()]) > 1 else ""


def main() -> None:
    arguments = sys.argv[1:]
    named = {key: arguments[i + 1] for i, key in enumerate(arguments) if key.startswith("--")}
    kinds = [one for one in arguments if one in (*PICTURES, "resume")] or [*PICTURES, "resume"]
    each, seed = int(named.get("--each", 500)), int(named.get("--seed", 0))
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    import matplotlib.backends.backend_agg  # once, for all
    import matplotlib.figure  # noqa: F401

    from fcm.plot.style import house_style  # noqa: F401

    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("MODEL.toml").write_text(MODEL + "[response]\nfrequency = [0.7, 1.7]\n")
        Path("SWEPT.toml").write_text(MODEL + SWEPT)
        Path("SCHEDULE.toml").write_text(MODEL + "[response]\nfrequency = [0.7, 1.7]\n" + SCHEDULE)
        Path("OPTIMUM.toml").write_text(MODEL + RANGE + OPTIMUM)
        Path("FIT.toml").write_text(MODEL + RANGE + FIT)
        Path("data.csv").write_text(MEASURED)
        for name in sorted({"harmonics", *(PICTURES[kind][0] for kind in kinds if kind in PICTURES)}):
            scene, *options = RESPOND[name]
            code, words = run(["respond", f"{scene}.toml", *options, "-o", f"{name}.nc", "-q"])
            assert code == 0, (name, words)
        sweep = ["respond", "SWEPT.toml", "-q", "--jobs", "1"]
        unfinished("resumed.nc", sweep)
        kept = Path("resumed.nc.unfinished").read_bytes()
        found = 0
        for kind in kinds:
            ends: Counter[int] = Counter()
            for number in range(each):
                rng = random.Random(f"{seed} {kind} {number}")
                path, by_bytes = Path("damaged.nc"), number % 3 == 2
                if kind == "resume":
                    path = Path("resumed.nc.unfinished")
                    what = corrupted(rng, kept, path) if by_bytes else forged(rng, kept, path)
                    command = [*sweep, "-o", "resumed.nc", "--resume"]
                else:
                    name, words_of = PICTURES[kind]
                    whole = Path(f"{name}.nc")
                    what = (
                        corrupted(rng, whole.read_bytes(), path)
                        if by_bytes
                        else changed(rng, Content.of(whole), path)
                    )
                    command = ["plot", *(str(path) if one == "FILE" else one for one in words_of)]
                code, words = run(command)
                ends[code] += 1
                if fault := wrong(code, words, by_bytes and kind != "resume"):
                    found += 1
                    print(f"{kind} {number}: {fault}: {what}: {words.strip()[-400:]}", flush=True)
            print(f"{kind}: {each} files, ends {dict(sorted(ends.items()))}", flush=True)
        print(f"{found} faults")
        sys.exit(bool(found))


if __name__ == "__main__":
    main()
