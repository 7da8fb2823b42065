"""Amplitude-frequency curves of Figs. 4, 7 and 10, all loads of a figure side by side.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, Sec. III; what is run stands in `cases`.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from delagrange.drives.drive import Sine
from delagrange.engines.lanes import Outcome
from delagrange.engines.numpy_engine import integrate_lanes
from delagrange.model.load import load_model
from delagrange.model.parameters import SHENG_2015
from delagrange.problem.problem import Problem, make_problem
from delagrange.reproduction.runs.cases import CurveLoad, ResponseFigure
from delagrange.reproduction.runs.numerics import ACCURATE, NumericsVariant
from delagrange.run.run_dataset import (
    AMPLITUDE_DEFINITION,
    extrema_variables,
    run_attributes,
    status_time_variable,
    status_variable,
    variable,
)


def response(
    figure: ResponseFigure,
    numerics: NumericsVariant = ACCURATE,
    formulation: str | None = None,
    frequency: np.ndarray | None = None,
) -> xr.Dataset:
    """Amplitude over frequency for every load of a figure.

    Args:
        figure: one of `cases.RESPONSES`.
        formulation: of pure shear, "as_printed" or "consistent" (the default).
        frequency: (n_frequencies,) [Hz]; that of the figure if left out.

    Returns:
        Dataset over (load, frequency): `amplitude` [1] of the first coordinate (NaN where the solution was
        lost), `maximum` and `minimum` (up to the loss), `status`, `status_time`; the coordinates `force` [N],
        `field_amplitude` [V/m] and, in pure shear, `held_stretch` [1] lie along `load`.
    """
    frequency = figure.frequency if frequency is None else np.asarray(frequency, dtype=float)
    problem = _paired_problem(figure, formulation, numerics.drive_frequency(frequency))
    lanes = len(figure.loads) * len(frequency)
    state = np.asarray(problem.model.reference_state(problem.parameters), dtype=float)
    state = np.array(np.broadcast_to(state.reshape(len(state), -1), (len(state), lanes)))
    outcome = integrate_lanes(problem, state, numerics.settings(figure.window))
    return _response_dataset(figure, problem, numerics, frequency, outcome)


def _paired_problem(figure: ResponseFigure, formulation: str | None, frequency: np.ndarray) -> Problem:
    """One lane for every load and frequency, the frequency varying fastest."""
    count = len(frequency)

    def lanes(name: str) -> np.ndarray:
        return np.repeat([getattr(load, name) for load in figure.loads], count)

    held = None if figure.loads[0].held_stretch is None else lanes("held_stretch")
    field = Sine(lanes("field_amplitude"), np.tile(frequency, len(figure.loads)))
    return make_problem(load_model(figure.model, formulation), SHENG_2015, {}, held, lanes("force"), field)


def _response_dataset(
    figure: ResponseFigure, problem: Problem, numerics: NumericsVariant, frequency: np.ndarray, outcome: Outcome
) -> xr.Dataset:
    dimensions, shape = ("load", "frequency"), (len(figure.loads), len(frequency))
    settings = numerics.settings(figure.window)
    window = {
        "definition": AMPLITUDE_DEFINITION,
        "window_start": settings.window[0],
        "window_stop": settings.window[1],
    }
    data = extrema_variables(problem.model, outcome, dimensions, shape, window)
    data["status"] = status_variable(dimensions, outcome.status.reshape(shape))
    data["status_time"] = status_time_variable(dimensions, outcome.status_time.reshape(shape))
    attributes = run_attributes(problem, settings.limits) | window | numerics.attributes()
    attributes |= {
        "figure": figure.number,
        "duration": figure.window,
        "force_drive": "constant from t = 0",
        "nominal_electric_field_drive": "field_amplitude sin(2 pi frequency t)",
    }
    frequencies = variable("frequency", frequency, "Hz", "frequency of the electric field", "f")
    coordinates = _load_coordinates(figure.loads) | {"frequency": frequencies}
    return xr.Dataset(data, coords=coordinates, attrs=attributes)


def _load_coordinates(loads: tuple[CurveLoad, ...]) -> dict[str, tuple]:
    meanings = {
        "force": ("N", "applied force", "P"),
        "field_amplitude": ("V/m", "amplitude of the nominal electric field", "E_0"),
        "held_stretch": ("1", "stretch at which axis 2 is held", "λ_2p"),
    }
    return {
        name: variable("load", [getattr(load, name) for load in loads], *meaning)
        for name, meaning in meanings.items()
        if getattr(loads[0], name) is not None
    }


def curve(responses: xr.Dataset, load: CurveLoad) -> xr.Dataset:
    """The curve over `frequency` of one load of a response.

    Raises:
        ValueError: the response has no such load.
    """
    same = (responses["force"] == load.force) & (responses["field_amplitude"] == load.field_amplitude)
    if load.held_stretch is not None:
        same &= responses["held_stretch"] == load.held_stretch
    places = np.flatnonzero(same.values)
    if len(places) != 1:
        raise ValueError(f"the response of Fig. {responses.attrs['figure']} has no curve of {load}")
    return responses.isel(load=int(places[0]))
