"""The pictures of the gallery, drawn by the commands that stand there, and made small.

usage: python -m tests.guide.gallery
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

from PIL import Image

from ..program import shell
from .pages import GUIDE, commands

PAGE, FOLDER = GUIDE / "gallery.md", GUIDE / "figures/gallery"
WIDTH, COLOURS = 560, 64  # pixels


def small(picture: Path, out: Path) -> None:
    """The picture with fewer pixels and colours: some ten kilobytes."""
    with Image.open(picture) as image:
        height = round(image.height * WIDTH / image.width)
        fewer = image.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
        fewer.quantize(COLOURS).save(out, optimize=True)


def main() -> None:
    FOLDER.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for command, _ in commands(PAGE):
            done = shell(command, folder)
            assert done.code == 0, done.err
            for name in re.findall(r"-o (\S+\.png)", command):
                small(Path(folder, name), FOLDER / name)
                print(FOLDER / name)


if __name__ == "__main__":
    main()
