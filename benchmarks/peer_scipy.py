"""SciPy's `solve_ivp` (DOP853) with a right-hand side from SymPy's `lambdify`, one run after the other.

Written as one would by hand: scalar functions of `math`, common subexpressions, the membrane's numbers put in
before printing, events where the rate passes zero for the extrema.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

import delagrange
from benchmarks.cases import Case, Runs
from benchmarks.contestant import Contestant, Run
from benchmarks.membrane import parameter_values
from benchmarks.peer_delagrange import ABSOLUTE_SHARE
from delagrange.derive.equations.described import description_equations
from delagrange.derive.papers.sheng_2015.paper import PAPER

RightHandSide = Callable[..., list[float]]


@lru_cache
def right_hand_side(model: str) -> tuple[RightHandSide, list[float], int]:
    """f(t, y, P, E_0, f) of a model, its state at rest, and the place of the first coordinate's rate."""
    eom = description_equations(PAPER.description(model))
    time, state = sp.Symbol("time"), [quantity.symbol for quantity in eom.state]
    force, field = (quantity.symbol for quantity in eom.load_case.inputs)
    amplitude, frequency = sp.symbols("field_amplitude frequency")
    numbers = dict(zip((quantity.symbol for quantity in eom.parameters), parameter_values(model)))
    drive = {field: amplitude * sp.sin(2 * sp.pi * frequency * time)}
    rates = [coordinate.rate.symbol for coordinate in eom.load_case.coordinates]
    rows = [
        sp.sympify(row).subs(numbers).subs(drive) for row in (*rates, *eom.acceleration, *eom.internal_rates)
    ]
    function = sp.lambdify([time, state, force, amplitude, frequency], rows, modules="math", cse=True)
    start = delagrange.load_model(model).reference_state(parameter_values(model))
    return function, [float(value) for value in start], len(rates)


def amplitude_of_one(
    model: str, force: float, field: float, frequency: float, duration: float, rtol: float, atol: float
) -> float:
    """Half of peak to peak of the first coordinate [1]; NaN where the integration fails."""
    function, start, rate = right_hand_side(model)

    def turning(time: float, state: np.ndarray, *_: float) -> float:
        return state[rate]

    arguments = (force, field, frequency)
    with np.errstate(all="ignore"):
        solution = solve_ivp(
            function, (0.0, duration), start, "DOP853", rtol=rtol, atol=atol, events=turning, args=arguments
        )
    if not solution.success:
        return math.nan
    found = [start[0], solution.y[0, -1], *(state[0] for state in solution.y_events[0])]
    return (max(found) - min(found)) / 2


def amplitudes(case: Case, runs: Runs, rtol: float, atol: float) -> np.ndarray:
    """Amplitudes [1] of the runs, (n_runs,)."""
    each = zip(runs.force.tolist(), runs.field_amplitude.tolist(), runs.frequency.tolist())
    return np.array([amplitude_of_one(case.model, *run, case.duration, rtol, atol) for run in each])


def _prepare(case: Case, places: np.ndarray, tolerance: float) -> Run:
    right_hand_side(case.model)
    runs = case.runs.take(places)
    return lambda: amplitudes(case, runs, tolerance, tolerance * ABSOLUTE_SHARE)


SCIPY = Contestant(
    "scipy", "SciPy solve_ivp", "DOP853, right-hand side from SymPy lambdify (math, cse), events for the extrema",
    (), (1e-3, 1e-5, 1e-7, 1e-9), _prepare, subset=24, repeats=2,
)  # fmt: skip
