"""Described membranes in what follows a motion with its tangent: where a spring locks, and how exact a charge is."""

from __future__ import annotations

import numpy as np
import pytest
from charge_membranes import VOLTAGE, derived
from electrical_membranes import LEAKY_FILE
from emitted_once import described_in, loaded
from hypothesis import given
from hypothesis import strategies as st

import delagrange as dl
from delagrange.analysis.steady.shooting import Shooting
from delagrange.engines.flow import FlowPath
from delagrange.engines.flow_compiled import flow_compiled
from delagrange.engines.flow_scipy import flow_by_scipy
from delagrange.equilibrium.continuation import Lost
from delagrange.model.kernels import VARIATIONAL, kernel_name, load_kernel
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.problem import make_problem
from delagrange.problem.status import STATUS

MODULUS, LOCKING = 6e4, 5.0
LOCKED_AT = 1.9920461616  # [1]: 2 x^2 + x^-4 = 3 + LOCKING
GENTLE = {"force": 0.5, "field": dl.Sine(1e6, 373.0)}
HARD = {"force": 50.0, "field": dl.Sine(2e8, 373.0)}


@pytest.fixture(scope="module")
def stiffening(tmp_path_factory):
    """Equal-biaxial, under voltage, a Gent spring alone."""
    spring = f'material = "Gent"\nshear_modulus = {MODULUS}\nlocking = {LOCKING}'
    return derived(tmp_path_factory.mktemp("stiff"), "stiff", kernels=True, control=VOLTAGE, spring=spring)


@pytest.fixture(scope="module")
def leaky(tmp_path_factory):
    return loaded(described_in(tmp_path_factory.mktemp("leaky"), "leaky", LEAKY_FILE))


def path_of(model, load, tolerance=1e-11, **material) -> FlowPath:
    problem = make_problem(model, None, material, None, load["force"], load["field"])
    return FlowPath(problem, typical_sizes(problem), tolerance)


# --- springs that lock ---------------------------------------------------------------------------


@pytest.mark.parametrize("force", [10.0, 50.0])
def test_a_kernel_and_scipy_agree_on_whether_and_when_a_spring_locks(stiffening, force):
    path = path_of(stiffening, {"force": force, "field": 6e7}, 1e-8)
    times = np.linspace(0.0, 1e-3, 5)
    found, expected = (follow(path, np.array([1.0, 0.0]), times) for follow in (flow_compiled, flow_by_scipy))
    assert found.status == expected.status
    assert found.status_time == pytest.approx(expected.status_time, rel=1e-5)
    np.testing.assert_allclose(found.maximum, expected.maximum, rtol=1e-6)
    np.testing.assert_array_equal(np.isnan(found.state), np.isnan(expected.state))


def test_a_lock_between_two_times_is_seen(stiffening):
    """The membrane runs into its lock in 60 us, long before the one time that is asked for."""
    found = flow_compiled(path_of(stiffening, HARD), np.array([1.0, 0.0]), np.array([0.0, 1e-2]))
    assert STATUS[found.status] == "locked"
    assert 0.0 < found.status_time < 1e-4
    assert np.isnan(found.state[-1]).all()
    assert 1.99 < found.maximum[0] <= LOCKED_AT


def test_what_is_beyond_the_lock_stays_no_motion(stiffening):
    """On the far side of the limit the equations have numbers, of which nothing may be made."""
    beyond = np.array([1.05 * LOCKED_AT, 0.0])
    path = path_of(stiffening, {"force": 0.0, "field": 0.0})
    assert np.isfinite(path.problem.rhs(0.0, beyond)).all()
    found = flow_compiled(path, beyond, np.array([0.0, 1e-3]))
    assert (STATUS[found.status], found.status_time) == ("locked", pytest.approx(0.0, abs=1e-12))
    assert np.isnan(found.state[-1]).all()


@given(force=st.floats(0.0, 60.0), field=st.floats(0.0, 2e8))
def test_no_motion_ever_passes_the_lock(stiffening, force, field):
    """Under any load: all of it within, or locked, or lost by another limit; and nothing of it without a number."""
    path = path_of(stiffening, {"force": force, "field": dl.Sine(field, 500.0)}, 1e-7)
    found = flow_compiled(path, np.array([1.0, 0.0]), np.linspace(0.0, 1e-3, 3), np.eye(2))
    assert found.maximum[0] <= LOCKED_AT
    assert STATUS[found.status] in ("completed", "locked", "collapsed")
    if STATUS[found.status] == "completed":
        assert np.isfinite(found.state).all() and np.isfinite(found.tangent).all()
        assert np.all(path.problem.validity(0.0, found.state.T) > 0)


@pytest.mark.parametrize(("engine", "tolerance"), [("compiled", 1e-11), ("scipy", 1e-5)])
def test_the_analyses_say_that_a_spring_locks(stiffening, engine, tolerance):
    how = {"duration": 0.05, "engine": engine, "tolerance": tolerance}
    spectrum = dl.lyapunov_spectrum(stiffening, **how, **HARD)
    assert spectrum["status"].item() == "locked"
    assert 0.0 < spectrum["status_time"].item() < 1e-3
    assert np.isnan(spectrum["lyapunov_exponents"]).all()
    motion = dl.classify(stiffening, **how, **HARD)
    assert (motion["status"].item(), motion["verdict"].item()) == ("locked", "lost")
    assert "locked at" in motion["evidence"].item()


def test_a_motion_that_stays_below_its_lock_is_told_as_any_other(stiffening):
    spectrum = dl.lyapunov_spectrum(stiffening, duration=0.1, tolerance=1e-9, **GENTLE)
    assert spectrum["status"].item() == "completed"
    assert np.isfinite(spectrum["lyapunov_exponents"]).all()
    motion = dl.classify(stiffening, duration=0.1, tolerance=1e-9, **GENTLE)
    assert motion["status"].item() == "completed" and motion["verdict"].item() != "lost"


def test_a_stepped_sweep_ends_where_a_spring_locks(stiffening):
    load = {"frequency": [373.0, 380.0], "dashpots": "frozen", "settle": 1, "measure": 2}
    unloaded = {"stretch": 1.0}
    found = dl.stepped_sweep(stiffening, force=50.0, field_amplitude=2e8, initial_state=unloaded, **load)
    assert found["status"].values.tolist() == ["locked", "interrupted"]
    assert np.isnan(found["amplitude"]).all()
    found = dl.stepped_sweep(stiffening, force=0.5, field_amplitude=1e6, **load)
    assert found["status"].values.tolist() == ["completed"] * 2


def test_a_period_in_which_a_spring_locks_is_no_periodic_motion(stiffening):
    path = path_of(stiffening, {"force": 0.0, "field": 0.0})
    load = {"force": 3.0, "field_amplitude": 1e6, "field_bias": 0.0, "frequency": 373.0}
    one = Shooting(path, flow_compiled, np.array([1.0, 0.0]), np.arange(2), load, "frequency", 30.0, 2)
    assert one.amplitude(one.x_of(np.array([1.1, 0.0]), 373.0)) > 0
    with pytest.raises(Lost, match="the motion locked after"):
        one.residual(one.x_of(np.array([1.1, 1e7]), 373.0))


def test_a_steady_response_below_the_lock_is_found(stiffening):
    found = dl.steady_response(stiffening, force=0.5, field_amplitude=1e6, frequency=(370.0, 373.0))
    assert found.sizes["point"] > 1
    assert float(found["maximum"].max()) < LOCKED_AT


def test_the_kernel_of_a_membrane_without_limits_knows_none(stiffening, leaky):
    with_limits, without = (load_kernel(kernel_name(model, VARIATIONAL)) for model in (stiffening, leaky))
    assert STATUS[int(with_limits.LOCKED)] == "locked"
    assert not hasattr(without, "LOCKED") and not hasattr(without, "_validity")


# --- a charge that leaks -------------------------------------------------------------------------


def test_the_size_of_a_charge_is_that_which_strains_the_membrane_by_one(leaky):
    """Of n springs of moduli mu_i: 12 sum mu_i of stiffness against 2 D^2 / epsilon of pull, by hand."""
    problem = make_problem(leaky, None, {}, None, 0.0, 0.0)
    place = [entry.name for entry in leaky.STATE].index("nominal_charge_density")
    sizes = typical_sizes(problem)
    assert sizes[place] == pytest.approx(np.sqrt(6 * (1.8e4 + 4.2e4) * 60e-12), rel=1e-9)
    sizes = typical_sizes(make_problem(leaky, None, {"permittivity": 6e-9}, None, 0.0, 0.0))
    assert sizes[place] == pytest.approx(np.sqrt(6 * (1.8e4 + 4.2e4) * 6e-9), rel=1e-9)


@pytest.mark.parametrize("follow", [flow_compiled, flow_by_scipy])
def test_a_charge_is_as_exact_as_the_stretches(leaky, follow):
    """Under a current of 30 kHz, whose steps the charge alone asks for: the membrane vibrates at 900 Hz."""
    inputs = {"nominal_current_density": dl.Sine(100.0, 3e4)}  # [A/m^2]
    problem = make_problem(leaky, None, {}, None, 0.0, 0.0, inputs)
    sizes, times = typical_sizes(problem), np.linspace(0.0, 1.05e-3, 7)
    start = np.asarray(leaky.reference_state(problem.parameters), dtype=float)
    loose, exact = (
        follow(FlowPath(problem, sizes, tolerance), start, times).state for tolerance in (1e-6, 1e-12)
    )
    assert 1e-4 < np.max(np.abs(exact[:, -1])) < 2e-3
    assert np.all(np.max(np.abs(loose - exact), axis=0) < 2e-6 * sizes)
