"""Pages to look into: one file, no network, the numbers of the file under the mouse."""

from __future__ import annotations

import json
import shutil

import netCDF4
import numpy as np
import pytest
from tests.program import called

pytest.importorskip("plotly")


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("page") / "n5.nc"
    assert called("respond", "yang1998", "-o", path).code == 0
    return path


def page(file, what="response", *options):
    output = file.with_suffix(f".{what}.html")
    done = called("plot", what, file, "-o", output, *options)
    assert done.code == 0, done.err
    return output


@pytest.mark.slow
def test_a_page_needs_no_network(file):
    """The library is within; nothing is loaded from elsewhere when the page is opened."""
    text = page(file).read_text(encoding="utf-8")
    assert len(text) > 3_000_000 and "<script src" not in text and "<link" not in text


@pytest.mark.parametrize("what, options", [("response", ("--band", 5, 95)), ("peak", ("--folds",))])
def test_what_a_page_cannot_show_is_refused(file, what, options):
    done = called("plot", what, file, "-o", file.with_suffix(".html"), *options)
    assert done.code == 2 and not file.with_suffix(".html").exists()


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    webdriver = pytest.importorskip("selenium.webdriver")
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or driver is None:
        pytest.skip("no headless browser is installed")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    profile = tmp_path_factory.mktemp("profile")
    flags = ("headless=new", "no-sandbox", "disable-gpu", "disable-background-networking", "disable-sync")
    for flag in (*flags, "disable-component-update", "no-first-run", f"user-data-dir={profile}"):
        options.add_argument(f"--{flag}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    service = webdriver.ChromeService(executable_path=driver)
    found = webdriver.Chrome(options=options, service=service)
    yield found
    found.quit()


def shown(browser, path):
    """The page in the browser; nothing is said in its console."""
    browser.get(path.as_uri())
    assert browser.get_log("browser") == []
    return lambda script, *args: browser.execute_script(script, *args)


@pytest.mark.slow
def test_the_number_of_the_file_is_under_the_mouse(browser, file):
    run = shown(browser, page(file, "response", "--dof", "v"))
    with netCDF4.Dataset(file) as data:
        amplitude = np.ma.filled(data["amplitude"][:, :, 1], np.nan)
        frequency = np.ma.filled(data["frequency"][:], np.nan)
    last = np.nanargmax(amplitude[-1])
    # the point of the greatest amplitude of the last curve, among the traces of the page
    found = run(
        """const plot = document.querySelector('.plotly-graph-div');
        let best = [0, 0, 0];
        plot.calcdata.forEach((trace, t) => trace.forEach((one, k) => {
            const name = plot.data[t].legendgroup;
            if (name === plot.data[plot.data.length - 1].legendgroup && one.y > best[2]) best = [t, k, one.y];
        }));
        const place = plot.calcdata[best[0]][best[1]].i;
        Plotly.Fx.hover(plot, [{curveNumber: best[0], pointNumber: place}]);
        return document.querySelector('.hoverlayer').textContent;"""
    )
    assert f"{amplitude[-1, last]:.6g}" in found and f"{frequency[-1, last]:.6g}" in found, found


def test_the_menu_changes_the_degree_of_freedom(browser, file):
    run = shown(browser, page(file))
    heights = run(
        """const plot = document.querySelector('.plotly-graph-div');
        const greatest = () => Math.max(...plot.calcdata.flat().map(one => one.y || 0));
        const before = greatest();
        const button = plot.layout.updatemenus[0].buttons[1];
        return Plotly.update(plot, button.args[0], button.args[1]).then(
            () => JSON.stringify([before, greatest(), plot.layout.yaxis.title.text]));"""
    )
    with netCDF4.Dataset(file) as data:
        greatest = [float(np.ma.filled(data["amplitude"][:, :, d], 0.0).max()) for d in (0, 1)]
    before, after, title = json.loads(heights)
    assert [before, after] == pytest.approx(greatest, rel=1e-12) and title.startswith("Amplitude of v")


def test_peaks_have_a_page(browser, file):
    run = shown(browser, page(file, "peak"))
    found = run(
        """const plot = document.querySelector('.plotly-graph-div');
        return JSON.stringify(plot.calcdata[0].map(one => [one.x, one.y]));"""
    )
    with netCDF4.Dataset(file) as data:
        swept = np.ma.filled(data["contact.shroud.n_0"][:])
        peak = np.ma.filled(data["peak_amplitude"][:, 0])
    order = np.argsort(swept)
    assert np.array(json.loads(found)) == pytest.approx(np.stack((swept[order], peak[order]), axis=1))


@pytest.mark.parametrize(("drawn", "mode"), [((), "lines+markers"), (("n",), "markers")])
def test_random_draws_have_no_line_between_them_on_a_page(tmp_path, drawn, mode):
    from fcm.plot.interactive import peak_page
    from fcm.plot.peak import Peaks

    two = np.array([[1.0], [2.0]])
    peaks = Peaks(("u",), "Hz", {"n": two[:, 0]}, two, two, np.full(2, True), drawn=drawn)
    peak_page(peaks, None, None, tmp_path / "a.html")
    assert f'"mode":"{mode}"' in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_the_branch_of_a_point_is_told_where_there_are_several(tmp_path):
    """Points behind the gap between two branches are of the second."""
    from fcm.plot.interactive import response_page
    from fcm.plot.read import DrawnCurve, DrawnResponse

    gap = np.array([1.0, 2.0, np.nan, 1.0, 2.0])
    height = np.array([[1.0], [2.0], [np.nan], [3.0], [4.0]])
    stable = np.array([True, True, True, False, False])
    unknown = np.zeros(5, dtype=bool)
    curve = DrawnCurve({}, gap, height, stable, unknown, frozenset(), None, np.full(5, 0.01))
    response_page(DrawnResponse(("u",), "rad/s", (curve,)), None, None, tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert '"stable, branch 1"' in text and '"unstable, branch 2"' in text and '"1.0e-02"' in text


@pytest.fixture(scope="module")
def joint(tmp_path_factory):
    """A response with ten contacts, and their places."""
    path = tmp_path_factory.mktemp("joint") / "blade.nc"
    assert called("respond", "blade", "--harmonics", 1, "-o", path).code == 0
    with netCDF4.Dataset(path) as data:
        lines = [f"{name} {k} {k * k % 5}" for k, name in enumerate(data["contact"][:])]
    path.with_suffix(".txt").write_text("\n".join(lines))
    return path


@pytest.mark.slow
@pytest.mark.parametrize("with_places", [False, True])
def test_contacts_have_a_page_with_all_that_one_bears_under_the_mouse(browser, joint, with_places):
    at = 0.99 * greatest(joint)[0]
    options = ("--at", greatest(joint)[0], "--at", at)
    options += ("--places", joint.with_suffix(".txt")) if with_places else ()
    run = shown(browser, page(joint, "contacts", *options))
    hover = """const plot = document.querySelector('.plotly-graph-div');
        Plotly.Fx.hover(plot, [{curveNumber: arguments[0], pointNumber: 4}]);
        return document.querySelector('.hoverlayer').textContent;"""
    _, k, names, contact_loads = greatest(joint)
    found = run(hover, 0)
    assert found.startswith(f"{names[4]}: ")
    for value in contact_loads[:, k, 4]:
        assert f": {value:.6g}" in found, (found, value)
    last = run(
        """const plot = document.querySelector('.plotly-graph-div');
        const [shown, frequency] = plot.layout.updatemenus.map(menu => menu.buttons);
        return Plotly.restyle(plot, frequency[1].args[0]).then(
            () => Plotly.update(plot, shown[2].args[0], shown[2].args[1])).then(
            () => JSON.stringify([plot.data.map(one => one.visible), plot.data[0].marker.color]));"""
    )
    visible, colours = json.loads(last)
    assert visible == [False, True] and colours == pytest.approx(contact_loads[2, k].tolist())


def greatest(path):
    """Frequency and place of the greatest amplitude, the contacts, and what they bear (3, point, contact)."""
    with netCDF4.Dataset(path) as data:
        amplitude = np.ma.filled(data["amplitude"][0], np.nan)
        k = int(np.nanargmax(np.nanmax(amplitude, axis=1)))
        kinds = ("dissipated_energy", "slip_path", "greatest_normal_force")
        contact_loads = np.array([np.ma.filled(data[name][0], np.nan) for name in kinds])
        return float(data["frequency"][0, k]), k, list(data["contact"][:]), contact_loads
