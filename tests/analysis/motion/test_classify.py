"""The kind of a motion: known ones, the paper's, what is too short to say, the command and the figure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl
from delagrange.analysis.motion.evidence import tangent_growth
from delagrange.analysis.motion.known_motions import (
    CHAOTIC_MEMBRANE,
    PERIODIC_MEMBRANE,
    QUASI_PERIODIC_MEMBRANE,
)
from delagrange.analysis.motion.verdict import VERDICTS
from delagrange.cli import main
from delagrange.figures.motion_figure import combination, draw_motion
from delagrange.figures.style import journal_style
from delagrange.reproduction.runs.cases import MOTIONS
from delagrange.reproduction.runs.runs import formulations

FIELD = dl.Sine(5e6, 424.0)
HORIZONS = {"chaotic": 0.6, "periodic": 0.8, "quasi-periodic": 1.0}  # [s]


def shifted(drive, phase):
    return replace(drive, phase=phase) if isinstance(drive, dl.Sine) else drive


# --- known motions -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "known", [CHAOTIC_MEMBRANE, PERIODIC_MEMBRANE, QUASI_PERIODIC_MEMBRANE], ids=lambda k: k.kind
)
def test_phases_and_small_initial_states_do_not_flip_a_verdict(known):
    first = dl.load_model(known.model).STATE[0].name

    @settings(max_examples=6, deadline=None)
    @given(phase=st.floats(0.0, 6.28), offset=st.floats(-0.03, 0.03), rate=st.floats(-20.0, 20.0))
    def holds(phase, offset, rate):
        arguments = known.arguments()
        arguments |= {name: shifted(arguments[name], phase) for name in ("force", "field")}
        start = {first: 1 + offset, first.replace("stretch", "stretch_rate"): rate}
        found = dl.classify(**arguments, initial_state=start, duration=HORIZONS[known.kind])
        assert found["verdict"].item() == known.kind, found["evidence"].item()

    holds()


def test_the_chaotic_membrane_for_longer():
    found = dl.classify(**CHAOTIC_MEMBRANE.arguments(), duration=4.0)
    assert found["verdict"].item() == "chaotic"
    exponents = found["lyapunov_exponents"].values
    assert exponents[0] == pytest.approx(52.0, abs=4 * found["lyapunov_uncertainty"].values[0])
    assert exponents[1] > 3 * found["lyapunov_uncertainty"].values[1] / 2
    assert found["zero_one_K"].item() > 0.9
    assert found["unexplained_power"].item() > 0.1
    assert np.isnan(found["torus_dimension"].item())


def test_the_periodic_membrane_repeats_with_the_forcing():
    found = dl.classify(**PERIODIC_MEMBRANE.arguments(), duration=1.0)
    assert found["base_frequencies"].values == pytest.approx([742.0], rel=1e-14)
    assert (found["torus_dimension"].item(), found["period_multiple"].item()) == (1, 1)
    assert np.all(found["lyapunov_exponents"] < -10.0)
    assert np.ptp(found["section_stretch"].values) < 1e-6
    assert "transient of" in found["evidence"].item()


# --- the paper's motions -----------------------------------------------------------------------------

CASES = [
    (case, form, frequency)
    for case in MOTIONS
    for form in formulations(case.model)
    for frequency in case.frequencies
]


@pytest.mark.parametrize(
    ("case", "form", "frequency"), CASES, ids=lambda value: str(getattr(value, "model", value))
)
def test_every_motion_of_figures_6_9_and_12_is_quasi_periodic(case, form, frequency):
    found = dl.classify(
        case.model, force=case.load.force, field=dl.Sine(case.load.field_amplitude, frequency),
        formulation=form, held_stretch=case.load.held_stretch, duration=2.5,
    )  # fmt: skip
    assert found["verdict"].item() == "quasi-periodic", found["evidence"].item()
    coordinates = dl.load_model(case.model, form).COORDINATE_COUNT
    assert found["torus_dimension"].item() == coordinates + 1
    assert found["base_frequencies"].values[0] == 2 * frequency
    assert abs(found["sum_error"].item()) < 1e-6
    made = np.abs(found["line_integers"].values @ found["base_frequencies"].values)
    kept = found["line_explained"].values
    np.testing.assert_allclose(made[kept], found["line_frequency"].values[kept], atol=0.05)


# --- free motions ------------------------------------------------------------------------------------


def test_small_free_vibration_has_the_natural_frequency():
    """f_n = (1 / 2 pi) sqrt(18 (mu_alpha + mu_beta) / (rho H^2 (2 + L^2 / H^2))), the closed form."""
    p = dl.SHENG_2015
    stiffness = 18 * (p.shear_modulus_alpha + p.shear_modulus_beta)
    inertia = p.density * p.half_thickness**2 * (2 + (p.half_length / p.half_thickness) ** 2)
    natural = np.sqrt(stiffness / inertia) / (2 * np.pi)
    found = dl.classify("equal_biaxial", initial_state={"stretch": 1 + 1e-5}, duration=1.0)
    assert found["verdict"].item() == "periodic"
    assert found["base_frequencies"].values == pytest.approx([natural], rel=1e-8)


def test_a_free_motion_of_two_coordinates_has_two_base_frequencies():
    found = dl.classify("uniaxial", force=0.5, duration=1.0)
    assert found["verdict"].item() == "quasi-periodic"
    assert found["torus_dimension"].item() == 2
    assert "small vibration" in found["section_time"].attrs["long_name"]


def test_without_force_two_coordinates_move_as_one():
    field = dl.Sine(3e6, 300.0)
    two, one = (dl.classify(name, field=field, duration=1.0) for name in ("uniaxial", "equal_biaxial"))
    assert two["verdict"].item() == one["verdict"].item() == "quasi-periodic"
    np.testing.assert_allclose(two["base_frequencies"], one["base_frequencies"], rtol=1e-8)


def test_two_drives_with_no_common_measure_both_count():
    found = dl.classify(
        "equal_biaxial", force=dl.Sine(0.1, 203.7, bias=0.4), field=dl.Sine(3e6, 371.0), duration=2.0
    )
    assert found["verdict"].item() == "quasi-periodic"
    np.testing.assert_array_equal(found["base_frequencies"].values[:2], [203.7, 742.0])


@pytest.mark.parametrize(
    ("force", "field", "first"),
    [
        (0.5, dl.Sine(2e6, 300.0), 600.0),
        (0.5, dl.Sine(2e6, 300.0, bias=1e6), 300.0),
        (dl.Sine(0.1, 300.0, bias=0.3), 0.0, 300.0),
        (dl.Sine(0.1, 300.0, bias=0.3), dl.Sine(2e6, 300.0), 300.0),
        (dl.Sine(0.1, 400.0, bias=0.3), dl.Sine(2e6, 300.0), 200.0),
    ],
)
def test_the_forcing_is_at_twice_the_frequency_of_a_field_without_bias(force, field, first):
    found = dl.classify("equal_biaxial", force=force, field=field, duration=0.05)
    assert found["base_frequencies"].values[0] == pytest.approx(first, rel=1e-14)
    assert found.attrs["forcing_period"] == pytest.approx(1 / first, rel=1e-14)


# --- rest, loss, doubt -------------------------------------------------------------------------------


def test_rest():
    still = dl.classify("equal_biaxial", duration=0.1)
    assert still["verdict"].item() == "at rest"
    hardly_begun = dl.classify("equal_biaxial", field=dl.Sine(1e6, 1e9), duration=1e-6)
    assert hardly_begun["verdict"].item() == "undecided"
    assert hardly_begun["sufficient_horizon"].item() > 1.0
    damped = dl.classify("equal_biaxial", force=0.3, dashpots="evolving", relaxation_time=0.01, duration=0.5)
    assert damped["verdict"].item() == "at rest"
    assert damped.attrs["transient"] > 0.3


def test_a_motion_that_is_lost_says_when():
    lost = dl.classify("equal_biaxial", field=dl.Sine(5e7, 371.0))
    assert lost["verdict"].item() == "lost"
    assert lost["status"].item() == "collapsed"
    assert f"{lost['status_time'].item():.6g}" in lost["evidence"].item()


@pytest.mark.parametrize(
    "arguments",
    [
        {"model": "uniaxial", "force": 0.5, "field": FIELD, "duration": 0.05},
        {"model": "equal_biaxial", "force": 0.5, "field": dl.Sine(5e6, 371.0), "duration": 0.2},
        CHAOTIC_MEMBRANE.arguments() | {"duration": 0.06},
    ],
)
def test_too_short_a_horizon_is_undecided_and_the_one_it_names_would_do(arguments):
    short = dl.classify(**arguments)
    assert short["verdict"].item() == "undecided"
    horizon = short["sufficient_horizon"].item()
    assert horizon > arguments["duration"]
    assert f"{horizon:.3g} s would do" in short["evidence"].item()
    longer = dl.classify(**arguments | {"duration": horizon})
    assert longer["verdict"].item() in ("quasi-periodic", "chaotic")
    assert np.isnan(longer["sufficient_horizon"].item())


def test_dashpots_that_creep_for_long_are_undecided_or_said():
    arguments = {"model": "equal_biaxial", "force": 0.5, "field": dl.Sine(3e6, 371.0), "dashpots": "evolving"}
    creeping = dl.classify(**arguments, relaxation_time=1.0, duration=1.0)
    assert creeping["verdict"].item() == "undecided"
    assert creeping["sufficient_horizon"].item() > 30.0
    assert "while the dashpots evolve" in creeping["evidence"].item()
    hardly = dl.classify(**arguments, relaxation_time=1e9, duration=1.0)
    assert hardly["verdict"].item() == "quasi-periodic"
    assert "while the dashpots evolve" in hardly["evidence"].item()


def test_relaxed_waits_for_transients_however_long():
    arguments = {
        "model": "equal_biaxial",
        "force": 0.5,
        "field": dl.Sine(3e6, 371.0),
        "relaxation_time": 0.02,
    }
    waited = dl.classify(**arguments, dashpots="relaxed", duration=0.3)
    assert waited.attrs["transient"] > 1.2
    assert waited["verdict"].item() == "periodic"
    with pytest.raises(ValueError, match="transient must lie from 0 s to"):
        dl.classify(**arguments | {"relaxation_time": 1e9}, dashpots="relaxed", duration=0.3)


def test_a_long_transient_is_taken_in_parts(monkeypatch):
    arguments = PERIODIC_MEMBRANE.arguments() | {"duration": 0.3, "transient": 0.1}
    whole = dl.classify(**arguments)
    monkeypatch.setattr("delagrange.analysis.motion.observation._AT_ONCE", 20)
    parts = dl.classify(**arguments)
    np.testing.assert_allclose(parts["section_stretch"], whole["section_stretch"], rtol=0, atol=1e-9)


def test_the_gain_of_the_tangent_parts_powers_of_time_from_exponentials():
    times = np.linspace(0.01, 10.0, 4000)
    for power in (0.5, 1.0, 2.0):
        growth = tangent_growth(np.diff(power * np.log(times))[:, None])
        assert growth.gain == pytest.approx(0.75 * power, rel=0.1)
    growth = tangent_growth(np.diff(5.0 * times)[:, None])
    assert growth.gain == pytest.approx(25.0, rel=0.01)
    assert growth.sustained


# --- the Dataset, the command, the figure ------------------------------------------------------------


@pytest.fixture(scope="module")
def quasi_periodic():
    return dl.classify(**QUASI_PERIODIC_MEMBRANE.arguments(), duration=1.2)


def test_the_dataset_says_what_it_is(quasi_periodic, tmp_path):
    for name, data in quasi_periodic.variables.items():
        assert "long_name" in data.attrs, name
        assert data.dtype == object or name == "status" or "units" in data.attrs, name
    assert {"verdict", "lyapunov_exponents", "base_frequencies"} <= set(quasi_periodic.data_vars)
    assert quasi_periodic["lyapunov_exponents"].attrs["units"] == "1/s"
    assert quasi_periodic["base_frequencies"].attrs["units"] == "Hz"
    assert quasi_periodic["verdict"].item() in VERDICTS
    assert {"dashpots", "tolerance", "duration", "load", "model", "parameters_source"} <= set(
        quasi_periodic.attrs
    )
    quasi_periodic.to_netcdf(tmp_path / "motion.nc")
    with xr.open_dataset(tmp_path / "motion.nc") as read:
        np.testing.assert_array_equal(read["line_integers"], quasi_periodic["line_integers"])
        assert read["verdict"].item() == "quasi-periodic"


@pytest.mark.parametrize(
    "options",
    [
        {"duration": 0.0},
        {"duration": "long"},
        {"transient": -1.0},
        {"dashpots": "molten"},
        {"field": dl.Tabulated([0.0, 1.0], [0.0, 1.0])},
        {"held_stretch": 2.0},
        {"relaxation_tme": 1.0},
    ],
)
def test_bad_input_is_refused_in_one_line(options):
    with pytest.raises(ValueError, match=r"\w") as refusal:
        dl.classify("equal_biaxial", **options)
    assert "\n" not in str(refusal.value)


def test_the_command_prints_draws_and_writes(tmp_path, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "140")
    out, plot = tmp_path / "motion.nc", tmp_path / "motion.png"
    code = main([
        "classify", "equal-biaxial", "--force", "0.5", "--field-amplitude", "5e6", "--frequency", "185",
        "--duration", "1.2", "--out", str(out), "--plot", str(plot), "--quiet",
    ])  # fmt: skip
    printed = capsys.readouterr()
    assert (code, printed.err) == (0, "")
    assert "equal_biaxial: quasi-periodic" in printed.out
    assert "x 370 Hz" in printed.out
    assert plot.read_bytes().startswith(b"\x89PNG")
    with xr.open_dataset(out) as read:
        assert read["torus_dimension"].item() == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--out", "motion.csv"], "must end in .nc"),
        (["--plot", "motion.gif"], "must end in .png"),
        (["--initial", "stretch=1,2"], "initial stretch must be a single number"),
        (["--initial", "length=1"], "names no state variable"),
        (["--duration", "-1"], "duration must lie"),
        (["--frequency", "100"], "changes nothing without"),
    ],
)
def test_the_command_refuses_in_one_line(arguments, said, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["classify", "equal-biaxial", *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


def test_every_verdict_can_be_drawn(quasi_periodic):
    short = {"force": 0.5, "duration": 0.05}
    motions = (
        quasi_periodic,
        dl.classify("uniaxial", field=FIELD, **short),
        dl.classify("equal_biaxial", duration=0.05),
        dl.classify("equal_biaxial", field=dl.Sine(5e7, 371.0)),
        dl.classify(**CHAOTIC_MEMBRANE.arguments(), duration=0.5),
        dl.classify(**PERIODIC_MEMBRANE.arguments(), duration=0.5),
    )
    assert {motion["verdict"].item() for motion in motions} == set(VERDICTS)
    with journal_style():
        for motion in motions:
            figure = draw_motion(motion)
            figure.canvas.draw()
            for axes in figure.axes:
                assert "[" in axes.get_xlabel() and "[" in axes.get_ylabel()


def test_combinations_are_written_as_one_says_them():
    assert combination(np.array([2, -1, 0])) == "$2f_{1}-f_{2}$"
    assert combination(np.array([-1, 0, 3])) == "$-f_{1}+3f_{3}$"
