"""Membranes that leak: their charge is part of the state, fed by a current and drained by Ohm's law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from electrical_membranes import (
    CONDUCTIVITY,
    FALL,
    KINDS,
    LAWS,
    LEAKY_FILE,
    PERMITTIVITY,
    VALUES,
    along,
    described,
    emitted,
    moving_state,
    parameters_of,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import delagrange as dl
from delagrange.common.dimension import Dimension
from delagrange.derive.equations.described import description_equations
from delagrange.derive.membrane.description import UNIAXIAL
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.model_file.toml_table import ModelError
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.dimensions import DimensionError
from delagrange.problem.dashpots import charge_place, coordinate_places, dashpot_places, frozen, rate_places
from delagrange.problem.problem import make_problem

MAXWELL_TIME = PERMITTIVITY / CONDUCTIVITY  # [s]
HARD = {"rtol": 1e-12, "atol": 1e-16}
CURRENT, CHARGE = "nominal_current_density", "nominal_charge_density"
seeds = st.integers(0, 10**6)


def inputs_of(module, current: float) -> list[float]:
    return [0.4 if entry.unit == "N" else current for entry in module.INPUTS]


def start_of(module, charge: float) -> list[float]:
    """The reference state with a charge density [C/m^2]."""
    return [*module.reference_state(parameters_of(module))[:-1], charge]


def run_of(module, **given):
    held = {"held_stretch": VALUES["held_stretch"]} if "held_stretch" in module.DEFAULTS else {}
    return dl.simulate(module, **{"duration": 0.02, "samples": 101, "force": 0.2, **held, **HARD, **given})


# --- the law -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_ohms_law_of_a_constant_permittivity_knows_no_stretches(kind):
    balance = description_equations(described("current", kind)).charge_balance
    expected = m.CONDUCTIVITY.symbol * m.CHARGE_DENSITY.symbol / s.PERMITTIVITY.symbol
    assert sp.simplify(balance.leakage_current - expected) == 0
    assert sp.simplify(balance.law - (m.CURRENT_DENSITY.symbol - expected)) == 0


@pytest.mark.parametrize("kind", [kind for kind, law in LAWS if law == "softening"])
@given(seed=seeds)
@settings(max_examples=10)
def test_of_a_permittivity_that_falls_it_does(kind, seed):
    module = emitted("current", kind, "softening")
    parameters, state = parameters_of(module), moving_state(module, seed)
    first, second, _ = module.principal_stretches(state, inputs_of(module, 0.0), parameters)
    expected = -CONDUCTIVITY * state[-1] / (PERMITTIVITY * (1 + FALL * (first + second - 2)))
    rate = module.rhs(state, inputs_of(module, 0.0), parameters)[-1]
    assert rate == pytest.approx(expected, rel=1e-13)


def test_the_state_ends_with_the_charge():
    module = emitted("current", UNIAXIAL)
    assert [entry.unit for entry in module.STATE] == ["1", "1", "1/s", "1/s", "1", "1", "C/m^2"]
    assert (charge_place(module), dashpot_places(module)) == (6, slice(4, 6))
    assert (coordinate_places(module), rate_places(module)) == (slice(0, 2), slice(2, 4))
    assert module.reference_state(parameters_of(module))[-1] == 0.0
    assert charge_place(emitted("charge", UNIAXIAL)) is None
    assert dashpot_places(emitted("charge", UNIAXIAL)) == slice(4, 6)


@pytest.mark.parametrize(("kind", "law"), LAWS)
@settings(max_examples=15)
@given(seed=seeds, current=st.floats(-0.1, 0.1))
def test_energy_changes_by_what_the_source_gives_and_what_leaks_and_flows(kind, law, seed, current):
    """d(T + Pi)/dt at constant inputs, along the motion."""
    module = emitted("current", kind, law)
    given_ = (inputs_of(module, current), parameters_of(module))
    state = moving_state(module, seed)
    names = ("source_power", "leakage_power", "dashpot_power")
    source, leaked, flowed = (getattr(module, name)(state, *given_) for name in names)
    assert leaked > 0 and flowed > 0
    rate = module.rhs(state, *given_)
    kinetic, potential = (
        along(lambda at, energy=energy: getattr(module, energy)(at, *given_), state, rate)
        for energy in ("kinetic_energy", "potential_energy")
    )
    scale = abs(kinetic) + abs(potential) + abs(source) + leaked + flowed
    assert kinetic + potential == pytest.approx(source - leaked - flowed, abs=1e-12 * scale)


@pytest.mark.parametrize(("kind", "law"), LAWS)
def test_the_powers_are_those_of_the_field(kind, law):
    """j E of the nominal ones and sigma E^2 of the true field, times the volume."""
    module = emitted("current", kind, law)
    given_ = (inputs_of(module, 0.03), parameters_of(module))
    state, volume = moving_state(module, 3), 8 * VALUES["half_thickness"] * VALUES["half_length"] ** 2
    field = module.electrodes(state, *given_)[0]
    true_field = field / module.principal_stretches(state, *given_)[2]
    assert module.source_power(state, *given_) == pytest.approx(volume * 0.03 * field, rel=1e-13)
    leaked = volume * CONDUCTIVITY * true_field**2
    assert module.leakage_power(state, *given_) == pytest.approx(leaked, rel=1e-13)


@pytest.mark.parametrize(("kind", "law"), LAWS)
def test_the_jacobians_are_the_derivatives_of_the_rates(kind, law):
    module = emitted("current", kind, law)
    parameters, inputs = parameters_of(module), np.array(inputs_of(module, 0.03))
    state = moving_state(module, 11)
    for name, values, rates in (
        ("jacobian", state, lambda at: module.rhs(at, inputs, parameters)),
        ("input_jacobian", inputs, lambda at: module.rhs(state, at, parameters)),
    ):
        found = getattr(module, name)(state, inputs, parameters)
        witness = np.stack([along(rates, values, unit) for unit in np.eye(len(values))], axis=1)
        scale = np.abs(witness).max(axis=1, keepdims=True)
        np.testing.assert_allclose(found, witness, rtol=1e-11, atol=1e-13 * scale.max())
        assert np.any(found[-1] != 0)


# --- runs --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "law"), LAWS[:4])
def test_without_conductivity_it_is_the_membrane_that_keeps_its_charge(kind, law):
    leaky, charged = emitted("current", kind, law), emitted("charge", kind, law)
    run = run_of(leaky, conductivity=0.0, initial_state=start_of(leaky, 3e-4))
    kept = run_of(charged, inputs={CHARGE: 3e-4})
    assert run.attrs["status"] == "completed"
    np.testing.assert_array_equal(run[CHARGE], 3e-4)
    for entry in charged.STATE:
        scale = float(np.abs(kept[entry.name]).max())
        np.testing.assert_allclose(run[entry.name], kept[entry.name], rtol=0, atol=1e-10 * scale)
    np.testing.assert_allclose(run["nominal_electric_field"], kept["nominal_electric_field"], rtol=1e-10)


def test_in_open_circuit_the_charge_decays_with_the_maxwell_time_while_the_membrane_moves():
    module = emitted("current", UNIAXIAL)
    run = run_of(module, duration=0.05, force=dl.Sine(0.3, 120.0), initial_state=start_of(module, 5e-4))
    assert np.ptp(run["stretch_1"].values) > 0.02
    expected = 5e-4 * np.exp(-run["time"] / MAXWELL_TIME)
    np.testing.assert_allclose(run[CHARGE], expected, rtol=1e-9)


def test_a_steady_current_charges_it_up_to_where_as_much_leaks():
    run = run_of(emitted("current"), duration=0.1, inputs={CURRENT: 0.03})
    final = 0.03 * MAXWELL_TIME
    expected = final * -np.expm1(-run["time"] / MAXWELL_TIME)
    np.testing.assert_allclose(run[CHARGE], expected, rtol=1e-9, atol=1e-15)


def test_no_charge_is_there_that_nobody_brings():
    run = run_of(emitted("current"))
    np.testing.assert_array_equal(run[CHARGE], 0.0)


def test_frozen_dashpots_freeze_no_charge():
    module = emitted("current", UNIAXIAL)
    free = make_problem(module, None, {}, None, 0.2, 0.0, {CURRENT: 0.03})
    state = moving_state(module, 5)
    rate = frozen(free).rhs(0.0, state)
    np.testing.assert_array_equal(rate[dashpot_places(module)], 0.0)
    assert rate[charge_place(module)] == free.rhs(0.0, state)[-1] != 0.0


def test_a_run_accounts_for_its_energy():
    run = run_of(emitted("current"), samples=4001, inputs={CURRENT: dl.Sine(0.1, 150.0)}, energies=True)
    power = run["source_power"] - run["leakage_power"] - run["dashpot_power"]
    assert run["source_power"].attrs["units"] == run["leakage_power"].attrs["units"] == "W"
    values, step = power.values, float(run["time"][1])
    gained = step / 3 * np.sum(values[:-2:2] + 4 * values[1:-1:2] + values[2::2])
    leaked = step * float(run["leakage_power"].sum())
    found = float(run["total_energy"][-1] - run["total_energy"][0])
    assert leaked > 0.1 * abs(found)
    assert found == pytest.approx(gained, rel=1e-7)


def by_hand(time, state, force, current):
    """Equal-biaxial, by hand: Gent spring, neo-Hookean branch, parallel dashpot, softening permittivity."""
    stretch, rate, inelastic, charge = state
    length, thick, alpha, beta = 5e-3, 1e-3, 1.8e4, 4.2e4
    volume = 8 * length**2 * thick
    mass = 8 / 3 * 1.2e3 * thick * length**2 * (2 * length**2 + 4 * thick**2 * stretch**-6)
    mass_slope = 8 / 3 * 1.2e3 * thick * length**2 * -24 * thick**2 * stretch**-7
    room = 1 - (2 * stretch**2 + stretch**-4 - 3) / VALUES["locking_alpha"]
    springs = 2 * alpha * (stretch - stretch**-5) / room
    springs += 2 * beta * (stretch / inelastic**2 - inelastic**4 * stretch**-5)
    permittivity = PERMITTIVITY * (1 + FALL * (2 * stretch - 2))
    electric = (
        -(charge**2)
        / (2 * permittivity * stretch**4)
        * (4 / stretch + 2 * FALL * PERMITTIVITY / permittivity)
    )
    # 2 eta d_i d(d_i)/d(rate) over the three axes, d = (rate, rate, -2 rate) / stretch
    dashpot = 2 * VALUES["parallel_viscosity"] * 6 * rate / stretch**2
    net = 4 * length * force - volume * (springs + electric + dashpot) - mass_slope * rate**2 / 2
    flow = beta * inelastic / (6 * 420.0) * ((stretch / inelastic) ** 2 - (inelastic / stretch) ** 4)
    true_field = charge / stretch**2 / permittivity
    leaked = CONDUCTIVITY * true_field * stretch**2  # through the deformed area
    return [rate, net / mass, flow, current(time) - leaked]


def test_it_moves_as_equations_written_by_hand():
    module = emitted("current", permittivity="softening")
    drive = dl.Sine(0.1, 90.0, 0.02)
    run = run_of(module, duration=0.03, force=0.1, inputs={CURRENT: drive})
    witness = solve_ivp(
        by_hand, (0.0, 0.03), [1.0, 0.0, 1.0, 0.0], "DOP853", run["time"].values,
        args=(0.1, drive.at), rtol=1e-12, atol=1e-16,
    )  # fmt: skip
    assert float(run[CHARGE].max()) > 3e-4 and np.ptp(run["stretch"].values) > 0.01
    for entry, values in zip(module.STATE, witness.y, strict=True):
        np.testing.assert_allclose(run[entry.name], values, rtol=0, atol=1e-9 * np.abs(values).max())


# --- what is refused ---------------------------------------------------------------------------------


def read(tmp_path, text: str):
    file = tmp_path / "leaky.toml"
    file.write_text(text, encoding="utf-8")
    return read_model_file(file)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('control = "charge"', 'control = "voltage"', "line 17: conductivity needs control = 'charge'"),
        ('control = "charge"\n', "", "line 16: conductivity needs control = 'charge'"),
        ("6 nS/m", "-6 nS/m", "line 17: conductivity must be zero or positive, got '-6 nS/m'"),
        ("6 nS/m", "6 nS", "line 17: conductivity = '6 nS' has a unit of dimension .*; needed is S/m"),
        ('"6 nS/m"', "inf", "line 17: conductivity must be finite"),
        ("conductivity", "conductivty", r"unknown key 'conductivty' .*did you mean 'conductivity'\?"),
    ],
)
def test_a_file_that_makes_no_sense_is_refused_in_one_line(tmp_path, old, new, says):
    assert LEAKY_FILE.count(old) == 1
    with pytest.raises(ModelError, match=says) as refusal:
        read(tmp_path, LEAKY_FILE.replace(old, new))
    assert "\n" not in str(refusal.value)


def test_leakage_under_voltage_is_refused():
    with pytest.raises(ValueError, match="leakage under voltage control changes no motion") as refusal:
        description_equations(described("voltage", leakage=m.CONDUCTIVITY))
    assert "\n" not in str(refusal.value)


def test_a_conductivity_of_another_unit_is_refused():
    wrong = replace(m.CONDUCTIVITY, unit="S")
    with pytest.raises(DimensionError, match=r"own, .* has dimension"):
        description_equations(described("current", leakage=wrong))


@pytest.mark.parametrize(
    ("given_", "says"),
    [
        ({"field": 1e6}, "own has no such input"),
        ({"inputs": {CHARGE: 1e-4}}, "unknown input 'nominal_charge_density'"),
        ({"initial_state": [1.0, 0.0, 1.0]}, r"must hold 4 values .*nominal_charge_density \[C/m\^2\]"),
        ({"initial_state": [1.0, 0.0, 1.0, np.nan]}, "must be finite"),
        ({"conductivity": np.inf}, "conductivity must be zero or positive and finite, got inf S/m"),
    ],
)
def test_a_run_that_makes_no_sense_is_refused(given_, says):
    with pytest.raises(ValueError, match=says):
        dl.simulate(emitted("current"), duration=1e-3, **given_)


@pytest.mark.parametrize("start", [-3e-4, 0.0])
def test_a_charge_may_be_negative_or_none(start):
    run = run_of(emitted("current"), duration=1e-3, initial_state=[1.0, 0.0, 1.0, start])
    assert run.attrs["status"] == "completed"


def test_siemens_are_amperes_over_volts():
    assert Dimension.of_unit("S") == Dimension.of_unit("A/V")
    assert Dimension.of_unit("F/m") / Dimension.of_unit("S/m") == Dimension.of_unit("s")


def test_a_membrane_may_be_said_to_leak_nothing(tmp_path):
    assert read(tmp_path, LEAKY_FILE.replace('"6 nS/m"', "0")).defaults["conductivity"] == 0.0
