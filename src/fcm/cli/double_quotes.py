"""Messages of wrong usage with values in double quotes, as those of scenes and files have them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

import click

_SINGLE = re.compile(r"(?<!\w)'([^'\n]*)'(?!\w)")  # no apostrophe, as of a contact's name


def double_quoted(text: str) -> str:
    """A text whose single quotes are double.

    >>> double_quoted("Invalid value for '-o' / '--output': the contact's name")
    'Invalid value for "-o" / "--output": the contact\\'s name'
    """
    return _SINGLE.sub(r'"\1"', text)


@contextmanager
def double_quotes() -> Iterator[None]:
    """Wrong usage that is found inside is said with double quotes."""
    try:
        yield
    except click.UsageError as wrong:
        raise click.UsageError(double_quoted(wrong.format_message()), wrong.ctx) from None
