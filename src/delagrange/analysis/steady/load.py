"""The load of a periodic motion: a constant force, and bias and amplitude of a sine of field, charge or current."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from delagrange.drives.drive import Constant, Drive, Sine
from delagrange.drives.inputs import FORCE, ElectricalInput, electrical_input, has_input
from delagrange.engines.flow import AMPLITUDE, BIAS, FREQUENCY
from delagrange.problem.problem import Problem


def load_names(electrical: ElectricalInput) -> tuple[str, str, str, str]:
    """The numbers of the load of a model with that electrical input."""
    return "force", electrical.amplitude, electrical.bias, "frequency"


def source_of(name: str, electrical: ElectricalInput) -> tuple[str, int]:
    """The input that a number of the load belongs to, and which number of its drive it is."""
    return {
        "force": (FORCE, BIAS),
        electrical.amplitude: (electrical.name, AMPLITUDE),
        electrical.bias: (electrical.name, BIAS),
        "frequency": (electrical.name, FREQUENCY),
    }[name]


def sine_of(load: Mapping[str, float], electrical: ElectricalInput) -> Drive:
    """bias + amplitude sin(2 pi f t), at phase 0 at t = 0."""
    return Sine(load[electrical.amplitude], load["frequency"], load[electrical.bias])


def under_load(problem: Problem, load: Mapping[str, float]) -> Problem:
    """The problem with the force and the field, or charge, of a load, as far as its model has them."""
    electrical = electrical_input(problem.model)
    loaded = {FORCE: Constant(load["force"]), electrical.name: sine_of(load, electrical)}
    entries = zip(problem.model.INPUTS, problem.drives)
    return replace(problem, drives=tuple(loaded.get(entry.name, drive) for entry, drive in entries))


def forces_of(problem: Problem, load: Mapping[str, float]) -> dict[str, float]:
    """The force of a load as the input that it is, if the model has it."""
    return {FORCE: load["force"]} if has_input(problem.model, FORCE) else {}
