"""Put values in messages on wrong usage in double quotes, as messages on scenes and files do."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

import click

_SINGLE = re.compile(r"(?<!\w)'([^'\n]*)'(?!\w)")  # no apostrophe, as of a contact's name


def double_quoted(text: str) -> str:
    """The text with double quotes in place of single ones; apostrophes stay.

    >>> double_quoted("Invalid value for '-o' / '--output': the contact's name")
    'Invalid value for "-o" / "--output": the contact\\'s name'
    """
    return _SINGLE.sub(r'"\1"', text)


@contextmanager
def double_quotes() -> Iterator[None]:
    """Context in which messages on wrong usage get double quotes."""
    try:
        yield
    except click.UsageError as wrong:
        raise click.UsageError(double_quoted(wrong.format_message()), wrong.ctx) from None
