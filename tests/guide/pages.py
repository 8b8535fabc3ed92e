"""The pages as their tests read them: fenced blocks, files, commands, headings, sentences.

A block after a paragraph that ends with "as `NAME`:" is a file. After "Replace `[TABLE]` of `FILE` by this,
and save it as `NAME`:" it is that file with another table. Commands stand in blocks of sh. A block of text
after one shows what its last command prints first, with a line `...` for lines that are left out.

usage: python -m tests.guide.pages [-v], which prints the median and the longest sentence and paragraph
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass
from pathlib import Path
from statistics import median

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
GUIDE = ROOT / ".github/guide"
PAGES = [README, *sorted(GUIDE.rglob("*.md"))]
OTHERS = [ROOT / ".github/CHANGELOG.md", ROOT / ".github/CONTRIBUTING.md"]
LONGEST_SENTENCE, LONGEST_PARAGRAPH = 24, 99  # words

FENCED = re.compile(r"^( *)```(\w*)\n(.*?)^\1```$", re.M | re.S)
NAMED = re.compile(r"as `([\w.-]+)`:\s*\Z")
REPLACED = re.compile(
    r"Replace `(\[\w+\])`\s+of\s+`([\w.-]+)`\s+by\s+this,\s+and\s+save\s+it\s+as\s+`\S+`:\s*\Z"
)
HEADING = re.compile(r"^#+ (.*)$", re.M)


def name_of(page: Path) -> str:
    return str(page.relative_to(ROOT))


def read(page: Path) -> str:
    return page.read_text(encoding="utf-8")


@dataclass(frozen=True)
class Block:
    """A fenced block: its kind, its text, the heading above, and its name if it is a file.

    A part of a file has the table that it replaces, and of which file.
    """

    kind: str
    text: str
    heading: str = ""
    file: str = ""
    replaces: tuple[str, str] | None = None


def blocks(page: Path) -> list[Block]:
    """The fenced blocks of a page, in their order."""
    text = read(page)
    found = []
    for match in FENCED.finditer(text):
        before = text[: match.start()]
        headings = HEADING.findall(FENCED.sub("", before))
        named, replaced = NAMED.search(before), REPLACED.search(before)
        file, replaces = named[1] if named else "", (replaced[1], replaced[2]) if replaced else None
        found.append(Block(match[2], match[3], headings[-1] if headings else "", file, replaces))
    return found


def files(page: Path) -> dict[str, str]:
    """The files that a reader of the page saves."""
    found: dict[str, str] = {}
    for block in blocks(page):
        if block.replaces:
            name, whole = block.replaces
            before, table, after = found[whole].partition(f"{name}\n")
            assert table, f"{whole} has no {name}"
            found[block.file] = before + block.text + "".join(re.findall(r"^\[.*", after, re.M | re.S))
        elif block.file:
            found[block.file] = block.text
    return found


def commands(page: Path, without: str = "") -> list[tuple[str, str | None]]:
    """Each command of a page, but for those below one heading, with the output that is shown of it."""
    found: list[tuple[str, str | None]] = []
    for block in blocks(page):
        if without and block.heading == without:
            continue
        if block.kind == "sh":
            lines = re.sub(r"\\\n\s*", "", block.text).splitlines()
            found += [(line, None) for line in lines if line and not line.startswith("#")]
        elif block.kind == "text" and not block.file and found:
            found[-1] = (found[-1][0], block.text)
    return found


def anchors(page: Path) -> set[str]:
    """What a link to a heading of the page may name."""
    text = FENCED.sub("", read(page))
    return {
        re.sub(r"[^\w -]", "", title).strip().lower().replace(" ", "-") for title in HEADING.findall(text)
    }


def links(page: Path) -> list[tuple[str, str]]:
    """The file and the heading of each link or picture; those of other sites are left out."""
    found = re.findall(r"\]\(([^)#\s]*)(?:#([^)]*))?\)", FENCED.sub("", read(page)))
    return [(file, heading) for file, heading in found if not file.startswith("http")]


def prose(page: Path, cells: bool = False) -> list[str]:
    """The headings, paragraphs and list items of a page, or the cells of its tables.

    Blocks of code, equations and sources are left out. A formula, a piece of code or a link counts as a word.
    """
    text = re.split(r"^## Sources$", FENCED.sub("\n\n", read(page)), flags=re.M)[0]
    text = re.sub(r"^\$\$.*?\$\$$", "\n\n", text, flags=re.M | re.S)
    text = re.sub(r"(?<=\n\n)(?:(?:    |\t).*\n)+", "", text)  # code by indentation
    text = re.sub(r"\$[^$\n]+\$|`[^`\n]+`", "X", text)
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"^(#+ .*)$", r"\n\1\n", text, flags=re.M)
    found = []
    for part in re.split(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )|\n(?=\|)", text):
        line = part.strip()
        if line.startswith("|") == cells and line:
            found += line.strip("|").split("|") if cells else [re.sub(r"^(?:[-*]|\d+\.|#+) ", "", line)]
    return [one.strip() for one in found if re.search(r"\w", one)]


def sentences(paragraph: str) -> list[str]:
    """Its sentences, without the signs of emphasis."""
    text = paragraph.replace("**", "").replace("*", "")
    return [one for one in re.split(r"(?<=[.!?])\s+(?=[A-Z0-9(])", text) if re.search(r"\w", one)]


def words(text: str) -> int:
    return len(re.findall(r"[^\s–—·|]*\w[^\s–—·|]*", text))


def too_long(page: Path) -> list[str]:
    """Its sentences, cells and paragraphs that are longer than they may be."""
    texts = prose(page)
    found = [one for text in [*texts, *prose(page, True)] for one in sentences(text)]
    return [one for one in found if words(one) > LONGEST_SENTENCE] + [
        text for text in texts if words(text) > LONGEST_PARAGRAPH
    ]


def main() -> None:
    for page in [*PAGES, *OTHERS]:
        texts = prose(page)
        of_sentences = [words(one) for text in texts for one in sentences(text)]
        of_paragraphs = [words(text) for text in texts]
        print(
            f"{name_of(page):55} sentences: median {median(of_sentences):4.1f}, longest {max(of_sentences):3}"
            f"   paragraphs: median {median(of_paragraphs):4.1f}, longest {max(of_paragraphs):3}"
        )
        for text in too_long(page) if "-v" in sys.argv else []:
            print(f"    {words(text)}: {text}")


if __name__ == "__main__":
    main()
