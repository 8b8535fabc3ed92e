"""A small valid scene, as text and as a dict, for tests to break."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Callable
from typing import Any

import pytest

from fcm.scene import SceneError, scene_from_dict

VALID = """
title = "a test"
[modal]
dofs      = ["u", "v", "w.x"]
mass      = [1.0, 2.0]
frequency = [1.0, 10.0]
damping   = [0.01, 0.02]
shapes    = [[0.7, 0.7, 0.1], [1.0, -0.5, 0.2]]
[[contact]]
name       = "shroud"
tangential = "u"
normal     = { v = 1.0, "w.x" = -0.5 }
mu  = 0.4
k_u = 1.0
k_v = 2.0
n_0 = 5.0
[[contact]]
name       = "damper"
tangential = "w.x"
normal     = "v"
mu  = 0.3
k_u = 1.5
k_v = 2.5
gap = 3.0
[[force]]
dof = "u"
amplitude = 1.0
[[force]]
dof = { u = 1.0, v = -1.0 }
amplitude = 2.0
phase = 0.5
[response]
frequency = [0.7, 1.7]
[sweep]
"contact.shroud.n_0" = [5, 2, -1]
[[schedule]]
frequency = 1.2
cycles = 10
"""

Mistakes = Callable[[dict[str, Any]], str]


@pytest.fixture
def text() -> str:
    return VALID


@pytest.fixture
def data() -> dict[str, Any]:
    """The valid scene's dict, to be changed at will."""
    return copy.deepcopy(tomllib.loads(VALID))


@pytest.fixture
def mistakes() -> Mistakes:
    """Reads a dict that must be refused, and gives the message."""

    def read(data: dict[str, Any]) -> str:
        with pytest.raises(SceneError) as caught:
            scene_from_dict(data, "test.toml")
        return str(caught.value)

    return read
