"""The how-tos of the guide, each from an empty folder: its scene, and the commands that are typed."""

import csv
import json
import re
import shutil

import netCDF4
import numpy as np
import pytest

from ..program import ended, shell
from ..scene.test_matrix_formats import ABAQUS_K, ABAQUS_M, BEAM, BOEING, PUNCH, ROWS
from .pages import FENCED, GUIDE, ROOT, blocks, read

PATH = GUIDE / "howto/from-another-program.md"
PAGE = read(PATH)
MAPPING = "Matrix Eqn    Node    DOF\n 1 7 UX\n 2 7 UY\n 3 9 UX\n 4 9 ROTZ\n"
MASSES = """Masses                                                                  M
             3             1             1             1             0
RSA                        4             4             4             0
(5I4)           (5I4)           (4E14.7)
   1   2   3   4   5
   1   2   3   4
 1.0000000E+00 1.0000000E+00 1.0000000E+00 1.0000000E+00
"""
LOWEST = {"From Abaqus": 100.0, "From Nastran": 100.0, "From Ansys": 100.0, "From modes of a test": 10.0}


def parts(title):
    """The scene of a how-to, the lines for the other program, and the commands."""
    section = PAGE.split(f"## {title}\n")[1].split("\n## ")[0]
    (scene,) = re.findall(r"^```toml\n(.*?)^```", section, re.M | re.S)
    lines = re.findall(r"^    (.*)$", FENCED.sub("", section), re.M)
    return scene, lines, typed(title)


def typed(title):
    """The commands below a heading."""
    lines = [
        line
        for block in blocks(PATH)
        if (block.kind, block.heading) == ("sh", title)
        for line in block.text.splitlines()
    ]
    assert len(lines) == 3
    return lines


def files_of(title, folder):
    """What the other program writes."""
    if title == "From CalculiX":
        shutil.copy(BEAM / "beam.inp", folder)
        if shutil.which("ccx"):
            assert ended("ccx", "beam", cwd=folder).code == 0
        else:
            for ending in ("sti", "mas", "dof"):
                shutil.copy(BEAM / f"beam.{ending}", folder)
    elif title == "From modes of a test":
        shutil.copy(ROOT / "tests/scene/two_modes.uff", folder / "test.uff")
    else:
        texts = {
            "From Abaqus": {"job_STIF2.mtx": ABAQUS_K, "job_MASS2.mtx": ABAQUS_M},
            "From Nastran": {"model.pch": PUNCH},
            "From Ansys": {"K.matrix": BOEING, "M.matrix": MASSES, "K.mapping": MAPPING},
        }
        for name, text in texts[title].items():
            (folder / name).write_text(text)


@pytest.mark.slow
@pytest.mark.parametrize("title", re.findall(r"^## (From .*)$", PAGE, re.M))
def test_from_an_empty_folder_to_a_curve(tmp_path, title):
    scene, _, commands = parts(title)
    files_of(title, tmp_path)
    (tmp_path / "model.toml").write_text(scene)
    for command in commands:
        done = shell(command, tmp_path)
        assert done.code == 0, f"{command}\n{done.out}{done.err}"
    found = json.loads(shell("fcm plot modes model.toml --json", tmp_path).out)
    if title in LOWEST:
        assert found["modes"][0]["frequency"] == pytest.approx(LOWEST[title], rel=1e-9)
    assert not any("the range would hold" in text for text in found["read"])
    with netCDF4.Dataset(tmp_path / "curve.nc") as data:
        assert data["complete"][0] == 1 and np.nanmax(data["dissipated_energy"][0]) > 0.0
    assert (tmp_path / "curve.png").stat().st_size > 10_000


@pytest.mark.slow
def test_back_to_the_mesh(tmp_path):
    scene, _, _ = parts("From CalculiX")
    files_of("From CalculiX", tmp_path)
    (tmp_path / "model.toml").write_text(scene)
    section = PAGE.split("## Back to the mesh\n")[1]
    for command in typed("Back to the mesh"):
        done = shell(command, tmp_path)
        assert done.code == 0, f"{command}\n{done.out}{done.err}"
    with (tmp_path / "forces.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["force"] == "friction" and row["harmonic"] == "1"]
    shown = re.search(r"force of ([\d.]+) − ([\d.]+) i along", section)
    assert float(shown[1]) == pytest.approx(float(rows[0]["real"]), abs=0.006)
    assert -float(shown[2]) == pytest.approx(float(rows[0]["imag"]), abs=0.006)
    loads = [float(word) for word in re.findall(r"^    16, 2, ([\d.]+)$", section, re.M)]
    assert loads == [pytest.approx(40.0 - float(shown[1])), float(shown[2])]
    assert all((tmp_path / f"peak.{ending}").is_file() for ending in ("vtu", "uff", "h5"))


def test_the_step_of_calculix_is_that_of_the_input():
    assert "\n".join(parts("From CalculiX")[1]) in (BEAM / "beam.inp").read_text()


def test_the_rows_that_the_scenes_name_are_there():
    for title in ("From Abaqus", "From Nastran"):
        named = set(re.findall(r"\b(\d+[xyz])\b", parts(title)[0]))
        assert named <= set(ROWS)
