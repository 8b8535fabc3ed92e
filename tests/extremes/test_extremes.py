"""The catalogue of stiff and extreme cases: a fast sample of it, its criteria able to fail, its command."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fcm
from fcm.response import trace
from fcm.scene import SceneError

from ..program import python
from .conditioning import condition_number
from .known import changes, read_known
from .residual import unbalanced
from .row import catalogue, measured
from .verdict import faults

ROOT = Path(__file__).parents[2]
KNOWN = Path(__file__).with_name("passed.txt")
SAMPLE = (
    "slip-limit-met",
    "separation-limit-met",
    "no-tangential-motion",
    "b-one-opposed",
    "equal-modes",
    "stiff-tangential",
    "stiff-tangential-soft-normal",
    "force-1e-9",
    "friction-100",
)


def curve_of(name):
    return trace(fcm.load_scene(name), "closed-form").curves[0]


@pytest.fixture(scope="module")
def rows():
    return {name: measured(name) for name in SAMPLE}


@pytest.fixture(scope="module")
def yang():
    scene = fcm.load_scene("yang1998-n5")
    return scene, curve_of("yang1998-n5")


@pytest.mark.slow
def test_the_sample_passes(rows):
    assert not [(name, faults(row)) for name, row in rows.items() if faults(row)]


def test_a_motion_that_is_rounding_noise_is_not_followed(rows):
    """Two equal modes under a symmetric force leave v at 1e-14 of u."""
    assert rows["equal-modes"].points < 1000


def test_a_name_without_its_collection():
    with pytest.raises(SceneError, match='did you mean "extreme/stiff-normal"'):
        fcm.load_scene("stiff-normal")


def test_every_scene_is_known_to_pass_or_said_not_to():
    text = KNOWN.read_text(encoding="utf-8")
    fail = set(re.findall(r"^#   (\S+)  ", text, re.M))
    assert set(catalogue()) == read_known(KNOWN) | fail
    assert not fail & read_known(KNOWN)


def test_every_scene_has_a_title_and_says_why_it_is_hard():
    folder = Path(fcm.__file__).parent / "scenes/extreme"
    for name in catalogue():
        text = (folder / f"{name}.toml").read_text(encoding="utf-8")
        assert text.startswith("# ") and fcm.load_scene(f"extreme/{name}").title


@pytest.mark.parametrize("name", ["units-1e-12", "units-1e12", "length-1e-12"])
def test_the_curve_does_not_depend_on_units(yang, name):
    scene, plain = yang
    other, curve = fcm.load_scene(f"extreme/{name}"), curve_of(f"extreme/{name}")
    time = other.frequency_range[0] / scene.frequency_range[0]
    length = (other.forces[0].amplitude / other.contacts[0].k_u) / (
        scene.forces[0].amplitude / scene.contacts[0].k_u
    )
    assert curve.points == plain.points
    # behind a corner, which is met to some 1e-9 of a step, all points are moved along the curve by as much
    assert curve.frequency == pytest.approx(time * plain.frequency, rel=1e-8)
    assert curve.amplitude == pytest.approx(length * plain.amplitude, rel=1e-8)
    for dof, (height, at, *_) in curve.peaks.items():
        assert height == pytest.approx(length * plain.peaks[dof].amplitude, rel=1e-9)
        assert at == pytest.approx(time * plain.peaks[dof].frequency, rel=1e-9)
    assert curve.folds == pytest.approx([time * fold for fold in plain.folds], rel=1e-9)
    differ = curve.regime != plain.regime  # on a boundary of two regimes a contact is in either
    assert differ.sum() <= 2 * (len(plain.folds) + 4)
    judged = np.isclose(
        curve.stable, plain.stable, equal_nan=True
    )  # nor is the estimate that may forbid to tell
    assert (~judged).sum() <= 2


def test_masses_and_shapes_of_any_size_give_the_same_curve(yang):
    curve = curve_of("extreme/heavy-and-light")
    (height, at, *_), (same, there, *_) = curve.peaks["u"], yang[1].peaks["u"]
    assert height == pytest.approx(same, rel=1e-9)
    assert at == pytest.approx(there, rel=1e-8)  # it is flat there
    assert curve.folds == pytest.approx(yang[1].folds, rel=1e-9)


def test_a_wrong_point_is_unbalanced(yang):
    """A displacement wrong by 1e-6 leaves a force of about that, in every mode that it moves."""
    scene, curve = yang
    assert unbalanced(scene, curve).force.max() < 1e-12
    fundamental = curve.fundamental.copy()
    fundamental[::2] *= 1.0 + 1e-6
    left = unbalanced(scene, replace(curve, fundamental=fundamental)).force
    assert left[1::2].max() < 1e-12 and left[::2].min() > 1e-8


def test_a_wrong_mean_is_unbalanced(yang):
    scene, curve = yang
    opens = np.char.find(curve.regime[:, 0], "S") >= 0
    assert opens.any()
    left = unbalanced(scene, replace(curve, mean=curve.mean + 1e-6)).force
    assert left[opens].min() > 1e-8


def test_more_modes_than_displacements_cannot_be_judged(yang):
    scene, curve = yang
    modal = replace(scene.modal, shapes=np.array([[1.0, 1.0], [2.0, 2.0]]))
    with pytest.raises(ValueError, match="not known"):
        unbalanced(replace(scene, modal=modal), curve)


def test_the_condition_number_of_an_open_contact_is_that_of_its_equations():
    """Nothing but x = x(omega): the identity beside one column, whose norm follows from the slope."""
    name = "extreme/gap-1e6"
    scene, curve = fcm.load_scene(name), curve_of(name)
    X = curve.fundamental * np.exp(1j * curve.phase)
    w, modal = curve.frequency[:, None], scene.modal
    stiffness = modal.mass * (modal.frequency**2 - w**2 + 2j * modal.damping * modal.frequency * w)
    by_omega = modal.mass * (2j * modal.damping * modal.frequency - 2.0 * w)
    slope = (-by_omega / stiffness**2 * (modal.shapes @ [1.0, 1.0])) @ modal.shapes
    # the unit of a displacement: its size, or a tenth of its greatest so far, by the root of their number
    unit = np.maximum(np.abs(X), 0.1 * np.maximum.accumulate(np.abs(X))) * np.sqrt(2.0)
    length = np.sqrt((np.abs(slope / unit) ** 2).sum(axis=1))  # the range is 1 wide
    assert condition_number(scene, curve) == pytest.approx(np.sqrt(1.0 + length.max() ** 2), rel=1e-6)


def test_each_criterion_can_fail(rows):
    row = rows["b-one-opposed"]
    point = row.exact[0]
    assert "not complete" in faults(replace(row, complete=False, reason="it stopped"))[0]
    assert "residual" in faults(replace(row, residual=1e-6))[0]
    assert "by table" in faults(replace(row, table=1e-5))[0]
    assert "no exact motion" in faults(replace(row, exact=[replace(point, difference=np.nan)]))[0]
    wrong = replace(point, difference=0.1, truncation=0.01)
    assert "differs" in faults(replace(row, exact=[wrong]))[0]
    assert "not compared" in faults(replace(row, exact=[]))[0]


def test_a_curve_without_limit_passes_if_it_says_so():
    row = measured("undamped-open")
    assert not row.complete and "hardly anything damps" in row.reason
    assert faults(row) == []


def test_changes_against_the_known_rows(rows):
    broken = replace(rows["equal-modes"], residual=1.0)
    found = [rows["force-1e-9"], broken, rows["slip-limit-met"]]
    assert changes(found, {"force-1e-9", "equal-modes"}) == (["equal-modes"], ["slip-limit-met"])


EXTREMES = ("-m", "tests.extremes")


def test_the_command(tmp_path):
    known, output = tmp_path / "passed.txt", tmp_path / "rows.json"
    known.write_text("slip-limit-met  # exactly\n", encoding="utf-8")
    done = python(*EXTREMES, "slip-limit-met", "no-motion-at-all", "--known", known, "-o", output, cwd=ROOT)
    assert done.code == 0, done.err
    assert "2 of 2 pass" in done.out and "pass and are not in" in done.err
    (first, second) = json.loads(output.read_text(encoding="utf-8"))
    assert first["passes"] and second["name"] == "no-motion-at-all" and second["residual"] < 1e-12


def test_a_name_that_does_not_exist():
    done = python(*EXTREMES, "slip-limit-mett", cwd=ROOT)
    assert done.code == 2 and 'did you mean "slip-limit-met"?' in done.err
    assert "Traceback" not in done.err
