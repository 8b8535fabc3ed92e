"""Pictures of mistuned rings: the envelope over the sectors, the tuned ring's peak, the amplification."""

import numpy as np
import pytest

from fcm.cli.curves import as_table
from fcm.plot import draw_response, read_response
from fcm.plot.peak import draw_peak, read_peaks
from fcm.response import trace
from fcm.results.blades import worst_of
from fcm.results.output import write_netcdf
from fcm.results.summary import summary
from fcm.scene import scene_from_dict

from ..ring.test_mistuned import rings, sector


def ring(tmp_path_factory, sweep, end=225.0):
    data = sector(3, 1, (rings.SHROUD,), harmonics=1, max_step=0.5, frequency=[165.0, end])
    found = trace(scene_from_dict({**data, "sweep": sweep}))
    path = tmp_path_factory.mktemp("ring") / "ring.nc"
    write_netcdf(found, path)
    return found, path


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """Rings of three sectors with less and less mistuning."""
    return ring(tmp_path_factory, {"cyclic.mistuning.scale": [1.0, 0.5]})


def drawn(path, **more):
    figure = draw_response(read_response(path), **more)
    return figure, figure.axes[0], [text.get_text() for text in figure.legends[-1].get_texts()]


def diamonds(axes):
    return [line.get_xydata()[0].tolist() for line in axes.lines if line.get_marker() == "D"]


@pytest.mark.slow
def test_the_envelope_over_all_blades_is_drawn(swept):
    """It was one blade alone, that of the greatest peak."""
    found, path = swept
    _, axes, _ = drawn(path)
    tips = [found.dofs.index(f"tip@{k}") for k in range(3)]
    own = [line for line in axes.lines if not str(line.get_label()).startswith("_unnamed")]
    for line, curve in zip(own, found.curves, strict=False):
        known = np.isfinite(line.get_ydata())  # the rest is faded
        assert known.mean() > 0.5
        np.testing.assert_array_equal(line.get_ydata()[known], curve.amplitude[:, tips].max(axis=1)[known])
    assert axes.get_ylabel() == "Greatest amplitude of tip in 3 sectors"
    _, axes, _ = drawn(path, dof="tip@1")
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), found.curves[0].amplitude[:, tips[1]])
    assert axes.get_ylabel() == "Amplitude of tip@1" and not diamonds(axes)


def test_the_amplification_and_its_sector_are_named_beside_the_peak_of_the_tuned_ring(swept):
    found, path = swept
    figure, axes, _ = drawn(path)
    texts = [text.get_text() for text in (*axes.texts, *(t for one in figure.legends for t in one.texts))]
    tuned = found.blades.tuned[0, found.blades.names.index("tip")]
    for curve in found.curves:
        peaks = [curve.peaks[f"tip@{k}"].amplitude for k in range(3)]
        said = f"amplification {max(peaks) / tuned:.3f}, sector {np.argmax(peaks)}"
        assert any(text.endswith(said) for text in texts), texts
    ((at, height),) = diamonds(axes)  # one of both: the tuned ring is the same
    assert height == tuned and at == pytest.approx(221.4, abs=0.1)
    notes = [text.get_text() for text in figure.legends[0].get_texts()]
    assert notes[:2] == ["peak of the tuned ring", "amplification: greatest peak over the tuned ring's"]


@pytest.mark.slow
def test_tuned_rings_that_differ_have_a_diamond_each_and_a_ring_alone_its_sectors(tmp_path_factory):
    found, path = ring(tmp_path_factory, {"contact.shroud.n_0": [5.0, 60.0]})
    _, axes, _ = drawn(path)
    assert [height for _, height in diamonds(axes)] == found.blades.tuned[:, 2].tolist()
    found, path = ring(tmp_path_factory, {"contact.shroud.n_0": [5.0]})
    figure, axes, _ = drawn(path)
    each = [line for line in axes.lines if line.get_label() == "_each sector"]
    assert len(each) == 3 and figure.legends[0].get_texts()[0].get_text() == "each sector"
    top = np.max([line.get_ydata() for line in each], axis=0)
    (envelope,) = (line for line in axes.lines if line.get_color() == "#000000" and line.get_xdata().size > 1)
    np.testing.assert_array_equal(envelope.get_ydata(), top)


def test_an_amplification_is_a_bound_where_a_greatest_amplitude_is_at_an_end_of_the_range(tmp_path_factory):
    """It was told as if the tuned ring had its peak there."""
    found, path = ring(tmp_path_factory, {"cyclic.mistuning.scale": [1.0, 0.5]}, 220.0)
    worst, place = worst_of(found), found.blades.names.index("tip")
    ends = zip(worst.at_end[:, place], worst.tuned_at_end[:, place], strict=True)
    assert list(ends) == [(False, True), (True, True)]
    response = read_response(path)
    ratio = worst.amplification[0, place]
    said = [f"amplification at most {ratio:.3f}, sector {worst.sector[0, place]}", ""]
    assert response.blades.labels(place, [0, 1]) == said
    table = as_table(summary(found), "Hz").splitlines()
    rows = [line.split() for line in table if "tip of sector" in line]
    assert [("*" in row[6], "*" in row[8]) for row in rows] == [(False, True), (True, True)]
    assert any(line.startswith("* at an end of the range, and no peak: of the worst blade") for line in table)


def test_peaks_of_rings_are_those_of_the_worst_blades_with_the_amplification(swept):
    """One blade was drawn, that of the greatest peak of all."""
    found, path = swept
    worst, place = worst_of(found), found.blades.names.index("tip")
    upper, lower, last = draw_peak(read_peaks(path)).axes
    assert upper.get_ylabel() == "Greatest peak of tip in 3 sectors"
    assert last.get_ylabel() == "Amplification (–)"
    for axes, values in (
        (upper, worst.amplitude[:, place]),
        (lower, worst.frequency[:, place] / (2.0 * np.pi)),
        (last, worst.amplification[:, place]),
    ):
        assert axes.lines[0].get_ydata() == pytest.approx(values[[1, 0]])  # in the order of the scale
    (tuned,) = upper.figure.legends
    assert [text.get_text() for text in tuned.get_texts()] == ["peak of the tuned ring"]
    across = [line for line in upper.lines if len(set(line.get_ydata())) == 1 and len(line.get_ydata()) == 2]
    assert across[0].get_ydata()[0] == found.blades.tuned[0, place]
    upper, lower = draw_peak(read_peaks(path), dof="tip@1").axes
    assert upper.get_ylabel() == "Peak amplitude of tip@1"


def test_an_amplification_that_is_a_bound_is_left_out_of_the_picture(tmp_path_factory):
    _, path = ring(tmp_path_factory, {"cyclic.mistuning.scale": [1.0, 0.5]}, 220.0)
    upper, _, last = draw_peak(read_peaks(path)).axes
    assert np.isnan(last.lines[0].get_ydata()).all() and not upper.figure.legends
    assert last.get_title(loc="right").startswith("left out: 2 of 2, of greatest amplitudes at an end")
