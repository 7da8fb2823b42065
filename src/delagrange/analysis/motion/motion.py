"""A motion put together from what a user gives: the run, where it starts, how it is forced, what of it moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from delagrange.analysis.forcing import Forcing, forcing
from delagrange.analysis.motion.observation import moving_places
from delagrange.common import checks
from delagrange.common.units import with_unit
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import Inputs, input_name
from delagrange.engines.flow import Flow, FlowPath, drive_numbers
from delagrange.engines.flows import resolve_flow
from delagrange.equilibrium.start import starting_state
from delagrange.model.load import check_offers
from delagrange.model.parameters import Parameters
from delagrange.problem.coordinate_size import typical_sizes
from delagrange.problem.dashpots import FROZEN, frozen
from delagrange.problem.initial import start_attributes
from delagrange.problem.problem import Problem, make_specimen
from delagrange.problem.status import Limits
from delagrange.problem.tolerances import DURATION_RANGE, check_duration
from delagrange.run.run_dataset import run_attributes

TOLERANCE_RANGE = (1e-13, 1e-4)


@dataclass(frozen=True)
class Motion:
    """One run from its start, with what carries it on."""

    path: FlowPath
    flow: Flow
    start: np.ndarray  # (n_state,) at t = 0
    forcing: Forcing
    moving: np.ndarray  # (n_moving,) places in the state of what moves
    dashpots: str
    attributes: dict[str, object]  # of the Dataset

    @property
    def model(self) -> ModuleType:
        """The model of the run."""
        return self.path.problem.model

    def periods(self, duration: float) -> int:
        """How many periods of the forcing make up `duration` [s], at least 16.

        Raises:
            ValueError: a duration outside `delagrange.problem.tolerances.DURATION_RANGE`.
        """
        return max(16, round(check_duration(duration) / self.forcing.period))

    def transient_periods(self, transient: float) -> int:
        """How many periods of the forcing make up `transient` [s], which may be 0.

        Raises:
            ValueError: a negative transient, or one longer than a duration may be.
        """
        return round(checks.within("transient", transient, "s", 0.0, DURATION_RANGE[1]) / self.forcing.period)


def make_motion(
    model: str | ModuleType,
    force: Drive | float,
    field: Drive | float,
    *,
    inputs: Inputs | None,
    formulation: str | None,
    lateral_dashpot: str | None,
    held_stretch: float | None,
    parameters: Parameters | None,
    initial_state: Mapping[str, float] | str | None,
    dashpots: str,
    choices: tuple[str, ...],
    limits: Limits,
    tolerance: float,
    engine: str,
    material: Mapping[str, float],
) -> Motion:
    """The motion, checked; `choices` are those of the dashpots.

    Raises:
        ValueError: as `delagrange.simulate`; a drive that is neither constant nor a sine; arrays.
    """
    specimen = make_specimen(model, formulation, lateral_dashpot, parameters)
    check_offers(specimen.model, ("jacobian",), "the kind of a motion")
    checks.choice("dashpots", dashpots, choices)
    checks.instance("limits", limits, Limits)
    tolerance = checks.within("tolerance", tolerance, "1", *TOLERANCE_RANGE)
    problem = specimen.single_problem(material, held_stretch, force, field, inputs)
    start = starting_state(problem, initial_state, limits)
    run = frozen(problem) if dashpots == FROZEN else problem
    path = FlowPath(run, typical_sizes(run), tolerance, limits)
    attributes = run_attributes(problem, limits) | start_attributes(specimen.model, initial_state)
    return Motion(
        path,
        resolve_flow(run, engine),
        start,
        forcing(run, start),
        moving_places(path, dashpots),
        dashpots,
        attributes | {"load": load_text(problem), "dashpots": dashpots, "tolerance": tolerance},
    )


def load_text(problem: Problem) -> str:
    """`force 0.5 N, field 5e+06 V/m sin(2π 371 Hz t)`."""
    rows = zip(problem.model.INPUTS, drive_numbers(problem))
    return ", ".join(
        f"{input_name(entry.name)} {_drive_text(numbers, entry.unit)}" for entry, numbers in rows
    )


def _drive_text(numbers: np.ndarray, unit: str) -> str:
    bias, amplitude, frequency, phase = (float(f"{number:.6g}") for number in numbers)
    if amplitude == 0.0:
        return with_unit(bias, unit)
    start = f"{with_unit(bias, unit)} + " if bias else ""
    lag = f" {'+' if phase > 0 else '-'} {abs(phase):.4g} rad" if phase else ""
    return f"{start}{with_unit(amplitude, unit)} sin(2π {frequency:g} Hz t{lag})"
