"""Pictures of tracked peaks: what chooses the axis, and what is said of ends and gaps."""

from dataclasses import replace

import numpy as np

from fcm.plot.tracked import DrawnTrack, DrawnTracking, draw_tracked

NUMBER = np.linspace(2.0, 50.0, 49)


def track(number, height, trough=None):
    count = len(number)
    trough = np.zeros(count) if trough is None else trough
    height = np.asarray(height, dtype=float)[:, None]
    return DrawnTrack(
        "peak of u", number, np.full(count, 200.0), height, np.zeros(count), trough, np.ones(count)
    )


def drawn(*tracks):
    return DrawnTracking("contact.c.n_0", ("u",), "Hz", tracks)


def notes(figure):
    return figure.axes[1].get_title(loc="left")


def test_a_speck_of_a_low_peak_does_not_make_the_axis_logarithmic():
    high, low = track(NUMBER, np.linspace(5e-4, 6e-5, 49)), track(NUMBER[:2], [1e-5, 1.1e-5])
    assert draw_tracked(drawn(high, low)).axes[0].get_yscale() == "linear"
    assert draw_tracked(drawn(high, track(NUMBER, np.full(49, 1e-5)))).axes[0].get_yscale() == "log"


def test_a_line_that_ends_within_is_explained():
    """It was said to be a trough behind a gap, and there was no gap to see."""
    whole = track(NUMBER, np.full(49, 1.0))
    assert "ends where" not in notes(draw_tracked(drawn(whole)))
    trough = np.where(NUMBER > 30.0, 1.0, 0.0)
    ends = notes(draw_tracked(drawn(whole, replace(whole, trough=trough))))
    assert "a line ends where its peak does" in ends and "gap" not in ends
    between = np.where(abs(NUMBER - 30.0) < 5.0, 1.0, 0.0)
    gap = notes(draw_tracked(drawn(replace(whole, trough=between))))
    assert "gap: it is no peak but a trough" in gap and "ends where" not in gap


def test_ticks_of_small_heights_are_of_one_kind():
    """They were 0.0005 above 5e-05."""
    figure = draw_tracked(drawn(track(NUMBER, np.geomspace(5e-4, 1e-5, 49))))
    figure.canvas.draw()
    words = [one.get_text() for one in figure.axes[0].get_yticklabels() if one.get_text()]
    assert all(r"\times10^" in one for one in words)
    figure = draw_tracked(drawn(track(NUMBER, np.geomspace(0.5, 20.0, 49))))
    figure.canvas.draw()
    assert {"1", "10"} <= {one.get_text() for one in figure.axes[0].get_yticklabels()}
