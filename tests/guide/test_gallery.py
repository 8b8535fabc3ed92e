"""The gallery is whole, and its pictures are of the scenes and commands that stand there today.

What the commands print is compared where all commands of the guide are run.
"""

import pytest
from PIL import Image

from .gallery import GALLERY, MADE_OF, TIME, drawn
from .pages import sentences

SECTIONS = drawn()
TWELVE = [one for one in SECTIONS if one.page == GALLERY]


def test_there_are_twelve():
    assert len({one.heading for one in TWELVE}) == 12


@pytest.mark.parametrize("one", TWELVE, ids=lambda one: one.heading)
def test_a_scene_has_a_picture_commands_output_its_time_and_what_to_see(one):
    (picture,) = one.pictures
    assert picture.is_file()
    assert any(line.startswith("fcm respond ") for line in one.commands)
    assert any(f" -o {picture.name}" in line for line in one.commands)
    assert any(block.kind == "text" for block in one.blocks)
    (time,) = TIME.findall(one.text)
    assert float(time) > 0.0
    assert len(sentences(one.text[one.text.index("Time: ") :])) >= 2


@pytest.mark.parametrize("one", SECTIONS, ids=lambda one: one.heading or one.page.stem)
def test_a_picture_is_of_what_stands_on_its_page(one):
    for picture in one.pictures:
        with Image.open(picture) as image:
            assert image.text[MADE_OF] == one.made_of, f"python -m tests.guide.gallery {picture.stem}"
