"""The programs that measure times run: each with its smallest case, and no word on how long that takes."""

import argparse
import timeit

import numpy as np
import pytest

import fcm

from ..response import random_points
from . import lap_joint, large, many, motion, own_law, process, ring, speed
from .others import problems, solved


@pytest.mark.slow
def test_points_of_random_scenes_are_counted(capsys):
    random_points.main(1, 1, 1)
    known = random_points.known(0, 1)
    assert f"known at {known.known} of {known.points} points" in capsys.readouterr().out
    assert 0 < known.known <= known.points


def test_a_large_structure(capsys):
    large.run(6, 2)
    assert "6 modes, 2 contacts" in (said := capsys.readouterr().out) and "complete: True" in said


def test_a_strip_of_many_contacts(capsys, tmp_path):
    many.strips(argparse.Namespace(contacts=[3], harmonics=["1"], sampled=None), tmp_path)
    head, row = capsys.readouterr().out.splitlines()
    assert len(row.split("\t")) == len(head.split("\t")) and row.startswith("3\t1\t")


def test_a_lap_joint_of_four_pairs(tmp_path):
    scene = fcm.load_scene(lap_joint.write(tmp_path, 2, 2, line=True))
    assert len(scene.contacts) == 4 and scene.modal.frequency[0] > 0.0


def test_whole_processes(capsys, monkeypatch):
    few = dict(list(process.COMMANDS.items())[-1:])
    monkeypatch.setattr(process, "COMMANDS", few)
    process.main(1)
    assert "fcm --help" in capsys.readouterr().out


def test_a_sector_is_its_ring(capsys):
    ring.main(5, [[1]])
    said = capsys.readouterr().out
    assert float(said.partition("apart by ")[2].partition(";")[0]) < 1e-5 and "complete: True" in said


@pytest.mark.slow
def test_exact_motion_beside_fixed_steps(capsys, monkeypatch):
    monkeypatch.setattr(timeit.Timer, "autorange", lambda _: (1, 0.0))
    monkeypatch.setattr(motion, "FREQUENCIES", np.linspace(0.7, 1.7, 2))
    monkeypatch.setattr(motion, "STEPS", (20, 40))
    monkeypatch.setattr(motion, "CYCLES", 2)
    motion.main()
    assert "order of the median error" in capsys.readouterr().out


def test_kernels_and_curves(capsys, monkeypatch):
    monkeypatch.setattr(speed, "REPEATS", 1)
    speed.coefficients(100, 2)
    speed.periodic(2)
    speed.planar(2, (1,))
    speed.many_curves(2)
    assert capsys.readouterr().out.count("scaled") == 5


@pytest.mark.slow
def test_laws_in_python_beside_that_of_fcm(capsys, monkeypatch):
    monkeypatch.setattr(own_law.Friction, "samples", 32)
    own_law.main(1)
    *_, own, arrays, loop = (line.split() for line in capsys.readouterr().out.splitlines())
    assert own[-1] == "1" and float(loop[-1]) > float(arrays[-1]) > 1.0


def test_a_problem_that_other_packages_get():
    (scene,) = (one for one in problems.preloads() if one.contacts[0].n_0 == 5.0)
    found = problems.compared("n_0 = 5", "preloads", scene, 1, fine=False)
    still = solved.Solved(np.zeros((3, 3 * len(found["natural"]))), np.linspace(*found["range"], 3))
    kept = solved.result(found | {"harmonics": 1}, 64, 1.0, lambda: still)
    assert found["fcm"]["complete"] and (kept.points, kept.peak, kept.state) == (3, 0.0, "")
