"""The figures of the theory pages show what is computed: a run draws the same lines again."""

import re
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest

from .figures import FIGURES, FOLDER, write
from .pages import GUIDE

WITHIN = 1.5  # points of print by which a line may be off
SVG = "{http://www.w3.org/2000/svg}"


def lines(path):
    """The lines that have a name: their vertices or markers, in points of print."""
    found = {}
    for group in ElementTree.parse(path).iter(f"{SVG}g"):
        name = group.get("id", "")
        marks = [(float(use.get("x")), float(use.get("y"))) for use in group.iter(f"{SVG}use")]
        paths = [one.get("d") for one in group.findall(f"{SVG}path")]
        vertices = [[float(x) for x in pair] for d in paths for pair in re.findall(r"([-\d.]+) ([-\d.]+)", d)]
        if name and not re.search(r"_\d+$", name) and (marks or vertices):
            found[name] = np.array(vertices or marks)
    return found


def furthest(points, line):
    """How far the furthest of the points is off the line, or off its nearest mark."""
    pieces = np.array([(a, b) for a, b in pairwise(line)] + [(a, a) for a in line])
    begin, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    length = np.maximum(np.sum(along**2, axis=1), 1e-12)
    part = np.clip(np.einsum("pkd,kd->pk", points[:, None] - begin, along) / length, 0.0, 1.0)
    return np.max(np.min(np.linalg.norm(points[:, None] - begin - part[..., None] * along, axis=-1), axis=1))


@pytest.mark.slow
@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_what_its_program_draws(name, tmp_path):
    ours, theirs = lines(write(name, tmp_path)), lines(FOLDER / f"{name}.svg")
    assert ours and set(ours) == set(theirs)
    for line, points in theirs.items():
        assert furthest(points, ours[line]) < WITHIN, line
        assert furthest(ours[line], points) < WITHIN, line


def test_a_shifted_line_is_seen():
    line = np.column_stack((np.linspace(0.0, 9.0, 10), np.zeros(10)))
    assert furthest(line + np.array([0.0, 2.0]), line) == pytest.approx(2.0)


def test_each_is_small():
    assert all((FOLDER / f"{name}.svg").stat().st_size < 80_000 for name in FIGURES)


def test_the_order_that_a_figure_shows_is_that_of_its_page():
    """It was 0: Newton's method was to go on to below rounding, and panels were halved for that."""
    orders = re.findall(r"order (\d+\.\d)", (FOLDER / "sampled-slip.svg").read_text("utf-8"))
    page = (GUIDE / "validation/accuracy.md").read_text("utf-8")
    assert f"radial return is of order {orders[0]} and the panels are of order {orders[1]}," in page
