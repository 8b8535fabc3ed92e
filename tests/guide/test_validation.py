"""The pages of validation: tables and figures with their commands, and numbers that a run tells."""

import json
import re

import pytest

from ..program import called, python
from .pages import GUIDE, PAGES, ROOT, name_of, read, sentences

VALIDATION = sorted((GUIDE / "validation").glob("*.md"))
KINDS = {"#": "heading", "```sh": "command", "|": "table", "![": "figure"}
CAPTION = 2  # sentences


def parts(page):
    """Each part of a page between empty lines, with its kind."""
    for text in re.split(r"\n\s*\n", read(page).strip()):
        yield next((kind for sign, kind in KINDS.items() if text.startswith(sign)), "text"), text


@pytest.mark.parametrize("page", VALIDATION, ids=name_of)
def test_each_table_and_figure_stands_below_its_command(page):
    commands, shown = "", 0
    for kind, text in parts(page):
        if kind == "heading":
            commands = ""
        elif kind == "command":
            commands = text
        elif kind in ("table", "figure"):
            assert commands, text
            shown += 1
    assert shown > 2


@pytest.mark.parametrize("page", VALIDATION, ids=name_of)
def test_text_is_a_caption_below_a_table_or_figure(page):
    """But for what stands below the title."""
    kinds = ["", *(kind for kind, _ in parts(page))]
    for number, (kind, text) in enumerate(parts(page)):
        if kind == "text" and number > 1:
            assert kinds[number] in ("table", "figure"), text
            assert len(sentences(text)) <= CAPTION, text


@pytest.mark.slow
def test_tables_are_those_that_their_commands_print():
    """Of commands that take seconds."""
    for page, command in (
        ("accuracy", ("tests/response/exact_peaks.py",)),
        ("others-cases", ("-m", "tests.published")),
    ):
        done = python(*command, cwd=ROOT)
        assert done.code == 0, done.err
        tables = done.out.strip().split("\n\n")
        assert all(table in read(GUIDE / f"validation/{page}.md") for table in tables), done.out


def test_the_table_errs_by_far_less_than_the_harmonics_left_out():
    (claim,) = re.findall(r"moves no point by\s+more\s+than\s+(\S+)\s+of", "\n".join(map(read, PAGES)))
    curves = json.loads(called("respond", "yang1998", "--json").out)["curves"]
    table, harmonic = (max(curve[name] for curve in curves) for name in ("table_error", "truncation_error"))
    assert 0 < table < float(claim) and harmonic > 100 * table  # "by far the larger error"
