"""Finds syntax mistakes in a TOML file: in which line, and what to write there.

Remedies are tried one by one. A remedy is reported only if the parser reads further with it, so that the
suggestion is valid TOML. The search then continues with the remedy applied, until the file is read or no
remedy helps.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import pi

from fcm.frozen import Frozen
from fcm.scene.errors import quoted
from fcm.scene.keys import LISTS
from fcm.scene.names import at_node
from fcm.scene.options import TOML

_AT = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")
_ASIDE = re.compile(
    r'"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'|#.*'
)  # strings and comments, which remedies leave alone
_QUOTES = dict.fromkeys(map(ord, "“”„‟«»″"), '"') | dict.fromkeys(map(ord, "‘’‚‛‹›′"), "'")
_SIGNS = {0x2212: "-", 0x2013: "-", 0x2014: "-", 0xFF0C: ",", 0xFF1D: "=", 0x066B: "."}
_BLANKS = dict.fromkeys([0xA0, 0x2007, 0x2009, 0x202F, 0x3000], " ") | dict.fromkeys([0xFEFF, 0x200B], "")
_WORDS = {"True": "true", "TRUE": "true", "False": "false", "FALSE": "false", "yes": "true", "no": "false",
          "on": "true", "off": "false", "Inf": "inf", "Infinity": "inf", "infinity": "inf",
          "NaN": "nan"}  # fmt: skip
_NOTHING = ("None", "null", "nil")  # not turned into strings: a key without a value should be left out
_KEY = r'(?:[\w-]+|"[^"]*")(?:\s*\.\s*(?:[\w-]+|"[^"]*"))*'
_ODD_KEY = r"""^(\s*)([^\s"'=\[{][^"'=\[{]*?)\s*="""
_VALUE = re.compile(r"([=\[,]\s*)([A-Za-z_0-9][\w:.*/\\ -]*?)(?=\s*(?:[,\]}#]|$))")
_NEARLY = re.compile(
    r"\d+(?:\.\d+)?[eE][-+]?(?:\d+\.\d+)?"
)  # a number with an incomplete or fractional exponent, which has no obvious remedy
_OF_BASE = re.compile(r"(?<![\w.])0([xXoObB])(\w+)")
_BASES = {"x": (16, "0123456789abcdef"), "o": (8, "01234567"), "b": (2, "01")}
_THOUSANDS = r"(?<=\d),(?=\d{3}(?:,\d{3})*\.\d)|(?<=\d),(?=\d{3},\d{3}\b)|(?<=\d,\d{3}),(?=\d{3}\b)"
_PI = re.compile("pi|π")
_EXPONENT = re.compile(r"[eEdDqQ]\d*")  # an exponent, not a unit
_CALCULATED = re.compile(
    r"([=\[,]\s*)([-+]?\d+(?:\.\d*)?|[-+]?pi|[-+]?π)\s*(/|\*\*?|\^)\s*([-+]?\d+(?:\.\d*)?|pi|π)(?=\s*(?:[,\]}]|$))"
)
_NUMBER = re.compile(r"[-+]?\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?")

Remedy = Callable[[str], str]  # takes a line; returns the corrected line, or the same


class _Fault(Frozen):
    """Place and reason of the failure of the TOML parser."""

    line: int | None  # from 0; None at the end of the document
    column: int
    why: str


def slips(text: str) -> list[str]:
    """Sentences on the mistakes in a text that is not TOML; empty for valid TOML.

    >>> slips("mu = .3\\nname = shroud")
    ['line 1, mu = .3: a number begins with a digit: write mu = 0.3', 'line 2, name = shroud: a word needs quotes: write name = "shroud"']
    """  # noqa: E501
    lines, said = text.replace("\r\n", "\n").split("\n"), list[str]()
    slip: _Slip | None = None
    tries = iter(range(TOML.most_read // max(len(text), 1)))
    while (fault := _fault(lines)) and len(said) < TOML.most_slips:
        found: tuple[_Slip | str, list[str]] | None = _twice(lines, fault) or _wrong_digit(lines, fault)
        found = found or _mended(lines, fault, tries)
        if found is None:
            said.append(_unmended(lines, fault))
            break
        one, lines = found
        if isinstance(one, _Slip) and slip is not None and slip.line == one.line and slip.new == one.old:
            one, said = replace(one, why=f"{slip.why}, {one.why}", old=slip.old), said[:-1]
        slip = one if isinstance(one, _Slip) else None
        said.append(str(one))
    return said


class _Slip(Frozen):
    """A mistake in a line (counted from 0): its reason, the line as it is, and as it should be."""

    line: int
    why: str
    old: str
    new: str

    def __str__(self) -> str:
        old, new = self.old, self.new
        if max(len(old.strip()), len(new.strip())) > TOML.longest_line:
            old, new = _changed(old, new)
        written = " and ".join(_plain(line) for line in new.split("\n"))
        return f"line {self.line + 1}, {_plain(old)}: {self.why}: write {written}"


def _fault(lines: list[str]) -> _Fault | None:
    try:
        tomllib.loads("\n".join([*lines, ""]))
    except tomllib.TOMLDecodeError as error:
        why = str(error)
        if (match := _AT.search(why)) and match[1]:
            return _Fault(int(match[1]) - 1, int(match[2]), why[: match.start()])
        return _Fault(None, 0, why[: match.start()] if match else why)
    except (RecursionError, ValueError):  # from a number or a date that a remedy produced
        return _Fault(0, 0, "")
    return None


def _mended(lines: list[str], fault: _Fault, tries: Iterator[int]) -> tuple[_Slip, list[str]] | None:
    """A mistake, and the lines with its remedy; None if no remedy helps."""
    last = min(len(lines) - 1 if fault.line is None else fault.line, len(lines) - 1)
    before = [at for at in range(last, -1, -1) if lines[at].strip()][: TOML.lines_before + 1]
    before = [at for at in before if len(lines[at]) <= TOML.longest_mended]
    for at in before:
        for why, remedy in _REMEDIES:
            line = remedy(lines[at])
            if line == lines[at] or next(tries, None) is None:
                continue
            others = [*lines[:at], *line.split("\n"), *lines[at + 1 :]]
            if _further(others, _fault(others), lines, fault):
                return _Slip(at, why, lines[at], line), others
    return None


def _further(lines: list[str], fault: _Fault | None, before: list[str], first: _Fault) -> bool:
    """Whether the parser reads further with a remedy: less of the text is left."""
    if fault is None:
        return True
    if fault.line is None or first.line is None:
        return first.line is None and fault.line is not None
    return _left(lines, fault.line, fault.column) < _left(before, first.line, first.column)


def _left(lines: list[str], line: int, column: int) -> tuple[int, int]:
    return len(lines) - line, (len(lines[line]) if line < len(lines) else 0) - column


def _changed(old: str, new: str) -> tuple[str, str]:
    """The parts in which two lines differ, extended to whole words."""
    begin = next(
        (i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), min(len(old), len(new))
    )
    begin = max((old.rfind(mark, 0, begin) for mark in " ,[{="), default=-1) + 1
    ends = zip(reversed(old[begin:]), reversed(new[begin:]), strict=False)
    same = next((i for i, (a, b) in enumerate(ends) if a != b), 0)
    return old[begin : len(old) - same][: TOML.longest_line], new[begin : len(new) - same][
        : TOML.longest_line
    ]


def _plain(line: str) -> str:
    """A line as shown in a message: shortened and printable."""
    line = line.strip()
    short = line if len(line) <= TOML.longest_line else f"{line[: TOML.longest_line]}..."
    return short if short.isprintable() else quoted(short, TOML.longest_line + 3)


def _unmended(lines: list[str], fault: _Fault) -> str:
    """Sentence on a fault for which no remedy helps."""
    what = next((said for word, said in _REASONS.items() if word in fault.why), "it is not TOML")
    if fault.line is None:
        return f"at its end: {what}"
    line = lines[fault.line] if fault.line < len(lines) else ""
    return f"line {fault.line + 1}, {_plain(line)}: {what} (column {fault.column})"


def _twice(lines: list[str], fault: _Fault) -> tuple[str, list[str]] | None:
    """Sentence on a repeated table or key, and the lines without it; None for another fault."""
    if not any(word in fault.why for word in ("twice", "overwrite", "mutate", "Duplicate")):
        return None
    at = min(fault.line if fault.line is not None else len(lines) - 1, len(lines) - 1)
    at = next((i for i in range(at, -1, -1) if lines[i].strip()), at)
    line = lines[at].strip()
    name = line.strip("[] \t")
    others = [*lines[:at], f"# {lines[at]}", *lines[at + 1 :]]
    if line.startswith("["):
        same = [
            i for i in range(at) if lines[i].strip().startswith("[") and lines[i].strip().strip("[] ") == name
        ]
        place = f": it is in line {same[0] + 1} already" if same else ""
        if name in LISTS:
            right = [f"[[{name}]]" if i in (at, *same) else one for i, one in enumerate(lines)]
            said = f"there may be several of them{place}: write [[{name}]] each time"
            return f"line {at + 1}, {_plain(line)}: {said}", right
        header = next((i for i in range(at + 1, len(lines)) if lines[i].strip().startswith("[")), len(lines))
        others = [*lines[:at], *(f"# {one}" for one in lines[at:header]), *lines[header:]]
        return (
            f"line {at + 1}, {_plain(line)}: the table is there twice{place}: put its keys together",
            others,
        )
    key = line.partition("=")[0].strip()
    table = next((i for i in range(at - 1, -1, -1) if lines[i].lstrip().startswith("[")), -1)
    same = [i for i in range(table + 1, at) if lines[i].partition("=")[0].strip() == key]
    place = f"it is in line {same[0] + 1} already" if same else "it is there already"
    said = f"the key {_plain(key)} is there twice: {place}: leave one out"
    if "Duplicate" in fault.why:
        said = "a key is there twice within { }: leave one out, and put a name with a dot in quotes"
    return f"line {at + 1}, {_plain(line)}: {said}", others


def _wrong_digit(lines: list[str], fault: _Fault) -> tuple[str, list[str]] | None:
    """Sentence on a hexadecimal, octal or binary number with an invalid digit, and the lines with 0 instead.

    None for another fault.
    """
    at = min(fault.line if fault.line is not None else len(lines) - 1, len(lines) - 1)
    line, said = lines[at], list[str]()

    def mend(match: re.Match[str]) -> str:
        base, digits = _BASES[match[1].lower()]
        wrong = next((one for one in match[2] if one.lower() not in f"{digits}_"), "")
        if not wrong:
            return f"0{match[1].lower()}{match[2]}"
        said.append(
            f"{match[0]} begins with 0{match[1]} as a number to the base {base}, and {quoted(wrong)} is no "
            "digit of it: write a decimal number"
        )
        return "0"

    new = _outside(lambda part: _OF_BASE.sub(mend, part))(line)
    if not said:
        return None
    return f"line {at + 1}, {_plain(line)}: {'; '.join(said)}", [*lines[:at], new, *lines[at + 1 :]]


def _outside(mend: Remedy) -> Remedy:
    """A remedy applied to a line except its strings and comments."""

    def remedy(line: str) -> str:
        parts, end = [], 0
        for aside in _ASIDE.finditer(line):
            parts += [mend(line[end : aside.start()]), aside[0]]
            end = aside.end()
        return "".join([*parts, mend(line[end:])])

    return remedy


def _code(line: str) -> tuple[str, str]:
    """A line without its comment, and the comment."""
    comment = next((one.start() for one in _ASIDE.finditer(line) if one[0].startswith("#")), len(line))
    code = line[:comment].rstrip()
    return code, line[len(code) :]


def _substituted(pattern: str, by: str) -> Remedy:
    found = re.compile(pattern)
    return _outside(lambda part: found.sub(by, part))


def _of_code(pattern: str, by: str) -> Remedy:
    """Remedy that replaces a pattern in a line, apart from its comment."""
    found = re.compile(pattern)

    def remedy(line: str) -> str:
        code, comment = _code(line)
        return found.sub(by, code) + comment

    return remedy


def _translated(table: dict[int, str]) -> Remedy:
    return lambda line: line.translate(table)


def _header(line: str) -> str:
    """Corrects the header of a table: [name], or [[name]] for a list of tables."""
    code, comment = _code(line)
    match = re.fullmatch(rf"\s*\[*\s*({_KEY})\s*\]*", code)
    if not match or not (code.lstrip().startswith("[") or code.endswith("]")):
        return line
    return (f"[[{match[1]}]]" if match[1] in LISTS else f"[{match[1]}]") + comment


def _decimal_commas(line: str) -> str:
    """Replaces decimal commas: in a number after "=", or in a list with separators other than bare commas."""

    def mend(part: str) -> str:
        return re.sub(r"(?<![\w.,])([-+]?\d+),(\d+(?:[eE][-+]?\d+)?)(?![\w.])", r"\1.\2", part)

    return _outside(lambda part: re.sub(r"\s*;\s*", ", ", mend(part)))(line)


def _in_small(part: str) -> str:
    """Replaces words such as True, yes or Infinity by the words of TOML."""
    return _VALUE.sub(lambda match: match[1] + _WORDS.get(match[2].rstrip(), match[2]), part)


def _value_of_word(match: re.Match[str]) -> str:
    """Replaces a word by a string, unless it is a value of TOML or resembles a number."""
    before, word = match[1], match[2].rstrip()
    if word in ("true", "false", "inf", "nan", *_NOTHING) or all(map(_NUMBER.fullmatch, word.split())):
        return match[0]
    if _NEARLY.fullmatch(word):
        return match[0]
    return before + (f"'{word}'" if "\\" in word else f'"{word}"')


def _deviation(line: str) -> str:
    """Replaces a standard deviation in percent of the mean by its value; the mean may be in percent of 1."""

    def mend(match: re.Match[str]) -> str:
        mean, percent = float(match[2]) / (100.0 if match[3] else 1.0), float(match[4])
        return f"{match[1]}{mean:.12g}, {abs(mean) * percent / 100.0:.12g}"

    return _outside(
        lambda part: re.sub(
            rf"(normal\s*=\s*\[\s*)({_NUMBER.pattern})\s*(%?)\s*,\s*({_NUMBER.pattern})\s*%", mend, part
        )
    )(line)


def _units(line: str) -> str:
    """Removes units after numbers; a percentage becomes a ratio, an angle in degrees a string."""

    def mend(match: re.Match[str]) -> str:
        if at_node(match[0].strip()) or _EXPONENT.fullmatch(match[2]):
            return match[0]
        if match[2] == "%":
            return f"{float(match[1]) / 100.0:.12g}"
        return f'"{match[1]}deg"' if match[2] in ("deg", "°") else match[1]

    pattern = re.compile(
        r"(?<![\w.])([-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)\s*([A-Za-zµ%°][\w/%²³^*]*)(?![\w.\s]*=)"
    )
    return _outside(
        lambda part: pattern.sub(mend, part) if "=" in part or "[" in part or "," in part else part
    )(line)


def _closed(mark: str) -> Remedy:
    def remedy(line: str) -> str:
        code, comment = _code(line)
        return f"{code}{mark}{comment}" if code else line

    return remedy


def _in_small_base(part: str) -> str:
    return _OF_BASE.sub(lambda match: f"0{match[1].lower()}{match[2]}", part)


def _calculated(part: str) -> str:
    """Replaces a quotient, product or power of two numbers by its value."""

    def come_to(match: re.Match[str]) -> str:
        one, other = (float(_PI.sub(repr(pi), match[i])) for i in (2, 4))
        try:
            found = one / other if match[3] == "/" else one * other if match[3] == "*" else one**other
        except ArithmeticError:
            return match[0]
        return match[0] if isinstance(found, complex) else f"{match[1]}{found!r}"

    return _CALCULATED.sub(come_to, part)


def _statements(line: str) -> str:
    """Puts two keys on one line, with their values, on separate lines."""
    return re.sub(rf"(=\s*\S.*?)[\s,;]+({_KEY}\s*=(?!=))", r"\1" + "\n" + r"\2", line, count=1)


def _comma_behind(line: str) -> str:
    return _outside(lambda part: re.sub(r"(?<=[\w\])}])\s+(?=[-+.\w\[({])", ", ", part))(
        re.sub(r'(["\]}])\s+(?=["\[{])', r"\1, ", line)
    )


def _points_and_commas(line: str) -> str:
    with_points = _decimal_commas(line)
    return line if with_points == line else _comma_behind(with_points)


_REMEDIES: tuple[tuple[str, Remedy], ...] = (
    ("its quotes are typographic", _translated(_QUOTES)),
    ("it has a character that only looks like a blank", _translated(_BLANKS)),
    ("it has a character that only looks like a sign", _outside(_translated(_SIGNS))),
    (
        'a backslash within "..." begins a special character',
        lambda line: re.sub(r'"([^"\']*\\[^"\']*)"', r"'\1'", line),
    ),
    ("a comment begins with #", lambda line: re.sub(r"^(\s*)(?://|/\*|;|%|!|--)\s*", r"\1# ", line)),
    ("a comment begins with #", _of_code(r"\s(?://|;|%|!)\s.*$", lambda m: f" # {m[0].strip(' /;%!')}")),  # type: ignore[arg-type]
    (
        "it is as numpy shows a number",
        _substituted(r"\b(?:np|numpy)\.(?:float|u?int|longdouble)\w*\(([^()]*)\)", r"\1"),
    ),
    (
        "it is as numpy shows an array",
        _substituted(r"\b(?:(?:np|numpy)\.)?array\((\[[^()]*\])[^()]*\)", r"\1"),
    ),
    ("a table begins with its name in brackets", _header),
    ("a number begins with a digit", _substituted(r"(?<![\w.])([-+]?)\.(?=\d)", r"\g<1>0.")),
    ("a digit follows the point of a number", _substituted(r"(?<![\w.])([-+]?\d+)\.(?![\d\w])", r"\1.0")),
    (
        "a digit follows the point of a number",
        _substituted(r"(?<![\w.])([-+]?\d+)\.(?=[eE][-+]?\d)", r"\1.0"),
    ),
    (
        "an exponent begins with e",
        _substituted(r"(?<![\w.])([-+]?\d+(?:\.\d+)?)(?:\.?)[dDqQ]([-+]?\d+)(?!\w)", r"\1e\2"),
    ),
    (
        "an exponent begins with e",
        _substituted(r"(?<![\w.])([-+]?)\.(\d+)[dDqQ]([-+]?\d+)(?!\w)", r"\g<1>0.\2e\3"),
    ),
    ("digits are not parted", _substituted(_THOUSANDS, "")),
    ("a number is written with a decimal point", _decimal_commas),
    (
        "an exponent has no blank before it",
        _substituted(r"(?<![\w.])(\d+(?:\.\d+)?[eE]?)[ \t]+(?=[eE][-+]?\d)", r"\1"),
    ),
    (
        "an exponent has no blank before it",
        _substituted(r"(?<![\w.])(\d+(?:\.\d+)?[eE])[ \t]+(?=[-+]?\d)", r"\1"),
    ),
    (
        "an exponent is a whole number",
        _substituted(r"(?<![\w.])(\d+(?:\.\d+)?[eE][-+]?\d+)\.0*(?!\d)", r"\1"),
    ),
    ("a number is not calculated", _outside(_calculated)),
    ("digits are not parted", _substituted(r"(?<=\d)(?:[ '_]+(?=\d{3}\b)|_+(?!\d))", "")),
    ("a number does not begin with 0", _substituted(r"(?<![\w.+-])([-+]?)0+(?=\d)", r"\1")),
    ("it begins with 0x, 0o or 0b, in small letters", _outside(_in_small_base)),
    ("a key and its value are parted by =", _of_code(rf"^(\s*{_KEY})\s*(?::=|==|=>|:)\s*", r"\1 = ")),
    ("a key and its value are parted by =", _of_code(rf"([{{,]\s*{_KEY})\s*(?::=|==|:)\s*", r"\1 = ")),
    ("a list is in brackets", _outside(lambda part: re.sub(r"=\s*\(([^()]*)\)", r"= [\1]", part))),
    ("each key is on a line of its own", lambda line: line.replace("\r", "\n")),
    ("each key is on a line of its own", _statements),
    ("normal has a mean and a standard deviation, both in units of the key", _deviation),
    ("units are not written", _units),
    ("it is true, false, inf or nan, in small letters", _outside(_in_small)),
    ("a word needs quotes", _outside(lambda part: _VALUE.sub(_value_of_word, part))),
    ("a key that is no plain word needs quotes", _of_code(_ODD_KEY, r'\1"\2" =')),
    ("numbers have a decimal point, and commas part them", _points_and_commas),
    ("items are parted by commas", _comma_behind),
    ("quotes within a string are of the other kind", _of_code(r"=\s*'([^\"]*)'$", r'= "\1"')),
    ("quotes within a string are of the other kind", _of_code(r"=\s*\"([^']*)\"$", r"= '\1'")),
    ("items are parted by commas", _outside(lambda part: part.replace(";", ","))),
    ("nothing follows a value", _of_code(r"[\s,;]+$", "")),
    ("there is no comma behind the last", _of_code(r",\s*}$", " }")),
    ("there is a bracket too many", _of_code(r"[\]}]$", "")),
    ("a bracket is missing at its end", _closed("]")),
    ("a bracket is missing at its end", _closed("]]")),
    ("a bracket is missing at its end", _closed(" }")),
    ("a bracket is missing at its end", _closed(" }]")),
    ("the quote at its end is missing", _closed('"')),
    ("the quote at its end is missing", _closed("'")),
    ("the quote before it is missing", _of_code(r"=\s*([^\"'=]+)\"$", r'= "\1"')),
    ("a comma is missing at its end", _closed(",")),
    ("a key and its value are parted by =", _of_code(rf"^(\s*{_KEY})\s+(?=[\"'\[{{\w.+-])", r"\1 = ")),
)
_REASONS = {  # reasons in plain words, by the parser's messages
    "Unclosed array": "a list has no ] at its end",
    "Unclosed inline table": "a table has no } at its end",
    "Unterminated string": "a string has no quotes at its end",
    "Expected '='": "there is no = behind a key",
    "Invalid value": "there is no value behind =",
    "Expected newline": "something follows a value",
    "Expected ']": "a table's name has no ] at its end",
    "Invalid initial character": "a key that is no plain word needs quotes",
    "Illegal character": "it has a control character",
    "Found invalid character": "it has a control character",
    "Invalid statement": "a line is a table [name], a key = value or a comment #",
}
