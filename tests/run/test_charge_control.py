"""Membranes under charge control through every analysis: closed forms, and the same membrane under voltage control."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
import xarray as xr
from charge_membranes import (
    DENSITY,
    EPSILON,
    GENT,
    LENGTH,
    MEDIUM,
    MU,
    ONE_BRANCH,
    PARALLEL,
    THICKNESS,
    TWO_BRANCHES,
    VOLTAGE,
    derived,
)
from scipy.integrate import solve_ivp

import delagrange as dl
from delagrange.cli import main
from delagrange.engines.flow import AMPLITUDE, FREQUENCY, FlowPath, Source
from delagrange.engines.flow_scipy import flow_by_scipy
from delagrange.engines.flows import resolve_flow
from delagrange.figures.equilibrium_figure import draw_equilibria
from delagrange.figures.modes_figure import draw_modes
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import is_damped
from delagrange.problem.problem import Problem, make_problem

CHARGE = "nominal_charge_density"
TYPICAL = np.sqrt(MU * EPSILON)  # [C/m^2]
CRITICAL = 2 ** (1 / 3)  # stretch at which the voltage is largest


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("charge")


@pytest.fixture(scope="module")
def charged(folder) -> ModuleType:
    return derived(folder, "charged")


@pytest.fixture(scope="module")
def voltaged(folder) -> ModuleType:
    return derived(folder, "voltaged", control=VOLTAGE)


@pytest.fixture(scope="module")
def damped(folder) -> ModuleType:
    """Two branches, and the medium, with compiled kernels."""
    return derived(folder, "damped", kernels=True, more=TWO_BRANCHES + MEDIUM)


def at_rest(charge):
    """Stretch of the neo-Hookean membrane under a nominal charge density without force.

    The charge of an electrode is spread over the area that the stretch gives it, true density D/lambda^2, and the
    true field is D/(epsilon lambda^2). The Maxwell stress epsilon E^2 balances mu (lambda^2 - lambda^-4), so that
    lambda^6 = 1 + D^2/(mu epsilon).
    """
    return (1 + np.square(charge) / (MU * EPSILON)) ** (1 / 6)


def same_field(charge):
    """The nominal field [V/m] there: voltage over reference thickness, true field times lambda^-2."""
    return charge / (EPSILON * at_rest(charge) ** 4)


# --- equilibria --------------------------------------------------------------------------------------


def test_equilibria_are_those_of_the_closed_form_and_stable(charged, rng):
    charges = TYPICAL * np.sort(10 ** rng.uniform(-3.0, 1.5, 30))
    found = dl.equilibria(charged, inputs={CHARGE: charges})
    assert found.sizes["branch"] == 1 and found.sizes["limit_point"] == 0
    np.testing.assert_allclose(found["stretch"][:, 0], at_rest(charges), rtol=1e-10)
    np.testing.assert_allclose(
        found["true_field"][:, 0], charges / EPSILON / at_rest(charges) ** 2, rtol=1e-9
    )
    assert set(found["stability"].values.ravel()) == {"stable"}


def test_the_charge_is_a_coordinate_with_its_unit_and_there_is_no_voltage(charged):
    found = dl.equilibria(charged, inputs={CHARGE: [0.0, TYPICAL]})
    assert found[CHARGE].attrs["units"] == "C/m^2"
    assert found["stretch"].dims == (CHARGE, "branch")
    assert found["margin"].attrs["units"] == found[f"branch_highest_{CHARGE}"].attrs["units"] == "C/m^2"
    assert not [
        name
        for name in found.variables
        if "voltage" in name or (name.endswith("_field") and name != "true_field")
    ]
    single = dl.equilibria(charged, inputs={CHARGE: -TYPICAL})  # its sign does not matter
    assert float(single["stretch"][0]) == pytest.approx(2 ** (1 / 6), rel=1e-12)


def test_no_charge_pulls_it_in(charged):
    found = dl.pull_in(charged, inputs={"force": [0.0, 0.2]})
    assert found["found"].values.tolist() == ["no limit point up to the limits"] * 2
    assert np.all(np.isnan(found[CHARGE])) and "voltage" not in found
    assert np.all(found[f"highest_{CHARGE}"] > 19 * TYPICAL)


def test_nor_a_charge_applied_at_once_before_a_stretch_passes_its_limit(charged):
    """By energy it turns back where D^2 (1 - lambda^-4)/epsilon = mu (2 lambda^2 + lambda^-4 - 3)."""
    sudden = dl.dynamic_pull_in(charged, resolution=1e-4, duration=4e-3)
    assert sudden["found"].item() == "no barrier"
    assert np.isnan(sudden[f"static_{CHARGE}"]) and np.isnan(sudden[f"{CHARGE}_by_energy"])
    stretch = dl.Limits().smallest_stretch ** -0.5  # where the thickness passes it
    expected = TYPICAL * np.sqrt((2 * stretch**2 + stretch**-4 - 3) / (1 - stretch**-4))
    found, width = float(sudden[f"{CHARGE}_by_integration"]), float(sudden["bracket_width"])
    assert width <= 1e-4 * found
    assert abs(found - expected) <= width / 2 + 1e-8 * expected  # the middle of a bracket that holds it


def test_nor_with_two_coordinates_before_one_passes_its_limit(folder):
    """The largest value of a coordinate decides, and that lies between the ends of steps."""
    membrane = derived(folder, "pulled", load='kind = "uniaxial"')
    limits, duration = dl.Limits(1e-3, 1.2), 2e-3
    sudden = dl.dynamic_pull_in(membrane, resolution=1e-4, duration=duration, limits=limits, force=0.1)
    middle, width = float(sudden[f"{CHARGE}_by_integration"]), float(sudden["bracket_width"])
    largest = [
        float(
            dl.simulate(
                membrane,
                duration=duration,
                samples=20001,
                inputs={"force": 0.1, CHARGE: middle + sign * width},
            )["stretch_1"].max()
        )
        for sign in (-0.6, 0.6)
    ]
    assert largest[0] < 1.2 < largest[1] and largest[1] - largest[0] < 1e-3


def test_a_resolution_of_none_is_coarse_where_energy_gives_the_critical_value():
    one = dl.dynamic_pull_in("equal_biaxial", force=0.2, resolution=None)
    fine = dl.dynamic_pull_in("equal_biaxial", force=0.2, resolution=1e-6)
    assert float(one["field"]) == float(fine["field"]) and one["found"].item() == fine["found"].item()
    assert float(one["duration"]) == pytest.approx(float(fine["duration"]) / 10)
    assert 1e-6 < float(one["bracket_width"] / one["field"]) < 1e-2
    two = dl.dynamic_pull_in("uniaxial", force=0.2, resolution=None, duration=0.01)
    assert float(two["bracket_width"] / two["field"]) <= 1e-7


def test_breakdown_comes_at_the_charge_that_gives_the_field(charged):
    """True field D/(epsilon lambda^2) over the strength."""
    strength = 0.9 * np.sqrt(MU / EPSILON)
    charge = float(dl.pull_in(charged, breakdown_field=strength)[f"breakdown_{CHARGE}"])
    assert charge / (EPSILON * at_rest(charge) ** 2) == pytest.approx(strength, rel=1e-9)


@pytest.mark.parametrize("ratio", [0.4, 0.9, 1.1, 3.0])
def test_voltage_control_has_the_same_equilibrium_and_loses_it(charged, voltaged, ratio):
    """Both balance the same forces; beyond the stretch of pull-in only the charge holds the membrane there."""
    stretch = 1 + ratio * (CRITICAL - 1)
    charge = np.sqrt(MU * EPSILON * (stretch**6 - 1))
    held = dl.equilibria(charged, inputs={CHARGE: charge})
    free = dl.equilibria(voltaged, field=same_field(charge))
    nearest = int(np.argmin(np.abs(free["stretch"].values - stretch)))
    assert float(held["stretch"][0]) == pytest.approx(stretch, rel=1e-10)
    assert float(free["stretch"][nearest]) == pytest.approx(stretch, rel=1e-8)
    assert float(free["true_field"][nearest]) == pytest.approx(float(held["true_field"][0]), rel=1e-8)
    assert held["stability"].values[0] == "stable"
    assert free["stability"].values[nearest] == ("stable" if ratio < 1 else "unstable")


def test_a_stiffening_membrane_snaps_under_voltage_and_goes_on_under_charge(folder):
    snapping = derived(folder, "snapping", control=VOLTAGE, spring=GENT)
    smooth = derived(folder, "smooth", spring=GENT)
    field = np.sqrt(MU / EPSILON)
    folds = dl.equilibria(snapping, field=[0.0, 0.5 * field, field])
    assert sorted(folds["limit_kind"].values) == ["snap-back", "snap-through"]
    assert int(folds["stable_count"].max()) == 2
    charges = TYPICAL * np.linspace(0.0, 150.0, 16)
    found = dl.equilibria(smooth, inputs={CHARGE: charges})
    assert found.sizes["limit_point"] == 0 and found.sizes["branch"] == 1
    stretches = found["stretch"].values[:, 0]
    assert np.all(np.diff(stretches) > 0) and stretches[-1] > float(folds["limit_stretch"].max())
    assert set(found["curve_stability"].values) == {"stable"}


def test_the_true_field_knows_a_permittivity_that_follows_the_stretch(folder):
    softening = (
        f'permittivity_formula = "e*(1 - c*(lambda_1 - 1))"\nparameters = {{ e = "{EPSILON} F/m", c = 0.05 }}'
    )
    membrane = derived(folder, "softening", permittivity=softening)
    found = dl.equilibria(membrane, inputs={CHARGE: [0.3 * TYPICAL, 1.5 * TYPICAL]})
    stretch = found["stretch"].values[:, 0]
    expected = found[CHARGE].values / (EPSILON * (1 - 0.05 * (stretch - 1)) * stretch**2)
    np.testing.assert_allclose(found["true_field"].values[:, 0], expected, rtol=1e-9)


# --- vibrations --------------------------------------------------------------------------------------


def test_natural_frequencies_are_those_of_the_closed_form(charged):
    """omega^2 = K/M, K = V (mu (2 + 10 lambda^-6) + 10 D^2 lambda^-6/epsilon), M = rho V (2 L^2 + 4 H^2 lambda^-6)/3.

    Second derivative of V (mu/2 (2 lambda^2 + lambda^-4 - 3) + D^2 lambda^-4/(2 epsilon)), and the kinetic energy of
    a plate of 2 L by 2 L by 2 H whose thickness stretch is lambda^-2.
    """
    charges = TYPICAL * np.array([0.0, 0.5, 1.0, 2.0, 5.0])
    stretch = at_rest(charges)
    stiffness = MU * (2 + 10 * stretch**-6) + 10 * charges**2 * stretch**-6 / EPSILON
    mass = DENSITY * (2 * LENGTH**2 + 4 * THICKNESS**2 * stretch**-6) / 3
    found = dl.modes(charged, inputs={CHARGE: charges})
    np.testing.assert_allclose(found["frequency"][:, 0], np.sqrt(stiffness / mass) / (2 * np.pi), rtol=1e-9)
    np.testing.assert_allclose(found["resonant_charge_frequency"], found["frequency"] / 2)
    assert found["frequency"].dims == (CHARGE, "mode") and found[CHARGE].attrs["units"] == "C/m^2"


def test_what_damps_beside_frozen_dashpots(folder, damped):
    """A dashpot in parallel, or the medium; a branch alone, or nothing, does not."""
    parallel = derived(folder, "parallel", more=PARALLEL)
    branch = derived(folder, "branch", more=ONE_BRANCH)
    plain = derived(folder, "plain")
    found = [
        is_damped(loaded(membrane))
        for membrane in (damped, parallel, branch, plain, dl.load_model("uniaxial"))
    ]
    assert found == [True, True, False, False, False]


def loaded(model: ModuleType, drive: object = 0.0) -> Problem:
    inputs = {CHARGE: drive} if model.INPUTS[-1].name == CHARGE else {}
    return make_problem(model, None, {}, None, 0.0, 0.0, inputs)


# --- motion ------------------------------------------------------------------------------------------


def test_tangents_are_those_of_the_flow_by_scipy(damped):
    """Of the state and of two numbers of the charge, with branches and medium that damp."""
    problem = loaded(damped, dl.Sine(0.7 * TYPICAL, 310.0, 0.2 * TYPICAL))
    path = FlowPath(problem, typical_sizes(problem), 1e-12)
    times, start = np.array([0.0, 1e-3, 6e-3]), np.array([1.05, 20.0, 1.02, 0.99])
    place = len(damped.INPUTS) - 1
    tangent = np.column_stack([np.diag(path.weights), np.zeros((4, 2))])
    sources = (*(None,) * 4, Source(place, AMPLITUDE), Source(place, FREQUENCY))
    fast, slow = (
        flow(path, start, times, tangent, sources)
        for flow in (resolve_flow(problem, "compiled"), flow_by_scipy)
    )
    np.testing.assert_allclose(fast.state / path.weights, slow.state / path.weights, atol=1e-9)
    sizes = np.max(np.abs(slow.tangent) / path.weights[:, None], axis=0)
    assert np.all(sizes > 0)
    np.testing.assert_allclose(
        fast.tangent / path.weights[:, None] / sizes, slow.tangent / path.weights[:, None] / sizes, atol=1e-9
    )
    np.testing.assert_allclose(fast.divergence, slow.divergence, rtol=1e-9)


def test_energy_is_kept_under_a_constant_charge(charged):
    run = dl.simulate(
        charged, duration=0.02, inputs={CHARGE: 1.2 * TYPICAL}, energies=True, rtol=1e-11, atol=1e-13
    )
    energy = run["total_energy"].values
    scale = float(np.max(run["kinetic_energy"]))
    assert scale > 1e-5  # it moves
    np.testing.assert_allclose(energy, energy[0], atol=1e-8 * scale)
    assert float(run["stretch"].max()) > at_rest(1.2 * TYPICAL)  # and swings over where it would rest


def test_a_run_is_that_of_the_equations_integrated_by_scipy(damped):
    drive = dl.Sine(0.8 * TYPICAL, 250.0)
    run = dl.simulate(damped, duration=0.01, inputs={CHARGE: drive}, rtol=1e-11, atol=1e-13)
    problem = loaded(damped, drive)
    start = np.asarray(damped.reference_state(problem.parameters), dtype=float)
    inputs = [0.0, 0.0]

    def rates(time, state):
        inputs[1] = 0.8 * TYPICAL * np.sin(2 * np.pi * 250.0 * time)
        return damped.rhs(state, inputs, problem.parameters)

    times = run["time"].values
    witness = solve_ivp(rates, times[[0, -1]], start, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-13)
    for entry, values in zip(damped.STATE, witness.y):
        np.testing.assert_allclose(run[entry.name], values, atol=1e-8 * np.max(np.abs(values)), rtol=0)


# --- the periodic response, and the kind of motion ------------------------------------------------------


@pytest.fixture(scope="module")
def steady(damped):
    return dl.steady_response(
        damped, frequency=(420.0, 440.0), charge_amplitude=0.3 * TYPICAL, resolution=10, seeds=2
    )


def test_periodic_motions_under_a_sine_of_the_charge_come_back(damped, steady):
    assert steady["charge_amplitude"].attrs["units"] == "C/m^2" and "field_amplitude" not in steady
    assert set(steady["stability"].values) == {"stable"}
    point = steady.isel(point=len(steady["point"]) // 2)
    frequency = float(point["frequency"])
    assert float(point["period"]) == pytest.approx(1 / (2 * frequency))  # the charge enters squared
    state = np.array([float(point[entry.name]) for entry in damped.STATE])
    viscous = {"viscosity_1": np.inf, "viscosity_2": np.inf}  # frozen
    parameters = make_problem(damped, None, {}, None, 0.0, 0.0).parameters
    frozen = [viscous.get(entry.name, value) for entry, value in zip(damped.PARAMETERS, parameters)]

    def rates(time, at):
        return damped.rhs(at, [0.0, 0.3 * TYPICAL * np.sin(2 * np.pi * frequency * time)], frozen)

    end = solve_ivp(rates, (0.0, float(point["period"])), state, method="DOP853", rtol=1e-12, atol=1e-13).y[
        :, -1
    ]
    np.testing.assert_allclose(end, state, rtol=1e-8, atol=1e-6)


def test_a_stepped_sweep_settles_on_them(damped, steady):
    swept = dl.stepped_sweep(
        damped, frequency=[425.0, 435.0], charge_amplitude=0.3 * TYPICAL, dashpots="frozen", settle=150
    )
    order = np.argsort(steady["frequency"].values)
    expected = np.interp(
        swept["frequency"], steady["frequency"].values[order], steady["amplitude"].values[order]
    )
    np.testing.assert_allclose(swept["amplitude"], expected, rtol=5e-3)  # of the chords between points
    assert swept.attrs[f"{CHARGE}_drive"] == "charge_bias + charge_amplitude * sin(2 pi frequency t)"


def test_along_the_amplitude_of_the_charge(damped):
    """A small motion grows with the square of the charge."""
    found = dl.steady_response(
        damped, frequency=300.0, charge_amplitude=(0.01 * TYPICAL, 0.02 * TYPICAL), resolution=10, seeds=2
    )
    ratio = found["amplitude"] / found["charge_amplitude"] ** 2
    np.testing.assert_allclose(ratio, float(ratio[0]), rtol=1e-3)


def test_its_kind_of_motion_and_its_exponents(damped):
    """A stable motion, forced at twice the frequency of the charge."""
    given = {"inputs": {CHARGE: dl.Sine(0.3 * TYPICAL, 430.0)}, "duration": 0.5}
    kind = dl.classify(damped, **given)
    assert kind["verdict"].item() == "periodic"
    assert float(kind["base_frequencies"][0]) == pytest.approx(860.0, rel=1e-9)
    assert "C/m^2" in kind.attrs["load"]
    spectrum = dl.lyapunov_spectrum(damped, **given)
    assert np.all(spectrum["lyapunov_exponents"].values[:2] < 0)


# --- what is refused -----------------------------------------------------------------------------------

REFUSED = {
    "a field": (dl.equilibria, {"field": 1e6}, "input of charged is nominal_charge_density .*; give inputs="),
    "a voltage": (dl.equilibria, {"voltage": 1e3}, "but the electrical input of charged is nominal_charge_density"),
    "nothing": (dl.equilibria, {}, r"inputs nominal_charge_density \[C/m\^2\] must be given, got none"),
    "not increasing": (dl.equilibria, {"inputs": {CHARGE: [1e-3, 0.0]}}, "nominal_charge_density must"),
    "a drive": (dl.modes, {"inputs": {CHARGE: dl.Sine(1.0, 2.0)}}, "must be a number or an array of them here"),
    "a field to modes": (dl.modes, {"field": [1e6]}, "but the electrical input of charged is nominal_charge_density"),
    "what varies": (dl.pull_in, {"inputs": {CHARGE: 1e-3}}, "nominal_charge_density is what varies here"),
    "an amplitude of the field": (
        dl.steady_response,
        {"frequency": (1.0, 2.0), "field_amplitude": 1e6},
        "field_amplitude given as 1000000, but the electrical input of charged is nominal_charge_density",
    ),
    "no amplitude": (dl.steady_response, {"frequency": (1.0, 2.0)}, r"charge_amplitude must be a number in C/m\^2"),
    "a negative amplitude": (
        dl.stepped_sweep,
        {"frequency": [1.0], "charge_amplitude": -1e-3},
        r"charge_amplitude must not be negative, got -0.001 C/m\^2",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused_in_one_line(charged, case):
    analysis, given, says = REFUSED[case]
    with pytest.raises(ValueError, match=says) as refusal:
        analysis(charged, **given)
    assert "\n" not in str(refusal.value)


def test_a_charge_is_refused_where_the_voltage_drives():
    with pytest.raises(
        ValueError, match=r"charge_amplitude given as 0.001, but the electrical input of equal_biaxial"
    ):
        dl.steady_response("equal_biaxial", frequency=(1.0, 2.0), field_amplitude=1.0, charge_amplitude=1e-3)
    with pytest.raises(ValueError, match="unknown input 'nominal_charge_density'"):
        dl.equilibria("equal_biaxial", field=0.0, inputs={CHARGE: 1e-3})


def test_a_current_that_feeds_no_charge_of_the_state_is_refused(charged):
    fed = ModuleType("fed")
    fed.__dict__.update({name: value for name, value in vars(charged).items() if not name.startswith("__")})
    fed.MODEL = "fed"
    fed.INPUTS = (charged.INPUTS[0], charged.INPUTS[1]._replace(name="nominal_current_density", unit="A/m^2"))
    for analysis in (dl.rest_state, dl.pull_in, dl.modes):
        with pytest.raises(ValueError, match="the model fed has a current, and no charge in its state") as refusal:
            analysis(fed)
        assert "\n" not in str(refusal.value)


# --- commands and figures ------------------------------------------------------------------------------


def told(capsys, *arguments: str) -> str:
    """What a command that succeeds prints."""
    assert main([*arguments, "--quiet"]) == 0
    return capsys.readouterr().out


def test_equilibria_and_modes_by_command(capsys, tmp_path, monkeypatch, charged):
    monkeypatch.setenv("COLUMNS", "140")
    out, plot = tmp_path / "found.nc", tmp_path / "found.png"
    given = ["--input", f"{CHARGE}=0:4e-3:2e-3", "--out", str(out), "--plot", str(plot)]
    text = told(capsys, "equilibrium", charged.__file__, *given)
    assert "nominal charge density [C/m^2]" in text and "margin [C/m^2]" in text
    stored = xr.load_dataset(out)
    np.testing.assert_allclose(stored["stretch"][:, 0], at_rest(stored[CHARGE].values), rtol=1e-10)
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert "charge frequency [Hz]" in told(capsys, "modes", charged.__file__, *given)
    assert xr.load_dataset(out)["frequency"].dims == (CHARGE, "mode")
    alone = told(capsys, "equilibrium", charged.__file__)  # up to a charge that it chooses
    assert alone.count("stable") == 12


def test_response_and_kind_of_motion_by_command(capsys, tmp_path, damped):
    out, plot = tmp_path / "found.nc", tmp_path / "found.png"
    files = ["--out", str(out), "--plot", str(plot)]
    sine = ["--charge-amplitude", "5e-4", "--frequency"]
    text = told(
        capsys, "response", damped.__file__, *sine, "300:303", "--steady", "--most-points", "8", *files
    )
    assert "periodic motions along frequency" in text and "The charge enters squared" in text
    assert np.all(xr.load_dataset(out)["charge_amplitude"] == 5e-4)
    assert "periodic" in told(capsys, "classify", damped.__file__, *sine, "300", "--duration", "0.5", *files)
    assert plot.read_bytes().startswith(b"\x89PNG")


def test_a_transient_response_by_command(capsys, tmp_path, damped):
    """Beside the periodic motions and alone, as under a field."""
    out, plot = tmp_path / "found.nc", tmp_path / "found.png"
    sine = [
        "--charge-amplitude",
        "5e-4",
        "--charge-bias",
        "1e-4",
        "--frequency",
        "300:303:1",
        "--duration",
        "0.01",
    ]
    text = told(capsys, "response", damped.__file__, *sine, "--out", str(out), "--plot", str(plot))
    assert "transient amplitude" in text and plot.read_bytes().startswith(b"\x89PNG")
    stored = xr.load_dataset(out)
    assert stored["charge_bias"] == 1e-4 and stored["charge_amplitude"].units == "C/m^2"
    sine = dl.Sine(5e-4, 303.0, 1e-4)
    run = dl.simulate(damped, inputs={CHARGE: sine}, duration=0.01, samples=20001)
    half = (float(run["stretch"].max()) - float(run["stretch"].min())) / 2
    assert float(stored["amplitude"][-1]) == pytest.approx(half, rel=1e-6)


WRONG = {
    "field": (
        ["response", "--field-amplitude", "5e4", "--frequency", "300:303", "--steady"],
        "field_amplitude given as 50000, but the electrical input of charged is nominal_charge_density [C/m^2]",
    ),
    "none": (["response", "--frequency", "300:303", "--steady"], "charge_amplitude must be a number in C/m^2"),
    "both": (
        ["classify", "--charge-amplitude", "5e-4", "--frequency", "300", "--field-amplitude", "1e6"],
        "driven by --field-amplitude and --charge-amplitude at once",
    ),
    "a force beside a map": (
        ["equilibrium", "--map-force", "0:0.2:0.1", "--force", "0"],
        "--force changes nothing with --map-force, which gives the forces itself",
    ),
    "dashpots beside a map": (
        ["equilibrium", "--map-force", "0:0.2:0.1", "--dashpots", "relaxed"],
        "--dashpots changes nothing with --map-force, which has relaxed and frozen ones side by side",
    ),
    "twice": (
        ["classify", "--charge-amplitude", "5e-4", "--frequency", "300", "--input", f"{CHARGE}=1e-3"],
        "is given by --charge-amplitude and by --input",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_command_is_refused_in_one_line(capsys, charged, case):
    (command, *arguments), says = WRONG[case]
    assert main([command, charged.__file__, *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert says in line


def test_figures_label_the_charge(charged, voltaged):
    charges = TYPICAL * np.linspace(0.0, 2.0, 5)
    found = dl.equilibria(charged, inputs={CHARGE: charges})
    vibrations = dl.modes(charged, inputs={CHARGE: charges})
    for figure in (draw_equilibria(found), draw_modes(vibrations)):
        assert figure.axes[0].get_xlabel() == "nominal charge density $D$ [mC/m²]"
        assert figure.axes[0].get_xlim()[1] == pytest.approx(2e3 * TYPICAL)
    field = draw_equilibria(dl.equilibria(voltaged, field=[0.0, 1e7])).axes[0]
    assert field.get_xlabel() == "nominal field $E$ [MV/m]"
