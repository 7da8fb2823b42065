"""Delagrange: dielectric-elastomer membranes, derived, checked, emitted as code, integrated, measured.

Nothing heavy is imported before it is used (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from delagrange.analysis.motion.classify import classify
    from delagrange.analysis.motion.lyapunov import lyapunov_spectrum
    from delagrange.analysis.motion.portrait import phase_portrait
    from delagrange.analysis.motion.sections import stroboscopic_section
    from delagrange.analysis.rest.dynamic_pull_in import dynamic_pull_in
    from delagrange.analysis.rest.equilibria import equilibria
    from delagrange.analysis.rest.modes import modes
    from delagrange.analysis.rest.pull_in import pull_in
    from delagrange.analysis.steady.steady_response import steady_response
    from delagrange.analysis.steady.stepped_sweep import stepped_sweep
    from delagrange.drives.drive import Constant, Drive, Ramp, Sine, Step, Tabulated
    from delagrange.equilibrium.rest_state import rest_state
    from delagrange.model.load import load, load_model, model_names
    from delagrange.model.parameters import SHENG_2015, Parameters
    from delagrange.problem.status import Limits
    from delagrange.run.frequency_response import frequency_response, peaks
    from delagrange.run.simulation import simulate

_HOME = {
    "SHENG_2015": "model.parameters",
    "Constant": "drives.drive",
    "Drive": "drives.drive",
    "Limits": "problem.status",
    "Parameters": "model.parameters",
    "Ramp": "drives.drive",
    "Sine": "drives.drive",
    "Step": "drives.drive",
    "Tabulated": "drives.drive",
    "classify": "analysis.motion.classify",
    "dynamic_pull_in": "analysis.rest.dynamic_pull_in",
    "equilibria": "analysis.rest.equilibria",
    "frequency_response": "run.frequency_response",
    "load": "model.load",
    "load_model": "model.load",
    "lyapunov_spectrum": "analysis.motion.lyapunov",
    "model_names": "model.load",
    "modes": "analysis.rest.modes",
    "peaks": "run.frequency_response",
    "phase_portrait": "analysis.motion.portrait",
    "pull_in": "analysis.rest.pull_in",
    "rest_state": "equilibrium.rest_state",
    "simulate": "run.simulation",
    "steady_response": "analysis.steady.steady_response",
    "stepped_sweep": "analysis.steady.stepped_sweep",
    "stroboscopic_section": "analysis.motion.sections",
}

__all__ = [
    "SHENG_2015",
    "Constant",
    "Drive",
    "Limits",
    "Parameters",
    "Ramp",
    "Sine",
    "Step",
    "Tabulated",
    "classify",
    "dynamic_pull_in",
    "equilibria",
    "frequency_response",
    "load",
    "load_model",
    "lyapunov_spectrum",
    "model_names",
    "modes",
    "peaks",
    "phase_portrait",
    "pull_in",
    "rest_state",
    "simulate",
    "steady_response",
    "stepped_sweep",
    "stroboscopic_section",
]


def __getattr__(name: str) -> object:
    if name == "__version__":
        return import_module("importlib.metadata").version("delagrange")
    if name not in _HOME:
        raise AttributeError(f"module 'delagrange' has no attribute {name!r}")
    return getattr(import_module(f"delagrange.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
