"""How an adaptive method measures its error and chooses its next step, for many lanes at once.

Errors are scaled so that a step is accepted when its error is at most 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.engines.tableau import Row, Tableau
from delagrange.problem.problem import Problem


def combine(row: Row, stages: np.ndarray) -> np.ndarray:
    """sum_j row_j stages_j over the coefficients that are not zero.

    Term by term, so that a lane's result does not depend on the lanes beside it (a BLAS product may).
    stages: (n_stages, n_state, n_lanes) -> (n_state, n_lanes)
    """
    (first, coefficient), *others = row
    total = coefficient * stages[first]
    for stage, coefficient in others:
        total += coefficient * stages[stage]
    return total


@dataclass(frozen=True)
class ScipyControl:
    """The controller of `scipy.integrate`: Hairer, Nørsett & Wanner (1993), Sec. II.4, with their norm."""

    rtol: float
    atol: float

    def first_step(
        self,
        problem: Problem,
        tableau: Tableau,
        time: np.ndarray,
        state: np.ndarray,
        rate: np.ndarray,
        stop: float,
    ) -> np.ndarray:
        """Step [s] to begin with, (n_lanes,)."""
        span = stop - time
        scale = self.atol + np.abs(state) * self.rtol
        size, speed = _rms(state / scale), _rms(rate / scale)
        trial = np.where((size < 1e-5) | (speed < 1e-5), 1e-6, 0.01 * size / speed)
        trial = np.minimum(trial, span)
        bend = _rms((problem.rhs(time + trial, state + trial * rate) - rate) / scale) / trial
        fastest = np.maximum(speed, bend)
        step = np.where(
            fastest <= 1e-15,
            np.maximum(1e-6, trial * 1e-3),
            (0.01 / fastest) ** (1 / (tableau.error_order + 1)),
        )
        step = np.where(np.isfinite(step), step, 1e-6)
        return np.minimum(np.minimum(100 * trial, step), span)

    def bounded(self, step: np.ndarray, time: np.ndarray, stop: float) -> tuple[np.ndarray, np.ndarray]:
        """The step to try [s] and the time it ends at [s], not beyond `stop`."""
        end = np.minimum(time + step, stop)
        return end - time, end

    def error(
        self, tableau: Tableau, stages: np.ndarray, step: np.ndarray, state: np.ndarray, new_state: np.ndarray
    ) -> np.ndarray:
        """Error of a step in units of the tolerance, (n_lanes,)."""
        scale = self.atol + np.maximum(np.abs(state), np.abs(new_state)) * self.rtol
        if len(tableau.errors) == 1:
            return step * _rms(combine(tableau.errors[0], stages) / scale)
        fifth, third = (_square_sum(combine(row, stages) / scale) for row in tableau.errors)
        weight = fifth + 0.01 * third
        return np.where(weight == 0, 0.0, step * fifth / np.sqrt(weight * len(state)))

    def next_step(
        self, tableau: Tableau, step: np.ndarray, error: np.ndarray, accepted: np.ndarray, retried: np.ndarray
    ) -> np.ndarray:
        """Step to try next [s]; `retried` lanes had been rejected just before and may not grow."""
        factor = 0.9 * error ** (-1 / (tableau.error_order + 1))
        grown = np.where(retried, np.minimum(factor, 1.0), np.minimum(factor, 10.0))
        return step * np.where(accepted, grown, np.fmax(factor, 0.2))

    def smallest_step(self, time: np.ndarray) -> np.ndarray:
        """Step [s] below which time is no longer resolved."""
        return 10 * np.spacing(time)


@dataclass(frozen=True)
class Ode45Control:
    """The controller of MATLAB's `ode45`: Shampine & Reichelt (1997), SIAM J. Sci. Comput. 18, 1.

    Largest component instead of root mean square, a largest step, halving after a second failure, and
    the last step stretched or cut to meet the end.
    """

    rtol: float
    atol: float
    largest_step: float  # [s]; `ode45` takes a tenth of the span

    def first_step(
        self,
        problem: Problem,
        tableau: Tableau,
        time: np.ndarray,
        state: np.ndarray,
        rate: np.ndarray,
        stop: float,
    ) -> np.ndarray:
        """Step [s] to begin with, (n_lanes,)."""
        largest = np.minimum(self.largest_step, stop - time)
        speed = self._largest(rate, np.abs(state)) / (0.8 * self.rtol ** (1 / (tableau.error_order + 1)))
        return np.where(largest * speed > 1, 1 / speed, largest)

    def bounded(self, step: np.ndarray, time: np.ndarray, stop: float) -> tuple[np.ndarray, np.ndarray]:
        """The step to try [s] and the time it ends at [s]; within 10 % of `stop` it goes there."""
        step = np.minimum(step, self.largest_step)
        end = np.where(1.1 * step >= stop - time, stop, time + step)
        return end - time, end

    def error(
        self, tableau: Tableau, stages: np.ndarray, step: np.ndarray, state: np.ndarray, new_state: np.ndarray
    ) -> np.ndarray:
        """Error of a step in units of the tolerance, (n_lanes,)."""
        size = np.maximum(np.abs(state), np.abs(new_state))
        return step * self._largest(combine(tableau.errors[0], stages), size) / self.rtol

    def next_step(
        self, tableau: Tableau, step: np.ndarray, error: np.ndarray, accepted: np.ndarray, retried: np.ndarray
    ) -> np.ndarray:
        """Step to try next [s]; after a rejection it does not grow, after a second one it is halved."""
        scaled = error ** (1 / (tableau.error_order + 1))
        grown = np.where(retried, 1.0, np.minimum(5.0, 1 / (1.25 * scaled)))
        shrunk = np.where(retried, 0.5, np.fmax(0.1, 0.8 / scaled))
        return step * np.where(accepted, grown, shrunk)

    def smallest_step(self, time: np.ndarray) -> np.ndarray:
        """Step [s] below which time is no longer resolved."""
        return 16 * np.spacing(time)

    def _largest(self, values: np.ndarray, size: np.ndarray) -> np.ndarray:
        return np.max(np.abs(values) / np.maximum(size, self.atol / self.rtol), axis=0)


@dataclass(frozen=True)
class PiControl:
    """The controller that compiled kernels are emitted with; here only its tolerances.

    Gustafsson (1991), ACM Trans. Math. Softw. 17, 533.
    """

    rtol: float
    atol: float


StepControl = ScipyControl | Ode45Control | PiControl
STEP_CONTROLS = ("scipy", "ode45", "pi")


def step_control(name: str, rtol: float, atol: float, duration: float) -> StepControl:
    """The controller "scipy", "pi", or "ode45" with its largest step of a tenth of `duration` [s]."""
    if name == "ode45":
        return Ode45Control(rtol, atol, 0.1 * duration)
    return {"scipy": ScipyControl, "pi": PiControl}[name](rtol, atol)


def _square_sum(values: np.ndarray) -> np.ndarray:
    total = values[0] * values[0]
    for component in values[1:]:
        total += component * component
    return total


def _rms(values: np.ndarray) -> np.ndarray:
    return np.sqrt(_square_sum(values) / len(values))
