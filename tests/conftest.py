"""What is tested are the kernels as they are in the sources: all compiled since the last change, or none."""

import tomllib
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from .program import Program, called
from .scale import SCALE

ROOT = Path(__file__).parents[1]

# The same examples every time, and new ones where more of them are asked for.
settings.register_profile("fcm", derandomize=SCALE <= 1.0)
settings.load_profile("fcm")


def kernels() -> list[str]:
    """The modules that pyproject.toml lists to be compiled."""
    listed = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["ext-modules"]
    return [kernel["name"] for kernel in listed]


def compiled() -> bool:
    """Whether the kernels run as machine code; ends the session if some do and some do not."""
    # imported here, before doctests are collected: pytest would load their sources beside the compiled ones
    files = [Path(import_module(name).__file__) for name in kernels()]
    machine = [file for file in files if file.suffix != ".py"]
    own = [file for file in machine if ROOT / "src" in file.parents]
    stale = [file for file in own if _older(file, file.name.split(".")[0])]
    if stale or len(machine) not in (0, len(files)):
        pytest.exit(
            f"the compiled kernels are not those of the sources ({stale or machine}): make kernels", 3
        )
    return bool(machine)


def _older(file: Path, kernel: str) -> bool:
    sources = [file.with_name(f"{kernel}{suffix}") for suffix in (".py", ".pxd")]
    return file.stat().st_mtime < max(source.stat().st_mtime for source in sources if source.exists())


@pytest.fixture(autouse=True)
def print_options():
    """Those of numpy stay as they were: pyyeti sets others when it is imported."""
    with np.printoptions():
        yield


@pytest.fixture
def fcm(tmp_path, monkeypatch):
    """``fcm("respond", ...)``, called here in a folder of its own: exit code, standard output and error."""
    monkeypatch.chdir(tmp_path)
    return called


@pytest.fixture
def program(tmp_path):
    """Processes of the program in a folder of its own."""
    one = Program(tmp_path)
    yield one
    one.close()


def pytest_configure(config):
    config.stash["compiled"] = compiled()


def pytest_report_header(config):
    return "kernels: " + ("compiled" if config.stash["compiled"] else "run as Python")
