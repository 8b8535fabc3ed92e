"""The least peak over a number, and the way down over several, of peaks that are known functions."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fcm.cli.track import as_table
from fcm.results.tracked import Optimal
from fcm.tracking.minimax import PeakEnvelope, downhill
from fcm.tracking.options import DESCENT, SEARCH, TRACKING
from fcm.tracking.peak_envelope import PieceHeight, envelope_minimum
from fcm.tracking.trials import by_trials

EDGE = 0.37  # of the first number: below it another, higher peak is there, which no way leads to


class Known(PeakEnvelope):
    """A valley whose peaks are a slope along the first number and a parabola along the second."""

    def __init__(self):
        self.lowest, self.options = None, DESCENT

    def peaks(self, q):
        return ["slope", "higher"] if q[0] < EDGE else ["slope"]

    def moved(self, member, q, to):
        return member

    def height(self, member, q):
        if member == "higher":
            return 3.0, np.zeros(2)
        return 1.0 + q[0] + (q[1] - 0.8) ** 2, np.array([1.0, 2.0 * (q[1] - 0.8)])


def test_the_way_down_ends_where_a_higher_peak_appears_that_was_not_followed():
    """It stayed where it began: at the end of the way is a higher peak. (Along the edge leads no way.)"""
    q, value, members = downhill(Known(), np.array([0.9, 0.1]))
    assert EDGE <= q[0] < EDGE + 0.01 and members == ["slope"]
    assert value == pytest.approx(1.0 + q[0] + (q[1] - 0.8) ** 2)
    assert abs(q[1] - 0.8) < 0.5


class Tried:
    """Responses to a number from 0 to 1, some without a peak, in the order in which they are looked at, and 2
    from then on."""

    span, options = (0.0, 1.0), SEARCH

    def __init__(self, *heights):
        self.heights, self.visited_values = list(heights), {}

    def greatest_at(self, value):
        height = self.heights.pop(0) if self.heights else 2.0
        self.visited_values[value] = PieceHeight(height, 0.0, np.zeros(0), 0)


def test_trials_where_some_responses_have_no_peak():
    """The bracket was sought with infinite heights, and numpy warned of their differences."""
    search = Tried(3.0, 2.5, 2.0, 1.0, 2.0, 2.0, 0.0, 0.0, 1.5, 1.4, 0.0, 3.0, 2.0, 2.0)
    search.greatest_at(np.float64(0.4))
    found = by_trials(search)
    assert (found.s, found.value) == (0.5, 1.0)


def test_trials_about_the_second_lowest_value_may_find_the_lowest():
    """At 0.6 is the least, in a valley of which the values that are tried first show the slopes alone."""

    class Valleys(Tried):
        def greatest_at(self, value):
            height = min(1.0 + value, 0.7 + 4.0 * abs(value - 0.6))
            self.visited_values[value] = PieceHeight(height, 0.0, np.zeros(0), 0)

    found = by_trials(Valleys())
    assert found.kind == "trials" and found.between[0] < 0.6 < found.between[1]
    assert found.value < 0.9


def test_trials_go_on_at_the_lowest_until_its_neighbours_are_about_as_high():
    """Above 0.08 the peak does not depend on the number: trials there lead nowhere."""

    class Steep(Tried):
        def greatest_at(self, value):
            height = 1.0 + min(abs(value - 0.01), 0.07)
            self.visited_values[value] = PieceHeight(height, 0.0, np.zeros(0), 0)

    found = by_trials(Steep())
    assert found.value < 1.01 and abs(found.s - 0.01) < 0.01


class Straight:
    """A piece of a curve of peaks, 2 + slope s, from one value to another."""

    condition, tracked_points = None, ()

    def __init__(self, low, high, slope):
        self.s, self.slope = np.array([low, high]), slope
        self.height = 2.0 + slope * self.s

    def covers(self, s):
        return self.s[0] <= s <= self.s[1]

    def roughly(self, s):
        return 2.0 + self.slope * s

    def at(self, s):
        return PieceHeight(self.roughly(s), self.slope, np.array([s]), 0)


def test_the_least_beside_a_gap_between_pieces():
    """In the gap nothing is known: its heights were infinite, and numpy warned of their differences."""
    setup = SimpleNamespace(span=(0.0, 1.0), options=TRACKING)
    found = envelope_minimum(setup, [Straight(0.0, 0.25, -1.0), Straight(0.5, 1.0, 1.0)])
    assert found.s == pytest.approx(0.25, abs=1e-9) and found.value == pytest.approx(1.75, abs=1e-9)


def test_least_peaks_of_several_numbers_by_trials_say_so():
    found = Optimal(
        {}, {"contact.c.n_0": 1.0, "contact.c.k_u": 2.0}, ("peak.u",), 3.0, (("u", 1.2),), "trials", (1,),
        stable=(1.0,), residual=(0.0,),
    )  # fmt: skip
    shown = as_table({"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}, "rad/s")
    assert "contact.c.k_u = 2; along each number known by trials alone" in shown


def test_a_least_peak_that_the_response_exceeds_is_not_told_as_the_least():
    found = Optimal(
        {}, {"n": 1.0}, ("peak.u",), 0.3, (("u", 2.0),), "smooth", (1,), 1e-3, stable=(1.0,), residual=(0.0,)
    )
    shown = as_table({"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}, "rad/s")
    assert "NOT THE LEAST" not in shown and found.summary("rad/s")["higher"] is None
    summary = replace(found, higher=("peak.u", 5.88)).summary("rad/s")
    shown = as_table({"optimum": [summary], "tracked": {"what": "optimum"}}, "rad/s")
    assert "NOT THE LEAST: the response there has a higher peak.u, 5.88" in shown.splitlines()[0]
    assert summary["higher"] == {"what": "peak.u", "value": 5.88}


@pytest.mark.parametrize(
    ("error", "said"), [(2e-3, "off by 2.0e-03, relative"), (None, "off by an unknown amount")]
)
def test_how_far_off_the_end_of_a_higher_peak_is_stands_beside_the_number(error, said):
    found = Optimal(
        {}, {"n": 1.0}, ("peak.u",), 0.3, (("u", 2.0),), "end", (1,), 1e-3, stable=(1.0,), residual=(0.0,)
    )  # fmt: skip
    summary = found.summary("rad/s") | {"end_error": error}
    shown = as_table({"optimum": [summary], "tracked": {"what": "optimum"}}, "rad/s")
    assert said in shown.splitlines()[0]


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("end", "where a higher peak leaves the range of frequencies at 5 rad/s"),
        ("corner", "where the peak leaves the range of frequencies at 5 rad/s"),
    ],
)
def test_a_peak_that_leaves_the_range_is_said_to(kind, said):
    found = Optimal(
        {}, {"n": 1.0}, ("peak.u",), 0.3, (("u", 2.0),), kind, (1,), 1e-3, stable=(1.0,), residual=(0.0,)
    )  # fmt: skip
    for at, is_said in ((5.0, True), (np.nan, False)):
        run = {"optimum": [replace(found, leaves_range=at).summary("rad/s")], "tracked": {"what": "optimum"}}
        assert (said in as_table(run, "rad/s").splitlines()[0]) is is_said


def test_a_greater_amplitude_at_an_end_of_the_range_stands_below_a_least_peak():
    found = Optimal(
        {}, {"n": 1.0}, ("peak.u",), 0.3, (("u", 2.0),), "smooth", (1,), 1e-3, stable=(1.0,), residual=(0.0,)
    )  # fmt: skip
    run = {"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}
    for amplitude, is_said in ((0.4, True), (0.3, False)):
        end = {"amplitude": amplitude, "frequency": 9.0, "at_edge": True}
        shown = as_table(run | {"curves": [{"peak": {"u": end}}]}, "rad/s")
        assert (
            'u is 0.4 at 9 rad/s, an end of the range, which is higher: minimise = "greatest.u"' in shown
        ) is is_said


def test_a_least_peak_that_the_response_lacks_says_so_below_its_headline():
    """The response there is traced alone, and has not the branches that other numbers lead to."""
    found = Optimal(
        {}, {"n": 1.0}, ("peak.u",), 0.3, (("u", 2.0),), "smooth", (1,), 1e-3, stable=(1.0,), residual=(0.0,)
    )  # fmt: skip
    run = {"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}
    for amplitude, is_said in ((0.28, True), (0.3, False), (0.31, False)):
        curve = {"complete": True, "peak": {"u": {"amplitude": amplitude, "frequency": 2.5}}}
        shown = as_table(run | {"curves": [curve]}, "rad/s")
        assert ("the response below, traced alone, has 0.28 at most" in shown) is is_said


def test_a_least_peak_where_nothing_stable_was_found_says_so_in_its_headline():
    """The motion is nowhere stable between 1.9 and 2.1, so the design rests on no steady motion."""
    found = Optimal(
        {}, {"n": 1.0}, ("peak.u",), 0.3, (("u", 2.0),), "smooth", (1,), 1e-3, stable=(0.0,), residual=(0.0,)
    )
    run = {"optimum": [found.summary("rad/s")], "tracked": {"what": "optimum"}}
    for stretch, said in (
        ([1.9, 2.1], "0.3, at which no stable motion was found ("),
        ([1.0, 1.2], "0.3, unstable ("),
    ):
        shown = as_table(run | {"curves": [{"no_stable_motion": [stretch]}]}, "rad/s")
        assert said in shown.splitlines()[0]


def test_a_way_down_from_numbers_without_a_peak_ends_there():
    """Its response rises to an end of the range; it was a traceback."""
    numbers = np.array([0.5, 0.5])
    nowhere = SimpleNamespace(traced=lambda q: (np.inf, []), options=DESCENT)
    q, value, members = downhill(nowhere, numbers)
    assert (q == numbers).all() and value == np.inf and members == []
