"""Tangents against heyoka's own variational equations, which differentiate the emitted rates by themselves."""

import heyoka
import numpy as np
import pytest

import delagrange as dl
from delagrange.engines.flow import AMPLITUDE, BIAS, FlowPath, Source
from delagrange.engines.flows import resolve_flow
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import frozen, given_state
from delagrange.problem.problem import make_problem

MODELS = {
    "equal_biaxial": {},
    "uniaxial": {},
    "pure_shear_as_printed": {"held_stretch": 2.0},
    "pure_shear_consistent": {"held_stretch": 2.0},
    "pure_shear_consistent_free": {"held_stretch": 2.0},
}
FORCE, AMPLITUDE_OF_FIELD, FREQUENCY = 0.3, 2e6, 380.0
DURATION = 1 / FREQUENCY


def witness(problem, state):
    """State after DURATION, its derivative by the initial state, and that by force and field amplitude.

    Biscani & Izzo (2021), Mon. Not. R. Astron. Soc. 504, 2614.
    """
    model = problem.model
    names = [entry.name for entry in model.STATE]
    symbols = np.array(heyoka.make_vars(*names), dtype=object)
    field = heyoka.par[1] * heyoka.sin(2 * np.pi * FREQUENCY * heyoka.time)
    finite = [1e300 if np.isinf(value) else value for value in problem.parameters]
    rates = model.rhs(symbols, (heyoka.par[0], field), finite)
    system = list(zip(symbols, rates))
    arguments = heyoka.var_args.vars | heyoka.var_args.params
    integrator = heyoka.taylor_adaptive(
        heyoka.var_ode_sys(system, arguments, order=1), list(state), pars=[FORCE, AMPLITUDE_OF_FIELD],
        tol=1e-16, compact_mode=True,
    )  # fmt: skip
    integrator.propagate_until(DURATION)
    size = len(names)
    slopes = integrator.state[integrator.get_vslice(order=1)].reshape(size, size + 2)
    return integrator.state[:size], slopes[:, :size], slopes[:, size:]


@pytest.mark.parametrize("flowing", [True, False])
@pytest.mark.parametrize("name", MODELS)
def test_the_tangent_is_that_of_heyoka(name, flowing):
    drives = {"force": FORCE, "field": dl.Sine(AMPLITUDE_OF_FIELD, FREQUENCY)}
    changes = {"relaxation_time": 2e-3}
    held = MODELS[name].get("held_stretch")
    problem = make_problem(dl.load_model(name), None, changes, held, drives["force"], drives["field"])
    problem = problem if flowing else frozen(problem)
    state = given_state(problem, None)
    size = len(state)
    path = FlowPath(problem, typical_sizes(problem), 1e-13)
    sources = (*[None] * size, Source(0, BIAS), Source(1, AMPLITUDE))
    columns = np.hstack([np.eye(size), np.zeros((size, 2))])
    travel = resolve_flow(problem)(path, state, np.array([0.0, DURATION]), columns, sources)
    end, slopes, by_drives = witness(problem, state)
    scale = path.weights
    np.testing.assert_allclose(travel.state[-1] / scale, end / scale, rtol=0, atol=1e-10)
    ours, theirs = (matrix * scale / scale[:, None] for matrix in (travel.tangent[:, :size], slopes))
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9 * np.abs(theirs).max())
    for column in (0, 1):
        theirs = by_drives[:, column] / scale
        atol = 1e-9 * np.abs(theirs).max()
        np.testing.assert_allclose(travel.tangent[:, size + column] / scale, theirs, rtol=0, atol=atol)
