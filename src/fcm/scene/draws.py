"""Random values of a swept number: normal, uniform, or from scipy.stats, with or without correlation.

Draws depend on the seed (default 0) and on the key. So two keys with one seed are independent, and a further
key does not change the draws of the others. Correlated keys use a Gaussian copula: each key's normal scores
are mapped to the quantiles of its own distribution.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from time import perf_counter
from typing import Any, NamedTuple
from zlib import crc32

import numpy as np

from fcm import resources
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.scene.errors import counted, kind, quoted
from fcm.scene.keys import names
from fcm.scene.number_text import number_in
from fcm.scene.options import LIMITS, TOLERANCES
from fcm.scene.rules import ANY, POSITIVE, as_float
from fcm.scene.section import Section

FORMS = ("normal", "uniform", "distribution")
OTHER_NAMES = {"gauss": "norm", "gaussian": "norm", "normal": "norm"}  # synonyms of names in scipy.stats


Quantile = Callable[[FloatArray], FloatArray]  # takes probabilities


class Draws(Frozen):
    """How random values of a key are drawn: its distribution, their count and seed."""

    key: str
    form: str  # one of FORMS
    pair: tuple[float, float]  # mean and deviation of "normal", ends of "uniform"
    quantile: Quantile | None  # of "distribution"
    count: int
    seed: int

    def _generator(self) -> np.random.Generator:
        return np.random.default_rng([self.seed, crc32(self.key.encode("utf-8", "replace"))])

    def values(self) -> FloatArray:
        """The draws (count,), independent of those of other keys."""
        generator, (low, high) = self._generator(), self.pair
        if self.form == "normal":
            return generator.normal(low, high, self.count)
        if self.form == "uniform":
            return generator.uniform(low, high, self.count)
        return self._quantiles(generator.random(self.count))

    def scores(self) -> FloatArray:
        """Standard normal draws, (count,)."""
        return self._generator().standard_normal(self.count)

    def at(self, scores: FloatArray) -> FloatArray:
        """The draws that belong to given normal scores."""
        from scipy.special import ndtr

        low, high = self.pair
        if self.form == "normal":
            return low + high * scores
        share: FloatArray = ndtr(scores)
        return low + (high - low) * share if self.form == "uniform" else self._quantiles(share)

    def seconds(self) -> float:
        """Estimated seconds of all draws, from timing a few; 0 for draws that take no time."""
        if self.quantile is None or self.count <= LIMITS.draws_timed:
            return 0.0
        begin = perf_counter()
        self._quantiles(np.linspace(0.05, 0.95, LIMITS.draws_timed))
        return (perf_counter() - begin) * self.count / LIMITS.draws_timed

    def _quantiles(self, probability: FloatArray) -> FloatArray:
        assert self.quantile is not None
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # a value that is not finite is reported later
            found: FloatArray = np.asarray(self.quantile(probability), dtype=np.float64)
        return found


def read_draws(table: Section, form: str, key: str, integer: Callable[..., int | None]) -> Draws | None:
    """Reads { normal = [..], count, seed }, or with uniform or distribution; None after a mistake."""
    before = table.mistakes.count
    pair, quantile = (0.0, 1.0), None
    if form == "distribution":
        quantile = _distribution(table)
    else:
        table.only(form, "count", "seed")
        pair = _pair(table, form)
    count, seed = integer(table, "count", 1), integer(table, "seed", 0, default=0)
    if table.mistakes.count > before or count is None or seed is None:
        return None
    found = Draws(key, form, pair, quantile, count, seed)
    seconds = found.seconds()
    long = f"{count} draws of this distribution take about {resources.duration(seconds)}"
    if seconds > LIMITS.draws_seconds:
        table.wrong(
            "count",
            f"{long}, {seconds / count:.2g} s each: give "
            f"{int(count * LIMITS.draws_seconds / seconds)} at most, or another distribution",
        )
        return None
    notices = table.mistakes.notices
    if seconds > notices.options.seconds_of_draws:
        notices.say(f"{table.path}: {long}")
    return found


def _pair(table: Section, form: str) -> tuple[float, float]:
    given = table.data[form]
    if form == "normal" and isinstance(given, list) and (fault := _deviation_in_percent(given)):
        table.wrong(f"{form}[1]", fault)
        return 0.0, 1.0
    pair = table.vector(form, ANY)
    words = "[mean, deviation]" if form == "normal" else "[low, high]"
    if pair is None:
        return 0.0, 1.0
    if len(pair) != 2:
        table.wrong(form, f"must be two numbers, {words}, is a list of {len(pair)}")
        return 0.0, 1.0
    if form == "normal" and pair[1] < 0:
        table.wrong(form, f"the deviation must be at least 0, is {pair[1]:g}")
    elif form == "uniform" and pair[1] < pair[0]:
        table.wrong(form, f"goes down: [{pair[0]:g}, {pair[1]:g}]; give the lower one first")
    return float(pair[0]), float(pair[1])


def _deviation_in_percent(pair: list[Any]) -> str:
    """Hint on a standard deviation given as a percentage of its mean; else ''.

    >>> _deviation_in_percent([5.0, "20 %"]), _deviation_in_percent([5.0, "20"])
    ('"20 %" is no number: the standard deviation is in the units of the key, as its mean is: write 1', '')
    """
    text = pair[1].strip() if len(pair) == 2 and isinstance(pair[1], str) else ""
    mean, percent = as_float(pair[0]), number_in(text[:-1].strip()) if text.endswith("%") else None
    if mean is None or percent is None:
        return ""
    return (
        f"{quoted(pair[1])} is no number: the standard deviation is in the units of the key, as its mean is: "
        f"write {abs(mean) * percent / 100.0:.12g}"
    )


def _distribution(table: Section) -> Quantile | None:
    """The quantile function of a distribution of scipy.stats with its parameters; None after a mistake."""
    name = table.text("distribution")
    if not name:
        if table.data.get("distribution") == "":
            table.wrong("distribution", 'is empty; name one of scipy.stats, such as "lognorm"')
        return None
    found = _family(name, table)
    if found is None:
        return None
    table.only(
        "distribution", *found.shapes, "loc", *(["scale"] if found.continuous else []), "count", "seed"
    )
    before = table.mistakes.count
    values = {word: table.number(word, ANY) for word in found.shapes}
    values["loc"] = table.number("loc", ANY, default=0.0)
    if found.continuous:
        values["scale"] = table.number("scale", POSITIVE, default=1.0)
    if table.mistakes.count > before:
        return None
    quantile = partial(found.quantile, **values)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        allowed = np.isfinite(quantile(0.5))
    if not allowed:
        given = ", ".join(f"{word} = {value:g}" for word, value in values.items())
        table.wrong("", f"{name} has no values with {given}")
        return None
    return quantile


class _Family(NamedTuple):
    """A family of distributions: names of its shape parameters, and its quantile function."""

    shapes: tuple[str, ...]
    continuous: bool
    quantile: Callable[..., FloatArray]


def _family(name: str, table: Section) -> _Family | None:
    """The family of a name in scipy.stats; None after a mistake.

    "lognorm" does without scipy.stats, whose import takes long.
    """
    if name == "lognorm":
        return _Family(("s",), True, _lognormal)
    from scipy import stats

    kinds = (stats.rv_continuous, stats.rv_discrete)
    found = getattr(stats, name, None) if name.isidentifier() else None
    if not isinstance(found, kinds):
        known = [word for word in dir(stats) if isinstance(getattr(stats, word), kinds)]
        meant = OTHER_NAMES.get(name.casefold(), name)
        table.wrong("distribution", f"there is no distribution {quoted(name)} in scipy.stats", meant, known)
        return None
    shapes = tuple(word.strip() for word in (found.shapes or "").split(",") if word.strip())
    return _Family(shapes, isinstance(found, stats.rv_continuous), found.ppf)


def _lognormal(probability: FloatArray | float, s: float, loc: float, scale: float) -> FloatArray:
    """loc + scale exp(s x), with x the standard normal score; as in scipy.stats, without its import.

    >>> _lognormal(0.5, 0.2, 0.0, 8.0).item()
    8.0
    """
    from scipy.special import ndtri

    found: FloatArray = np.exp(s * ndtri(probability)) * scale + loc
    return found if s > 0.0 else found * np.nan


class Correlation(Frozen):
    """Correlated keys, and the factor L of their correlation matrix L L^T."""

    keys: tuple[str, ...]
    factor: FloatArray

    def values(self, draws: Mapping[str, Draws]) -> dict[str, FloatArray]:
        """Random draws of the correlated keys."""
        scores = self.factor @ np.array([draws[key].scores() for key in self.keys])
        return {key: draws[key].at(own) for key, own in zip(self.keys, scores, strict=True)}


def read_correlation(section: Section) -> Correlation | None:
    """Reads [sweep.correlation]: keys, and the correlation matrix of their normal scores."""
    table = section.table("correlation", "")
    if table is None:
        return None
    table.only(*names("sweep.correlation"))
    keys, matrix = _keys(table), _matrix(table)
    if keys is None or matrix is None:
        return None
    if len(keys) != len(matrix):
        table.wrong("matrix", f"has {counted(len(matrix), 'row')}, but there are {len(keys)} keys")
        return None
    return Correlation(keys, _factor(matrix))


def _keys(table: Section) -> tuple[str, ...] | None:
    if table.missing("keys", 'a list of drawn keys, as in ["contact.shroud.mu", "contact.shroud.n_0"]'):
        return None
    value = table.data["keys"]
    if not isinstance(value, list | tuple) or not all(isinstance(key, str) for key in value):
        table.wrong("keys", f"must be a list of strings, is {kind(value)}")
        return None
    if len(value) < 2 or len(set(value)) < len(value):
        table.wrong("keys", "must be two keys or more, each once")
        return None
    return tuple(value)


def _matrix(table: Section) -> FloatArray | None:
    """A correlation matrix; None after a mistake."""
    if table.missing("matrix", "a list of rows, as in [[1, 0.5], [0.5, 1]]"):
        return None
    value = table.data["matrix"]
    if not isinstance(value, list | tuple | np.ndarray):
        table.wrong("matrix", f"must be a list of rows, is {kind(value)}")
        return None
    if len(value) == 0:
        table.wrong("matrix", "is empty; give a row for each key, as in [[1, 0.5], [0.5, 1]]")
        return None
    rows = [table.numbers(row, table.at(f"matrix[{i}]"), ANY) for i, row in enumerate(value)]
    good = [row for row in rows if row is not None]
    if len(good) < len(rows):
        return None
    if any(len(row) != len(rows) for row in good):
        table.wrong("matrix", f"must be square, is {_shape(good)}")
        return None
    matrix = np.array(good)
    if fault := _fault(matrix):
        table.wrong("matrix", fault)
        return None
    return matrix


def _shape(rows: Sequence[Any]) -> str:
    return f"{len(rows)} rows of {' and '.join(map(str, sorted({len(row) for row in rows})))}"


def _fault(matrix: FloatArray) -> str:
    """What is wrong with a square correlation matrix; empty if nothing is."""
    if (matrix.diagonal() != 1.0).any():
        return "must have 1 everywhere on its diagonal"
    if (matrix != matrix.T).any():
        i, j = np.argwhere(matrix != matrix.T)[0]
        return f"must be symmetric, but [{i}][{j}] is {matrix[i, j]:g} and [{j}][{i}] is {matrix[j, i]:g}"
    if (np.abs(matrix) > 1.0).any():
        return "must have numbers from -1 to 1"
    least = np.linalg.eigvalsh(matrix)[0]
    if least < -TOLERANCES.correlation * len(matrix):
        return (
            f"is no correlation matrix: it has the negative eigenvalue {least:.3g}, and needs all to be at "
            "least 0"
        )
    return ""


def _factor(matrix: FloatArray) -> FloatArray:
    """A factor L of the matrix L L^T; for a regular matrix lower triangular.

    The first key's normal scores are then the same as without correlation.
    """
    try:
        found: FloatArray = np.asarray(np.linalg.cholesky(matrix), dtype=np.float64)
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh(matrix)
        found = vectors * np.sqrt(np.maximum(values, 0.0))
    return found
