"""Numbers that are hardly meant are asked about, and taken as they are."""

from __future__ import annotations

import tomllib
from math import pi

import numpy as np
import pytest

from fcm.model.question import Question
from fcm.scene import bundled_scenes, load_scene, scene_from_dict
from fcm.scene.listing import listing, resonance_doubt

from ..guide.pages import PAGES, files
from ..program import called

STRUCTURE = {"dofs": ["u"], "mass": [1.0], "stiffness": [1.0]}


def notes(data, **more):
    return [one for one in scene_from_dict(data | more).notes if " right? " in one]


@pytest.mark.parametrize(
    "path, value, words",
    [
        (
            ("modal", "damping"),
            2,
            ["modal.damping: is 2 right? It is 200 % of critical damping; if 2 % is meant, write 0.02"],
        ),
        (("modal", "damping"), [0.01, 1.0], ["modal.damping: is 1 right?"]),
        (
            ("modal", "damping"),
            [0.0, 0.0],
            ["modal.damping: is 0 right? Where no contact slips nothing damps"],
        ),
        (("modal", "damping"), [0.0, 0.01], []),
        (("modal", "damping"), [0.01, 0.99], []),
        (
            ("modal", "damping"),
            0.2,
            ["so that a resonance is 2.5 times the static displacement; if 0.2 % is meant, write 0.002"],
        ),
        (("modal", "damping"), 0.19, []),
        (
            ("force", 0, "phase"),
            30,
            ['force[0].phase: is 30 right? 30 rad are 4.77 turns; if degrees are meant, write "30deg"'],
        ),
        (
            ("force", 1, "phase"),
            -90.0,
            ['force[1].phase: is -90 right? -90 rad are 14.3 turns; if degrees are meant, write "-90deg"'],
        ),
        (("force", 1, "phase"), "270deg", []),
        (
            ("contact", 0, "mu"),
            30,
            ["contact[0].mu: is 30 right? Friction is 30 times the normal force; if 30 % is meant"],
        ),
        (("contact", 0, "mu"), 2.0, []),
        (
            ("contact", 1, "gap"),
            -0.01,
            ["contact[1].gap: is -0.01 right? Below zero the faces overlap, and press at rest with -k_v"],
        ),
        (("contact", 1, "gap"), 0.0, []),
        (
            ("sweep", "contact.damper.gap"),
            [-1.0, 1.0],
            ['sweep."contact.damper.gap": is -1 right? Below zero the faces overlap'],
        ),
        (("force", 1, "phase"), 2.0 * pi, []),
        (("sweep", "force.1.phase"), [0.0, 45.0], ["if degrees are meant, write it in rad"]),
        (("sweep", "modal.damping"), [0.01, 5.0], ['sweep."modal.damping": is 5 right? It is 500 %']),
        (("sweep", "modal.damping"), {"from": 0.1, "to": 0.2, "count": 3}, []),
        (
            ("sweep", "modal.frequency.*"),
            [1.0, 1.1],
            ['sweep."modal.frequency.*": is one frequency for all 2 modes right?'],
        ),
        (("sweep", "modal.frequency.0"), [1.0, 1.1], []),
    ],
)
def test_of_modes(data, path, value, words):
    *way, last = path
    table = data
    for step in way:
        table = table[step]
    table[last] = value
    said = notes(data)
    assert len(said) == len(words) and all(word in one for word, one in zip(words, said, strict=True))


def test_a_ring_that_is_written_out_is_asked_about_its_phases_once():
    """Engine order 2 on 8 sectors goes round twice: sectors 5 to 7 had a question each."""
    dofs = [f"u{k}" for k in range(8)]
    structure = {"dofs": dofs, "mass": [1.0] * 8, "stiffness": [1.0 + 0.1 * k for k in range(8)]}
    forces = [{"dof": name, "amplitude": 1.0, "phase": pi / 2 * k} for k, name in enumerate(dofs)]
    data = {"structure": structure | {"damping": 0.1}, "response": {"frequency": [0.5, 1.5]}}
    (said,) = notes(data | {"force": forces})
    assert said.startswith("force[7].phase: is 10.9955742876 right? 10.9955742876 rad are 1.75 turns; if")
    assert said.endswith('write "10.9955742876deg". The same of "force[5].phase", "force[6].phase"')


def test_each_kind_of_number_of_many_contacts_is_asked_about_once(data):
    data["contact"] = [data["contact"][0] | {"name": f"c{i}", "mu": 30 + i} for i in range(20)]
    del data["sweep"]
    (said,) = notes(data)
    assert said.startswith("contact[19].mu: is 49 right?")
    assert '. The same of "contact[0].mu", "contact[1].mu", ' in said and said.endswith("... (19 in all)")


@pytest.mark.parametrize(
    "damping, words",
    [
        (2, "structure.damping: is 2 right?"),
        ({"loss_factor": 3.0}, "structure.damping.loss_factor: is 3 right? It is 300 % of the stiffness"),
        ({"mass": 4.0}, ""),
    ],
)
def test_of_matrices(damping, words):
    force, response = [{"dof": "u", "amplitude": 1.0}], {"frequency": [0.5, 1.5]}
    said = notes({"structure": STRUCTURE | {"damping": damping}, "force": force, "response": response})
    assert len(said) == bool(words) and all(words in one for one in said)


def test_the_run_goes_on(tmp_path):
    text = '[modal]\ndofs = ["u"]\nfrequency = [1]\ndamping = 2\nshapes = [[1]]\n'
    text += '[[force]]\ndof = "u"\namplitude = 1\nphase = 30\n[response]\nfrequency = [0.5, 2]\n'
    (tmp_path / "s.toml").write_text(text)
    done = called("respond", tmp_path / "s.toml")
    assert (
        done.code == 0
        and done.err.count(" right? ") == 2 == done.err.count("fcm: warning: ")
        and "right?" not in done.out
    )


def test_a_mode_that_contacts_bring_near_the_range_is_no_slip_of_units():
    """One mode at 10 rad/s, at 316 where the contact sticks: 31.6 times as high, as by a slip of units."""
    modal = {
        "dofs": ["u", "v"],
        "frequency": [10.0, 1e4],
        "damping": 0.01,
        "shapes": [[1.0, 0.0], [0.0, 1.0]],
    }
    contact = {"name": "a", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 1e5, "k_v": 1.0, "n_0": 1.0}
    rest = {"response": {"frequency": [310, 320]}, "force": [{"dof": "u", "amplitude": 1.0}]}
    assert not resonance_doubt(scene_from_dict({"modal": modal, "contact": [contact], **rest}))
    weak = contact | {"k_u": 1.0}
    assert "give the mass in t" in resonance_doubt(
        scene_from_dict({"modal": modal, "contact": [weak], **rest})
    )


STEEL = {  # two modes, 50.3 and 87.2 Hz, as a program in N, m, kg writes it
    "dofs": ["u", "v"],
    "mass": [[2.0, 0.0], [0.0, 2.0]],
    "stiffness": [[4e5, -2e5], [-2e5, 4e5]],
    "damping": 0.01,
}


@pytest.mark.parametrize(
    "change, words",
    [
        ({}, ""),
        ({"mass": [[2e-3, 0.0], [0.0, 2e-3]]}, "31.6 times as low"),
        (
            {"mass": [[2e3, 0.0], [0.0, 2e3]]},
            "stick; is the range as meant? If so, the range would hold modes if frequencies were 31.6",
        ),
        ({"mass": [[2e3, 0.0], [0.0, 2e3]]}, "31.6 times as high"),
        ({"mass": [[772.0, 0.0], [0.0, 772.0]], "force": "lbf"}, "divide the mass by 386"),
        ({"mass": [[2e3, 0.0], [0.0, 2e3]], "force": "lbf"}, "are the units of the structure"),
        ({"unit": "rad/s"}, 'in Hz: frequency_unit = "Hz"'),
        ({"k_u": 1e12}, ""),  # a resonance lies between the free mode and the stuck one
        ({"mass": [[2e-5, 0.0], [0.0, 2e-5]]}, "are the units of the structure"),
        (
            {"stiffness": [[2.0, -2.0], [-2.0, 2.0]], "k_u": 1e2, "k_v": 1e2},
            "at 0.225079 Hz",
        ),  # beside a rigid body
    ],
)
def test_a_range_without_a_resonance_says_so_with_the_nearest_modes(change, words):
    structure = STEEL | {key: change[key] for key in ("mass", "stiffness") if key in change}
    contact = {"name": "a", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 1e5, "k_v": 1e5, "n_0": 1.0}
    data = {
        "frequency_unit": change.get("unit", "Hz"),
        "structure": structure,
        "contact": [contact | {key: change[key] for key in ("k_u", "k_v") if key in change}],
        "force": [{"dof": "u", "amplitude": 1.0}],
        "response": {"frequency": [40.0, 60.0]},
        "units": {"length": "in", "force": change["force"]} if "force" in change else {},
    }
    said = resonance_doubt(scene_from_dict(data))
    assert words in said and bool(said) == bool(words)
    if words:
        assert "no resonance is near the range of frequencies: the nearest mode is at" in said
        assert "without contacts" in said and "while all stick" in said


@pytest.mark.parametrize(
    ("unit", "high", "asked"), [("rad/s", 250.0, True), ("rad/s", 400.0, False), ("Hz", 250.0, False)]
)
def test_a_forgotten_unit_of_the_range_is_asked_about_though_a_resonance_is_near(unit, high, asked):
    """The mode of the matrices is at 316 rad/s, which is 50.3 Hz: 20 to 250 holds it in Hz alone."""
    data = {
        "frequency_unit": unit,
        "structure": STEEL,
        "force": [{"dof": "u", "amplitude": 1.0}],
        "response": {"frequency": [20.0, high]},
    }
    said = resonance_doubt(scene_from_dict(data))
    assert bool(said) == asked
    assert not asked or ("no resonance is within the range" in said and 'frequency_unit = "Hz"' in said)


@pytest.mark.parametrize(
    ("direction", "high", "asked"),
    [("u", 150.0, False), ("v", 150.0, True), ({"u": 1.0, "v": 1.0}, 150.0, False), ("v", 600.0, False)],
)
def test_forces_that_push_no_mode_near_the_range_are_asked_about(direction, high, asked):
    """One mode moves along u at 100 rad/s, another along v at 1000: the second is beyond twice 150."""
    modal = {"dofs": ["u", "v"], "frequency": [100.0, 1000.0], "damping": 0.01, "shapes": [[1, 0], [0, 1]]}
    contact = {"name": "a", "tangential": "u", "normal": "v", "mu": 0.3, "k_u": 1e4, "k_v": 1e4, "n_0": 1.0}
    rest = {"force": [{"dof": direction, "amplitude": 1.0}], "response": {"frequency": [50.0, high]}}
    said = [
        one for one in scene_from_dict({"modal": modal, "contact": [contact], **rest}).notes if "push" in one
    ]
    assert bool(said) == asked
    assert not asked or "none of the modes up to 300 rad/s" in said[0]


@pytest.mark.parametrize(("harmonics", "asked"), [((1,), True), ((4,), False), ((1, 4), False), ((9,), True)])
def test_a_force_of_a_higher_harmonic_meets_resonances_above_the_range(harmonics, asked):
    """One mode at 200 rad/s, and a range about 50: its fourth harmonic meets it."""
    data = {
        "modal": {"dofs": ["u"], "frequency": [200.0], "damping": 0.01, "shapes": [[1.0]]},
        "force": [{"dof": "u", "amplitude": 1.0, "harmonic": h} for h in harmonics],
        "response": {"frequency": [45.0, 55.0]},
    }
    scene = scene_from_dict(data)
    said = resonance_doubt(scene)
    assert bool(said) == asked
    assert ("forces act from 405 to 495 rad/s" in said) == (harmonics == (9,))
    assert any("no resonance is within" in one for one in listing(scene)["warnings"]) == asked


@pytest.mark.parametrize(
    "stiffness, said",
    [
        (1e13, ["1.0e+08 times as stiff as the structure there. Are k_u and k_v in its units?"]),
        (1e9, []),
        (1e3, []),  # 0.5 %
        (100.0, ["the resonance at 316.23 rad/s is 0.05 % higher, so that friction changes little"]),
        (0.0, []),  # no spring
    ],
)
def test_contacts_of_another_unit_than_the_structure(stiffness, said):
    """One degree of freedom of 1e5 N/m; a contact of 1 N/mm in N/m, or of GPa where MPa are meant."""
    structure = {"dofs": ["u", "v"], "mass": [[1.0, 0.0], [0.0, 1.0]], "stiffness": [[1e5, 0.0], [0.0, 1e5]]}
    structure["damping"] = 0.01
    contact = {"name": "a", "tangential": "u", "normal": "v", "mu": 0.3, "n_0": 1.0}
    data = {
        "structure": structure,
        "contact": [contact | {"k_u": stiffness, "k_v": stiffness}],
        "force": [{"dof": "u", "amplitude": 1.0}],
        "response": {"frequency": [200.0, 400.0]},
    }
    found = [one for one in scene_from_dict(data).notes if "in its units" in one]
    assert len(found) == len(said) and all(words in one for words, one in zip(said, found, strict=True))
    swept = data | {"sweep": {"contact.a.k_u": [1.0, 1e5]}}
    assert not any("in its units" in one for one in scene_from_dict(swept).notes)


@pytest.mark.parametrize(("factor", "asked"), [(1.0, 0), (1e3, 1), (10.0, 0)])
def test_a_first_resonance_far_below_the_range_is_asked_about(factor, asked):
    """A mass in another unit: higher modes are near the range then, and no name tells of it."""
    count = 8
    mass, stiffness = (factor * np.eye(count)).tolist(), np.diag(np.geomspace(1e5, 1e9, count)).tolist()
    first = np.sqrt(1e5)
    dofs = [f"A{i}q" for i in range(count)]
    contact = {"name": "a", "tangential": dofs[3], "normal": dofs[5], "mu": 0.3, "n_0": 1.0}
    data = {
        "structure": {"dofs": dofs, "mass": mass, "stiffness": stiffness, "damping": 0.01},
        "contact": [contact | {"k_u": 1e4, "k_v": 1e4}],
        "force": [{"dof": dofs[1], "amplitude": 1.0}],
        "response": {"frequency": [0.9 * first, 1.2 * first]},
    }  # fmt: skip
    scene = scene_from_dict(data)
    assert resonance_doubt(scene) == ""
    assert len([one for one in scene.notes if "are the units those meant?" in one]) == asked


def blade(units=("m", "N"), **more):
    """One mode of 100 Hz at a tip, in m, N and kg: 1 kg, 3.9e5 N/m, 0.63 mm in resonance."""
    data = {
        "frequency_unit": "Hz",
        "modal": {"dofs": ["x", "z"], "frequency": [100.0, 400.0], "damping": 0.002,
                  "shapes": [[1.0, 0.3], [-0.3, 1.0]]},
        "contact": [{"name": "tip", "tangential": "x", "normal": "z", "mu": 0.3, "k_u": 2e5, "k_v": 3e5,
                     "n_0": 10.0} | more.pop("contact", {})],
        "force": [{"dof": "x", "amplitude": 1.0}],
        "response": {"frequency": [80.0, 150.0]},
    }  # fmt: skip
    given = {"units": dict(zip(("length", "force"), units, strict=True))} if units else {}
    return data | given | more


def asked(data):
    return [one for one in scene_from_dict(data).notes if isinstance(one, Question)]


@pytest.mark.parametrize(
    ("contact", "units", "words"),
    [
        ({}, ("m", "N"), ""),
        (
            {"k_u": 200.0, "k_v": 300.0},
            ("m", "N"),
            "read in N/m; if they are in N/mm, write 1000 times as much",
        ),
        ({"k_u": 200.0, "k_v": 300.0}, (), "Are k_u and k_v in its units?"),
        (
            {"k_u": 200.0},
            ("m", "N"),
            "are k_u = 200 and k_v = 300000 N/m both right? They differ 1.5e+03 times",
        ),
        ({"k_v": 300.0}, ("m", "N"), "are k_u = 200000 and k_v = 300 N/m both right?"),
        ({"k_u": 200.0}, (), ""),
        ({"k_u": 1200.0}, ("m", "N"), ""),  # by a factor of 250
        ({"k_u": 200.0, "mu": 0.0}, ("m", "N"), ""),
        ({"k_v": 0.0}, ("m", "N"), ""),
    ],
)
def test_stiffnesses_a_thousand_times_too_soft(contact, units, words):
    said = asked(blade(units, contact=contact))
    assert len(said) == bool(words) and all(words in one for one in said)


def test_soft_contacts_are_told_by_the_resonance_that_a_higher_harmonic_of_the_force_meets():
    data = blade(contact={"k_u": 200.0, "k_v": 300.0})
    force = data["force"][0] | {"harmonic": 4}
    data |= {"force": [force], "response": {"frequency": [24.0, 26.0]}}
    (said,) = asked(data)
    assert "the resonance at 100 Hz is" in said


def test_contacts_that_change_a_resonance_below_the_range_are_not_soft():
    data = blade(response={"frequency": [390.0, 410.0]})
    data["modal"]["shapes"] = [[1.0, 0.3], [1e-3, 1e-2]]
    assert asked(data) == []
    data["modal"]["shapes"][0] = [1e-2, 1e-2]
    assert len(asked(data)) == 1


def test_contacts_that_no_resonance_near_the_range_moves_are_not_soft():
    """Of whatever stiffness."""
    data = blade(contact={"k_u": 200.0, "k_v": 300.0})
    data["modal"]["shapes"] = [[1e-3, 1e-3], [1.0, 1.0]]
    data["force"][0]["dof"] = "x"
    assert asked(data) == []


def test_soft_contacts_that_together_are_not_soft():
    """A thousand contacts, each of a ten-thousandth of the structure's stiffness."""
    data = blade()
    data["contact"] = [data["contact"][0] | {"name": f"c{i}", "k_u": 40.0, "k_v": 40.0} for i in range(1000)]
    assert asked(data) == []


@pytest.mark.parametrize("table", ["sweep", "optimum", "fit"])
def test_stiffnesses_that_vary_are_not_asked_about(table, tmp_path):
    key, soft = "contact.tip.k_u", blade(contact={"k_u": 200.0, "k_v": 300.0})
    (tmp_path / "a.csv").write_text("frequency,amplitude\n" + "".join(f"{f},1e-4\n" for f in range(90, 110)))
    more = {
        "sweep": {key: [1e2, 1e3]},
        "optimum": {"vary": [key], "bounds": [[1e2, 1e6]], "minimise": "peak.x"},
        "fit": {"vary": [key], "bounds": [[1e2, 1e6]], "data": [{"file": "a.csv", "dof": "x"}]},
    }
    assert len(asked(soft)) == 1
    made = scene_from_dict(soft | {table: more[table]}, folder=tmp_path)
    assert not any("soft" in one for one in made.notes)


def floating(k_u, mass=0.015, frequency=(0.0, 0.0), pushed=()):
    """The blade, and a damper of its own mass that only the contact holds."""
    data = blade(contact={"k_u": k_u, "k_v": 1.5 * k_u})
    shapes = [[1.0, 0.3, 0.0, 0.0], [-0.3, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    data["modal"] |= {"dofs": ["x", "z", "dx", "dz"], "shapes": shapes, "mass": [1.0, 1.0, mass, mass],
                      "frequency": [100.0, 400.0, *frequency]}  # fmt: skip
    data["contact"][0] |= {"tangential": {"x": 1.0, "dx": -1.0}, "normal": {"z": 1.0, "dz": -1.0}}
    data["force"] += [{"dof": dof, "amplitude": 1.0} for dof in pushed]
    return data


def mass_on(stiffness, hertz):
    return stiffness / (2.0 * pi * hertz) ** 2


@pytest.mark.parametrize(
    ("scene", "count"),
    [
        (floating(2e5), 0),
        (floating(200.0), 1),
        (floating(200.0, frequency=(90.0, 0.0)), 1),  # the damper's own spring is soft, too
        (floating(200.0, mass=mass_on(200.0, 100.0)), 1),
        (floating(200.0, mass=mass_on(200.0, 100.0), pushed=["dx"]), 0),  # on mounts, in resonance there
        (floating(200.0, mass=mass_on(200.0, 20.0), pushed=["dx"]), 1),  # below the range
        (floating(200.0, mass=mass_on(200.0, 400.0), pushed=["dx"]), 1),  # above it
    ],
)
def test_soft_contacts_that_hold_a_floating_body(scene, count):
    """Nothing was asked beside a rigid body: a damper's stiffness in N/mm was read in N/m."""
    said = asked(scene)
    assert len(said) == count
    assert all("the resonance at 100 Hz is" in one and "if they are in N/mm" in one for one in said)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"gap": 0.1}, "is a gap of 0.1 m (-n_0 / k_v) right?"),
        ({"n_0": 10.0, "k_u": 200.0, "k_v": 3e5}, "k_u = 200 and k_v = 300000 N/m both right?"),
        ({"n_0": 10.0, "k_u": 1e12}, "times as stiff as the structure there"),
    ],
)
def test_other_questions_beside_a_floating_body(change, words):
    data = floating(2e5)
    del data["contact"][0]["n_0"]
    data["contact"][0] |= change
    (said,) = asked(data)
    assert words in said


@pytest.mark.parametrize(
    ("damping", "units", "count"),
    [(0.1, ("m", "N"), 1), (0.09, ("m", "N"), 0), (0.1, (), 0), ([0.002, 0.1], ("m", "N"), 0)],
)
def test_damping_ratios_in_percent_of_a_structure_with_units(damping, units, count):
    data = blade(units)
    data["modal"]["damping"] = damping
    said = asked(data)
    assert len(said) == count
    assert all("a resonance is 5 times the static displacement; if 0.1 % is meant" in one for one in said)


@pytest.mark.parametrize(
    ("loss", "units", "count"), [(0.2, ("m", "N"), 1), (0.19, ("m", "N"), 0), (0.4, (), 0)]
)
def test_a_loss_factor_in_percent(loss, units, count):
    data = blade(units)
    del data["modal"], data["contact"]
    data["structure"] = {"dofs": ["x"], "mass": [1.0], "stiffness": [3.9e5], "damping": {"loss_factor": loss}}
    said = [one for one in asked(data) if "loss_factor" in one]
    assert len(said) == count
    assert all("20 % of the stiffness, so that a resonance is 5 times" in one for one in said)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"gap": 1e-4}, ""),
        ({"gap": 0.1}, "is a gap of 0.1 m (-n_0 / k_v) right? Forces move its faces by"),
        ({"n_0": -3e4}, "is a gap of 0.1 m"),
        ({"gap": 0.1, "units": ()}, ""),
        ({"gap": 0.1, "sweep": {"contact.tip.gap": [1e-4, 0.1]}}, ""),
        ({"gap": 0.1, "sweep": {"force.0.amplitude": [1.0, 1e3]}}, ""),
        ({"gap": 0.1, "load": [{"dof": "z", "force": 1e4}]}, ""),
        ({"n_0": -1.0, "k_v": 0.0}, ""),
    ],
)
def test_a_gap_in_another_unit_of_length(change, words):
    of_contact = {key: change[key] for key in ("gap", "n_0", "k_v") if key in change}
    more = {key: change[key] for key in ("sweep", "load") if key in change}
    data = blade(change.get("units", ("m", "N")), contact=of_contact, **more)
    if "gap" in of_contact:
        del data["contact"][0]["n_0"]
    said = [one for one in asked(data) if "gap" in one and "k_v = 0" not in one]
    assert len(said) == bool(words) and all(words in one for one in said)
    assert all("never closes. If it is in mm, divide it by 1000" in one for one in said)


def test_a_gap_is_measured_by_the_motion_of_the_structure_without_contact():
    """The mode at 100 Hz alone, in resonance: 1 N over 2 * 0.002 (2 pi 100)^2 kg/s^2, times 0.3."""
    data = blade(contact={"gap": 0.1})
    del data["contact"][0]["n_0"]
    data["modal"] |= {"frequency": [100.0], "shapes": [[1.0, 0.3]]}
    motion = 0.3 / (2 * 0.002 * (2 * pi * 100.0) ** 2)
    (said,) = asked(data)
    assert f"by {motion:.2g} m at most" in said
    for times, count in ((9.9, 0), (10.1, 1)):
        data["contact"][0]["gap"] = times * motion
        assert len(asked(data)) == count


def test_a_gap_that_a_closed_contact_carries_the_motion_to_is_not_asked_about():
    """A second body that no force moves but through a closed contact."""
    data = blade()
    data["modal"] = {"dofs": ["x", "y"], "frequency": [100.0, 90.0], "damping": 0.002,
                     "shapes": [[1.0, 1e-9], [1e-9, 1.0]]}  # fmt: skip
    shared = {"mu": 0.3, "k_u": 2e5, "k_v": 3e5}
    link = {"name": "link", "tangential": {"x": 1.0, "y": -1.0}, "normal": "x", "n_0": 10.0}
    stop = {"name": "stop", "tangential": "x", "normal": "y", "gap": 1e-4}
    assert len([one for one in asked(data | {"contact": [stop | shared]}) if "gap" in one]) == 1
    assert [one for one in asked(data | {"contact": [link | shared, stop | shared]}) if "gap" in one] == []


def test_of_bundled_scenes_those_are_asked_about_that_are_extreme():
    """And dampings of 0, of two scenes that others published without any."""
    found = {name: asked_of(name) for name in bundled_scenes()}
    plain = {name: said for name, said in found.items() if said and not name.startswith("extreme/")}
    assert set(plain) == {"beam", "den-hartog"}
    assert all("damping: is 0 right?" in one for said in plain.values() for one in said)
    soft = {name for name, said in found.items() if any("are soft" in one for one in said)}
    assert soft == {
        "extreme/close-modes-1e-6", "extreme/separation-limit-met", "extreme/slip-limit-just-exceeded",
        "extreme/slip-limit-met", "extreme/soft-both",
    }  # fmt: skip


def test_scenes_of_the_guide_are_not_asked_about(tmp_path):
    """Those that stand alone, by their modes."""
    texts = {
        f"{page.name}:{name}": text
        for page in PAGES
        for name, text in files(page).items()
        if name.endswith(".toml") and "[modal]" in text and "[fit]" not in text
    }
    assert len(texts) >= 3
    assert {name: said for name, text in texts.items() if (said := asked(tomllib.loads(text)))} == {}


def asked_of(name):
    return [one for one in load_scene(name).notes if isinstance(one, Question)]
