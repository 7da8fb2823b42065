"""Lyapunov spectrum: the mean rates at which neighbours of a motion part from it, or come to it.

Benettin, Galgani, Giorgilli & Strelcyn (1980), Meccanica 15, 9 and 21: tangent vectors are carried by the
variational equations and made orthonormal again and again; the logarithms of their lengths add up.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.analysis.forcing import Forcing
from delagrange.analysis.motion.motion import Motion, make_motion
from delagrange.analysis.motion.observation import Observation, observe
from delagrange.common.progress import progress_bar
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import Inputs
from delagrange.model.parameters import Parameters
from delagrange.problem.dashpots import EVOLVING, FROZEN
from delagrange.problem.status import Limits
from delagrange.run.run_dataset import status_time_variable, status_variable, variable

_RUNNING = 50  # times at which the running estimate is given
_LEFT_OUT = 0.25  # of the time, in which the tangent vectors find their directions
_FEWEST = 64  # samples, without which nothing is said
_BLOCKS = 8  # parts of the time whose means are compared
_POWER = 2.0  # growth like the square of time is the fastest that a regular motion is expected to show
MOST_SAMPLES = 20_000_000  # of a motion, some gigabytes
_FAR = 5.0  # times what such growth amounts to: an exponent beyond is not made of it
DEFINITION = (
    "mean rate over the last three quarters of the time, weighted by Hann's window, under which what "
    "oscillates averages out"
)
UNCERTAINTY = (
    "standard error from 8 parts of that time; for a small exponent also what growth like the square of time, "
    "which is not exponential, would amount to"
)


@dataclass(frozen=True)
class Spectrum:
    """Lyapunov exponents [1/s], in falling order, with what they stand on."""

    exponents: np.ndarray  # (n,) as `DEFINITION` says
    uncertainty: np.ndarray  # (n,)
    times: np.ndarray  # (n_times,) [s], how long the motion had been followed
    running: np.ndarray  # (n, n_times), the same means at those times
    divergence: float  # [1/s], mean of the trace of the Jacobian over the same time

    @property
    def sum_error(self) -> float:
        """Sum of the exponents less the mean divergence [1/s]: zero in exact arithmetic."""
        return float(np.sum(self.exponents) - self.divergence)


def spectrum(observation: Observation) -> Spectrum | None:
    """The spectrum of what was observed; None where the motion was lost too early for one."""
    interval = observation.forcing.interval
    rates = observation.growth / interval
    if len(rates) < _FEWEST:
        return None
    ends = np.linspace(0, len(rates), _RUNNING + 1).astype(int)[1:]
    running = np.array([_mean(rates[_first(end) : end]) for end in ends]).T
    order = np.argsort(-running[:, -1], kind="stable")
    traces = np.diff(observation.divergence)[:, None] / interval
    return Spectrum(
        running[order, -1],
        _uncertainty(rates, interval, running[:, -1])[order],
        observation.times[ends] - observation.times[0],
        running[order],
        float(_mean(traces[_first(len(traces)) :])[0]),
    )


def _first(end: int) -> int:
    """The sample from which on the mean up to sample `end` is taken."""
    return int(_LEFT_OUT * end)


def _mean(rates: np.ndarray) -> np.ndarray:
    """Of (n, n_columns) over n, weighted by Hann's window."""
    weights = np.sin(np.pi * (np.arange(len(rates)) + 0.5) / len(rates)) ** 2
    return weights @ rates / np.sum(weights)


def _uncertainty(rates: np.ndarray, interval: float, exponents: np.ndarray) -> np.ndarray:
    first = _first(len(rates))
    means = [_mean(block) for block in np.array_split(rates[first:], _BLOCKS)]
    error = np.std(means, axis=0, ddof=1) / np.sqrt(_BLOCKS)
    times = (np.arange(first, len(rates)) + 0.5) * interval
    algebraic = _mean(_POWER / times[:, None])
    return np.where(np.abs(exponents) > _FAR * algebraic, error, np.hypot(error, algebraic))


def lyapunov_spectrum(
    model: str | ModuleType,
    *,
    duration: float,
    force: Drive | float = 0.0,
    field: Drive | float = 0.0,
    inputs: Inputs | None = None,
    transient: float = 0.0,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    held_stretch: float | None = None,
    parameters: Parameters | None = None,
    initial_state: Mapping[str, float] | None = None,
    dashpots: str = FROZEN,
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    tolerance: float = 1e-11,
    engine: str = "auto",
    progress: bool = False,
    **material: float,
) -> xr.Dataset:
    """All Lyapunov exponents of one motion, by natural logarithm [1/s], with their convergence in time.

    An exponent is the mean over the last three quarters of the time: in the first, the tangent vectors
    find their directions, and what grows in proportion to time has done most of its growing. The mean is
    weighted by Hann's window, as in Das, Saiki, Sander & Yorke (2017), Nonlinearity 30, 4111: what oscillates
    averages out then.

    Args:
        model, force, field, inputs, formulation, lateral_dashpot, held_stretch, parameters, limits, material: as
            for `simulate`; the drives are constant or sines.
        duration: time observed [s], after
        transient: time [s] that is left out before; both are rounded to periods of the forcing, of which at
            least 16 are observed.
        initial_state: values of state variables at t = 0 by name; the rest is the reference state.
        dashpots: "frozen" where they stand at t = 0 (their directions are then left out of the spectrum), or
            "evolving".
        tolerance: of the local error, in units of typical sizes of the state.
        engine: "auto", "compiled", "core" (the integrator in C) or "scipy".
        progress: show a progress bar on standard error.

    Returns:
        Dataset over `exponent` and `time`: `lyapunov_exponents`, `lyapunov_uncertainty`, `running_exponents`
        [1/s]; `mean_divergence` [1/s], of the Jacobian's trace, which the exponents' sum equals, and
        `sum_error`, by how much it does not; `status` and `status_time`. NaN where the motion was lost.

    Raises:
        ValueError: something given makes no sense; the message names it, its value, its unit and what is
            allowed.
    """
    motion = make_motion(
        model, force, field, inputs=inputs, formulation=formulation, lateral_dashpot=lateral_dashpot,
        held_stretch=held_stretch, parameters=parameters, initial_state=initial_state, dashpots=dashpots,
        choices=(FROZEN, EVOLVING), limits=limits, tolerance=tolerance, engine=engine, material=material,
    )  # fmt: skip
    left_out = motion.transient_periods(transient)
    observation = observed(motion, motion.periods(duration), left_out, progress)
    attributes = motion.attributes | {
        "duration": observation.duration,
        "transient": left_out * motion.forcing.period,
    }
    return xr.Dataset(
        spectrum_variables(observation, len(motion.moving)) | status_variables(observation),
        attrs=attributes,
    )


def observed(motion: Motion, periods: int, left_out: int = 0, progress: bool = False) -> Observation:
    """The motion through `periods` periods of the forcing after `left_out`.

    Raises:
        ValueError: more samples than `MOST_SAMPLES`.
    """
    _check_samples(motion.forcing, periods)
    total = (left_out + periods) * motion.forcing.period
    with progress_bar(progress, "following the motion", total, "s") as bar:
        return observe(
            motion.path, motion.flow, motion.forcing, motion.start, motion.moving, periods, left_out, bar
        )


def _check_samples(forcing: Forcing, periods: int) -> None:
    samples = periods * forcing.samples
    if samples > MOST_SAMPLES:
        raise ValueError(
            f"the motion would take {samples:.3g} samples, {periods:.4g} periods of {forcing.period:.3g} s with "
            f"{forcing.samples:.4g} each, as its fastest small vibration is at {forcing.fastest:.3g} Hz; at most "
            f"{MOST_SAMPLES:.3g} are allowed"
        )


def status_variables(observation: Observation) -> dict[str, tuple]:
    """How the run ended, and when."""
    return {
        "status": status_variable((), observation.status),
        "status_time": status_time_variable((), observation.status_time),
    }


def spectrum_variables(observation: Observation, moving: int) -> dict[str, tuple]:
    """The spectrum for a Dataset, over `exponent` and `time`; NaN where there is none."""
    found = spectrum(observation) or _no_spectrum(moving)
    return {
        "lyapunov_exponents": variable(
            "exponent", found.exponents, "1/s", "Lyapunov exponent, by natural logarithm", "λ_i",
            definition=DEFINITION,
        ),
        "lyapunov_uncertainty": variable(
            "exponent", found.uncertainty, "1/s", "uncertainty of the Lyapunov exponent",
            definition=UNCERTAINTY,
        ),
        "running_exponents": variable(
            ("exponent", "time"), found.running, "1/s", "Lyapunov exponent, had the motion been followed so long",
        ),
        "mean_divergence": variable(
            (), found.divergence, "1/s", "mean of the trace of the Jacobian over the same time"
        ),
        "sum_error": variable(
            (), found.sum_error, "1/s", "sum of the Lyapunov exponents less the mean divergence"
        ),
        "time": variable("time", found.times, "s", "time for which the motion had been followed", "t"),
    }  # fmt: skip


def _no_spectrum(moving: int) -> Spectrum:
    nothing = np.full(moving, np.nan)
    return Spectrum(nothing, nothing, np.zeros(0), np.zeros((moving, 0)), np.nan)
