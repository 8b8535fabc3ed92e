"""Pairs from two sets of nodes, as the page of contacts describes them: its scene, on a mesh of the test."""

import pytest
from PIL import Image

from ..program import shell
from ..scene.test_node_sets import deck, places
from .pages import GUIDE, blocks

HEADING = "Pairs from two sets of nodes"


def block(kind):
    (found,) = [
        one.text for one in blocks(GUIDE / "howto/contacts.md") if (one.kind, one.heading) == (kind, HEADING)
    ]
    return found


@pytest.mark.slow
def test_the_command_draws_the_pairs_of_the_scene(tmp_path):
    first, second = places(0.03)
    (tmp_path / "blade.inp").write_text(deck(first, second))
    dofs = [f"{node}{one}" for begin in (1, 101) for node in range(begin, begin + 12) for one in "xyz"]
    matrices = f"stiffness = {[1e6] * len(dofs)}\nmass = {[1.0] * len(dofs)}\ndamping = 0.01"
    (tmp_path / "model.toml").write_text(f"[structure]\ndofs = {dofs}\n{matrices}\n{block('toml')}")
    done = shell(block("sh"), tmp_path)
    assert done.code == 0, done.err
    assert 'contact "shroud": 12 pairs, 0.03 apart' in done.err
    with Image.open(tmp_path / "model-pairs.png") as picture:
        assert min(picture.size) > 200
