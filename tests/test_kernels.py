"""The kernels: which modules they are, what a run says when they are not compiled, threads."""

import tomllib
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import fcm

from .program import AS_A_MODULE, python

SOURCES = Path(__file__).parents[1] / "src"
LISTED = tomllib.loads((SOURCES.parent / "pyproject.toml").read_text())["tool"]["setuptools"]["ext-modules"]


def warnings(*arguments):
    """How often a run says that kernels are not compiled."""
    done = python(*arguments)
    assert done.code == 0, done.err
    return done.err.count("the kernels of fcm run as Python")


def test_every_kernel_is_listed_to_be_compiled():
    """All that have declarations, and each under its own name."""
    declared = {path.relative_to(SOURCES).with_suffix(".py") for path in SOURCES.rglob("*.pxd")}
    assert declared <= {Path(kernel["name"].replace(".", "/") + ".py") for kernel in LISTED}
    assert all(kernel["sources"] == [f"src/{kernel['name'].replace('.', '/')}.py"] for kernel in LISTED)


@pytest.mark.slow
def test_a_run_says_once_that_kernels_are_not_compiled(tmp_path):
    compiled = not import_module("fcm.contact.closed_form").__file__.endswith(".py")
    expected = 0 if compiled else 1
    assert warnings("-c", "import fcm.table, fcm.contact.closed_form, fcm.contact.loop") == expected
    assert warnings(*AS_A_MODULE, "respond", "yang1998", "-o", tmp_path / "curves.nc") == expected
    assert warnings(*AS_A_MODULE, "--help") == warnings("-c", "import fcm") == 0


def test_threads_have_motions_of_their_own():
    rng = np.random.default_rng(1)
    u, v = rng.standard_normal((2, 8, 200, 5)) + 0j
    arguments = (0.4, 1.0, 2.0, 1.0)
    with ThreadPoolExecutor(4) as threads:
        together = list(threads.map(lambda i: fcm.periodic_forces(u[i], v[i], *arguments), range(8)))
    for i, both in enumerate(together):
        assert np.array_equal(both, fcm.periodic_forces(u[i], v[i], *arguments))


@pytest.mark.parametrize("law", [fcm.fourier_gradients, fcm.open_table().gradients])
def test_threads_do_not_disturb_one_another(law):
    points = np.random.default_rng(0).uniform(0.0, 2.0, (8, 3, 2000))
    with ThreadPoolExecutor(4) as threads:
        together = list(threads.map(lambda x: law(*x), points))
    for (F, dF), x in zip(together, points, strict=True):
        alone = law(*x)
        assert np.array_equal(F, alone[0]) and np.array_equal(dF, alone[1])
