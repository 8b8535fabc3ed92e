"""Whatever a file holds, it is a scene or a SceneError: nothing else is ever raised."""

from __future__ import annotations

import contextlib
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from fcm.scene import Scene, SceneError, load_scene, scene_from_dict

from ..scale import SCALE

TEXT = (Path(__file__).parents[2] / "src/fcm/scenes/two-contacts.toml").read_text()
SWEPT = (
    TEXT + '[sweep]\n"contact.shroud.n_0" = [1, 2]\n"modal.damping" = { normal = [0.1, 0.01], count = 3 }\n'
)
WORDS = ["[", "]", "{", "}", '"', "=", "\n", "#", ",", ".", "-", "1e999", "nan", "true", "0x" + "f" * 300]
WORDS += ["[[", "]]", "[modal]", "\x00", "'''", "=[]", "={}", "9" * 30, "1979-05-27", '""', "é", "-1", "0"]
KEYS = [
    "title",
    "frequency_unit",
    "modal",
    "contact",
    "force",
    "response",
    "sweep",
    "schedule",
    "dofs",
    "mass",
]
KEYS += [
    "frequency",
    "damping",
    "shapes",
    "file",
    "name",
    "tangential",
    "normal",
    "mu",
    "k_u",
    "k_v",
    "n_0",
    "gap",
]
KEYS += ["dof", "amplitude", "phase", "max_step", "cycles", "from", "to", "count", "log", "seed", "uniform"]
KEYS += [
    "structure",
    "stiffness",
    "modes",
    "loss_factor",
    "nodes",
    "areas",
    "proportional_to",
    "load",
    "base",
]
KEYS += [
    "base",
    "acceleration",
    "direction",
    "units",
    "length",
    "output",
    "paired",
    "participation",
    "x",
    "1x",
    "2x",
]
KEYS += ["contact.0.n_0", "modal.damping", "force.0.dof.u", "u", "v", ""]


def load_bytes(content: bytes) -> None:
    with TemporaryDirectory() as folder, contextlib.suppress(SceneError):
        path = Path(folder) / "fuzz.toml"
        path.write_bytes(content)
        assert isinstance(load_scene(path), Scene)


@pytest.mark.slow
@settings(max_examples=int(200 * SCALE), deadline=None)
@given(st.binary(max_size=300))
def test_any_bytes(content):
    load_bytes(content)


@pytest.mark.slow
@settings(max_examples=int(400 * SCALE), deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, len(SWEPT)), st.integers(0, 12), st.sampled_from(WORDS)), max_size=4)
)
def test_a_valid_file_with_pieces_replaced(changes):
    text = SWEPT
    for start, length, word in changes:
        text = text[:start] + word + text[start + length :]
    load_bytes(text.encode())


@pytest.mark.slow
@settings(max_examples=int(300 * SCALE), deadline=None)
@given(st.data())
def test_a_valid_file_with_lines_dropped_and_repeated(data):
    lines = SWEPT.splitlines()
    kept = data.draw(st.lists(st.sampled_from(range(len(lines))), max_size=2 * len(lines)))
    load_bytes("\n".join(lines[index] for index in sorted(kept)).encode())


LEAVES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=5),
    st.sampled_from(["u", "Hz", "m.npz"]),
)
TREES = st.recursive(
    LEAVES,
    lambda below: st.lists(below, max_size=4) | st.dictionaries(st.sampled_from(KEYS), below, max_size=8),
    max_leaves=25,
)


@pytest.mark.slow
@settings(max_examples=int(150 * SCALE), deadline=None)
@given(st.dictionaries(st.sampled_from(KEYS[:8]), TREES, max_size=8))
def test_any_tree_of_known_keys(data):
    with contextlib.suppress(SceneError):
        assert isinstance(scene_from_dict(data), Scene)


PATHS = [("modal", key) for key in ("dofs", "mass", "frequency", "damping", "shapes", "file")]
PATHS += [("contact", key) for key in ("name", "tangential", "normal", "mu", "k_u", "k_v", "n_0", "gap")]
PATHS += [("force", key) for key in ("dof", "amplitude", "phase")]
PATHS += [
    ("response", "frequency"),
    ("response", "max_step"),
    ("schedule", "cycles"),
    ("schedule", "frequency"),
]
PATHS += [("start", key) for key in ("displacement", "velocity", "friction", "angle")]
PATHS += [
    ("sweep", key)
    for key in ("contact.shroud.n_0", "contact.0.tangential.u", "modal.shapes.0.0", "force.0.phase")
]


@pytest.mark.slow
@settings(max_examples=int(400 * SCALE), deadline=None)
@given(st.lists(st.tuples(st.sampled_from(PATHS), TREES), max_size=4))
def test_a_valid_scene_with_values_replaced(changes):
    data = {
        "modal": {
            "dofs": ["u", "v"],
            "frequency": [1.0, 2.0],
            "damping": 0.1,
            "shapes": [[1.0, 0.5], [0.2, 1.0]],
        },
        "contact": [
            {
                "name": "shroud",
                "tangential": "u",
                "normal": {"v": 1.0},
                "mu": 0.4,
                "k_u": 1,
                "k_v": 1,
                "n_0": 1,
            }
        ],
        "force": [{"dof": "u", "amplitude": 1.0}],
        "response": {"frequency": [0.5, 1.5]},
        "sweep": {"contact.shroud.n_0": [1, 2]},
        "schedule": [{"cycles": 1, "frequency": 1}],
        "start": {"displacement": [0.0, 1.0]},
    }
    for (section, key), value in changes:
        table = data[section]
        (table[0] if isinstance(table, list) else table)[key] = value
    with contextlib.suppress(SceneError):
        assert isinstance(scene_from_dict(data), Scene)


OF_MATRICES = [
    ("structure", key) for key in ("dofs", "file", "mass", "stiffness", "damping", "modes", "flexibility")
]
OF_MATRICES += [("contact", key) for key in ("nodes", "areas", "tangential", "normal", "n_0", "gap", "name")]
OF_MATRICES += [("load", key) for key in ("dof", "file", "force")]
OF_MATRICES += [("base", key) for key in ("acceleration", "direction", "phase")]
OF_MATRICES += [("units", key) for key in ("length", "force")]
OF_MATRICES += [
    ("response", "output"),
    ("response", "frequency"),
    ("force", "proportional_to"),
    ("force", "phase"),
]
OF_MATRICES += [
    ("sweep", key) for key in ("paired", "contact.*.n_0", "contact.c.mu", "base.acceleration", "*.*")
]
LISTED = ("contact", "force", "load")


@pytest.mark.slow
@settings(max_examples=int(400 * SCALE), deadline=None)
@example([(("structure", "mass"), [0, 0, 0, 2.9e-270])])
@given(st.lists(st.tuples(st.sampled_from(OF_MATRICES), TREES), max_size=4))
def test_a_valid_scene_of_matrices_with_values_replaced(changes):
    data = {
        "structure": {
            "dofs": ["1x", "1y", "2x", "2y"],
            "stiffness": [[2.0, 0, -1, 0], [0, 3, 0, 0], [-1, 0, 2, 0], [0, 0, 0, 1]],
            "mass": [1.0, 1.0, 2.0, 2.0],
            "damping": {"mass": 0.1},
        },
        "contact": {"name": "c", "nodes": [[1, 2], [2]], "tangential": "x", "normal": {"y": 1.0}, "n_0": 1.0}
        | {"mu": 0.4, "k_u": 1, "k_v": 1},
        "force": {"dof": "1:x", "amplitude": 1.0, "phase": "90deg"},
        "load": {"dof": "2x", "force": 1.0},
        "base": {"acceleration": 1.0, "direction": "x"},
        "units": {"length": "m"},
        "response": {"frequency": [0.5, 1.5], "output": ["2*"]},
        "sweep": {"contact.c.n_0": [1, 2]},
    }
    for (section, key), value in changes:
        data[section][key] = value
    with contextlib.suppress(SceneError):
        assert isinstance(scene_from_dict({k: [v] if k in LISTED else v for k, v in data.items()}), Scene)
