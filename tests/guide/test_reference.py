"""The pages of reference are what the program says of itself today."""

import json
import re

import pytest

from fcm.scene.load import path_of

from ..program import called
from .pages import read
from .reference import DRAWS, FOLDER, OF_DRAWS, PAGES


@pytest.mark.slow
@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_what_is_generated(name):
    assert read(FOLDER / f"{name}.md") == PAGES[name](), f"{name}: make reference"


def test_the_keys_of_percentiles_are_those_that_are_printed(tmp_path):
    (tmp_path / "draws.toml").write_text(f"{path_of('yang1998-n5').read_text()}\n{DRAWS}")
    done = called("respond", tmp_path / "draws.toml", "--harmonics", 1, "--json")
    (found,) = json.loads(done.out)["scatter"]
    named = {
        key for row in re.findall(r"^\| (`.*?`) \|", OF_DRAWS, re.M) for key in re.findall("`(.*?)`", row)
    }
    of_peaks = {key.rpartition(".")[2] for key in named if key.startswith("peak.")}
    assert {key.partition(".")[0] for key in named} - {"blades"} == set(found)
    assert all(of_peaks == set(one) for one in found["peak"].values())
    assert {key for key in named if key.startswith("jumps.")} == {f"jumps.{one}" for one in found["jumps"]}
