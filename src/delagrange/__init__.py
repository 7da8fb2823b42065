"""Delagrange: dielectric-elastomer membranes, derived, checked, emitted as code, integrated, measured.

Nothing heavy is imported before it is used (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from delagrange.analysis.motion.classify import classify
    from delagrange.analysis.motion.lyapunov import lyapunov_spectrum
    from delagrange.analysis.portrait import phase_portrait
    from delagrange.analysis.rest.dynamic_pull_in import dynamic_pull_in
    from delagrange.analysis.rest.equilibria import equilibria
    from delagrange.analysis.rest.modes import modes
    from delagrange.analysis.rest.pull_in import pull_in
    from delagrange.analysis.rest.rest_state import rest_state
    from delagrange.analysis.sections import stroboscopic_section
    from delagrange.analysis.steady.response import steady_response
    from delagrange.analysis.steady.stepped_sweep import stepped_sweep
    from delagrange.drive import Constant, Drive, Ramp, Sine, Step, Tabulated
    from delagrange.loss import Limits
    from delagrange.models import load, load_model, model_names
    from delagrange.parameters import SHENG_2015, Parameters
    from delagrange.response import frequency_response, peaks
    from delagrange.simulation import simulate

_HOME = {
    "SHENG_2015": "parameters",
    "Constant": "drive",
    "Drive": "drive",
    "Limits": "loss",
    "Parameters": "parameters",
    "Ramp": "drive",
    "Sine": "drive",
    "Step": "drive",
    "Tabulated": "drive",
    "classify": "analysis.motion.classify",
    "dynamic_pull_in": "analysis.rest.dynamic_pull_in",
    "equilibria": "analysis.rest.equilibria",
    "frequency_response": "response",
    "load": "models",
    "load_model": "models",
    "lyapunov_spectrum": "analysis.motion.lyapunov",
    "model_names": "models",
    "modes": "analysis.rest.modes",
    "peaks": "response",
    "phase_portrait": "analysis.portrait",
    "pull_in": "analysis.rest.pull_in",
    "rest_state": "analysis.rest.rest_state",
    "simulate": "simulation",
    "steady_response": "analysis.steady.response",
    "stepped_sweep": "analysis.steady.stepped_sweep",
    "stroboscopic_section": "analysis.sections",
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
