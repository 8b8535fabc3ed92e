"""A wheel without compiled kernels holds all that the program needs, an sdist all that tests do."""

import os
import shutil
import tarfile
import zipfile
from pathlib import Path

import pytest

from .program import python

ROOT = Path(__file__).parents[1]
TOP = ("pyproject.toml", "README.md", "LICENSE", "Makefile")
FOLDERS = ("src", "tables", "tests", ".ci", ".github")
MADE = shutil.ignore_patterns("__pycache__", "*.egg-info", "*.so", "*.pyd")


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    """A copy, as a clean clone would give it, and a call of the build backend in it, without a C compiler."""
    folder = tmp_path_factory.mktemp("package")
    for name in FOLDERS:
        shutil.copytree(ROOT / name, folder / name, symlinks=True, ignore=MADE)
    for name in TOP:
        shutil.copy(ROOT / name, folder)

    def build(what):
        code = f"import setuptools.build_meta as backend; backend.build_{what}({str(folder / what)!r})"
        (folder / what).mkdir()
        done = python("-c", code, cwd=folder, env={**os.environ, "CC": "false"})
        assert done.code == 0, done.out + done.err
        (made,) = (folder / what).iterdir()
        return made

    return build


@pytest.fixture(scope="module")
def wheel(clean):
    return clean("wheel")


@pytest.fixture(scope="module")
def held(wheel):
    """The names and sizes in it."""
    with zipfile.ZipFile(wheel) as archive:
        return {info.filename: info.file_size for info in archive.infolist()}


@pytest.mark.slow
def test_the_tables_and_scenes_are_in_it(held):
    data = {"tables": ROOT / "tables", "scenes": ROOT / "src/fcm/scenes"}
    files = [(name, path) for name, folder in data.items() for path in folder.rglob("*") if path.is_file()]
    assert len(files) >= 3
    for name, path in files:
        assert held[f"fcm/{name}/{path.relative_to(data[name])}"] == path.stat().st_size


def test_every_module_is_in_it(held):
    sources = (path for suffix in ("py", "pxd") for path in (ROOT / "src/fcm").rglob(f"*.{suffix}"))
    modules = {str(path.relative_to(ROOT / "src")) for path in sources}
    assert not [name for name in held if name.endswith(".so")]
    assert modules <= set(held) and "fcm/py.typed" in held
    assert not [name for name in held if name.startswith("tests")]


@pytest.mark.slow
def test_it_is_tagged_for_every_machine_and_says_once_that_it_is_slow(wheel, tmp_path):
    assert wheel.name.endswith("-py3-none-any.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "installed")
        (meta,) = (name for name in archive.namelist() if name.endswith(".dist-info/WHEEL"))
        assert "Root-Is-Purelib: true\nTag: py3-none-any\n" in archive.read(meta).decode()
    env = {**os.environ, "PYTHONPATH": str(tmp_path / "installed")}
    for args in (("plot", "loop", "-o", "loop.png"), ("respond", "yang1998-n5", "--max-step", "0.5")):
        done = python("-m", "fcm", *args, cwd=tmp_path, env=env)
        assert done.code == 0 and done.err.count("kernels of fcm run as Python, slowly") == 1, done.err


@pytest.mark.slow
def test_a_source_distribution_holds_what_the_tests_read(clean):
    with tarfile.open(clean("sdist")) as archive:
        names = {one.name.partition("/")[2]: one for one in archive.getmembers()}
    assert names["tables"].linkname == "src/fcm/tables"
    assert {f"src/fcm/tables/{path.name}" for path in (ROOT / "tables").iterdir()} <= set(names)
    for folder in set(FOLDERS) - {"tables"}:
        for path in (ROOT / folder).rglob("*"):
            there = path.relative_to(ROOT)
            if path.is_file() and not MADE(str(path.parent), there.parts):
                assert str(there) in names, there
    assert {*TOP} <= set(names)
