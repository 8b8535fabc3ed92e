"""The packages import one another in their order: each those above it, none below."""

import ast
import re
import sys
from functools import cache
from pathlib import Path

import pytest

from .layers import PACKAGES

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / "src/fcm"
NUMERICS = (
    "contact",
    "model",
    "structure",
    "continuation",
    "harmonic_balance",
    "nonlinear_modes",
    "sensitivity",
    "stability",
    "branches",
    "accuracy",
    "tracking",
    "fit",
    "time_domain",
    "shooting",
    "reduction",
)


@cache
def imported(package):
    """Pairs of a file of a package and a module that it imports, wherever in it that stands."""
    found = set()
    for path in (SOURCES / package).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found |= {(path.name, alias.name) for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                assert not node.level, f"{path} imports relatively"
                found.add((path.name, node.module.removeprefix("cython.cimports.")))
    for path in (SOURCES / package).rglob("*.pxd"):
        text = path.read_text(encoding="utf-8")
        found |= {(path.name, module) for module in re.findall(r"^from (\S+) cimport", text, re.M)}
    return found


def test_every_package_has_its_place():
    there = [path.parent.name for path in SOURCES.glob("*/__init__.py")]
    assert len(there) > 15 and sorted(PACKAGES) == sorted(there)


@pytest.mark.parametrize("package", PACKAGES)
def test_nothing_below_is_imported(package):
    allowed = PACKAGES[: PACKAGES.index(package) + 1]
    for file, module in sorted(imported(package)):
        top, *parts = module.split(".")
        if top == "fcm" and parts and parts[0] in PACKAGES and parts[0] not in allowed:
            pytest.fail(f"{package}/{file} imports {module}")


def test_continuation_knows_nothing_of_contacts():
    own = {module.split(".")[1] for _, module in imported("continuation") if module.startswith("fcm.")}
    assert own == {"continuation", "frozen", "cubic", "distinct_values"}


@pytest.mark.parametrize("package", NUMERICS)
def test_numerics_import_numpy_and_scipy_alone(package):
    outside = {module.split(".")[0] for _, module in imported(package)} - set(sys.stdlib_module_names)
    # sparse matrices of structures: factors where sksparse is installed, the order of unknowns by pymetis
    sparse = {"sksparse", "pymetis"} if package == "structure" else set()
    assert outside <= {"fcm", "numpy", "scipy", "cython", "libc", "cpython"} | sparse


def test_processes_are_started_by_one_helper():
    """And by the programs that measure, which are no tests."""
    tests = [path for path in (ROOT / "tests").rglob("*.py") if "benchmarks" not in path.parts]
    starts = re.compile(r"subprocess\.(run|Popen|call|check_\w+)|os\.(system|popen|spawn\w+)")
    found = {path.name for path in tests if starts.search(path.read_text(encoding="utf-8"))}
    assert len(tests) > 100 and found == {"program.py"}


def test_nothing_else_lies_at_the_top():
    """What was left there by a measurement once was taken for a part of the project."""
    there = {path.name for path in ROOT.iterdir() if not path.name.startswith(".")}
    made = {"build", "dist", "PKG-INFO", "setup.cfg"}  # which git ignores, or a source distribution adds
    assert there - made == {"LICENSE", "Makefile", "README.md", "pyproject.toml", "src", "tables", "tests"}
