"""The page of messages has the words that the program says."""

import re

from .pages import GUIDE, ROOT, read

PAGE = GUIDE / "howto/messages.md"
SAID = re.sub(
    r"\s+",
    " ",
    re.sub(
        r'"\s*\n\s*f?"',
        "",
        "\n".join(path.read_text("utf-8") for path in sorted((ROOT / "src/fcm").rglob("*.py"))),
    ),
).lower()
SHORT = 3  # words: of fewer a part of a message is not looked for


def parts(cell):
    """The parts of a message between numbers, signs and alternatives."""
    return [
        part.strip() for part in re.split(r"[;,:`]|\b[XFG]\b|[\d.]+| or ", cell) if len(part.split()) >= SHORT
    ]


def test_messages_are_those_of_the_program():
    said = read(PAGE).partition("## Curves")[2]
    rows = re.findall(r"^\| (?!it says|---)(.*?) \|", said, re.M)
    missing = [part for row in rows for part in parts(row) if part.lower() not in SAID]
    assert len(rows) > 20 and missing == []
