"""Tangents: the derivative of a state by an earlier one, by the compiled flow and by others, at equal error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.accuracy import Point, ratio, time_at
from benchmarks.timing import Timed, interleaved

PERIODS = 40  # of the forcing
ERROR = 1e-8  # relative to the largest entry, of the tangent in units of typical sizes
_TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)
_REFERENCE = 1e-18  # heyoka's order and step then are those of rounding
_FORCE, _AMPLITUDE, _FREQUENCY = 0.5, 1e6, 300.0

Tangent = Callable[[float], np.ndarray]  # of a tolerance: (2 n, 2 n) of the coordinates and their rates


@dataclass(frozen=True)
class Contestant:
    """One way to carry the tangent, and how often it is timed at most."""

    label: str
    tangent: Tangent
    repeats: int


def measured(models: tuple[str, ...], repeats: int, keep: Callable[[dict], None]) -> None:
    """Time [s] of each contestant at an error, and how many times ours that is."""
    found: dict[str, object] = {"periods": PERIODS, "error": ERROR, "models": {}}
    for model in models:
        found["models"][model] = _of_model(model, repeats)
        keep(found)


def _of_model(model: str, repeats: int) -> dict[str, object]:
    carry = _heyoka(model)
    reference = carry(_REFERENCE)
    contestants = {
        "compiled": Contestant("Delagrange, compiled flow", _ours(model, "compiled"), repeats),
        "heyoka": Contestant("heyoka.py, variational equations", carry, repeats),
        "scipy": Contestant("SciPy's DOP853 and the NumPy Jacobian", _ours(model, "scipy"), 1),
    }
    points = _points(contestants, reference)
    times = {name: time_at(some, ERROR) for name, some in points.items()}
    return {
        name: {"label": one.label, "time": times[name], "ratio": ratio(times[name], times["compiled"])}
        for name, one in contestants.items()
    }


def _points(contestants: dict[str, Contestant], reference: np.ndarray) -> dict[str, list[Point]]:
    """Every contestant at every tolerance, all of them in turn within a repeat."""
    entries = [(name, tolerance) for name in contestants for tolerance in _TOLERANCES]
    tasks = [
        Timed(partial(contestants[name].tangent, tolerance), contestants[name].repeats)
        for name, tolerance in entries
    ]
    for task, (name, _) in zip(tasks, entries):
        if name != "scipy":
            task.run()  # compiles
    times: list[list[float]] = [[] for _ in tasks]
    errors = [0.0] * len(tasks)
    for place, time, tangent in interleaved(tasks):
        times[place].append(time)
        errors[place] = float(np.abs(tangent - reference).max() / np.abs(reference).max())
    return {
        name: [
            Point(tolerance, error, error, tuple(some))
            for (whose, tolerance), error, some in zip(entries, errors, times)
            if whose == name
        ]
        for name in contestants
    }


def _ours(model: str, engine: str) -> Tangent:
    from delagrange.engines.flow import FlowPath
    from delagrange.engines.flows import resolve_flow
    from delagrange.problem.coordinate_size import typical_sizes
    from delagrange.problem.dashpots import given_state

    problem = _problem(model)
    flow, state, weights = resolve_flow(problem, engine), given_state(problem, None), typical_sizes(problem)
    moving = 2 * problem.model.COORDINATE_COUNT
    columns = np.diag(weights)[:, :moving]

    def tangent(tolerance: float) -> np.ndarray:
        travel = flow(FlowPath(problem, weights, tolerance), state, np.array([0.0, _stop()]), columns)
        return (travel.tangent / weights[:, None])[:moving]

    return tangent


def _problem(model: str) -> object:
    import delagrange
    from delagrange.problem.dashpots import frozen
    from delagrange.problem.problem import make_problem

    field = delagrange.Sine(_AMPLITUDE, _FREQUENCY)
    module = delagrange.load_model(model)
    return frozen(make_problem(module, delagrange.SHENG_2015, {}, None, _FORCE, field))


def _stop() -> float:
    return PERIODS / (2 * _FREQUENCY)  # the field enters squared


def _heyoka(model: str) -> Tangent:
    """By its own derivatives of the same rates, the inelastic stretches put in as numbers. Time in 0.1 ms."""
    import heyoka

    from delagrange.problem.coordinate_size import typical_sizes
    from delagrange.problem.dashpots import given_state

    problem = _problem(model)
    state, weights = given_state(problem, None), typical_sizes(problem)
    moving, unit = 2 * problem.model.COORDINATE_COUNT, 1e-4
    names = [entry.name for entry in problem.model.STATE[:moving]]
    symbols = np.array(heyoka.make_vars(*names), dtype=object)
    whole = [*(symbols * weights[:moving]), *map(float, state[moving:])]
    field = _AMPLITUDE * heyoka.sin(2 * np.pi * _FREQUENCY * unit * heyoka.time)
    rates = problem.model.rhs(whole, (_FORCE, field), problem.parameters)[:moving]
    system = list(zip(symbols, rates * unit / weights[:moving]))
    variational = heyoka.var_ode_sys(system, heyoka.var_args.vars, order=1)
    start = np.concatenate([state[:moving] / weights[:moving], np.eye(moving).ravel()])
    made: dict[float, object] = {}

    def tangent(tolerance: float) -> np.ndarray:
        if tolerance not in made:
            made[tolerance] = heyoka.taylor_adaptive(variational, start, tol=tolerance, compact_mode=True)
        integrator = made[tolerance]
        integrator.time = 0.0
        integrator.state[:] = start
        integrator.propagate_until(_stop() / unit)
        return integrator.state[moving:].reshape(moving, moving).copy()

    return tangent
