"""Every mistake is named by its path, with what is wrong and what would be right; all of them at once."""

from __future__ import annotations

import re
import tomllib
from functools import reduce
from math import inf, nan

import numpy as np
import pytest

from fcm.scene import SceneError, scene_from_dict

GONE = object()
LONG = 1 << 4000

CASES = [
    # path, value, words of the message
    ("titel", "x", 'titel: unknown key; did you mean "title"?'),
    ("a b", 1, '"a b": unknown key'),
    ("title", 3, "title: must be a string, is 3"),
    ("frequency_unit", "hz", 'frequency_unit: must be "rad/s" or "Hz", is "hz"; did you mean "Hz"?'),
    ("frequency_unit", 2, 'frequency_unit: must be "rad/s" or "Hz", is an integer'),
    ("modal", GONE, "modal: missing; give a [modal] table"),
    ("modal", 3, "modal: must be a table, is 3"),
    ("modal", [{}], "modal: must be a table, is a list of 1; there is one of it: write [modal]"),
    ("modal.dof", ["u"], "modal.dof: unknown key"),
    ("modal.dofs", GONE, "modal.dofs: missing; give a list of the names"),
    ("modal.dofs", [], "modal.dofs: must be a list of at least one name, is an empty list"),
    ("modal.dofs", "u", "modal.dofs: must be a list of at least one name, is a string"),
    ("modal.dofs", ["u", 2, "w.x"], "modal.dofs[1]: must be a string, is an integer"),
    ("modal.dofs", ["u", "", "w.x"], 'modal.dofs[1]: "" is not a name that can be printed'),
    ("modal.dofs", ["u", "\x1b[31m", "w.x"], 'modal.dofs[1]: "\\u001b[31m" is not a name'),
    ("modal.dofs", ["u", "v", "u"], 'modal.dofs: "u" is there 2 times'),
    ("modal.frequency", GONE, "modal.frequency: missing; give a list of numbers"),
    ("modal.damping", "x", "must be a number for all modes, or a list with one for each, is the string"),
    (
        "modal.damping",
        GONE,
        "modal.damping: missing; give a number for all modes, or a list with one for each",
    ),
    ("modal.frequency", 1.0, "modal.frequency: must be a list of numbers, is 1"),
    ("modal.frequency", [], "modal.frequency: is empty; there must be at least one mode"),
    ("modal.frequency", [1.0, -10.0], "modal.frequency[1]: must be at least 0, is -10"),
    ("modal.frequency", [1.0, nan], "modal.frequency[1]: must be finite, is nan"),
    ("modal.frequency", [1.0, "10"], 'modal.frequency[1]: must be a number, is the string "10"'),
    ("modal.frequency", [1.0, 2.0, 3.0], "modal.mass: has 2 numbers, but modal.frequency has 3"),
    ("modal.mass", [1.0], "modal.mass: has 1 number, but modal.frequency has 2"),
    ("modal.mass", [1.0, 0.0], "modal.mass[1]: must be greater than 0, is 0"),
    ("modal.mass", [1.0, -2.0], "modal.mass[1]: must be greater than 0, is -2"),
    ("modal.mass", [1.0, True], "modal.mass[1]: must be a number, is true"),
    ("modal.mass", [1.0, 1e-200], "modal.mass[1]: 1e-200 is too small to calculate with"),
    ("modal.mass", [1.0, [2.0]], "modal.mass[1]: must be a number, is a list of 1"),
    ("modal.damping", GONE, "modal.damping: missing"),
    ("modal.damping", [0.01, -0.02], "modal.damping[1]: must be at least 0, is -0.02"),
    ("modal.damping", -0.01, "modal.damping: must be at least 0, is -0.01"),
    ("modal.damping", [0.01] * 3, "modal.damping: has 3 numbers, but modal.frequency has 2"),
    ("modal.shapes", GONE, "modal.shapes: missing; give one list for each mode"),
    ("modal.shapes", [1.0, 2.0], "modal.shapes: must be a list of lists, one for each mode"),
    ("modal.shapes", [[1.0, 1, 1], 2], "modal.shapes[1]: must be a list of numbers, is 2"),
    ("modal.shapes", [[1.0, 1, 1], [1, 2]], "modal.shapes[1]: has 2 numbers, but dofs names 3"),
    ("modal.shapes", [[1.0, 1, 1]], "modal.shapes: has 1 row, but modal.frequency has 2"),
    ("modal.shapes", [[1.0, 1, inf], [1, 2, 3]], "modal.shapes[0][2]: must be finite, is inf"),
    ("contact", {}, "contact: must be a list of tables, is a table; write [[contact]]"),
    ("contact", [3], "contact[0]: must be a table, is 3; write [[contact]]"),
    ("contact.0.ku", 3, 'contact[0] "shroud".ku: unknown key'),
    ("contact.0.k_t", 3, 'contact[0] "shroud".k_t: unknown key; did you mean "k_u"?'),
    ("modal.modal_mass", [1.0, 1.0], 'modal.modal_mass: unknown key; did you mean "mass"?'),
    ("contact.0.k_n", 3, 'contact[0] "shroud".k_n: unknown key; did you mean "k_v"?'),
    ("contact.0.name", GONE, "contact[0].name: missing; give a string"),
    ("contact.0.name", 7, "contact[0].name: must be a string, is 7"),
    ("contact.0.name", "", 'contact[0].name: "" is not a name'),
    ("contact.0.name", "damper", 'contact: 2 contacts are named "damper"'),
    ("contact.0.mu", GONE, 'contact[0] "shroud".mu: missing; give a number'),
    ("contact.0.mu", -0.1, 'contact[0] "shroud".mu: must be at least 0, is -0.1'),
    ("contact.0.mu", True, 'contact[0] "shroud".mu: must be a number, is true'),
    ("contact.0.mu", "0.4", 'contact[0] "shroud".mu: must be a number, is the string "0.4"'),
    ("contact.0.k_u", -1, 'contact[0] "shroud".k_u: must be at least 0, is -1'),
    ("contact.0.k_v", -1.5, 'contact[0] "shroud".k_v: must be at least 0, is -1.5'),
    ("contact.0.k_v", 1e101, "1e+101 is too large to calculate with (more than 1e+100)"),
    ("contact.0.n_0", nan, 'contact[0] "shroud".n_0: must be finite, is nan'),
    ("contact.0.n_0", LONG, 'contact[0] "shroud".n_0: must be finite'),
    ("contact.0.n_0", GONE, 'contact[0] "shroud": has neither n_0 nor gap; give one'),
    ("contact.0.gap", 1.0, 'contact[0] "shroud": has both n_0 and gap; give one: gap means n_0 = -k_v * gap'),
    ("contact.0.normal", GONE, 'contact[0] "shroud".normal: missing; give a degree of freedom'),
    ("contact.0.normal", "x", 'unknown degree of freedom "x"; modal.dofs are "u", "v", "w.x"'),
    ("contact.0.normal", "w_x", 'did you mean "w.x"?'),
    ("contact.0.normal", "V", 'did you mean "v"?'),
    ("contact.0.tangential", ["x", "z"], 'tangential[0]: unknown degree of freedom "x"'),
    ("contact.0.normal", 1, "must be a degree of freedom or a table of weights, is 1"),
    ("contact.0.normal", {}, 'contact[0] "shroud".normal: is an empty combination'),
    ("contact.0.normal", {"z": 1.0}, 'contact[0] "shroud".normal: unknown degree of freedom "z"'),
    ("contact.0.normal", {"u": "x"}, 'contact[0] "shroud".normal.u: must be a number, is the string "x"'),
    ("contact.0.normal", {"w": {"x": 1.0}}, "is a table; put a name with a dot in quotes"),
    ("contact.0.tangential", {"u": 0.0}, 'contact[0] "shroud".tangential: has only zero weights'),
    ("force", GONE, "force: missing; without a [[force]] the response is zero"),
    ("force", [], "force: missing; without a [[force]] the response is zero"),
    ("force", {}, "force: must be a list of tables, is a table; write [[force]]"),
    ("response.harmonics", [1, "a"], "response.harmonics: must be a number from 1 to 50, or a list of them"),
    ("force.0.amplitud", 1, 'force[0].amplitud: unknown key; did you mean "amplitude"?'),
    ("force.0.amplitude", GONE, "force[0].amplitude: missing; give a number"),
    ("force.0.amplitude", inf, "force[0].amplitude: must be finite, is inf"),
    ("force.0.phase", "90", 'force[0].phase: must be a number, is the string "90"'),
    ("force.0.dof", "q", 'force[0].dof: unknown degree of freedom "q"'),
    ("force.0.dof", {"u": 0}, "force[0].dof: has only zero weights"),
    ("response.frequency", [1.7, 0.7], "response.frequency: goes down: [1.7, 0.7]; give the lower one first"),
    (
        "response.frequency",
        [1, 1],
        "response.frequency: is empty: [1, 1]; give a range, and a single frequency",
    ),
    ("response.frequency", [0, 1], "response.frequency[0]: must be greater than 0, is 0"),
    ("response.frequency", [-1, 1], "response.frequency[0]: must be greater than 0, is -1"),
    ("response.frequency", [1], "response.frequency: must be two numbers, [from, to], is a list of 1"),
    ("response.frequency", [1, 2, 3], "response.frequency: must be two numbers, [from, to], is a list of 3"),
    ("response.max_step", 0, "response.max_step: must be greater than 0 and at most 1, is 0"),
    ("response.max_step", 1.5, "response.max_step: must be greater than 0 and at most 1, is 1.5"),
    ("response.maxstep", 1, 'response.maxstep: unknown key; did you mean "max_step"?'),
    ("schedule", 3, "schedule: must be a list of tables, is 3; write [[schedule]]"),
    ("schedule.0.cycles", GONE, "schedule[0].cycles: missing; give a number"),
    ("schedule.0.cycles", 0, "schedule[0].cycles: must be greater than 0, is 0"),
    ("schedule.0.frequency", -1.0, "schedule[0].frequency: must be greater than 0, is -1"),
    ("schedule.0.frequncy", 1.0, "schedule[0].frequncy: unknown key"),
    ("start", [1], "start: must be a table, is a list of 1"),
    ("start", {"velocty": [0, 0]}, 'start.velocty: unknown key; did you mean "velocity"?'),
    ("start", {"displacement": 1.0}, "start.displacement: must be a list of numbers, is 1"),
    (
        "start",
        {"displacement": [1]},
        "start.displacement: must have one number for each mode, 2 in all, has 1",
    ),
    ("start", {"friction": [1]}, "start.friction: must have one number for each contact, 2 in all, has 1"),
    ("start", {"velocity": [0, nan]}, "start.velocity[1]: must be finite, is nan"),
    ("start", {"angle": "90"}, 'start.angle: must be a number, is the string "90"'),
    ("sweep", 3, "sweep: must be a table, is 3"),
]


def put(data, path, value):
    """Set or remove the value at a dotted path."""
    *way, last = [int(word) if word.isdecimal() else word for word in path.split(".")]
    table = reduce(lambda tree, word: tree[word], way, data)
    if value is GONE:
        del table[last]
    else:
        table[last] = value


@pytest.mark.parametrize(
    "path, value, words", CASES, ids=[f"{path}-{i}" for i, (path, *_) in enumerate(CASES)]
)
def test_a_mistake_is_named(data, mistakes, path, value, words):
    put(data, path, value)
    message = mistakes(data)
    assert message.startswith("test.toml: ")
    assert words in message


def test_every_mistake_is_reported_at_once(data, mistakes):
    for path, value in [
        ("titel", "x"),
        ("modal.mass", [1.0, -1.0]),
        ("contact.0.k_u", -1.0),
        ("contact.1.normal", "z"),
        ("force.0.amplitude", "x"),
        ("response.max_step", 2),
        ("schedule.0.cycles", -1),
    ]:
        put(data, path, value)
    data["sweep"]["contact.shrod.n_0"] = [1]
    first, *lines = mistakes(data).splitlines()
    assert first == "test.toml: 8 mistakes"
    paths = [
        "titel",
        "modal.mass",
        "contact[0]",
        "contact[1]",
        "force[0]",
        "response",
        "schedule[0]",
        "sweep",
    ]
    assert len(lines) == 8
    assert all(any(line.startswith(f"  {path}") for line in lines) for path in paths)


def test_a_mistake_alone_takes_one_line(data, mistakes):
    put(data, "contact.0.k_u", -1)
    assert mistakes(data) == 'test.toml: contact[0] "shroud".k_u: must be at least 0, is -1'


def test_very_many_mistakes_are_counted(data):
    data |= {f"key{i}": i for i in range(10_000)}
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data)
    assert caught.value.count == 10_000
    assert len(str(caught.value).splitlines()) == 32
    assert str(caught.value).endswith("... and 9970 more")


def test_a_mistake_does_not_cause_others(data, mistakes):
    put(data, "modal.dofs", "u")
    assert mistakes(data).count("\n") == 0


def test_transposed_shapes_are_recognised(data, mistakes):
    data["modal"] |= {"dofs": ["u", "v"], "frequency": [1, 2, 3], "damping": 0.01, "mass": [1, 1, 1]}
    data["modal"]["shapes"] = [[1.0, 0, 0], [0, 1, 0]]
    data |= {"contact": [], "sweep": {"modal.shapes.0.0": [1]}, "force": data["force"][:1]}
    right = "modal.shapes: has 2 rows of 3 numbers, but there are 3 modes and 2 dofs: transpose it"
    assert right in mistakes(data) and "\n" not in mistakes(data)


def test_forces_that_move_nothing(data, mistakes):
    del data["sweep"]
    data["force"] = [{"dof": "u", "amplitude": 0.0}]
    assert mistakes(data) == "test.toml: force[0].amplitude is 0, so the response is zero"
    data["force"] *= 4
    assert mistakes(data) == "test.toml: the amplitudes of all 4 forces are 0, so the response is zero"
    data["force"] = [{"dof": "u", "amplitude": 1.0}]
    data["modal"]["shapes"] = [[0, 1, 1], [0, 2, 2]]
    assert "the forces move no mode" in mistakes(data)


@pytest.mark.parametrize("phase", [np.pi, -np.pi, 3.0 * np.pi])
def test_forces_that_cancel_each_other(data, mistakes, phase):
    """The rounding of their sum would be traced, in the place of rest."""
    del data["sweep"]
    data["force"] = [{"dof": "u", "amplitude": 0.1}, {"dof": "u", "amplitude": 0.1, "phase": phase}]
    assert "the forces move no mode, so the response is zero" in mistakes(data)
    data["force"][0]["phase"] = 1e-6
    assert scene_from_dict(data).has_range


def test_keys_that_are_no_strings_and_values_that_are_nothing(data, mistakes):
    data[3] = None
    data["modal"]["mass"] = None
    data["contact"][0]["mu"] = object()
    data["contact"][0]["normal"] = {4: 1.0}
    data["title"] = tomllib.loads("t = 2020-01-01")["t"]
    message = mistakes(data)
    assert len(message.splitlines()) == 6
    assert "is a NoneType" in message and "is a date" in message


def test_messages_stay_on_their_line_and_are_short(data, mistakes):
    data["contact"][0]["name"] = "a\nb" * 1000
    del data["sweep"]
    data["force"][0]["dof"] = "\x1b[2J\u202e" * 1000
    data["x" * 10_000] = 1
    message = mistakes(data)
    assert len(message.splitlines()) == 4
    assert max(map(len, message.splitlines())) < 500
    assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f\u202e]", message)


@pytest.mark.parametrize(
    "array", [np.ones((2, 2, 2)), np.array(1.0), np.array([1j, 2j]), np.array(["a", "b"])]
)
def test_arrays_of_the_wrong_kind(data, mistakes, array):
    data["modal"]["frequency"] = array
    data["modal"]["shapes"] = array
    assert "modal.frequency" in mistakes(data)


@pytest.mark.parametrize("schedule", [GONE, []])
def test_without_a_schedule_there_must_be_a_range(data, mistakes, schedule):
    put(data, "schedule", schedule)
    del data["response"]["frequency"]
    assert "response.frequency: missing; give two numbers, [from, to], in rad/s" in mistakes(data)
    del data["response"]
    assert "response: missing; give a [response] table with frequency = [from, to]" in mistakes(data)


def test_a_start_needs_a_schedule(data, mistakes):
    del data["schedule"]
    data["start"] = {}
    assert mistakes(data) == ("test.toml: start: is of no use without a [[schedule]], which starts from it")


def test_of_a_start_without_a_schedule_friction_alone_is_of_use(data, mistakes):
    """It chooses among the exact motions of a contact that never slips."""
    del data["schedule"]
    friction = [1.0] * len(data["contact"])
    data["start"] = {"friction": friction, "angle": 1.0}
    assert mistakes(data) == (
        "test.toml: start.angle: is of no use without a [[schedule]], which starts from it"
    )
    del data["start"]["angle"]
    assert scene_from_dict(data).start.friction.tolist() == friction


def test_a_schedule_has_a_limit(data, mistakes):
    data["schedule"] = [{"frequency": 1.0, "cycles": 6e6}] * 2
    assert "schedule: asks for 1.2e+07 cycles; there can be 10000000" in mistakes(data)


def test_a_base_without_participation_is_said_beside_other_mistakes(data, mistakes):
    data["base"] = {"acceleration": 1.0}
    data["modal"]["damping"] = -0.01
    message = mistakes(data)
    assert "base: needs [structure], or modal.participation" in message
    assert "modal.damping: must be at least 0" in message


def test_what_stands_beside_a_file_that_is_not_there_is_checked(data, mistakes):
    data["modal"] = {"file": "none.npz", "damping": -1.0, "frequency": [-1.0], "dofs": "u", "shape": []}
    message = mistakes(data)
    assert '"none.npz" is not there' in message
    for key in ("damping", "frequency[0]", "dofs", "shape"):
        assert f"modal.{key}: " in message
