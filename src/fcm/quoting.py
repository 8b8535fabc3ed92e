"""Names in messages: in double quotes as in files, and several of them joined."""

from __future__ import annotations

import json
from collections.abc import Sequence


def quoted(text: str, longest: int = 60) -> str:
    """A text in double quotes, on one line, without control characters, shortened to a number of characters.

    >>> print(quoted("GRID"), quoted("a" * 9, 3))
    "GRID" "aaa..."
    """
    if len(text) > longest:
        text = text[:longest] + "..."
    return json.dumps(text, ensure_ascii=not text.isprintable())


def listed(names: Sequence[str]) -> str:
    """Names joined by commas and "and".

    >>> listed(["mu"]), listed(["mu", "k_u"]), listed(["mu", "k_u", "n_0"])
    ('mu', 'mu and k_u', 'mu, k_u and n_0')
    """
    *before, last = names
    return f"{', '.join(before)} and {last}" if before else last
