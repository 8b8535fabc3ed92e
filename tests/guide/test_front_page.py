"""The front page: what it claims of errors is what the program tells, and it is read in minutes."""

import re
import sys
import sysconfig
from pathlib import Path

import fcm
from fcm.compare.exact import exact_lines
from fcm.response import trace

from ..report.convergence import greatest_error
from .pages import README, read


def test_it_is_read_in_minutes():
    assert len(read(README).splitlines()) <= 150


def test_the_table_of_methods_has_the_errors_of_the_methods():
    """Those of `make convergence`, as it computes them."""
    rows = re.findall(r"^\| .*\| `--harmonics (\d+)` \| (\S+) \|", read(README), re.M)
    scene = fcm.load_scene("yang1998-n5")
    peaks = {dof: height for dof, (height, _) in exact_lines(scene)[0].peaks.items()}
    for harmonics, shown in rows:
        (curve,) = trace(scene, "closed-form", harmonics=int(harmonics)).curves
        assert abs(greatest_error(curve, peaks) / float(shown) - 1.0) < 0.05
    assert [int(harmonics) for harmonics, _ in rows] == [1, 3, 5, 9, 15]


def test_python_of_this_test_is_the_one_with_fcm():
    assert Path(sysconfig.get_path("scripts"), "fcm").exists(), f"{sys.prefix} has no fcm"
