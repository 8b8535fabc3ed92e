"""The pages of reference are what the program says of itself today."""

import pytest

from .pages import read
from .reference import FOLDER, PAGES


@pytest.mark.slow
@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_what_is_generated(name):
    assert read(FOLDER / f"{name}.md") == PAGES[name](), f"{name}: make reference"
