"""The pictures of the gallery and of tutorials, drawn by the commands that stand there, and made small.

Each keeps what it was made of, as a checksum of commands and scenes. Of a scene of the gallery the processor
time of its commands is written on the page, as it is where np.sin takes 10 ns a value.

usage: python -m tests.guide.gallery [PICTURE...], as yang1998 or joint-mode; all of them by default
"""

from __future__ import annotations

import hashlib
import re
import resource
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo

import fcm

from ..benchmarks.unit import SINE, sine
from ..program import shell
from .pages import GUIDE, Block, blocks, files, links, read

GALLERY, JOINT = GUIDE / "gallery.md", GUIDE / "tutorials/bolted-joint.md"
SCENES = Path(fcm.__file__).parent / "scenes"
WIDTH, COLOURS = 560, 64  # pixels
MADE_OF = "Made of"  # of the texts in a picture
TIME = re.compile(r"^Time: ([\d.]+) s\.", re.M)


@dataclass(frozen=True)
class Drawn:
    """A section of a page, or a page, with the commands that draw its pictures."""

    page: Path
    heading: str  # nothing, of a page as a whole
    text: str
    pictures: tuple[Path, ...]

    @property
    def blocks(self) -> list[Block]:
        return [one for one in blocks(self.page) if not self.heading or one.heading == self.heading]

    @property
    def commands(self) -> list[str]:
        return [line for one in self.blocks if one.kind == "sh" for line in one.text.splitlines()]

    @property
    def made_of(self) -> str:
        """A checksum of the commands, of the files of the page, and of the bundled scenes that are named."""
        words = {word for line in self.commands for word in line.split()}
        scenes = [path for path in sorted(SCENES.glob("*.toml")) if path.stem in words]
        given = [*self.commands, *files(self.page).values(), *(read(path) for path in scenes)]
        return hashlib.sha256("\n".join(given).encode()).hexdigest()


def drawn() -> list[Drawn]:
    """The sections of the gallery, and the tutorial whose pictures are made so."""
    found = []
    for text in re.split(r"^(?=## )", read(GALLERY), flags=re.M)[1:]:
        heading = text.splitlines()[0].removeprefix("## ")
        pictures = re.findall(r"^!\[.*?\]\((.*?)\)$", text, re.M)
        found.append(Drawn(GALLERY, heading, text, tuple((GUIDE / file).resolve() for file in pictures)))
    pictures = [(JOINT.parent / file).resolve() for file, _ in links(JOINT) if file.endswith(".png")]
    return [*found, Drawn(JOINT, "", read(JOINT), tuple(pictures))]


def small(picture: Path, out: Path, made_of: str = "") -> None:
    """The picture with fewer pixels and colours: some ten kilobytes; and what it is made of."""
    texts = PngInfo()
    if made_of:
        texts.add_text(MADE_OF, made_of)
    with Image.open(picture) as image:
        height = round(image.height * WIDTH / image.width)
        fewer = image.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
        fewer.quantize(COLOURS).save(out, optimize=True, pnginfo=texts)


def made(one: Drawn) -> float:
    """Draw its pictures; the processor time [s] of its commands where np.sin takes 10 ns."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files(one.page).items():
            Path(folder, name).write_text(text, encoding="utf-8")
        before = processor_time()
        for command in one.commands:
            done = shell(command, folder)
            assert done.code == 0, done.err
        took = processor_time() - before
        for picture in one.pictures:
            small(Path(folder, picture.name), picture, one.made_of)
            print(picture)
    return took * 1e-6 * SINE / sine()


def processor_time() -> float:
    """Of the commands that were run [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(names: list[str]) -> None:
    for one in drawn():
        if names and not {picture.stem for picture in one.pictures} & set(names):
            continue
        took = made(one)
        if one.heading:
            told = TIME.sub(f"Time: {took:.1f} s.", one.text)
            GALLERY.write_text(read(GALLERY).replace(one.text, told), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
