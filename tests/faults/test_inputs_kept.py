"""A file that is read is never written over, by whatever name; and no two runs write the same file."""

import os
import signal
import time

import pytest

from fcm.cli.terminal import plain

from .conftest import ONE

MATRICES = """
[structure]
dofs = "names.txt"
mass = "M.mtx"
stiffness = "K.mtx"
damping = 0.02
[[contact]]
name = "c"
tangential = "u"
normal = "v"
mu = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [0.7, 1.7]
"""
MTX = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 {}\n2 2 {}\n"
FILES = {
    "scene.csv": ONE,
    "scene.nc": ONE,
    "matrices.toml": MATRICES,
    "names.txt": "u\nv\n",
    "M.mtx": MTX.format(1.0, 1.0),
    "K.mtx": MTX.format(1.0, 2.0),
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with files of every kind that is read."""
    from ..program import Program

    program = Program(tmp_path_factory.mktemp("inputs"))
    for name, text in FILES.items():
        program.write(name, text)
    assert program("respond", "scene.nc", "-o", "result.nc").returncode == 0
    for ending in (".png", ".pdf", ".svg"):  # a result under the name of a picture
        (program.folder / f"result{ending}").write_bytes((program.folder / "result.nc").read_bytes())
    assert (
        program("respond", "scene.nc", "--method", "exact", "--at", "1.2", "-o", "exact.nc").returncode == 0
    )
    (program.folder / "exact.png").write_bytes((program.folder / "exact.nc").read_bytes())
    assert program("tabulate", "--nodes", 8, 8, 8, 8, "--points", 10000, "-o", "table.nc").returncode == 0
    (program.folder / "table.png").write_bytes((program.folder / "table.nc").read_bytes())
    for name, other in (("M.nc", "M.mtx"), ("K.csv", "K.mtx"), ("t.csv", "table.nc"), ("chain.nc", "t.csv")):
        (program.folder / name).symlink_to(other)
    (program.folder / "hard.nc").hardlink_to(program.folder / "names.txt")
    yield program
    program.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    "args",
    [
        ("respond", "scene.nc", "--table", "table.nc", "-o", "table.nc"),
        ("respond", "scene.nc", "--table", "table.nc", "-o", "./table.nc"),
        ("respond", "scene.nc", "--table", "table.nc", "-o", "chain.nc"),
        ("respond", "scene.nc", "--table", "table.nc", "--csv", "t.csv"),
        ("respond", "scene.csv", "--csv", "scene.csv"),
        ("respond", "scene.nc", "-o", "scene.nc"),
        ("respond", "scene.nc", "--compare", "-o", "scene.nc"),
        ("respond", "matrices.toml", "-o", "M.nc"),
        ("respond", "matrices.toml", "--csv", "K.csv"),
        ("respond", "matrices.toml", "-o", "hard.nc"),
        ("respond", "matrices.toml", "--level", "0.1:1", "--at", "1.2", "-o", "M.nc"),
        ("tabulate", "--for", "matrices.toml", "-o", "M.nc"),
        ("tabulate", "--for", "scene.nc", "-o", "scene.nc"),
        ("plot", "response", "result.nc", "--points", "exact.png", "-o", "exact.png"),
        ("plot", "response", "result.svg", "-o", "result.svg"),
        ("plot", "loop", "result.pdf", "-o", "result.pdf"),
        ("plot", "peak", "result.pdf", "-o", "result.pdf"),
        ("plot", "sensitivity", "result.pdf", "-o", "result.pdf"),
        ("plot", "mode", "result.pdf", "-o", "result.pdf"),
        ("plot", "history", "result.pdf", "-o", "result.pdf"),
        ("plot", "accuracy", "result.pdf", "-o", "result.pdf"),
        ("plot", "surface", "--table", "table.png", "-o", "table.png"),
        ("plot", "error", "--table", "table.png", "-o", "table.png"),
    ],
)
def test_a_file_that_is_read_is_not_written(made, args):
    folder = made.folder
    before = {path.name: (path.is_symlink(), path.read_bytes()) for path in folder.iterdir()}
    done = made(*args)
    assert done.returncode == 2 and "would overwrite" in done.err and "is read" in done.err
    assert {path.name: (path.is_symlink(), path.read_bytes()) for path in folder.iterdir()} == before


SLOW = "import fcm.cli.respond as module\nimport time\nmodule.calculated = lambda *_: time.sleep(60)\n"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("first", "second"),
    [
        (("--csv", "x.csv"), ("-o", "b.nc", "--csv", "x.csv")),
        (("-o", "a.nc", "--csv", "x.csv"), ("-o", "b.nc", "--csv", "x.csv")),
        (("-o", "a.nc", "--csv", "x.csv"), ("--csv", "x.csv")),
        (("-o", "a.nc"), ("-o", "link.nc")),
    ],
)
def test_two_runs_do_not_write_the_same_file(program, first, second):
    program.write("scene.toml", ONE)
    (program.folder / "link.nc").symlink_to("a.nc")
    run = program.start("respond", "scene.toml", *first, before=SLOW)
    program.until(lambda: any(path.suffix == ".unfinished" for path in program.folder.iterdir()), 20.0)
    time.sleep(0.1)
    done = program("respond", "scene.toml", *second)
    assert done.returncode == 2 and f"process {run.pid}" in plain(done.err) and "is at work on it" in done.err
    os.kill(run.pid, signal.SIGTERM)
    run.communicate(timeout=20)
    assert not [path for path in program.folder.iterdir() if path.suffix in (".unfinished", ".csv")]
    assert program("respond", "scene.toml", *second).returncode == 0
