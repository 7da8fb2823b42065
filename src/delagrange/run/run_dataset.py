"""Results as `xarray.Dataset`: every variable with its unit, every run with what it was made of."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.engines.lanes import Outcome
from delagrange.model.user_files import is_users
from delagrange.problem.problem import Problem
from delagrange.problem.status import COMPLETED, STATUS, STATUS_MEANING, Limits

AMPLITUDE_DEFINITION = "half of peak to peak over the window, transient included"
AVERAGE_DEFINITIONS = {
    "mean": "time average over the window, transient included",
    "root_mean_square": "square root of the time average of the square over the window, transient included",
}
PAPER = "Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384"


def variable(
    dimensions: str | tuple[str, ...],
    values: object,
    unit: str,
    long_name: str,
    symbol: str = "",
    **more: object,
) -> tuple:
    """What `xarray.Dataset` wants of one variable, with `units`, `long_name`, `symbol` as attributes."""
    attributes = {"units": unit, "long_name": long_name} | ({"symbol": symbol} if symbol else {}) | more
    return dimensions, values, attributes


def status_variable(dimensions: str | tuple[str, ...], codes: object) -> tuple:
    """Status by name from places in `delagrange.problem.status.STATUS`."""
    names = np.array(STATUS)[np.asarray(codes)].astype(object)
    return dimensions, names, {"long_name": "how the run ended", "meaning": STATUS_MEANING}


def status_time_variable(dimensions: str | tuple[str, ...], times: object) -> tuple:
    """When each run ended [s]."""
    return variable(dimensions, times, "s", "time at which the run ended")


def extrema_variables(
    model: ModuleType,
    outcome: Outcome,
    dimensions: tuple[str, ...],
    shape: tuple[int, ...],
    measure: dict[str, object],
) -> dict[str, tuple]:
    """Amplitude, maximum and minimum of every coordinate over a grid; those of the first go without its name.

    The amplitude is NaN where the run was lost, an extremum where the run did not reach the window.
    """
    completed = outcome.status.reshape(shape) == COMPLETED
    data = {}
    for place, entry in enumerate(model.STATE[: model.COORDINATE_COUNT]):
        maximum, minimum = (
            np.where(np.isfinite(values[place]), values[place], np.nan).reshape(shape)
            for values in (outcome.maximum, outcome.minimum)
        )
        amplitude = np.where(completed, (maximum - minimum) / 2, np.nan)
        prefix = f"{entry.name}_" if place else ""
        for what, values in (("amplitude", amplitude), ("maximum", maximum), ("minimum", minimum)):
            long_name = f"{what} of the {entry.meaning}"
            data[prefix + what] = variable(dimensions, values, entry.unit, long_name, entry.symbol, **measure)
    return data


def average_variables(
    model: ModuleType,
    outcome: Outcome,
    dimensions: tuple[str, ...],
    shape: tuple[int, ...],
    measure: dict[str, object],
) -> dict[str, tuple]:
    """Mean and root mean square of every coordinate over a grid, NaN where the run was lost.

    Named as the extrema are, each with its own definition.
    """
    completed = outcome.status == COMPLETED
    averages = {"mean": outcome.mean, "root_mean_square": np.sqrt(outcome.mean_square)}
    data = {}
    for place, entry in enumerate(model.STATE[: model.COORDINATE_COUNT]):
        prefix = f"{entry.name}_" if place else ""
        for what, averaged in averages.items():
            values = np.where(completed, averaged[place], np.nan).reshape(shape)
            long_name = f"{what.replace('_', ' ')} of the {entry.meaning}"
            attributes = measure | {"definition": AVERAGE_DEFINITIONS[what]}
            data[prefix + what] = variable(
                dimensions, values, entry.unit, long_name, entry.symbol, **attributes
            )
    return data


def final_variables(
    model: ModuleType, outcome: Outcome, dimensions: tuple[str, ...], shape: tuple[int, ...]
) -> dict[str, tuple]:
    """The state in which every run of a grid ended, at the loss where it was lost."""
    return {
        f"final_{entry.name}": variable(
            dimensions, values.reshape(shape), entry.unit, f"{entry.meaning}, at the end", entry.symbol
        )
        for entry, values in zip(model.STATE, outcome.state)
    }


def sample_variables(
    model: ModuleType, samples: np.ndarray, dimensions: tuple[str, ...], shape: tuple[int, ...], prefix: str
) -> dict[str, tuple]:
    """Samples of the state over a grid and one dimension more, of the samples.

    samples: (count, n_state, n_runs), taken as they are: the variables are views of them
    """
    data = {}
    for place, entry in enumerate(model.STATE):
        values = np.moveaxis(samples[:, place].reshape(-1, *shape), 0, -1)
        data[prefix + entry.name] = variable(dimensions, values, entry.unit, entry.meaning, entry.symbol)
    return data


def forces_text(found: xr.Dataset) -> str:
    """The single forces among the coordinates: `0.5 N`, or `force_1 0.3 N, force_2 0 N` where there are others."""
    if "force" in found.coords:
        return f"{float(found['force']):g} N"
    forces = {name: value for name, value in found.coords.items() if value.attrs.get("units") == "N"}
    given = [f"{name} {float(value):g} N" for name, value in forces.items() if value.ndim == 0]
    return ", ".join(given) or "0 N"


def run_attributes(problem: Problem, limits: Limits) -> dict[str, object]:
    """What a run was made of: model, single-valued parameters with units, drives, limits, version and source."""
    model = problem.model
    single: dict[str, object] = {}
    for entry, value in zip(model.PARAMETERS, problem.parameters):
        if np.ndim(value) == 0:
            single |= {entry.name: float(value), f"{entry.name}_units": entry.unit}
    drives = {f"{entry.name}_drive": str(drive) for entry, drive in zip(model.INPUTS, problem.drives)}
    return {
        "model": model.MODEL,
        "load_case": getattr(model, "LOAD_CASE", model.MODEL),
        "formulation": model.FORMULATION,
        **single,
        **drives,
        "parameters_source": problem.source,
        "smallest_stretch": limits.smallest_stretch,
        "largest_stretch": limits.largest_stretch,
        "delagrange_version": version("delagrange"),
        "source": _source(model),
    }


def _source(model: ModuleType) -> str:
    """Where the equations come from."""
    if is_users(model):
        return f"equations of the model in {Path(model.__file__).name}"
    return f"equations derived from the energies of {PAPER}, Eqs. (1)-(6)"
