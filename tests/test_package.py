"""A wheel built without a C compiler holds all that the program needs."""

import os
import shutil
import zipfile
from pathlib import Path

import pytest

from .program import python

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """The names in a wheel built from a copy, as a clean clone would give it."""
    folder = tmp_path_factory.mktemp("package")
    unwanted = shutil.ignore_patterns("__pycache__", "*.egg-info", "*.so", "*.pyd")
    for name in ("src", "tables"):
        shutil.copytree(ROOT / name, folder / name, symlinks=True, ignore=unwanted)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, folder)
    pip = ["-m", "pip", "--disable-pip-version-check", "wheel", "--quiet", "--no-deps"]
    env = {**os.environ, "PIP_ROOT_USER_ACTION": "ignore", "CC": "false"}
    done = python(*pip, "--no-build-isolation", "--wheel-dir", "made", ".", cwd=folder, env=env)
    assert done.code == 0, done.out + done.err
    (made,) = (folder / "made").iterdir()
    with zipfile.ZipFile(made) as archive:
        return {info.filename: info.file_size for info in archive.infolist()}


def test_the_tables_and_scenes_are_in_it(wheel):
    data = {"tables": ROOT / "tables", "scenes": ROOT / "src/fcm/scenes"}
    held = [(name, path) for name, folder in data.items() for path in folder.rglob("*") if path.is_file()]
    assert len(held) >= 3
    for name, path in held:
        assert wheel[f"fcm/{name}/{path.relative_to(data[name])}"] == path.stat().st_size


def test_every_module_is_in_it(wheel):
    sources = (path for suffix in ("py", "pxd") for path in (ROOT / "src/fcm").rglob(f"*.{suffix}"))
    modules = {str(path.relative_to(ROOT / "src")) for path in sources}
    assert not [name for name in wheel if name.endswith(".so")]
    assert modules <= set(wheel) and "fcm/py.typed" in wheel
    assert not [name for name in wheel if name.startswith("tests")]
