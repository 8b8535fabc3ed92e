"""Options are read from their documentation: what it names is what they have."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from dataclasses import fields

import pytest

import fcm
from fcm.frozen import Frozen


def classes() -> list[type]:
    """Every class of options that lists its fields."""
    found = []
    for one in pkgutil.walk_packages(fcm.__path__, "fcm."):
        if not one.name.endswith("__main__"):
            module = importlib.import_module(one.name)
            found += [c for c in vars(module).values() if inspect.isclass(c) and c.__module__ == one.name]
    return [c for c in found if issubclass(c, Frozen) and "Attributes\n---" in (inspect.getdoc(c) or "")]


def documented(of: type) -> list[str]:
    """The names that head its paragraphs."""
    text = (inspect.getdoc(of) or "").partition("Attributes\n----------\n")[2].partition("\n\n")[0]
    heads = [line.partition(" : ")[0] for line in text.splitlines() if not line.startswith(" ")]
    return [name for head in heads for name in head.split(", ")]


OPTIONS = [c for c in classes() if c.__name__.endswith("Options")]


def test_there_are_many():
    assert len(OPTIONS) > 40


@pytest.mark.parametrize("one", OPTIONS, ids=lambda c: f"{c.__module__}.{c.__name__}")
def test_the_documentation_names_the_fields(one):
    assert sorted(documented(one)) == sorted(field.name for field in fields(one))
