"""One trajectory, integrated by SciPy, as a Dataset."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType

import numpy as np
import xarray as xr

from delagrange.common import checks
from delagrange.common.units import shown
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import Inputs, input_name
from delagrange.equilibrium.start import starting_state
from delagrange.model.load import check_offers
from delagrange.model.parameters import Parameters
from delagrange.model.variables import sign_of
from delagrange.problem import status as loss
from delagrange.problem.initial import start_attributes
from delagrange.problem.problem import Problem, make_specimen
from delagrange.problem.status import Limits
from delagrange.problem.tolerances import check_duration, check_tolerances
from delagrange.problem.trajectory import EXPLICIT, METHODS, Trajectory, integrate
from delagrange.run.electrodes import electrode_variables, powers_of
from delagrange.run.run_dataset import (
    run_attributes,
    state_variables,
    status_time_variable,
    status_variable,
    variable,
)

_SPACING = 25e-6  # [s], some 40 samples in a period of the paper's membrane
_FEWEST_SAMPLES, _MOST_SAMPLES = 2001, 1_000_001
_SAMPLES_RANGE = (2, 10_000_000)


def simulate(
    model: str | ModuleType,
    *,
    duration: float,
    force: Drive | float = 0.0,
    field: Drive | float = 0.0,
    inputs: Inputs | None = None,
    held_stretch: float | None = None,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    time: np.ndarray | None = None,
    samples: int | None = None,
    initial_state: Mapping[str, float] | str | np.ndarray | None = None,
    method: str = "DOP853",
    rtol: float = 1e-9,
    atol: float = 1e-12,
    energies: bool = False,
    limits: Limits = Limits(),  # noqa: B008  (frozen)
    progress: bool = False,
    **material: float,
) -> xr.Dataset:
    """Integrate one run from t = 0 over `duration` [s], 1e-9 s to 1e6 s.

    Args:
        model: name of a load case or of a generated module, such a module itself, or the path of a model's file.
        force: drive of the applied force, or a number [N]; a number is a step at t = 0.
        field: drive of the nominal electric field, or a number [V/m].
        inputs: drives or numbers of any input of the model by its name, as {"force_2": 0.3}, in its own unit.
        held_stretch: stretch [1] at which pure shear holds axis 2; needed there, refused elsewhere.
        formulation, lateral_dashpot: choice among the models of pure shear, see `load_model`.
        parameters: the membrane, in place of the model's `DEFAULTS` or, where it has none, of SHENG_2015;
            `**material` replaces single values of it, `relaxation_time` [s] included.
        time: times [s] of the output, increasing, from 0 to `duration`; or
        samples: how many, evenly spaced, 2 to 10000000. Left out, at least 2001, at most 25 us apart in
            runs of up to 25 s; in longer ones 1000001, farther apart.
        initial_state: values of state variables at t = 0 by name, in the units of `model.STATE`; those left out, or
            all, are as in the reference state, at rest. Or "equilibrium": at rest where the membrane has relaxed
            under its forces as they are at t = 0 (the bias of a sine, where a ramp begins) without field, charge or
            current, which are then switched on. Or an array (n_state,) in the order of `model.STATE`.
        method: "DOP853", "RK45", or with the Jacobian, for short relaxation times, "Radau", "BDF", "LSODA";
            "auto" takes Radau where the Jacobian at the start has a decay much faster than its vibration,
            else DOP853.
        rtol, atol: tolerances of the local error of every state variable, in its own unit. An implicit method follows
            a slow drive of 100 s in steps far shorter than it needs, for minutes, where `atol` is far below `rtol`
            times what is of interest: with rtol 1e-6 give 1e-9 or so.
        energies: give energies and powers as well.
        limits: stretches beyond which the solution counts as lost.
        progress: show a progress bar on standard error.

    Returns:
        Dataset over `time`: the state, the inputs, `thickness_stretch`, reactions where the model has them,
        what its electrodes answer with where it says that (`nominal_charge_density` to a field,
        `nominal_electric_field` to a charge or a current), energies and powers on request; and `status`
        ("completed", "collapsed", "diverged", "locked") with `status_time`. After the loss of the solution the
        variables of the state are NaN.

    Raises:
        ValueError: something given makes no sense, or there is no equilibrium to start at; the message names it,
            its value, its unit and what is allowed.
    """
    specimen = make_specimen(model, formulation, lateral_dashpot, parameters)
    module = specimen.model
    duration = check_duration(duration)
    rtol, atol = check_tolerances(rtol, atol)
    checks.choice("method", method, METHODS)
    checks.instance("limits", limits, Limits)
    _check_offers(module, method, energies)
    problem = specimen.single_problem(material, held_stretch, force, field, inputs)
    for entry, drive in zip(module.INPUTS, problem.drives):
        drive.check_window(input_name(entry.name), 0.0, duration)
    times = output_times(time, samples, duration)
    start = initial_values(problem, initial_state, limits)
    trajectory = integrate(problem, start, times, duration, method, rtol, atol, limits, progress)
    numerics = {"method": trajectory.method, "rtol": rtol, "atol": atol, "duration": duration}
    attributes = run_attributes(problem, limits) | numerics | start_attributes(module, initial_state)
    return _dataset(problem, times, trajectory, energies, attributes)


def _check_offers(module: ModuleType, method: str, energies: bool) -> None:
    if method not in EXPLICIT:
        check_offers(module, ("jacobian",), f"method {method!r}")
    if energies:
        check_offers(module, _ENERGIES, "energies=True")
    if getattr(module, "REACTIONS", ()):
        check_offers(module, ("reaction_forces",), "REACTIONS")


def output_times(time: np.ndarray | None, samples: int | None, duration: float) -> np.ndarray:
    """The times [s] of the output, (n_times,): as given, or evenly spaced.

    Raises:
        ValueError: both given, times out of order or out of the run, or too few or too many samples.
    """
    if time is not None and samples is not None:
        raise ValueError(f"time and samples = {shown(samples)} both given; give one")
    if time is None:
        wanted = int(np.clip(np.ceil(duration / _SPACING) + 1, _FEWEST_SAMPLES, _MOST_SAMPLES))
        wanted = wanted if samples is None else checks.count("samples", samples, *_SAMPLES_RANGE)
        return np.linspace(0.0, duration, wanted)
    times = checks.increasing("time", time, "s")
    if times[0] < 0 or times[-1] > duration:
        raise ValueError(
            f"time must lie from 0 s to {duration:g} s (the duration), got {times[0]:g} to {times[-1]:g} s"
        )
    return times


def initial_values(
    problem: Problem, given: Mapping[str, float] | str | np.ndarray | None, limits: Limits
) -> np.ndarray:
    """The state at t = 0, (n_state,): as given by names or as an array, the loaded equilibrium, or the reference state.

    Raises:
        ValueError: an unknown name, wrong length, not finite, a stretch that is not positive, or no equilibrium.
    """
    model = problem.model
    if given is None or isinstance(given, Mapping | str):
        return starting_state(problem, given, limits)
    names = ", ".join(f"{entry.name} [{entry.unit}]" for entry in model.STATE)
    state = np.asarray(checks.finite("initial_state", given, "the units of the state"))
    if state.shape != (len(model.STATE),):
        raise ValueError(
            f"initial_state must hold {len(model.STATE)} values ({names}), got shape {state.shape}"
        )
    for entry, value in zip(model.STATE, state):
        checks.signed(f"initial_state {entry.name}", value, entry.unit, sign_of(entry))
    return state


def _dataset(
    problem: Problem, times: np.ndarray, trajectory: Trajectory, energies: bool, attributes: dict[str, object]
) -> xr.Dataset:
    with np.errstate(all="ignore"):
        inputs = [np.broadcast_to(values, times.shape) for values in problem.inputs(times)]
        data = {
            **state_variables(problem.model, "time", trajectory.state),
            **_input_variables(problem, inputs),
            **_derived_variables(problem, trajectory.state, inputs),
            **electrode_variables(problem, trajectory.state, inputs),
            **(_energy_variables(problem, trajectory.state, inputs) if energies else {}),
        }
    data["status"] = status_variable((), trajectory.status)
    data["status_time"] = status_time_variable((), trajectory.status_time)
    attributes |= {"status": loss.STATUS[trajectory.status], "status_time": trajectory.status_time}
    return xr.Dataset(data, coords={"time": variable("time", times, "s", "time", "t")}, attrs=attributes)


def _input_variables(problem: Problem, inputs: list[np.ndarray]) -> dict[str, tuple]:
    return {
        entry.name: variable("time", np.array(values), entry.unit, entry.meaning, entry.symbol)
        for entry, values in zip(problem.model.INPUTS, inputs)
    }


def _derived_variables(problem: Problem, state: np.ndarray, inputs: list[np.ndarray]) -> dict[str, tuple]:
    model = problem.model
    principal = model.principal_stretches(state, inputs, problem.parameters)
    derived = {
        "thickness_stretch": variable("time", principal[2], "1", "stretch through the thickness", "λ_3")
    }
    if getattr(model, "REACTIONS", ()):
        forces = model.reaction_forces(state, inputs, problem.parameters)
        for entry, values in zip(model.REACTIONS, forces):
            derived[entry.name] = variable("time", values, entry.unit, entry.meaning, entry.symbol)
    return derived


_ENERGIES = {
    "kinetic_energy": ("J", "kinetic energy of the membrane", "T"),
    "potential_energy": ("J", "potential of springs, forces and field", "Π"),
    "force_power": ("W", "power put in by the applied forces", ""),
    "dashpot_power": ("W", "power dissipated in the dashpots", ""),
}


def _energy_variables(problem: Problem, state: np.ndarray, inputs: list[np.ndarray]) -> dict[str, tuple]:
    data = {}
    for name, (unit, meaning, symbol) in (_ENERGIES | powers_of(problem.model)).items():
        values = getattr(problem.model, name)(state, inputs, problem.parameters)
        data[name] = variable("time", np.broadcast_to(values, state.shape[1:]).copy(), unit, meaning, symbol)
    total = data["kinetic_energy"][1] + data["potential_energy"][1]
    data["total_energy"] = variable("time", total, "J", "kinetic and potential energy", "T + Π")
    return data
