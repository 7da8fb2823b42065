"""Results as `xarray.Dataset`: every variable with its unit, every run with what it was made of."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib.metadata import version
from pathlib import Path
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.engines.lanes import Outcome
from delagrange.model.user_files import is_users
from delagrange.model.variables import role_of
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


def state_variables(
    model: ModuleType,
    dimensions: str | tuple[str, ...],
    states: Iterable[np.ndarray],
    where: str = "",
    prefix: str = "",
) -> dict[str, tuple]:
    """Every state variable, whose values are the rows of `states`, named with a prefix; `where` says when it is so."""
    said = f", {where}" if where else ""
    return {
        prefix + entry.name: variable(
            dimensions, values, entry.unit, entry.meaning + said, entry.symbol, role=str(role_of(entry))
        )
        for entry, values in zip(model.STATE, states)
    }


def coordinate_variables(
    model: ModuleType,
    dimensions: str | tuple[str, ...],
    measured: Mapping[str, np.ndarray],
    about: Mapping[str, Mapping[str, object]],
    prefix: str = "",
) -> dict[str, tuple]:
    """What is measured of every coordinate, each (n_coordinates, ...); that of the first goes without its name.

    about: further attributes of what is measured, by its name
    """
    data = {}
    for place, entry in enumerate(model.STATE[: model.COORDINATE_COUNT]):
        for what, values in measured.items():
            name = f"{prefix}{entry.name}_{what}" if place else prefix + what
            long_name = f"{what.replace('_', ' ')} of the {entry.meaning}"
            more = about.get(what, {})
            data[name] = variable(dimensions, values[place], entry.unit, long_name, entry.symbol, **more)
    return data


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
    maximum, minimum = (
        np.where(np.isfinite(values), values, np.nan).reshape(-1, *shape)
        for values in (outcome.maximum, outcome.minimum)
    )
    completed = outcome.status.reshape(shape) == COMPLETED
    amplitude = np.where(completed, (maximum - minimum) / 2, np.nan)
    measured = {"amplitude": amplitude, "maximum": maximum, "minimum": minimum}
    return coordinate_variables(model, dimensions, measured, dict.fromkeys(measured, measure))


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
    averages = {"mean": outcome.mean, "root_mean_square": np.sqrt(outcome.mean_square)}
    measured = {
        what: np.where(outcome.status == COMPLETED, values, np.nan).reshape(-1, *shape)
        for what, values in averages.items()
    }
    about = {what: measure | {"definition": AVERAGE_DEFINITIONS[what]} for what in averages}
    return coordinate_variables(model, dimensions, measured, about)


def sample_variables(
    model: ModuleType, samples: np.ndarray, dimensions: tuple[str, ...], shape: tuple[int, ...], prefix: str
) -> dict[str, tuple]:
    """Samples of the state over a grid and one dimension more, of the samples.

    samples: (count, n_state, n_runs), taken as they are: the variables are views of them
    """
    rows = (np.moveaxis(values.reshape(-1, *shape), 0, -1) for values in np.moveaxis(samples, 1, 0))
    return state_variables(model, dimensions, rows, prefix=prefix)


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
