"""What the parameters of a model are before a run, and which values mechanics allows them."""

from __future__ import annotations

import pickle
import re
from inspect import signature

import numpy as np
import pytest
from described import CURVED, described, emitted, parameters_of, plain

import delagrange as dl
from delagrange.derive.membrane.description import Load
from delagrange.model.parameters import material_of
from delagrange.problem.problem import make_problem

DEFAULTS = {"half_length": 0.1, "half_thickness": 5e-4, "density": 1.1e3, "permittivity": 4e-11}


@pytest.fixture(scope="module")
def own():
    """A user's neo-Hookean membrane with values of its own."""
    return emitted(plain("equal_biaxial", defaults={**DEFAULTS, "shear_modulus_alpha": 6e4}))


@pytest.fixture(scope="module")
def softened():
    """A Mooney-Rivlin spring beside a branch with one."""
    values = {"shear_modulus": 3e4, "second_modulus": 5e3}
    moduli = {f"{name}_{spring}": value for name, value in values.items() for spring in ("alpha", "beta")}
    defaults = {**DEFAULTS, **moduli, "viscosity": 1e3}
    return emitted(plain("uniaxial", "Mooney-Rivlin", alpha="Mooney-Rivlin", defaults=defaults))


# --- what is given counts --------------------------------------------------------------------------


@pytest.mark.parametrize("parameters", [
    dl.SHENG_2015, pickle.loads(pickle.dumps(dl.SHENG_2015)), dl.SHENG_2015.replace(source="a copy"),
], ids=["itself", "pickled", "equal"])  # fmt: skip
def test_parameters_that_are_given_count_whatever_object_they_are(own, parameters):
    run = dl.simulate(own, duration=1e-4, parameters=parameters)
    assert (run.attrs["density"], run.attrs["shear_modulus_alpha"]) == (1.2e3, 1.8e4)
    assert "replaced by those of" in run.attrs["parameters_source"]


def test_a_model_keeps_its_defaults_where_none_are_given(own):
    for more in ({}, {"parameters": None}):
        run = dl.simulate(own, duration=1e-4, **more)
        assert (run.attrs["density"], run.attrs["shear_modulus_alpha"]) == (1.1e3, 6e4)
        assert run.attrs["parameters_source"] == "defaults of the model own"
    built_in = dl.simulate("equal_biaxial", duration=1e-4, parameters=None)
    assert built_in.attrs["parameters_source"] == dl.SHENG_2015.source


def test_no_function_gives_parameters_by_itself():
    taking = {name: signature(getattr(dl, name)) for name in dl.__all__ if callable(getattr(dl, name))}
    given = {name: each.parameters["parameters"].default for name, each in taking.items()
             if "parameters" in each.parameters}  # fmt: skip
    assert {"simulate", "frequency_response", "rest_state", "modes", "equilibria", "pull_in", "classify",
            "dynamic_pull_in", "steady_response", "stepped_sweep", "lyapunov_spectrum"} <= set(given)  # fmt: skip
    assert set(given.values()) == {None}


# --- what mechanics needs --------------------------------------------------------------------------


@pytest.mark.parametrize("model", ["equal_biaxial", "own"])
def test_a_users_spring_needs_a_shear_modulus_as_a_built_in_one_does(own, model):
    says = "spring α at rest must be positive and finite, got -60000 Pa with shear_modulus_alpha = -60000 Pa"
    with pytest.raises(ValueError, match=re.escape(says)):
        dl.simulate(own if model == "own" else model, duration=1e-4, shear_modulus_alpha=-6e4)


def test_a_coefficient_may_be_negative_where_the_spring_is_stiff_at_rest(softened):
    run = dl.simulate(
        softened, duration=1e-3, force=0.01, second_modulus_alpha=-4e3, second_modulus_beta=-4e3
    )
    assert run.attrs["status"] == "completed" and run.attrs["second_modulus_alpha"] == -4e3
    says = (
        "shear modulus of spring β at rest must be positive and finite, got -1000 Pa with shear_modulus_beta = 30000 "
        "Pa, second_modulus_beta = -31000 Pa"
    )
    with pytest.raises(ValueError, match=says):
        dl.simulate(softened, duration=1e-3, second_modulus_beta=-3.1e4)


@pytest.mark.parametrize("run", [
    lambda model, **axes: dl.frequency_response(model, frequency=300.0, field_amplitude=1e5, duration=1e-3, **axes),
    lambda model, **axes: dl.modes(model, **axes),
], ids=["frequency_response", "modes"])  # fmt: skip
def test_every_pair_of_values_on_a_grid_is_checked_before_anything_runs(softened, run):
    moduli = {"shear_modulus_alpha": [1e4, 4e4], "second_modulus_alpha": [1e3, -2e4]}
    says = "spring α .* got -10000 Pa with shear_modulus_alpha = 10000 Pa, second_modulus_alpha = -20000 Pa"
    with pytest.raises(ValueError, match=says):
        run(softened, **moduli)


def test_a_relaxation_time_is_that_of_the_whole_spring_in_series(softened):
    """As in a model file: viscosity = relaxation_time times the shear modulus at rest, not its first coefficient."""
    assert material_of(softened, None).changed({"relaxation_time": 2.0})["viscosity"] == 2.0 * 3.5e4
    changed = material_of(softened, None).changed(
        {"relaxation_time": np.array([1.0, 2.0]), "second_modulus_beta": 0.0}
    )
    np.testing.assert_array_equal(changed["viscosity"], [3e4, 6e4])


def test_what_may_be_absent_may_be_zero_and_says_so():
    model = emitted(described("equal_biaxial"))
    values = dict(zip((entry.name for entry in model.PARAMETERS), parameters_of(model), strict=True))
    for name in ("medium_damping", "parallel_viscosity"):
        assert make_problem(model, None, values | {name: 0.0}, None, 0.0, 0.0).parameters
        with pytest.raises(ValueError, match=f"{name} must be zero or positive and finite, got -1 Pa s"):
            make_problem(model, None, values | {name: -1.0}, None, 0.0, 0.0)


def test_a_positive_coordinate_starts_at_a_positive_value():
    model = emitted(plain("relation", load=Load("relation", relation=CURVED)))
    with pytest.raises(ValueError, match=r"initial_state stretch must be positive and finite, got -1"):
        dl.simulate(model, duration=1e-3, slope=0.4, initial_state={"stretch": -1.0})
