"""What the program says can be read: no sentence of its messages has more than 25 words."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

SOURCES = Path(__file__).parents[2] / "src/fcm"
MOST = 25
FORMS = re.compile(r"\{[^{}]*=[^{}]*\}")  # as { from = , to = }: what may be written, not words to be read


def texts(tree: ast.Module) -> Iterator[str]:
    """Strings that are no docstrings; what is filled in counts as one word."""
    inner, documentation = set(), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            inner |= {id(one) for one in ast.walk(node) if one is not node}
        if isinstance(node, ast.Expr):
            documentation.add(id(node.value))
    for node in ast.walk(tree):
        if id(node) in inner | documentation:
            continue
        if isinstance(node, ast.JoinedStr):
            yield "".join(one.value if isinstance(one, ast.Constant) else "X" for one in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def too_long(text: str) -> list[str]:
    """Its sentences of more words than that."""
    found = re.split(r"(?<=[.?!])\s+|\n", FORMS.sub("X", text))
    return [one for one in found if len(one.split()) > MOST]


def test_what_is_filled_in_and_what_can_be_written_count_as_one_word():
    (said,) = texts(ast.parse('"""Not this."""\nx = f"a {b:.2f} c"'))
    assert said == "a X c"
    assert (
        too_long("word " * 26)
        and not too_long("word " * 25)
        and not too_long("word " * 20 + ". " + "word " * 20)
    )
    assert not too_long("word " * 20 + "{ normal = [mean, deviation], count = } " * 5)


@pytest.mark.parametrize(
    "path", sorted(SOURCES.rglob("*.py")), ids=lambda path: str(path.relative_to(SOURCES))
)
def test_sentences_of_messages_are_short(path):
    assert [one for text in texts(ast.parse(path.read_text("utf-8"))) for one in too_long(text)] == []
