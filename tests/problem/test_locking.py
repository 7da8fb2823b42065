"""Sweeps of membranes whose strain energies have limits: where the compiled lanes lock, and that they stop there.

A Gent spring is infinitely stiff at its limit: no resolved motion passes it, and what is driven hard comes so near
that double precision cannot tell what is left. An energy of one's own may hold up to a limit that nothing marks: a
motion passes it unhindered, and may be back long before its end.
"""

from __future__ import annotations

import numpy as np
import pytest
from charge_membranes import VOLTAGE, derived
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

import delagrange as dl
from delagrange.engines.engines import ENGINES, resolve_numerics
from delagrange.engines.lanes import Sampling
from delagrange.engines.locking import name_failures
from delagrange.problem.problem import Problem, make_problem
from delagrange.problem.status import COLLAPSED, COMPLETED, DIVERGED, LOCKED
from delagrange.run.sweep import make_settings

ROOM_AT_REST = 5.0  # of the Gent spring
UNTOLD = 1e-11  # of the room at rest: what of it is left to a motion that double precision does not tell
GENT = f'material = "Gent"\nshear_modulus = 6e4\nlocking = {ROOM_AT_REST}'
BOUNDED = """energy = "mu/2*(I_1 - 3)"
parameters = { mu = "60 kPa" }
validity = "9 - I_1"
"""
LIMITS = dl.Limits()


@pytest.fixture(scope="module")
def stiffening(tmp_path_factory):
    """Equal-biaxial, under voltage, a Gent spring alone."""
    return derived(tmp_path_factory.mktemp("stiff"), "stiff", kernels=True, control=VOLTAGE, spring=GENT)


@pytest.fixture(scope="module")
def bounded(tmp_path_factory):
    """The same with a neo-Hookean spring that is said to hold up to I_1 = 9."""
    return derived(tmp_path_factory.mktemp("bound"), "bound", kernels=True, control=VOLTAGE, spring=BOUNDED)


def integrated(engine: str, problem: Problem, start, duration: float, rtol=1e-6, limits=LIMITS, count=0):
    """What becomes of lanes from `start`, (n_state, n_lanes), with `count` samples of each."""
    numerics = resolve_numerics("DOP853", engine, None, "dense", problem.model)
    settings = make_settings(duration, None, rtol, 1e-3 * rtol, numerics, limits, averages=True)
    lanes = start.shape[1]
    every = np.full(lanes, duration / max(count - 1, 1))
    sampling = Sampling(np.zeros(lanes), every, count) if count else None
    return ENGINES[engine].integrate(problem, start, settings, sampling)


def driven(model, lanes: int, force: float, field: float) -> tuple[Problem, np.ndarray]:
    """Lanes at rest under forces [N], fields [V/m] and frequencies of all sizes up to the largest ones."""
    rng = np.random.default_rng(1)
    pull, push, often = (rng.uniform(0.0, 1.0, lanes) for _ in range(3))
    load = dl.Constant(force * pull), dl.Sine(field * push, 2000.0 * often)
    return make_problem(model, None, {}, None, *load), np.tile([[1.0], [0.0]], lanes)


def room(problem: Problem, stretch: np.ndarray) -> np.ndarray:
    """What is left to the limit at a stretch [1]."""
    return problem.validity(0.0, np.stack([stretch, np.zeros_like(stretch)]))


@pytest.fixture(scope="module")
def hard(stiffening):
    """Many lanes under all loads up to very hard ones, by the compiled kernel and by NumPy."""
    problem, start = driven(stiffening, 384, 60.0, 2e8)
    found = [integrated(engine, problem, start, 2e-4, count=9) for engine in ("compiled", "numpy")]
    return problem, *found


def told(problem: Problem, numpy) -> np.ndarray:
    """Lanes, (n_lanes,) of bool, that lock, or whose nearest approach to the lock double precision can tell."""
    return (numpy.status == LOCKED) | (room(problem, numpy.maximum[0]) > UNTOLD * ROOM_AT_REST)


def test_hard_driven_lanes_lock_as_the_numpy_engine_locks_them(hard):
    problem, compiled, numpy = hard
    clear = told(problem, numpy)
    assert np.mean(clear) > 0.9
    assert {COMPLETED, LOCKED} == set(compiled.status[clear])
    np.testing.assert_array_equal(compiled.status[clear], numpy.status[clear])
    np.testing.assert_allclose(compiled.status_time[clear], numpy.status_time[clear], rtol=1e-6)


def test_next_to_the_lock_a_lane_is_locked_or_completed(hard):
    """Where the engines differ, the lane has come so near to the lock that its return is a matter of rounding."""
    problem, compiled, numpy = hard
    near = ~told(problem, numpy)
    assert near.any()
    assert set(compiled.status[near]) <= {COMPLETED, LOCKED}


def test_what_a_lane_leaves_behind_is_the_numpy_engines(hard):
    """Samples up to the lock and none after it, extrema and averages over the time before it."""
    problem, compiled, numpy = hard
    same = compiled.status == numpy.status
    np.testing.assert_array_equal(np.isnan(compiled.samples[..., same]), np.isnan(numpy.samples[..., same]))
    calm = same & ((numpy.status == LOCKED) | (room(problem, numpy.maximum[0]) > 1e-4 * ROOM_AT_REST))
    assert np.count_nonzero(calm & (numpy.status == LOCKED)) > 50
    for name in ("maximum", "minimum", "mean", "mean_square"):
        np.testing.assert_allclose(
            getattr(compiled, name)[..., calm], getattr(numpy, name)[..., calm], atol=2e-5
        )
    np.testing.assert_allclose(compiled.samples[:, 0, calm], numpy.samples[:, 0, calm], atol=2e-5)


@pytest.mark.parametrize(("rtol", "slack"), [(1e-3, 1e-3), (1e-5, 0.0), (1e-6, 0.0), (1e-8, 0.0)])
def test_no_lane_that_completes_has_been_beyond_its_lock(stiffening, rtol, slack):
    """Nor is an extremum inside of a step beyond it, but where that is no more than the tolerance."""
    problem, start = driven(stiffening, 2048, 60.0, 2e8)
    found = integrated("compiled", problem, start, 1e-3, rtol)
    done = found.status == COMPLETED
    assert done.any() and np.all(done | (found.status == LOCKED))
    assert np.all(room(problem, found.state[0, done]) > 0)
    for extremum in (found.maximum[0, done], found.minimum[0, done]):
        assert np.all(room(problem, extremum) > -slack * ROOM_AT_REST)


def test_gentle_lanes_complete_as_they_do_by_numpy(stiffening):
    problem, start = driven(stiffening, 96, 1.0, 2e6)
    compiled, numpy = (
        integrated(engine, problem, start, 5e-3, 1e-10, count=5) for engine in ("compiled", "numpy")
    )
    assert np.all(compiled.status == COMPLETED) and np.all(numpy.status == COMPLETED)
    for name in ("maximum", "minimum", "mean", "mean_square", "samples"):
        np.testing.assert_allclose(
            getattr(compiled, name), getattr(numpy, name), rtol=1e-8, atol=1e-6, err_msg=name
        )


# --- a limit that nothing marks --------------------------------------------------------------------


def thrown(model, speeds) -> tuple[Problem, np.ndarray]:
    """Lanes without load that set out from the reference state at some speeds [1/s]."""
    problem = make_problem(model, None, {}, None, 0.0, dl.Constant(np.zeros(len(speeds))))
    return problem, np.stack([np.ones(len(speeds)), speeds])


def test_a_lane_that_comes_back_from_beyond_has_been_seen(bounded):
    """It ends at the limit on its way out, though a run without the limit would be back long before the end."""
    problem, start = thrown(bounded, np.linspace(100.0, 9000.0, 90))
    compiled, numpy = (integrated(engine, problem, start, 2e-3, 1e-9) for engine in ("compiled", "numpy"))
    assert np.count_nonzero(compiled.status == LOCKED) > 20
    np.testing.assert_array_equal(compiled.status, numpy.status)
    np.testing.assert_allclose(compiled.status_time, numpy.status_time, rtol=1e-6)
    lost = compiled.status == LOCKED
    np.testing.assert_allclose(room(problem, compiled.state[0, lost]), 0.0, atol=1e-12)
    np.testing.assert_array_equal(compiled.state[0, lost], compiled.maximum[0, lost])
    assert np.all(room(problem, compiled.maximum[0, ~lost]) > 0)


def test_energy_says_which_lanes_reach_the_limit(bounded):
    """Without load, a lane passes the limit if it sets out with more energy than is stored there."""
    problem, start = thrown(bounded, np.linspace(100.0, 9000.0, 90))
    found = integrated("compiled", problem, start, 2e-3, 1e-9)
    at_limit = np.array([brentq(lambda stretch: 9 - 2 * stretch**2 - stretch**-4, 1.0, 9.0), 0.0])
    reach = energy(problem, start) > energy(problem, at_limit)
    np.testing.assert_array_equal(found.status == LOCKED, reach)


def energy(problem: Problem, state: np.ndarray) -> np.ndarray:
    """Kinetic and potential energy [J]."""
    model, arguments = problem.model, (problem.inputs(0.0), problem.parameters)
    return model.kinetic_energy(state, *arguments) + model.potential_energy(state, *arguments)


# --- starts, and steps that no engine resolves -----------------------------------------------------


@given(
    stretches=st.lists(st.floats(0.05, 20.0), min_size=1, max_size=40),
    smallest=st.floats(1e-3, 0.9),
    largest=st.floats(1.1, 15.0),
)
def test_a_start_beyond_any_limit_is_lost_as_by_numpy(stiffening, stretches, smallest, largest):
    problem, start = thrown(stiffening, np.zeros(len(stretches)))
    start[0] = stretches
    compiled, numpy = (
        integrated(engine, problem, start, 1e-9, limits=dl.Limits(smallest, largest))
        for engine in ("compiled", "numpy")
    )
    np.testing.assert_array_equal(compiled.status, numpy.status)
    np.testing.assert_array_equal(compiled.status_time, numpy.status_time)


def test_an_unresolved_lane_is_locked_where_next_to_nothing_is_left(stiffening):
    """Within the limits and unresolved; the same far from the lock; beyond the largest stretch."""
    problem, start = thrown(stiffening, np.zeros(3))
    limits = dl.Limits(largest_stretch=1.5)
    found = integrated("numpy", problem, start, 1e-6)
    lock = 1.9920461616
    found.state[0], found.status[:] = (lock * (1 - 1e-9), 1.2, 1.6), DIVERGED
    assert name_failures(found, problem, LIMITS).status.tolist() == [LOCKED, DIVERGED, DIVERGED]
    assert name_failures(found, problem, limits).status.tolist() == [DIVERGED, DIVERGED, DIVERGED]
    found.status[:] = COMPLETED, COLLAPSED, COMPLETED
    assert name_failures(found, problem, LIMITS).status.tolist() == [COMPLETED, COLLAPSED, COMPLETED]
