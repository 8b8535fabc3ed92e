"""Options are compared, shown and sent to other processes by their fields, compiled as well as not."""

import pickle
from dataclasses import fields, replace

import pytest

from fcm.continuation import options
from fcm.continuation.options import FollowOptions, NewtonOptions, StepOptions

CHANGED = FollowOptions(0.2, newton=NewtonOptions(tolerance=1e-9), step=StepOptions(retreats=(2,)))


@pytest.mark.parametrize("one", [FollowOptions(), CHANGED], ids=["default", "changed"])
def test_what_is_sent_or_printed_is_the_same_options(one):
    sent, printed = pickle.loads(pickle.dumps(one)), eval(repr(one), vars(options))
    for other in (sent, printed):
        assert other == one and hash(other) == hash(one)
        assert all(getattr(other, field.name) == getattr(one, field.name) for field in fields(one))
    assert sent.newton.tolerance == one.newton.tolerance and printed.step.retreats == one.step.retreats


def test_one_other_field_makes_other_options():
    assert FollowOptions() != CHANGED
    for part in ("newton", "step", "events", "switching"):
        own = getattr(CHANGED, part)
        for field in fields(own):
            value = getattr(own, field.name)
            other = (3,) if isinstance(value, tuple) else 2 * value + 1
            assert replace(CHANGED, **{part: replace(own, **{field.name: other})}) != CHANGED
    assert NewtonOptions() != StepOptions()
