"""What a universal file holds, in words: for files without modes, and for their units."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from fcm.scene.errors import quoted

Dataset = tuple[str, list[str]]  # number, lines

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

    >>> contents([("151", [""]), ("15", [""]), ("15", [""])])
    'it holds 151 ×1: header; 15 ×2: nodes'
    """
    counts = Counter((kind[:6], _what(kind, block)) for kind, block in datasets)
    if not counts:
        return "it holds no dataset at all"
    return "it holds " + "; ".join(f"{kind} ×{count}: {what}" for (kind, what), count in counts.items())


def units(datasets: Iterable[Dataset]) -> list[str]:
    """A note on the units of a file, if it says them."""
    for kind, block in datasets:
        if kind == "164" and block and (name := block[0][10:30].strip()) and name.isprintable():
            return [f"modal: the units of the file are {quoted(name)}; the scene's must be the same"]
    return []


def _what(kind: str, block: Sequence[str]) -> str:
    """One dataset in words."""
    number = kind.rstrip("b")[:6].strip()
    if number.startswith("58"):
        return FUNCTIONS.get(_integer(block, 5, 0), "functions")
    line = {"55": 5, "2414": 8}.get(number)
    if line is None:
        return DATASETS.get(number, "of another kind")
    analysis = ANALYSES.get(_integer(block, line, 1), "of another analysis")
    result = RESULTS.get(_integer(block, line, 3), "values")
    where = "" if number == "55" or _integer(block, 2, 0) == 1 else ", not at nodes"
    return f"{analysis}, {result}{where}"


def _integer(block: Sequence[str], line: int, place: int) -> int:
    """An integer of a line; -1 where there is none."""
    words = block[line].split() if len(block) > line else []
    return int(words[place]) if len(words) > place and words[place].isdecimal() else -1
