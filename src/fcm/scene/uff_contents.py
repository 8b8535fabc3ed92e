"""What a universal file holds, in words: for files without modes, and for their units."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from fcm.scene.errors import quoted
from fcm.scene.uff_datasets import Dataset

DATASETS = {
    "15": "nodes", "18": "coordinate systems", "55": "data at nodes", "56": "data at elements",
    "57": "data at nodes on elements", "58": "functions", "82": "trace lines", "151": "header",
    "164": "units", "781": "nodes", "1858": "qualifiers of functions", "2400": "model header",
    "2411": "nodes", "2412": "elements", "2414": "analysis data", "2420": "coordinate systems",
    "2467": "groups", "2477": "groups",
}  # fmt: skip
ANALYSES = {
    0: "of an unknown analysis", 1: "static", 2: "normal modes", 3: "complex modes", 4: "transient",
    5: "frequency responses", 6: "buckling", 7: "complex modes", 9: "static, non-linear",
}  # fmt: skip
RESULTS = {2: "stress", 3: "strain", 5: "temperature", 8: "displacement", 9: "reaction force"}
FUNCTIONS = {
    0: "functions", 1: "time responses", 2: "auto spectra", 3: "cross spectra",
    4: "frequency response functions", 5: "transmissibilities", 6: "coherences", 9: "power spectra",
}  # fmt: skip


def contents(datasets: Iterable[Dataset]) -> str:
    """What the datasets are, those of a kind together.

    >>> contents([Dataset("151", (), 3), Dataset("15", (), 6), Dataset("15", (), 9)])
    'it holds 151 ×1: header; 15 ×2: nodes'
    """
    counts = Counter((one.kind[:6], _what(one)) for one in datasets)
    if not counts:
        return "it holds no dataset at all"
    return "it holds " + "; ".join(f"{kind} ×{count}: {what}" for (kind, what), count in counts.items())


def units(datasets: Iterable[Dataset]) -> list[str]:
    """A note on the units of a file, if it says them."""
    for one in datasets:
        name = one.lines[0][10:30].strip() if one.kind == "164" and one.lines else ""
        if name and name.isprintable():
            return [f"modal: the units of the file are {quoted(name)}; the scene's must be the same"]
    return []


def _what(one: Dataset) -> str:
    """One dataset in words."""
    number = one.kind.rstrip("b")[:6].strip()
    if number == "58":
        return FUNCTIONS.get(_first(one, 5), "functions")
    if number not in ("55", "2414") or one.kind.endswith("b"):
        return DATASETS.get(number, "of another kind")
    definition = [*one.integers(one.definition()), -1, -1, -1, -1]
    analysis = ANALYSES.get(definition[1], "of another analysis")
    result = RESULTS.get(definition[3], "values")
    where = "" if number == "55" or one.at_nodes() else ", not at nodes"
    return f"{analysis}, {result}{where}"


def _first(one: Dataset, line: int) -> int:
    """The whole number that a line begins with; -1 where there is none."""
    word = (one.lines[line].split() if len(one.lines) > line else [])[:1]
    return int(word[0]) if word and re.fullmatch(r"\d{1,9}", word[0], re.ASCII) else -1
