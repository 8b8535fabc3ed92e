"""A scene small enough to be traced in every test."""

import pytest

SCENE = """
title = "one curve"
[modal]
dofs      = ["u", "v"]
frequency = [1.0, 10.0]
damping   = [0.05, 0.05]
shapes    = [[0.707, 0.707], [1.0, -0.5]]
[[contact]]
name       = "shroud"
tangential = "u"
normal     = "v"
mu  = 0.4
k_u = 1.0
k_v = 1.0
n_0 = 5.0
[[force]]
dof = "u"
amplitude = 1.0
[response]
frequency = [0.8, 1.6]
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path
