"""The table of keys is what scenes are checked against, and the template has all of them."""

from __future__ import annotations

import re
import tomllib

import pytest

from fcm.scene import SceneError, scene_from_dict
from fcm.scene.keys import TABLES, UNITS, as_lines, names

from ..program import called, python


def printed(option):
    done = called("respond", option)
    assert done.code == 0 and done.err == ""
    return done.out


def test_every_key_is_printed_with_its_rule():
    lines = printed("--keys").splitlines()
    assert max(map(len, lines)) <= 100
    keys = re.split(r"\n(?! )", "\n".join(lines))
    assert len(keys) == len(as_lines())
    whole = [re.sub(r"\s+", " ", one) for one in keys]
    (mu,), (areas,), (step,), (force,) = (
        [one for one in whole if one.startswith(f"{key}: ")]
        for key in ("contact[].mu", "contact[].areas", "response.max_step", "force")
    )
    assert re.fullmatch(r".*: friction coefficient; of pairs also .* number at least 0; required", mu)
    assert "one k_u, k_v or n_0 is a total" in areas and "a swept one is the total of the pairs" in areas
    assert step.endswith(" number greater than 0 and at most 1; without it: 0.05")
    assert force == "force: the harmonic forces [[force]]; needed without [base]"


def test_every_number_has_a_unit_and_nothing_else_has():
    numbers = {
        ".".join(filter(None, (table, name)))
        for table, keys in TABLES.items()
        for name, key in keys.items()
        if re.search(
            r"\bnumbers?\b|^1 to 50|list of lists|list of rows|\[from, to\]|^ratio|^list, (or|range)",
            key.kind,
        )
    }
    assert numbers - set(UNITS) == set()
    every = {".".join(filter(None, (table, name))) for table, keys in TABLES.items() for name in keys}
    assert set(UNITS) - every == set()
    assert set(UNITS) - numbers == {"force.phase", "base.phase"} - numbers


def test_units_are_printed_with_what_a_key_may_be():
    text = re.sub(r"\s+", " ", printed("--keys"))
    (k_v,) = re.findall(r"contact\[\].k_v: .*? required", text)
    assert k_v.endswith("a column of their file number at least 0 [force / length]; required")
    assert "modal.damping: damping ratios: 0.01 is 1 % of critical damping number at least 0; one for" in text


@pytest.mark.parametrize(
    ("change", "contact"),
    [({"n_0": 5.0}, 5.0), ({"n_0": -5.0}, -5.0), ({"gap": 3.0}, -6.0), ({"gap": -3.0}, 6.0)],
)
def test_a_gap_is_positive_where_faces_are_apart_and_a_preload_where_they_press(data, change, contact):
    del data["contact"][0]["n_0"], data["sweep"]
    data["contact"][0] |= change
    assert scene_from_dict(data).contacts[0].n_0 == contact  # k_v is 2


@pytest.mark.parametrize("table", [table for table in TABLES if table not in ("sweep",)])
def test_a_key_that_is_not_in_the_table_is_refused(table):
    """With the keys of the table as suggestions: what is checked is what is printed."""
    wrong = names(table)[0] + "q"
    inner = {wrong: 1}
    for word in reversed(table.split(".") if table else []):
        inner = {word: [inner] if word in ("contact", "force", "load", "schedule", "data") else inner}
    with pytest.raises(SceneError) as caught:
        scene_from_dict(inner)
    assert f"{wrong}: unknown key" in str(caught.value)


def test_the_template_is_a_scene():
    scene = scene_from_dict(tomllib.loads(printed("--template")))
    assert scene.contacts[0].name == "shroud" and scene.has_range


def test_the_template_has_every_key():
    text = printed("--template")
    for table, keys in TABLES.items():
        for key in keys:
            word = key.strip('"').replace("NAME", "*")
            if table == "" or key in ("paired", "correlation", "data", "mistuning"):
                assert re.search(rf"^(# )?(\[\[?)?(sweep\.|fit\.|cyclic\.)?{word}(\]| *=)", text, re.M), key
            else:
                assert re.search(rf"[#{{ \n\"]{re.escape(word)}\"? *=", text), (table, key)


PLANE = "tangential = ["  # how the choice of two directions begins


def test_what_the_template_has_in_comments_is_right():
    """Its comments taken away, all but one of each choice: a scene of matrices, with all tables but [fit]."""
    text = re.sub(r"^# \[fit\].*?\n\n", "", printed("--template"), flags=re.M | re.S)
    lines = [line.removeprefix("# ") for line in text[text.index("[[contact]]") :].splitlines()]
    dropped = ("accuracy", "gap", "areas", "nodes", "file ", "phase ", " ", "phase   =", PLANE)
    kept = [line for line in lines if not line.startswith(dropped)]
    table = '[structure]\ndofs = ["40x","40y","41x","41y","71x","50z","7a"]\nmass = [1,1,1,1,1,1,1]\n'
    table += "stiffness = [1e5,2e5,3e5,4e5,5e5,6e5,7e5]\ndamping = 0.002\n"
    data = tomllib.loads(table + "\n".join(kept))
    data["start"] = {
        key: [0.0] * (7 if key in ("displacement", "velocity") else 1)
        for key in data["start"]
        if key != "angle"
    }
    scene = scene_from_dict(data)
    assert scene.loads and scene.schedule and scene.start and scene.units == ("m", "N")
    assert len(scene.curves) == 6 * 20 and scene.forces[0].power == 2
    (two,) = (line for line in lines if line.startswith(PLANE))
    data["contact"] = [one | tomllib.loads(two) for one in data["contact"]]
    in_time = ("schedule", "start")  # of contacts on a line alone
    assert scene_from_dict({key: value for key, value in data.items() if key not in in_time}).planar


def test_neither_needs_the_solver():
    code = "import sys; from fcm.cli import main; main(['respond', '--keys'], standalone_mode=False); "
    code += "print([m for m in ('scipy', 'netCDF4', 'xarray', 'fcm.response.sweep') if m in sys.modules])"
    assert python("-c", code).out.splitlines()[-1] == "[]"


def test_what_the_template_has_of_a_fit_is_right(tmp_path):
    text = printed("--template")
    block = re.search(r"^# \[fit\].*?\n\n", text, re.M | re.S)[0]
    data = tomllib.loads(text) | tomllib.loads(block.replace("\n# ", "\n").removeprefix("# "))
    (tmp_path / "level1.csv").write_text("frequency,amplitude\n90,1\n")
    (tmp_path / "ring_down.csv").write_text("amplitude,frequency,damping\n1,90,0.01\n")
    found = scene_from_dict(data, folder=tmp_path).fit
    assert len(found.vary) == 2 and [one.mode for one in found.data] == [1, 1]
    assert found.data[0].amplitude_error == 0.01 and found.data[1].damping_error == 0.05
