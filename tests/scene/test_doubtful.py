"""Numbers that are hardly meant are asked about, and taken as they are."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from fcm.scene import scene_from_dict
from fcm.scene.listing import listing, resonance_doubt

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
        (("modal", "damping"), 0.2, ["It is 20 % of critical damping; if 0.2 % is meant, write 0.002"]),
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
        (1e3, []),
        (1.0, ["the contacts are soft beside the structure: 1.0e-05 times its stiffness at most"]),
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
