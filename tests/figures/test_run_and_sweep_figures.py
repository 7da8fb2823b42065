"""The figures of a run and of a sweep: they show the data, name their axes, and mark what was lost."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib import pyplot

import delagrange as dl
from delagrange.cli import main
from delagrange.figures.run_figure import draw_run
from delagrange.figures.sweep_figure import draw_sweep


@pytest.fixture(autouse=True)
def closed():
    yield
    pyplot.close("all")


def lines(axes):
    return [line for line in axes.get_lines() if line.get_marker() != "x"]


def crosses(axes):
    return [line for line in axes.get_lines() if line.get_marker() == "x"]


def sweep(**given):
    fixed = {"duration": 5e-3, "engine": "numpy", "rtol": 1e-6, "frequency": [300.0, 350.0, 400.0]}
    return dl.frequency_response("equal_biaxial", **(fixed | given))


def test_a_run_shows_stretches_and_what_varies_of_the_drive():
    run = dl.simulate("uniaxial", force=0.3, field=dl.Sine(2e6, 400.0), duration=0.01)
    stretches, inelastic, field = draw_run(run).axes
    np.testing.assert_array_equal(lines(stretches)[1].get_ydata(), run["stretch_2"])
    np.testing.assert_array_equal(lines(inelastic)[0].get_ydata(), run["inelastic_stretch_1"])
    np.testing.assert_allclose(lines(field)[0].get_ydata(), run["nominal_electric_field"] / 1e6)
    assert [axes.get_ylabel() for axes in (stretches, inelastic, field)] == [
        "stretches [1]", "inelastic stretches [1]", "$E$ [MV/m]",
    ]  # fmt: skip
    assert field.get_xlabel() == "time $t$ [s]" and "frequency=400" in field.get_title(loc="right")
    assert stretches.figure.get_suptitle() == "uniaxial: P = 0.3 N"
    assert not any(map(crosses, (stretches, inelastic, field)))


def test_a_constant_field_is_told_and_has_no_panel():
    figure = draw_run(dl.simulate("equal_biaxial", force=0.1, field=2e6, duration=1e-3))
    assert len(figure.axes) == 2
    assert figure.get_suptitle() == "equal biaxial: P = 0.1 N, E = 2 MV/m"


def test_a_run_that_is_lost_is_marked_where_it_ended():
    run = dl.simulate("equal_biaxial", field=dl.Ramp(0.0, 4e7, 0.05), duration=0.1)
    figure = draw_run(run)
    stretch, inelastic, _ = figure.axes
    last = run.isel(time=int(run["stretch"].notnull().sum()) - 1)
    for axes, name in ((stretch, "stretch"), (inelastic, "inelastic_stretch")):
        (mark,) = crosses(axes)
        np.testing.assert_array_equal([*mark.get_xdata(), *mark.get_ydata()], [last["time"], last[name]])
    told = f"{run.attrs['status']} at {run.attrs['status_time']:.4g} s"
    assert [text.get_text() for text in stretch.texts] == [told] and not inelastic.texts
    assert stretch.get_yscale() == "log"  # what was before is not pressed to the ground
    assert run.attrs["status"] in " ".join(text.get_text() for text in figure.texts)


def test_a_sweep_has_a_curve_for_each_load_and_names_it():
    response = sweep(force=[0.1, 0.3], field_amplitude=1e6)
    figure = draw_sweep(response)
    (axes,) = figure.axes
    np.testing.assert_array_equal([line.get_ydata() for line in lines(axes)], response["amplitude"])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["$P$ = 0.1 N", "$P$ = 0.3 N"]
    assert len({line.get_color() for line in lines(axes)}) == 2
    assert axes.get_xlabel() == "frequency $f$ [Hz]"
    assert axes.get_ylabel() == r"amplitude of $\lambda_\mathrm{EB}$ [1]"
    assert axes.get_title(loc="right") == "equal biaxial: E₀ = 1 MV/m"
    told = " ".join(" ".join(text.get_text() for text in figure.texts).split())
    assert "half of peak to peak" in told and "0 to 0.005 s" in told and "rtol 1e-6" in told


def test_runs_that_are_lost_are_crosses_of_their_curve():
    response = sweep(force=0.1, field_amplitude=[1e6, 8e7])
    figure = draw_sweep(response)
    (axes,) = figure.axes
    (mark,) = crosses(axes)
    np.testing.assert_array_equal(mark.get_xdata(), response["frequency"])
    assert mark.get_color() == lines(axes)[1].get_color()
    assert figure.legends[0].get_texts()[-1].get_text() == "run lost"
    assert "Lost: 3 of 6 runs." in " ".join(text.get_text() for text in figure.texts)


@pytest.mark.parametrize(
    ("fields", "told"),
    [([1e6], []), ([1e6, 2e6], ["$E_0$ = 1 MV/m", "$E_0$ = 2 MV/m"]),
     (list(np.arange(1.0, 6.0) * 1e6), ["curves of one colour: over amplitude of the field"])],
)  # fmt: skip
def test_of_many_curves_the_longest_axis_is_told_by_colour(fields, told):
    forces = np.linspace(0.0, 0.4, 9)
    response = sweep(force=forces, field_amplitude=fields if len(fields) > 1 else fields[0], duration=1e-3)
    figure = draw_sweep(response)
    axes, scale = figure.axes
    assert scale.get_ylabel() == "force $P$ [N]"
    assert len(lines(axes)) == len(forces) * len(fields)
    assert [text.get_text() for legend in figure.legends for text in legend.get_texts()] == told


def test_one_frequency_is_a_point_that_can_be_seen():
    (axes,) = draw_sweep(sweep(frequency=[300.0], force=0.1, field_amplitude=1e6)).axes
    assert lines(axes)[0].get_marker() == "."


@pytest.mark.parametrize(
    ("command", "more"),
    [("simulate", []), ("sweep", ["--engine", "numpy"])],
)
def test_both_commands_draw(tmp_path, capsys, command, more):
    plot = tmp_path / "drawn.png"
    drive = ["--force", "0.1", "--field-amplitude", "1MV/m", "--frequency", "300Hz", "--duration", "2ms"]
    assert main([command, "equal-biaxial", *drive, *more, "--plot", str(plot), "--quiet"]) == 0
    assert plot.read_bytes().startswith(b"\x89PNG") and plot.stat().st_size > 10000
    assert f"written: {plot}" in capsys.readouterr().out
    assert main([command, "equal-biaxial", *drive, "--plot", "drawn.svg"]) == 2


def test_the_limits_of_loss_are_within_reach(tmp_path, capsys):
    out = tmp_path / "run.nc"
    strong = ["simulate", "equal-biaxial", "--force", "0.5", "--duration", "0.01", "--quiet"]
    assert main([*strong, "--largest-stretch", "1.1", "--smallest-stretch", "0.5", "--out", str(out)]) == 0
    assert "diverged" in capsys.readouterr().out
    stored = dl.simulate("equal_biaxial", force=0.5, duration=0.01, limits=dl.Limits(0.5, 1.1))
    assert stored.attrs["status"] == "diverged"
    assert main([*strong, "--largest-stretch", "0.9"]) == 2
    assert "largest_stretch above 1" in capsys.readouterr().err
