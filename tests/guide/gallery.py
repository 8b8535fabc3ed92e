"""The pictures of the gallery and of tutorials, drawn by the commands that stand there, and made small.

usage: python -m tests.guide.gallery
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from PIL import Image

from ..program import shell
from .pages import GUIDE, commands, files, links

PAGES = GUIDE / "gallery.md", GUIDE / "tutorials/bolted-joint.md"
WIDTH, COLOURS = 560, 64  # pixels


def small(picture: Path, out: Path) -> None:
    """The picture with fewer pixels and colours: some ten kilobytes."""
    with Image.open(picture) as image:
        height = round(image.height * WIDTH / image.width)
        fewer = image.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
        fewer.quantize(COLOURS).save(out, optimize=True)


def main() -> None:
    for page in PAGES:
        shown = {(page.parent / file).resolve() for file, _ in links(page) if file.endswith(".png")}
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files(page).items():
                Path(folder, name).write_text(text, encoding="utf-8")
            for command, _ in commands(page):
                done = shell(command, folder)
                assert done.code == 0, done.err
            for picture in shown:
                small(Path(folder, picture.name), picture)
                print(picture)


if __name__ == "__main__":
    main()
