"""Lyapunov spectra: the literature's, linear theory's, the divergence's; and what they say of themselves."""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import NamedTuple

import numpy as np
import pytest
import sympy as sp
from first_order import first_order, written
from hypothesis import given, settings
from hypothesis import strategies as st

import delagrange as dl
from delagrange.analysis.forcing import Forcing
from delagrange.analysis.motion.lyapunov import lyapunov_spectrum, spectrum
from delagrange.analysis.motion.observation import Observation
from delagrange.problem.dashpots import frozen
from delagrange.problem.problem import make_problem

FIELD = dl.Sine(5e6, 424.0)


class Variable(NamedTuple):
    name: str
    symbol: str
    unit: str
    meaning: str


def exponents_of(found):
    return found["lyapunov_exponents"].values, found["lyapunov_uncertainty"].values


# --- the literature ----------------------------------------------------------------------------------


def test_the_lorenz_system(tmp_path, monkeypatch):
    """0.9056, 0, -14.5723: Sprott (2003), Chaos and Time-Series Analysis, Oxford, Appendix A."""
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    x, y, z = sp.symbols("x y z")
    rates = {"x": 10 * (y - x), "y": x * (28 - z) - y, "z": x * y - sp.Rational(8, 3) * z}
    module = written(first_order("lorenz_of_1963", rates, (1, 1, 1)), tmp_path)
    found = lyapunov_spectrum(
        module, duration=1500.0, transient=20.0, dashpots="evolving", engine="compiled", tolerance=1e-9
    )
    exponents, uncertainty = exponents_of(found)
    assert np.all(np.abs(exponents - [0.9056, 0.0, -14.5723]) < 3 * uncertainty)
    assert np.all(uncertainty < 0.01)
    assert found["sum_error"].item() == pytest.approx(0.0, abs=1e-10)
    assert found["mean_divergence"].item() == pytest.approx(-(10 + 1 + 8 / 3), rel=1e-12)


def ueda() -> ModuleType:
    """x'' + 0.05 x' + x^3 = force, written by hand: a model without a kernel."""
    module = ModuleType("ueda")
    module.MODEL, module.FORMULATION, module.COORDINATE_COUNT = "ueda", "given", 1
    module.STATE = (Variable("place", "x", "1", "place"), Variable("speed", "v", "1/s", "speed"))
    module.INPUTS = (Variable("force", "F", "1", "force"),)
    module.PARAMETERS = ()
    module.rhs = lambda state, inputs, _: np.array([state[1], inputs[0] - 0.05 * state[1] - state[0] ** 3])
    module.jacobian = lambda state, *_: np.array([[0.0, 1.0], [-3 * state[0] ** 2, -0.05]])
    module.input_jacobian = lambda *_: np.array([[0.0], [1.0]])
    module.principal_stretches = lambda state, *_: np.ones((3, *np.shape(state[0])))
    module.reference_state = lambda _: np.array([1.0, 0.0])
    return module


def test_the_forced_duffing_system_of_ueda():
    """0.1034 and -0.1534 besides the drive's 0: Sprott (2003), Appendix A, "Ueda oscillator"."""
    force = dl.Sine(7.5, 1 / (2 * np.pi), phase=0.3)
    found = lyapunov_spectrum(ueda(), duration=800.0, force=force, dashpots="evolving", tolerance=1e-7)
    exponents, uncertainty = exponents_of(found)
    assert np.all(np.abs(exponents - [0.1034, -0.1534]) < 3 * uncertainty)
    assert np.all(uncertainty < 0.03)
    assert exponents.sum() == pytest.approx(-0.05, abs=1e-6)


# --- laws --------------------------------------------------------------------------------------------


@settings(max_examples=6, deadline=None)
@given(
    name=st.sampled_from(
        ["equal_biaxial", "uniaxial", "pure_shear_consistent_free", "pure_shear_as_printed"]
    ),
    force=st.floats(0.05, 0.5),
    amplitude=st.floats(0.0, 4e6),
    dashpots=st.sampled_from(["frozen", "evolving"]),
)
def test_the_sum_is_the_mean_divergence(name, force, amplitude, dashpots):
    held = 1.5 if "shear" in name else None
    found = lyapunov_spectrum(
        name, duration=0.3, force=force, field=dl.Sine(amplitude, 300.0), dashpots=dashpots,
        held_stretch=held, relaxation_time=0.02,
    )  # fmt: skip
    assert found["status"].item() == "completed"
    total = found["lyapunov_exponents"].values.sum()
    assert total == pytest.approx(found["mean_divergence"].item(), abs=1e-6)
    assert found["sum_error"].item() == pytest.approx(total - found["mean_divergence"].item(), abs=1e-12)


@pytest.mark.parametrize(("name", "duration"), [("equal_biaxial", 1.0), ("uniaxial", 4.0)])
def test_at_rest_they_are_the_decay_rates_of_linear_theory(name, duration):
    """Two rates of the uniaxial membrane are near each other, and the tangent takes long to part them."""
    arguments = {"force": 0.3, "relaxation_time": 0.01}
    found = dl.lyapunov_spectrum(
        name, duration=duration, transient=1.5, dashpots="evolving", tolerance=1e-9, **arguments
    )
    at_rest = dl.equilibria(name, field=np.array([0.0]), dashpots="relaxed", **arguments).isel(
        field=0, branch=0
    )
    model = dl.load_model(name)
    problem = make_problem(model, dl.SHENG_2015, {"relaxation_time": 0.01}, None, 0.3, 0.0)
    rest = np.array([at_rest[entry.name].item() for entry in model.STATE])
    rates = np.sort(np.linalg.eigvals(problem.jacobian(0.0, rest)).real)[::-1]
    np.testing.assert_allclose(exponents_of(found)[0], rates, rtol=2e-4)


def test_a_conservative_motion_has_pairs_and_its_largest_falls_with_time():
    found = dl.lyapunov_spectrum("uniaxial", duration=4.0, force=0.5, field=FIELD)
    exponents, uncertainty = exponents_of(found)
    np.testing.assert_allclose(exponents, -exponents[::-1], atol=0.05)
    assert np.all(np.abs(exponents) < uncertainty)
    late = found.isel(exponent=0, time=slice(20, None))
    tangent = (late["running_exponents"] * late["time"]).values  # constant for growth in proportion to time
    assert np.ptp(tangent) < 0.1 * np.mean(tangent)


def test_frozen_dashpots_have_no_exponents_and_evolving_ones_do():
    arguments = {"duration": 0.1, "force": 0.3}
    assert dl.lyapunov_spectrum("uniaxial", **arguments).sizes["exponent"] == 4
    assert dl.lyapunov_spectrum("uniaxial", dashpots="evolving", **arguments).sizes["exponent"] == 6


def test_the_slow_engine_agrees():
    arguments = {"duration": 0.02, "force": 0.5, "field": FIELD}
    fast, slow = (
        dl.lyapunov_spectrum("equal_biaxial", engine=name, **arguments) for name in ("compiled", "scipy")
    )
    np.testing.assert_allclose(fast["running_exponents"], slow["running_exponents"], atol=1e-4)


def test_twice_the_stiffness_is_the_same_motion_faster():
    """With mu, field and force scaled, time shrinks by the root of the scale, and rates grow by it."""
    plain = dl.lyapunov_spectrum("equal_biaxial", duration=0.4, force=0.5, field=dl.Sine(5e6, 371.0))
    stiff = dl.lyapunov_spectrum(
        "equal_biaxial", duration=0.2, force=2.0, field=dl.Sine(1e7, 742.0),
        shear_modulus_alpha=7.2e4, shear_modulus_beta=1.68e5,
    )  # fmt: skip
    np.testing.assert_allclose(exponents_of(stiff)[0], 2 * exponents_of(plain)[0], rtol=1e-5)


# --- what an estimate says of itself -----------------------------------------------------------------


def synthetic(growth, interval=0.01):
    times = np.arange(len(growth) + 1) * interval
    forcing = Forcing((1 / (10 * interval),), 10 * interval, 10, 1.0)
    return Observation(
        forcing, times, np.zeros((len(times), 1)), growth[:, None], np.zeros(len(times)), 0, times[-1]
    )


@settings(max_examples=20)
@given(power=st.floats(0.5, 2.0), ripple=st.floats(0.0, 1.0), frequency=st.floats(2.0, 9.0))
def test_growth_like_a_power_of_time_counts_as_none(power, ripple, frequency):
    times = 0.01 * np.arange(1, 4002)
    log_length = power * np.log(times) + ripple * np.sin(2 * np.pi * frequency * times)
    found = spectrum(synthetic(np.diff(log_length)))
    assert abs(found.exponents[0]) <= found.uncertainty[0] * 1.02
    assert found.uncertainty[0] < 0.2


def test_the_uncertainty_of_a_chaotic_exponent_is_what_it_is(rng):
    deviations = []
    for _ in range(200):
        found = spectrum(synthetic(0.02 + 0.1 * rng.standard_normal(4000)))
        deviations.append((found.exponents[0] - 2.0) / found.uncertainty[0])
    assert np.std(deviations) == pytest.approx(1.1, abs=0.35)


# --- what is refused, and what is lost ---------------------------------------------------------------


def test_a_motion_that_is_lost_has_a_status_and_no_exponents():
    lost = dl.lyapunov_spectrum("equal_biaxial", duration=1.0, field=dl.Sine(5e7, 371.0))
    assert lost["status"].item() == "collapsed"
    assert 0 < lost["status_time"].item() < 0.01
    assert np.all(np.isnan(lost["lyapunov_exponents"]))
    assert lost.sizes["exponent"] == 2
    later = dl.lyapunov_spectrum("equal_biaxial", duration=1.0, transient=1.0, field=dl.Sine(5e7, 371.0))
    assert later["status"].item() == "collapsed"


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"duration": -1.0}, "duration must lie from"),
        ({"transient": -1.0}, "transient must lie from 0 s"),
        ({"transient": float("nan")}, "transient must lie from 0 s"),
        ({"transient": ""}, "transient must be a number"),
        ({"transient": [0.0, 1.0]}, "transient must be a single number"),
        ({"transient": 2e6}, "transient must lie from 0 s"),
        ({"field": dl.Sine(1e6, 1e-3)}, "at most 2e+07 are allowed"),
        ({"force": 1e20}, "at most 2e+07 are allowed"),
        ({"dashpots": "relaxed"}, "dashpots must be one of frozen, evolving"),
        ({"tolerance": 1e-20}, "tolerance must lie from"),
        ({"field": dl.Ramp(0.0, 1e6, 1.0)}, "field must be constant or a delagrange.Sine"),
        ({"field": dl.Sine([1e6, 2e6], 300.0)}, "field must be a single number"),
        ({"force": np.array([0.1, 0.2])}, "force must be a single number"),
        ({"initial_state": {"stretch": [1.0, 1.1]}}, "initial_state stretch must be a single number"),
        ({"initial_state": {"strech": 1.0}}, "did you mean 'stretch'"),
        ({"engine": "fortran"}, "engine must be one of"),
        ({"limits": 3.0}, "limits must be a delagrange.Limits"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, named):
    with pytest.raises(ValueError, match=r".") as refusal:
        dl.lyapunov_spectrum("equal_biaxial", **({"duration": 0.1} | options))
    assert named in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_frozen_means_that_nothing_flows():
    problem = frozen(make_problem(dl.load_model("uniaxial"), dl.SHENG_2015, {}, None, 0.3, 0.0))
    slopes = problem.jacobian(0.0, np.array([1.2, 0.9, 3.0, 4.0, 1.0, 1.0]))
    assert np.all(slopes[4:] == 0.0)
