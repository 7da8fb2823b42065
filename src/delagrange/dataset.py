"""Results as `xarray.Dataset`: every variable with its unit, every run with what it was made of."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np

from delagrange.loss import STATUS, STATUS_MEANING, Limits
from delagrange.parameters import Parameters
from delagrange.problem import Problem

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
    """Status by name from places in `delagrange.loss.STATUS`."""
    names = np.array(STATUS)[np.asarray(codes)].astype(object)
    return dimensions, names, {"long_name": "how the run ended", "meaning": STATUS_MEANING}


def status_time_variable(dimensions: str | tuple[str, ...], times: object) -> tuple:
    """When each run ended [s]."""
    return variable(dimensions, times, "s", "time at which the run ended")


def run_attributes(problem: Problem, parameters: Parameters, limits: Limits) -> dict[str, object]:
    """What a run was made of: model, single-valued parameters, drives, limits, version and source."""
    model = problem.model
    single = {
        entry.name: float(value)
        for entry, value in zip(model.PARAMETERS, problem.parameters)
        if np.ndim(value) == 0
    }
    drives = {f"{entry.name}_drive": str(drive) for entry, drive in zip(model.INPUTS, problem.drives)}
    return {
        "model": model.MODEL,
        "load_case": getattr(model, "LOAD_CASE", model.MODEL),
        "formulation": model.FORMULATION,
        **single,
        **drives,
        "parameters_source": parameters.source,
        "smallest_stretch": limits.smallest_stretch,
        "largest_stretch": limits.largest_stretch,
        "delagrange_version": version("delagrange"),
        "source": f"equations derived from the energies of {PAPER}, Eqs. (1)-(6)",
    }
