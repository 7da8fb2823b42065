"""The figures: they show the data beside them, mark what was lost, name their axes, and come out the same."""

from __future__ import annotations

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.text import Text

from delagrange.figures.amplitude_axis import lost_places
from delagrange.figures.style import journal_style
from delagrange.reproduction.figures.gallery import NUMBERS, draw_all, draw_figures
from delagrange.reproduction.figures.history_figure import draw_history, history_data
from delagrange.reproduction.figures.phase_figure import MAP, PATH, draw_phase, part_of, phase_data
from delagrange.reproduction.figures.response_figure import (
    draw_response,
    peaks_of,
    response_data,
)
from delagrange.reproduction.runs.all_runs import Runs
from delagrange.reproduction.runs.cases import MOTIONS, RESPONSES
from delagrange.reproduction.runs.published_numbers import PEAKS
from delagrange.reproduction.runs.runs import NUMERICS, curve, formulations, motions, response, sections

FREQUENCIES = {
    4: [100.0, 370.0, 371.0, 800.0],
    7: [100.0, 424.0, 800.0],
    10: [1.0, 381.0, 386.0, 391.0, 396.0],
}

SAVED = (4, 6, 10, 11)


@pytest.fixture(scope="module")
def runs():
    """Real runs for all figures, of few frequencies and short windows."""
    datasets = {}
    for case in RESPONSES:
        for form in formulations(case.model):
            for numerics in NUMERICS:
                some_are_lost = (case.number, numerics.name) == (10, "paper")
                short = case if some_are_lost else replace(case, window=0.01)
                computed = response(short, numerics, form, np.array(FREQUENCIES[case.number]))
                datasets[case.number, form, numerics.name] = computed
    for case in MOTIONS:
        for form in formulations(case.model):
            datasets[case.history_number, form, "accurate"] = motions(replace(case, window=0.01), form)
            datasets[case.phase_number, form, "accurate"] = sections(case, form, count=5)
    return Runs(datasets)


@pytest.fixture(scope="module")
def gallery(runs, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    return draw_figures(runs, folder, only=SAVED)


@pytest.fixture(scope="module")
def drawn(runs):
    """Every figure, not yet saved, by number."""
    with journal_style():
        figures = {case.number: draw_response(response_data(runs, case), case) for case in RESPONSES}
        for case in MOTIONS:
            figures[case.history_number] = draw_history(history_data(runs, case), case)
            figures[case.phase_number] = draw_phase(phase_data(runs, case), case)
        for figure in figures.values():
            figure.draw_without_rendering()
    return figures


def test_every_figure_comes_with_its_data(gallery):
    expected = [f"figure_{number:02d}.{end}" for number in SAVED for end in ("png", "pdf", "nc", "csv")]
    assert [path.name for path in gallery] == expected
    starts = {".png": b"\x89PNG", ".pdf": b"%PDF", ".nc": b"\x89HDF"}
    for path in gallery:
        content = path.read_bytes()
        assert content.startswith(starts.get(path.suffix, b"")), path
        assert len(content) > 500, path


def test_the_same_runs_give_the_same_bytes(gallery, runs, tmp_path):
    again = draw_figures(runs, tmp_path, only=(6, 4))
    assert [path.name for path in again[::4]] == ["figure_04.png", "figure_06.png"]
    for path in again:
        if path.suffix != ".nc":
            first = next(one for one in gallery if one.name == path.name)
            assert path.read_bytes() == first.read_bytes(), path.name


def test_saved_data_read_back_equal(gallery, runs):
    for case in (RESPONSES[0], RESPONSES[2]):
        path = next(path for path in gallery if path.name == f"figure_{case.number:02d}.nc")
        xr.testing.assert_equal(xr.load_dataset(path), response_data(runs, case))


def panels(figure, letter):
    return [axes for axes in figure.axes if axes.get_title(loc="left") == f"({letter})"]


def solid_lines(axes):
    return [line for line in axes.get_lines() if not line.get_label().startswith("_")]


@pytest.mark.parametrize("case", RESPONSES, ids=lambda case: f"Fig. {case.number}")
def test_response_lines_are_the_data(drawn, runs, case):
    data = response_data(runs, case)
    for panel in case.panels:
        for axes, form in zip(
            panels(drawn[case.number], panel.letter), formulations(case.model), strict=True
        ):
            own = data if form is None else data.sel(formulation=form)
            for line, load in zip(solid_lines(axes), panel.loads, strict=True):
                shown = curve(own.sel(numerics="accurate"), load)
                np.testing.assert_array_equal(line.get_xdata(), shown["frequency"])
                np.testing.assert_array_equal(line.get_ydata(), shown["amplitude"])


@pytest.mark.parametrize("case", RESPONSES, ids=lambda case: f"Fig. {case.number}")
def test_printed_peaks_of_this_figure_and_no_other_are_marked(drawn, case):
    for panel in case.panels:
        expected = {
            (peak.frequency, peak.amplitude)
            for peak in PEAKS
            if peak.figure == case.number and peak.load in panel.loads and peak.amplitude
        }
        assert expected
        for axes in panels(drawn[case.number], panel.letter):
            marks = [line for line in axes.get_lines() if line.get_marker() == "o"]
            assert {(line.get_xdata()[0], line.get_ydata()[0]) for line in marks} == expected
            low, high = axes.get_ylim()
            assert all(low < amplitude < high for _, amplitude in expected)


def test_every_printed_peak_belongs_to_a_drawn_curve():
    shown = [peak for case in RESPONSES for load in case.loads for peak in peaks_of(case, load)]
    assert sorted(map(str, shown)) == sorted(map(str, PEAKS))


def crosses(axes):
    return sorted(x for line in axes.get_lines() if line.get_marker() == "x" for x in line.get_xdata())


def test_lost_points_are_marked_and_only_they(drawn, runs):
    data = response_data(runs, RESPONSES[2])
    total = 0
    for panel in RESPONSES[2].panels:
        both = zip(panels(drawn[10], panel.letter), formulations("pure_shear"), strict=True)
        for axes, form in both:
            own = data.sel(formulation=form)
            expected = [
                frequency
                for load in panel.loads
                for numerics in NUMERICS
                for frequency in lost_places(curve(own.sel(numerics=numerics.name), load))
            ]
            assert crosses(axes) == sorted(expected)
            total += len(expected)
    assert total > 0, "none of the runs was lost: the test shows nothing"
    assert np.isnan(data["amplitude"]).sum() == (data["status"] != "completed").sum()
    assert not any(crosses(axes) for number in (4, 7) for axes in drawn[number].axes)


def test_a_lost_run_is_marked_in_its_history(runs):
    case = MOTIONS[0]
    data = history_data(runs, case).copy(deep=True)
    frequency = case.frequencies[1]
    whole = data["time"].size
    data["stretch"].loc[{"frequency": frequency}] = (
        data["stretch"].sel(frequency=frequency).where(np.arange(whole) < whole // 2)
    )
    data["status"].loc[{"frequency": frequency}] = "collapsed"
    axes = panels(draw_history(data, case), "d")[0]
    last = float(data["time"][whole // 2 - 1])
    assert crosses(axes) == [last]
    assert "collapsed" in axes.texts[0].get_text()
    assert not any(crosses(axes) for axes in panels(draw_history(history_data(runs, case), case), "d"))


@pytest.mark.parametrize("case", MOTIONS, ids=lambda case: case.model)
def test_histories_and_phase_figures_show_the_data(drawn, runs, case):
    name = "stretch_1" if case.model == "uniaxial" else "stretch"
    rate = "stretch_rate_1" if case.model == "uniaxial" else "stretch_rate"
    rows, together = history_data(runs, case), phase_data(runs, case)
    for place, form in enumerate(formulations(case.model)):
        own, phase = (data if form is None else data.sel(formulation=form) for data in (rows, together))
        for column, frequency in enumerate(case.frequencies):
            history = panels(drawn[case.history_number], "bdf"[column])[0].get_lines()[place]
            np.testing.assert_array_equal(history.get_ydata(), own[name].sel(frequency=frequency))
            inelastic = panels(drawn[case.history_number], "ace"[column])[0].get_lines()[place]
            shown = own[f"inelastic_{name}"].sel(frequency=frequency)
            np.testing.assert_array_equal(inelastic.get_ydata(), shown)
            for letters, what in (("abc", PATH), ("def", MAP)):
                (line,) = panels(drawn[case.phase_number], letters[column])[place].get_lines()
                part = part_of(phase.sel(frequency=frequency), what)
                np.testing.assert_array_equal(line.get_xdata(), part[name])
                np.testing.assert_array_equal(line.get_ydata(), part[rate])
                assert np.isfinite(line.get_ydata()).all()


def test_phase_rows_are_the_runs(runs):
    case = MOTIONS[2]
    data = phase_data(runs, case)
    for form in formulations(case.model):
        path = part_of(data.sel(formulation=form), PATH)
        points = part_of(data.sel(formulation=form), MAP)
        np.testing.assert_array_equal(path["stretch"], runs.motions(11, form)["stretch"])
        np.testing.assert_array_equal(points["stretch"], runs.sections(12, form)["stretch"])
        np.testing.assert_array_equal(points["time"], runs.sections(12, form)["time"])


@pytest.mark.parametrize("number", NUMBERS)
def test_axes_have_labels_with_units(drawn, number):
    figure = drawn[number]
    labels = [label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    assert labels
    assert all(label.endswith("]") and "[" in label for label in labels)
    for axes in figure.axes:
        shared = axes.get_shared_x_axes().get_siblings(axes)
        assert any(sibling.get_xlabel() for sibling in shared)
        row = [
            one
            for one in figure.axes
            if one.get_position().y0 == pytest.approx(axes.get_position().y0, abs=0.02)
        ]
        assert any(one.get_ylabel() for one in row)


@pytest.mark.parametrize("number", NUMBERS)
def test_panels_are_lettered_in_order_and_text_is_legible(drawn, number):
    letters = "".join(axes.get_title(loc="left")[1] for axes in drawn[number].axes)
    once = {4: "ab", 7: "ab", 10: "abc"}.get(number, "abcdef")
    assert letters == (once * 2 if number in (10, 12) else once)
    texts = [text for text in drawn[number].findobj(Text) if text.get_text()]
    assert min(text.get_fontsize() for text in texts) >= 8.0


@pytest.mark.parametrize("number", NUMBERS)
def test_the_caption_says_how_it_was_computed(drawn, number):
    caption = " ".join(drawn[number].get_supxlabel().split())
    for said in (
        f"Fig. {number}.",
        "from rest",
        "DOP853, rtol 1e-9, atol 1e-12" if number not in (4, 7, 10) else "half of peak",
    ):
        assert said in caption
    if number in (4, 7, 10):
        assert "rtol 1e-9" in caption and "rtol 1e-3" in caption and "transient included" in caption


def test_the_caption_counts_what_was_lost(drawn, runs):
    status = response_data(runs, RESPONSES[2])["status"]
    rough = int((status.sel(numerics="paper") != "completed").sum())
    assert f"lost at 0 points accurate, at {rough} in" in " ".join(drawn[10].get_supxlabel().split())
    assert "lost at" not in drawn[4].get_supxlabel()


@pytest.mark.parametrize("number", (4, 7, 10))
def test_legends_lie_outside_of_the_panels(drawn, number):
    renderer = drawn[number].canvas.get_renderer()
    for axes in drawn[number].axes:
        frame, legend = axes.get_window_extent(renderer), axes.get_legend().get_window_extent(renderer)
        assert legend.y0 >= frame.y1


def test_the_users_own_settings_neither_matter_nor_change(gallery, runs, tmp_path):
    with mpl.rc_context({"font.size": 20.0, "axes.facecolor": "red", "lines.linewidth": 9.0}):
        before = dict(mpl.rcParams)
        drawn = draw_figures(runs, tmp_path, only=(4,))
        assert dict(mpl.rcParams) == before
    for path in drawn:
        first = next(one for one in gallery if one.name == path.name)
        assert path.suffix == ".nc" or path.read_bytes() == first.read_bytes(), path.name


def test_bad_requests_are_refused(runs, tmp_path):
    with pytest.raises(ValueError, match=r"figure must be one of 4, 5, .* 12; got 13"):
        draw_all(tmp_path, only=(13,))
    with pytest.raises(ValueError, match=r"figure must be one of 4, 5, .* 12; got 13"):
        draw_figures(runs, tmp_path, only=(13,))
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match=r"cannot be written"):
        draw_figures(runs, tmp_path / "file", only=(4,))
