"""Periodic motions under a sine of field or charge by shooting: the state at phase 0 that comes back after a period.

Residual y(T) - y(0), with the slopes from the variational equations that travel along with the motion. Source:
Seydel (2010), Practical Bifurcation and Stability Analysis, 3rd ed., Springer, Ch. 7.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from delagrange.analysis.steady.load import source_of, under_load
from delagrange.drives.inputs import electrical_input
from delagrange.drives.sines import LOAD_UNITS
from delagrange.engines.flow import Flow, FlowPath, Source, Travel
from delagrange.equilibrium.continuation import Evaluation, Lost
from delagrange.equilibrium.statics import input_place
from delagrange.problem import status as loss
from delagrange.problem.problem import Problem


class Parts(NamedTuple):
    """What equal parts of the period do to small disturbances."""

    matrices: np.ndarray  # (n_parts, n_unknowns, n_unknowns), in units of typical sizes
    divergence: float  # [1], integral of the trace of the Jacobian over all of them


@dataclass(frozen=True)
class Orbit:
    """A motion over one period; periodic as well as its shooting is solved."""

    state: np.ndarray  # (n_state,) at phase 0
    load: Mapping[
        str, float
    ]  # force [N], amplitude and bias of field [V/m] or charge [C/m^2], frequency [Hz]
    period: float  # [s]
    monodromy: np.ndarray  # (n_unknowns, n_unknowns), of the unknowns in units of their typical sizes
    slopes: np.ndarray  # (n_unknowns, n_unknowns + 1), of the shooting in units of its scale
    divergence: float  # [1], integral of the trace of the Jacobian over the period
    maximum: np.ndarray  # (n_coordinates,) [1]
    minimum: np.ndarray  # (n_coordinates,) [1]
    closure_error: float  # [1], what is missing to come back, in units of typical sizes
    in_parts: Callable[[int], Parts] | None = None  # the tangent over so many parts; raises Lost

    @property
    def amplitude(self) -> np.ndarray:
        """Half of peak to peak of every coordinate, (n_coordinates,) [1]."""
        return (self.maximum - self.minimum) / 2


@dataclass(frozen=True)
class Shooting:
    """The search for a periodic motion while one number of the load varies.

    A vector x, (n_unknowns + 1,), holds the unknown part of the state at phase 0, and the varied number last.
    """

    path: FlowPath  # its drives are replaced by those of the load
    flow: Flow
    rest: np.ndarray  # (n_state,), of which what is not unknown stays
    unknowns: np.ndarray  # places in the state
    load: Mapping[str, float]  # the numbers that do not vary; that of the varied one is not used
    varied: str  # its name in the load
    size: float  # typical size of the varied number, in its unit
    per_sine: (
        int  # forcing periods in a period of the sine: 2 where field or charge enters squared without bias
    )
    multiple: int = 1  # forcing periods in a period of the motion

    @property
    def scale(self) -> np.ndarray:
        """(n_unknowns + 1,): typical sizes of the unknowns and of the varied number."""
        return np.append(self.path.weights[self.unknowns], self.size)

    def varying(self, name: str, size: float, **values: float) -> Shooting:
        """The same search with another number varied, and others set."""
        return replace(self, varied=name, size=size, load={**self.load, **values})

    def at(self, value: float) -> dict[str, float]:
        """The load at a value of the varied number."""
        return {**self.load, self.varied: float(value)}

    def period(self, load: Mapping[str, float]) -> float:
        """Period of the motion [s]."""
        return self.multiple / (self.per_sine * load["frequency"])

    def problem(self, load: Mapping[str, float]) -> Problem:
        """The membrane under a load; inputs that are no part of it stay as they are."""
        return under_load(self.path.problem, load)

    def state(self, x: np.ndarray) -> np.ndarray:
        """(n_state,)"""
        state = self.rest.copy()
        state[self.unknowns] = x[:-1]
        return state

    def x_of(self, state: np.ndarray, value: float) -> np.ndarray:
        """The vector of a state at phase 0 and a value of the varied number."""
        return np.append(state[self.unknowns], value)

    def residual(self, x: np.ndarray) -> Evaluation:
        """What is missing to come back, its slopes, and the orbit.

        Raises:
            Lost: a load that has no meaning, or a motion that is lost within the period.
        """
        travel, problem, period = self.travel(x, with_tangent=True)
        state, weights = self.state(x), self.path.weights[self.unknowns]
        missing = (travel.state[-1] - state)[self.unknowns]
        tangent = travel.tangent[self.unknowns]
        monodromy = tangent[:, :-1] / weights[:, None]
        by_load = tangent[:, -1]
        if self.varied == "frequency":
            rates = problem.rhs(period, travel.state[-1])[self.unknowns]
            by_load = by_load - rates * period / x[-1]
        slopes = np.column_stack([(monodromy - np.eye(len(weights))) * weights[:, None], by_load * self.size])
        orbit = Orbit(
            state=state,
            load=self.at(x[-1]),
            period=period,
            monodromy=monodromy,
            slopes=slopes / weights[:, None],
            divergence=float(travel.divergence[-1]),
            maximum=travel.maximum,
            minimum=travel.minimum,
            closure_error=float(np.linalg.norm(missing / weights)),
            in_parts=partial(self.parts, np.array(x)),
        )
        return Evaluation(missing, slopes / self.scale, orbit)

    def amplitude(self, x: np.ndarray) -> float:
        """Half of peak to peak of the first coordinate over a period [1].

        Raises:
            Lost: as `residual`.
        """
        travel, _, _ = self.travel(x, with_tangent=False)
        return float(travel.maximum[0] - travel.minimum[0]) / 2

    def travel(self, x: np.ndarray, with_tangent: bool) -> tuple[Travel, Problem, float]:
        """The motion over one period, with the tangent by the unknowns and by the varied number."""
        path, period = self._path(x)
        tangent, sources = self._columns() if with_tangent else (None, ())
        travel = self._kept(self.flow(path, self.state(x), np.array([0.0, period]), tangent, sources))
        return travel, path.problem, period

    def parts(self, x: np.ndarray, count: int) -> Parts:
        """The tangent by the unknowns over `count` equal parts of the period, each from unit vectors at its begin.

        Raises:
            Lost: as `residual`.
        """
        path, period = self._path(x)
        state, weights = self.state(x), path.weights[self.unknowns]
        start, _ = self._columns()
        matrices, divergence = [], 0.0
        for span in pairwise(np.linspace(0.0, period, count + 1)):
            travel = self._kept(self.flow(path, state, np.array(span), start[:, :-1]))
            matrices.append(travel.tangent[self.unknowns] / weights[:, None])
            state, divergence = travel.state[-1], divergence + float(travel.divergence[-1])
        return Parts(np.array(matrices), divergence)

    def _path(self, x: np.ndarray) -> tuple[FlowPath, float]:
        """The path under the load of x, and the period of the motion [s]."""
        load = self.at(x[-1])
        if not (np.all(np.isfinite(x)) and load["frequency"] > 0):
            raise Lost(f"no motion at {self.varied} = {x[-1]:g} {LOAD_UNITS[self.varied]}")
        return replace(self.path, problem=self.problem(load)), self.period(load)

    @staticmethod
    def _kept(travel: Travel) -> Travel:
        if travel.status != loss.COMPLETED:
            raise Lost(f"the motion {loss.STATUS[travel.status]} after {travel.status_time:.3g} s")
        return travel

    def _columns(self) -> tuple[np.ndarray, tuple[Source | None, ...]]:
        """Unit vectors in units of the weights, and a column that starts at zero for the varied number."""
        name, number = source_of(self.varied, electrical_input(self.path.problem.model))
        tangent = np.zeros((len(self.rest), len(self.unknowns) + 1))
        tangent[self.unknowns, range(len(self.unknowns))] = self.path.weights[self.unknowns]
        source = Source(input_place(self.path.problem, name), number)
        return tangent, (*(None,) * len(self.unknowns), source)
