"""Text in messages, in double quotes as in files."""

from __future__ import annotations

import json


def quoted(text: str, longest: int = 60) -> str:
    """A text in double quotes, on one line, without control characters, shortened to a number of characters.

    >>> print(quoted("GRID"), quoted("a" * 9, 3))
    "GRID" "aaa..."
    """
    if len(text) > longest:
        text = text[:longest] + "..."
    return json.dumps(text, ensure_ascii=not text.isprintable())
