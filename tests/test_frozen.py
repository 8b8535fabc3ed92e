"""Records that do not change, beside the frozen dataclasses of the standard library."""

from __future__ import annotations

import copy
import inspect
import pickle
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields, replace

import numpy as np
import pytest

from fcm.frozen import Frozen


class Own(Frozen):
    a: float
    b: int = 2
    c: list[int] = field(default_factory=list, compare=False)
    d: str = field(default="x", repr=False)
    e: float = field(default=1.0, kw_only=True)


class Derived(Own):
    f: int = 3
    b: int = 5


@dataclass(frozen=True)
class Standard:
    a: float
    b: int = 2
    c: list[int] = field(default_factory=list, compare=False)
    d: str = field(default="x", repr=False)
    e: float = field(default=1.0, kw_only=True)


@dataclass(frozen=True)
class StandardDerived(Standard):
    f: int = 3
    b: int = 5


PAIRS = ((Own, Standard), (Derived, StandardDerived))
ARGUMENTS = (
    ((1.0,), {}),
    ((1.0, 3, [4]), {"e": 2.0}),
    ((), {"a": 1.0, "d": "y"}),
    ((1.0, 2, [], "z"), {}),
)


@pytest.mark.parametrize(("own", "standard"), PAIRS)
@pytest.mark.parametrize(("values", "named"), ARGUMENTS)
def test_a_record_is_what_the_frozen_dataclass_would_be(own, standard, values, named):
    ours, theirs = own(*values, **named), standard(*values, **named)
    assert asdict(ours) == asdict(theirs)
    assert repr(ours) == repr(theirs).replace(standard.__name__, own.__name__)
    assert [one.name for one in fields(ours)] == [one.name for one in fields(theirs)]
    assert asdict(replace(ours, b=9)) == asdict(replace(theirs, b=9))
    assert hash(ours) == hash(own(*values, **named))
    for copied in (copy.deepcopy(ours), pickle.loads(pickle.dumps(ours))):
        assert copied == ours
        assert copied is not ours


@pytest.mark.parametrize(("own", "standard"), PAIRS)
def test_equal_are_those_of_one_class_with_equal_compared_fields(own, standard):
    assert own(1.0, c=[1]) == own(1.0, c=[2])
    assert own(1.0) != own(1.0, e=2.0)
    assert own(1.0) != standard(1.0)
    assert Own(1.0) != Derived(1.0, 2)


@pytest.mark.parametrize(("own", "standard"), PAIRS)
@pytest.mark.parametrize(
    ("values", "named"),
    [
        ((), {}),
        ((1.0, 2, [], "x", 3, 4, 5), {}),
        ((1.0,), {"a": 2.0}),
        ((1.0,), {"g": 2.0}),
        ((), {"b": 1}),
    ],
)
def test_arguments_that_do_not_fit_are_refused(own, standard, values, named):
    for one in (own, standard):
        with pytest.raises(TypeError):
            one(*values, **named)


@pytest.mark.parametrize(("own", "standard"), PAIRS)
def test_the_signature_is_that_of_the_dataclass(own, standard):
    ours, theirs = inspect.signature(own).parameters, inspect.signature(standard).parameters
    assert list(ours) == list(theirs)
    assert [one.kind for one in ours.values()] == [one.kind for one in theirs.values()]
    assert [one.annotation for one in ours.values()] == [one.annotation for one in theirs.values()]


def test_no_field_is_set_or_deleted():
    record = Own(1.0)
    with pytest.raises(FrozenInstanceError):
        record.a = 2.0
    with pytest.raises(FrozenInstanceError):
        del record.a
    assert record.a == 1.0


def test_what_is_made_of_the_fields_is_made_once_they_are_known():
    class Circle(Frozen):
        radius: float
        area: float = field(init=False)

        def __post_init__(self):
            object.__setattr__(self, "area", np.pi * self.radius**2)

    assert Circle(2.0).area == pytest.approx(4.0 * np.pi)
