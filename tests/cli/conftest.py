"""A scene small enough to be traced in every test."""

import pytest

from ..oscillator import oscillator

SCENE = 'title = "one curve"' + oscillator("[response]\nfrequency = [0.8, 1.6]\n", damping=0.05)


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path
