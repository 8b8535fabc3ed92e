"""Where a comment or a page names a file of the project, there is one."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NAMED = re.compile(r"\b((?:tests|src|tables)/[\w./-]+\.(?:py|pxd|md|toml|csv|json))\b")
FILES = [
    path
    for folder in ("src/fcm", "tests", ".github")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in {".py", ".pxd", ".md"} and "build" not in path.parts
]


@pytest.mark.parametrize("folder", sorted({str(path.parent.relative_to(ROOT)) for path in FILES}))
def test_files_that_are_named_exist(folder):
    here = (path for path in FILES if path.parent == ROOT / folder)
    named = {name for path in here for name in NAMED.findall(path.read_text(encoding="utf-8"))}
    lacking = {name for name in named if "NAME" not in name and not (ROOT / name).exists()}
    assert not lacking
