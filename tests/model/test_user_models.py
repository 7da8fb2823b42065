"""Models with parameters, inputs and dashpots of their own, through everything that runs a model.

The user's membrane has two equal Maxwell branches and a force along each axis, so that it must move as the built-in
ones do: as the uniaxial one under one force, as the equal-biaxial one under two equal ones.
"""

from __future__ import annotations

import numpy as np
import pytest
from user_membranes import write_membrane

import delagrange as dl
from delagrange.model.parameters import material_of
from delagrange.problem.dashpots import frozen
from delagrange.problem.problem import make_problem

TAU = 0.02  # [s]
OWN = {"viscosity_1": TAU * 2.1e4, "viscosity_2": TAU * 2.1e4}
PULL = {"force_1": 0.3}


@pytest.fixture(scope="module")
def membrane(tmp_path_factory):
    return dl.load(write_membrane(tmp_path_factory.mktemp("user"), "two_branches"))


@pytest.fixture(scope="module")
def stiffening(tmp_path_factory):
    return dl.load(write_membrane(tmp_path_factory.mktemp("stiff"), "stiffening", branches=1, gent=True))


def test_two_equal_branches_move_as_one(membrane):
    run = dl.simulate(membrane, duration=0.01, inputs=PULL, field=2e6, energies=True, **OWN)
    one = dl.simulate("uniaxial", duration=0.01, force=0.3, field=2e6, relaxation_time=TAU, energies=True)
    for name in ("stretch_1", "stretch_2", "total_energy", "dashpot_power"):
        np.testing.assert_allclose(run[name], one[name], atol=1e-8)
    for axis in (1, 2):
        for branch in (1, 2):
            np.testing.assert_allclose(
                run[f"inelastic_stretch_{branch}_{axis}"], one[f"inelastic_stretch_{axis}"], atol=1e-9
            )


def test_equal_forces_move_it_as_the_equal_biaxial_one(membrane):
    pull = {"force_1": dl.Step(0.2), "force_2": 0.2, "nominal_electric_field": dl.Sine(2e6, 300.0)}
    run = dl.simulate(membrane, duration=0.01, inputs=pull)
    one = dl.simulate("equal_biaxial", duration=0.01, force=0.2, field=dl.Sine(2e6, 300.0))
    np.testing.assert_allclose(run["stretch_1"], one["stretch"], atol=1e-8)
    np.testing.assert_allclose(run["stretch_2"], one["stretch"], atol=1e-8)


def test_a_sweep_has_axes_of_its_inputs_and_parameters(membrane):
    grid = {"frequency": [300.0, 320.0], "field_amplitude": 1e6, "duration": 5e-3}
    found = dl.frequency_response(
        membrane, inputs={"force_1": [0.1, 0.2], "force_2": 0.0}, modulus_alpha=[1.5e4, 1.8e4], **grid
    )
    one = dl.frequency_response("uniaxial", force=[0.1, 0.2], shear_modulus_alpha=[1.5e4, 1.8e4], **grid)
    assert found["amplitude"].dims == ("force_1", "modulus_alpha", "frequency")
    assert (found["modulus_alpha"].units, found["force_1"].units) == ("Pa", "N")
    assert found.attrs["modulus_beta_2"] == 2.1e4
    assert "force" not in found.coords
    np.testing.assert_allclose(found["amplitude"], one["amplitude"], atol=1e-9)
    driven = dl.frequency_response(membrane, inputs={"force_1": dl.Ramp(0.1, 0.2, 1e-3)}, **grid)
    as_force = dl.frequency_response("uniaxial", force=dl.Ramp(0.1, 0.2, 1e-3), **grid)
    np.testing.assert_allclose(driven["amplitude"], as_force["amplitude"], atol=1e-9)


@pytest.mark.parametrize("dashpots", ["frozen", "relaxed"])
def test_equilibria_modes_and_pull_in(membrane, dashpots):
    """Relaxed or frozen, all dashpots of both branches are."""
    given = {"field": 1e6, "dashpots": dashpots}
    rests, one = dl.equilibria(membrane, inputs=PULL, **given), dl.equilibria("uniaxial", force=0.3, **given)
    np.testing.assert_allclose(rests["stretch"], one["stretch"], rtol=1e-9)
    np.testing.assert_allclose(rests["margin"], one["margin"], rtol=1e-8)
    np.testing.assert_allclose(rests["inelastic_stretch_2_1"], one["inelastic_stretch_1"], rtol=1e-9)
    vibrations = dl.modes(membrane, inputs=PULL, **given)
    np.testing.assert_allclose(
        vibrations["frequency"], dl.modes("uniaxial", force=0.3, **given)["frequency"], rtol=1e-9
    )
    limit = dl.pull_in(membrane, inputs={"force_1": 0.3, "force_2": 0.1}, dashpots=dashpots)
    assert limit["found"].item() == "pull-in"
    assert float(limit["force_2"]) == 0.1


def test_two_forces_reach_the_equilibrium_of_equal_pull(membrane):
    both = dl.modes(membrane, inputs={"force_1": 0.2, "force_2": 0.2}, dashpots="relaxed", field=[0.0, 1e6])
    one = dl.equilibria("equal_biaxial", force=0.2, field=[0.0, 1e6]).isel(branch=0)
    np.testing.assert_allclose(both["stretch_1"], one["stretch"], rtol=1e-9)
    np.testing.assert_allclose(both["stretch_2"], one["stretch"], rtol=1e-9)


def test_the_kind_of_a_motion(membrane):
    found = dl.classify(membrane, inputs=PULL, duration=0.05, transient=0.0, tolerance=1e-7)
    assert found.attrs["load"] == "force_1 0.3 N, force_2 0 N, field 0 V/m"
    assert found["status"].item() == "completed"
    assert np.all(found["section_inelastic_stretch_2_2"] == 1.0)  # frozen


def test_frozen_dashpots_of_all_branches_stand_still(membrane):
    problem = frozen(make_problem(membrane, None, {}, None, 0.0, 1e6, {"force_2": 0.3}))
    state = np.array([1.2, 0.9, 3.0, -2.0, 1.1, 0.9, 1.3, 0.8])
    np.testing.assert_array_equal(problem.rhs(0.0, state)[4:], 0.0)
    np.testing.assert_array_equal(problem.jacobian(0.0, state)[4:], 0.0)


def test_its_own_values_hold_and_other_parameters_replace_what_fits(membrane):
    run = dl.simulate(membrane, duration=1e-4, modulus_beta_2=1.0)
    assert (run.attrs["density"], run.attrs["modulus_alpha"], run.attrs["modulus_beta_2"]) == (
        1200.0,
        1.8e4,
        1.0,
    )
    assert (
        run.attrs["parameters_source"] == "defaults of the model two_branches; changed: modulus_beta_2 = 1 Pa"
    )
    assert run.attrs["source"] == "equations of the model in two_branches.py"
    other = dl.SHENG_2015.replace(density=1e3, shear_modulus_alpha=7.0)
    run = dl.simulate(membrane, duration=1e-4, parameters=other)
    assert (run.attrs["density"], run.attrs["modulus_alpha"]) == (1e3, 1.8e4)
    assert "replaced by those of: Sheng" in run.attrs["parameters_source"]


def test_a_relaxation_time_needs_the_one_dashpot_it_belongs_to(membrane):
    assert "relaxation_time" not in material_of(membrane, dl.SHENG_2015).units
    assert "relaxation_time" in material_of(dl.load_model("uniaxial"), dl.SHENG_2015).units


REFUSED = {
    "unknown parameter": (
        {"modulus_beta": 1.0},
        r"unknown parameter 'modulus_beta' \(did you mean 'modulus_beta_\d'",
    ),
    "relaxation time": ({"relaxation_time": 1.0}, "unknown parameter 'relaxation_time'"),
    "viscosity": ({"viscosity_2": 0.0}, "viscosity_2 must be positive and finite, got 0 Pa s"),
    "not finite": ({"modulus_beta_1": np.nan}, "modulus_beta_1 must be finite, got nan Pa"),
    "force": (
        {"force": 0.3},
        r"force given as .*two_branches has no such input; .*give force_1, force_2 by inputs",
    ),
    "unknown input": (
        {"inputs": {"force_3": 1.0}},
        r"unknown input 'force_3' in inputs \(did you mean 'force_\d'",
    ),
    "not a mapping": ({"inputs": 0.3}, r"inputs must map names of inputs .*force_1 \[N\]"),
    "input value": ({"inputs": {"force_1": np.inf}}, "inputs force_1 must be finite, got inf N"),
    "twice": ({"inputs": {"field": 1.0}, "field": 2.0}, "field is given as .* and in inputs as well"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused_in_one_line(membrane, case):
    given, says = REFUSED[case]
    with pytest.raises(ValueError, match=says) as refusal:
        dl.simulate(membrane, duration=1e-3, **given)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("inputs", "says"),
    [
        ({"force_1": dl.Constant(1.0)}, "inputs force_1 must be a number"),
        ({"field": 1.0}, "field is given as 0 and in inputs as well; give one"),
    ],
)
def test_a_membrane_at_rest_takes_numbers_alone(membrane, inputs, says):
    with pytest.raises(ValueError, match=says):
        dl.equilibria(membrane, field=0.0, inputs=inputs)


def test_a_model_without_defaults_asks_for_what_it_lacks(tmp_path):
    bare = write_membrane(tmp_path, "bare", branches=1, defaults=False)
    with pytest.raises(
        ValueError, match=r"modulus_alpha \[Pa\] is missing: the model bare has no default for it"
    ):
        dl.simulate(bare, duration=1e-3)
    moduli = {"modulus_alpha": 1.8e4, "modulus_beta_1": 4.2e4, "viscosity_1": 1e7}
    run = dl.simulate(bare, duration=1e-3, inputs=PULL, **moduli)
    assert run.attrs["density"] == dl.SHENG_2015.density  # of a name that fits


def test_energies_that_hold_stop_nothing(stiffening):
    run = dl.simulate(stiffening, duration=5e-3, inputs={"force_1": 0.5, "force_2": 0.5})
    assert run.attrs["status"] == "completed"


def test_a_run_ends_where_its_spring_locks(stiffening):
    """Pulled in by a large field the membrane runs into the stretch at which the spring locks."""
    pulled = {"duration": 5e-3, "field": 6e7, "inputs": {"force_1": 4.0, "force_2": 4.0}}
    run = dl.simulate(stiffening, rtol=1e-6, **pulled)
    assert run.attrs["status"] == "locked"
    assert 0.0 < run.attrs["status_time"] < 5e-3
    reached = float(run["stretch_1"].max())
    assert reached > 1.9 and 2 * reached**2 + reached**-4 - 3 <= 5.0  # J_m


def test_a_start_beyond_the_lock_is_locked_at_once(stiffening):
    run = dl.simulate(stiffening, duration=1e-3, initial_state=[2.4, 2.4, 0.0, 0.0, 1.0, 1.0])
    assert (run.attrs["status"], run.attrs["status_time"]) == ("locked", 0.0)


@pytest.mark.parametrize("engine", ["auto", "numpy", "scipy"])
def test_lanes_lock_each_by_itself(stiffening, engine):
    found = dl.frequency_response(
        stiffening, frequency=300.0, field_amplitude=1e6, duration=1e-3, engine=engine,
        initial_state={"stretch_1": [1.5, 2.4], "stretch_2": 1.5},
    )  # fmt: skip
    assert found["status"].values.ravel().tolist() == ["completed", "locked"]
    assert "locked" in found["status"].attrs["meaning"]
