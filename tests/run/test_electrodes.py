"""What electrodes answer: field and charge of one membrane, whichever of them drives it."""

from __future__ import annotations

import numpy as np
import pytest
from electrical_membranes import (
    FALL,
    LAWS,
    PERMITTIVITY,
    along,
    emitted,
    moving_state,
    parameters_of,
)
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl
from delagrange.generated import equal_biaxial, uniaxial

seeds = st.integers(0, 10**6)


def inputs_of(module, electrical: float) -> list[float]:
    return [0.4 if entry.unit == "N" else electrical for entry in module.INPUTS]


def permittivity_at(module, law: str, state, parameters) -> float:
    first, second, _ = module.principal_stretches(state, inputs_of(module, 0.0), parameters)
    return PERMITTIVITY * (1 + (FALL * (first + second - 2) if law == "softening" else 0.0))


@pytest.mark.parametrize(("kind", "law"), LAWS)
@settings(max_examples=20)
@given(seed=seeds, field=st.floats(1e3, 3e7))
def test_voltage_and_charge_control_are_one_membrane(kind, law, seed, field):
    """The field gives a charge that gives the field back, and both stretch the membrane alike."""
    held, fed = emitted("voltage", kind, law), emitted("charge", kind, law)
    parameters, state = parameters_of(held), moving_state(held, seed)
    known, charge = held.electrodes(state, inputs_of(held, field), parameters)
    back, same = fed.electrodes(state, inputs_of(fed, charge), parameters)
    assert (known, same) == (field, charge)
    assert back == pytest.approx(field, rel=1e-14)
    arguments = (state, inputs_of(held, field), parameters), (state, inputs_of(fed, charge), parameters)
    for name in ("rhs", "edge_forces", *(("reaction_forces",) if held.REACTIONS else ())):
        ours, theirs = (getattr(module, name)(*given) for module, given in zip((held, fed), arguments))
        np.testing.assert_allclose(ours, theirs, rtol=1e-10, atol=1e-12 * np.abs(ours).max())


@pytest.mark.parametrize(("kind", "law"), LAWS)
@settings(max_examples=20)
@given(seed=seeds, field=st.floats(-3e7, 3e7))
def test_the_charge_is_that_of_a_parallel_plate_capacitor(kind, law, seed, field):
    module = emitted("voltage", kind, law)
    parameters, state = parameters_of(module), moving_state(module, seed)
    first, second, third = module.principal_stretches(state, inputs_of(module, field), parameters)
    true_charge = permittivity_at(module, law, state, parameters) * field / third
    found = module.electrodes(state, inputs_of(module, field), parameters)[1]
    assert found == pytest.approx(true_charge * first * second, rel=1e-13, abs=1e-25)


@pytest.mark.parametrize(("driven", "sign"), [("voltage", -1), ("charge", 1)])
@pytest.mark.parametrize(("kind", "law"), LAWS)
def test_the_answer_is_the_slope_of_the_emitted_energy(kind, law, driven, sign):
    module = emitted(driven, kind, law)
    parameters, state = parameters_of(module), moving_state(module, 7)
    inputs = np.array(inputs_of(module, 2e7 if driven == "voltage" else 5e-4))
    direction = np.array([0.0] * (len(inputs) - 1) + [1.0])
    slope = along(lambda at: module.potential_energy(state, at, parameters), inputs, direction)
    volume = 8 * 1e-3 * 5e-3**2
    answer = module.electrodes(state, inputs, parameters)[1 if driven == "voltage" else 0]
    assert answer == pytest.approx(sign * slope / volume, rel=1e-13)


def test_fields_of_many_states_come_at_once():
    module = emitted("charge", "uniaxial", "softening")
    parameters, states = parameters_of(module), [moving_state(module, seed) for seed in range(4)]
    together = module.electrodes(np.transpose(states), inputs_of(module, 3e-4), parameters)
    assert together.shape == (2, 4)
    single = [module.electrodes(state, inputs_of(module, 3e-4), parameters) for state in states]
    np.testing.assert_array_equal(together, np.transpose(single))


@pytest.mark.parametrize(
    ("driven", "electrical", "added", "unit"),
    [
        ("voltage", {"nominal_electric_field": dl.Sine(4e6, 300.0)}, "nominal_charge_density", "C/m^2"),
        ("charge", {"nominal_charge_density": dl.Sine(3e-4, 300.0)}, "nominal_electric_field", "V/m"),
        ("current", {"nominal_current_density": dl.Sine(0.05, 300.0)}, "nominal_electric_field", "V/m"),
    ],
)
def test_a_run_says_what_the_electrodes_answer(driven, electrical, added, unit):
    module = emitted(driven)
    run = dl.simulate(module, duration=5e-3, force=0.1, inputs=electrical, samples=101)
    assert run[added].attrs["units"] == unit and run[added].attrs["long_name"]
    assert {"nominal_electric_field", "nominal_charge_density"} <= set(run.data_vars)
    capacitance = PERMITTIVITY * run["stretch"] ** 4
    np.testing.assert_allclose(
        run["nominal_charge_density"], capacitance * run["nominal_electric_field"], rtol=1e-13, atol=1e-20
    )


def test_what_is_lost_has_no_answer():
    run = dl.simulate(emitted("voltage"), duration=0.01, field=dl.Step(6e7), rtol=1e-6)
    assert run.attrs["status"] != "completed"
    after = run["time"].values > run.attrs["status_time"]
    assert np.all(np.isnan(run["nominal_charge_density"].values[after]))
    assert np.all(np.isfinite(run["nominal_charge_density"].values[~after]))


@pytest.mark.parametrize("module", [equal_biaxial, uniaxial])
def test_the_models_of_the_paper_say_their_charge(module):
    """Of an ideal dielectric, D = epsilon E (lambda_1 lambda_2)^2."""
    run = dl.simulate(module, duration=2e-3, force=0.3, field=4e6)
    first = "stretch_1" if "stretch_1" in run else "stretch"
    second = "stretch_2" if "stretch_2" in run else "stretch"
    charge = dl.SHENG_2015.permittivity * 4e6 * (run[first] * run[second]) ** 2
    np.testing.assert_allclose(run["nominal_charge_density"], charge, rtol=1e-12)
