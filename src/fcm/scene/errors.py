"""Every mistake of a scene, collected and reported at once."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from fcm import quoting
from fcm.scene.options import MESSAGES
from fcm.scene.size_notices import SizeNotices

_NUMBER = re.compile(r"[0-9]{1,18}")  # number of a node, at the beginning of a name


class SceneError(ValueError):
    """Raised for a faulty scene: its file or name, then one line for each mistake.

    >>> print(SceneError("fan.toml", ["modal.mass[0]: must be greater than 0, is -1"]))
    fan.toml: modal.mass[0]: must be greater than 0, is -1
    """

    def __init__(self, source: str, mistakes: Iterable[str], count: int | None = None) -> None:
        self.source = source if source.isprintable() else quoted(source)
        self.mistakes = tuple(mistakes)
        self.count = len(self.mistakes) if count is None else count
        super().__init__(self._message())

    def _message(self) -> str:
        if self.count == 1:
            return f"{self.source}: {self.mistakes[0]}"
        more = self.count - len(self.mistakes)
        lines = [f"{self.source}: {self.count} mistakes", *self.mistakes]
        return "\n  ".join([*lines, f"... and {more} more"] if more else lines)


class Mistakes:
    """Collects mistakes while a scene is read.

    >>> mistakes = Mistakes("fan.toml")
    >>> mistakes.add("contact[0].ku", "unknown key", "ku", ["mu", "k_u", "k_v"])
    >>> mistakes.raise_if_any()
    Traceback (most recent call last):
    fcm.scene.errors.SceneError: fan.toml: contact[0].ku: unknown key; did you mean "k_u"?
    """

    def __init__(self, source: str, notices: SizeNotices | None = None) -> None:
        """Starts the list of mistakes of a file; `notices` announces what takes long to read."""
        self.source = source
        self.notices = notices or SizeNotices()
        self.count = 0
        self._lines: list[str] = []

    def add(self, where: str, what: str, word: str = "", among: Iterable[str] = ()) -> None:
        """Note that `what` is wrong at the key path `where`; `word` may be a misspelling of one `among`."""
        self.count += 1
        if len(self._lines) < MESSAGES.mistakes:
            text = what + suggestion(word, among)
            self._lines.append(f"{where}: {text}" if where else text)

    def raise_if_any(self) -> None:
        """Raise a SceneError with every mistake so far."""
        if self.count:
            raise SceneError(self.source, self._lines, self.count)


def suggestion(word: str, among: Iterable[str]) -> str:
    """``; did you mean "..."?`` with the closest name, or nothing when none is close.

    >>> suggestion("frequncy", ["frequency", "damping"])
    '; did you mean "frequency"?'
    """
    close = nearest(word, among)
    return f"; did you mean {quoted(close)}?" if close else ""


def nearest(word: str, among: Iterable[str]) -> str:
    """The name closest to a misspelt word; empty when none is close. Nodes are compared by number.

    >>> nearest("frequncy", ["frequency", "damping"]), nearest("x", ["frequency"])
    ('frequency', '')
    >>> nearest("21x", ["2x", "20x", "20y"]), nearest("4000x", ["837x", "20y"])
    ('20x', '')
    """
    if not word or len(word) > MESSAGES.longest_value:
        return ""
    names = {name.casefold(): name for name, _ in zip(among, range(MESSAGES.names_compared), strict=False)}
    from difflib import get_close_matches

    if beside := _of_nearest_number(word, names):
        return names[get_close_matches(word.casefold(), beside, n=1, cutoff=0.0)[0]]
    close = get_close_matches(word.casefold(), names, n=1)
    return names[close[0]] if close else ""


def _of_nearest_number(word: str, among: Iterable[str]) -> list[str]:
    """Names that begin with the number nearest to that of a word; none if no number is near enough."""
    if not (wanted := _NUMBER.match(word)):
        return []
    numbers = {name: int(match[0]) for name in among if (match := _NUMBER.match(name))}
    away = {name: abs(number - int(wanted[0])) for name, number in numbers.items()}
    least = min(away.values(), default=0)
    return [name for name in away if away[name] == least <= MESSAGES.nearest_number]


def counted(count: int, what: str) -> str:
    """A number with its noun, in the plural if needed.

    >>> counted(1, "mode"), counted(2, "mode")
    ('1 mode', '2 modes')
    """
    return f"{count} {what}{'' if count == 1 else 's'}"


def choices(names: Iterable[str], most: int = 12) -> str:
    """The names in quotes, separated by commas; the rest are counted.

    >>> choices(["u", "v", "w"], most=2)
    '"u", "v", ... (3 in all)'
    """
    listed = list(names)
    rest = f", ... ({len(listed)} in all)" if len(listed) > most else ""
    return ", ".join(quoted(name) for name in listed[:most]) + rest


def quoted(text: object, longest: int = MESSAGES.longest_value) -> str:
    """Text in double quotes, on one line, without control characters and not too long."""
    return quoting.quoted(text if isinstance(text, str) else shown(text), longest)


def several(names: Sequence[str], most: int = MESSAGES.groups) -> str:
    """Names in a sentence, quoted: the first of very many, and how many others there are.

    >>> several(["a"]), several(["a", "b"]), several(["a", "b", "c", "d", "e"])
    ('"a"', '"a" and "b"', '"a", "b", "c" and 2 others')
    """
    shown = [quoted(name) for name in names[:most]]
    others = len(names) - len(shown)
    last = counted(others, "other") if others else shown.pop()
    return " and ".join(filter(None, (", ".join(shown), last)))


def bare(key: object) -> str:
    """A key as a path shows it: in quotes when it is not a plain word."""
    word = str(key)
    return word if word.isidentifier() and len(word) <= MESSAGES.longest_value else quoted(word)


def shown(value: object) -> str:
    """A value as a message shows it: short, and on one line.

    >>> shown(True), shown(-1.0), shown("x"), shown(1 << 5000)
    ('true', '-1', '"x"', 'an integer of 5001 bits')
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, int):
        return str(value) if value.bit_length() < 200 else f"an integer of {value.bit_length()} bits"
    if isinstance(value, float):
        return f"{value:.12g}"
    return kind(value)


def kind(value: object) -> str:
    """Kind of a value in the words of a scene file: a table, a list, a string, ...

    >>> kind({}), kind([1, 2]), kind(None)
    ('a table', 'a list of 2', 'a NoneType')
    """
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}" if value else "an empty list"
    names = {bool: "true or false", str: "a string", int: "an integer", float: "a number"}
    return names.get(type(value), f"a {type(value).__name__}")
