"""Delagrange: dielectric-elastomer membranes, derived, checked, emitted as code, integrated, measured.

Nothing heavy is imported before it is used (PEP 562).
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from delagrange.analysis.portrait import phase_portrait
    from delagrange.analysis.sections import stroboscopic_section
    from delagrange.drive import Constant, Drive, Ramp, Sine, Step, Tabulated
    from delagrange.loss import Limits
    from delagrange.models import load_model, model_names
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
    "frequency_response": "response",
    "load_model": "models",
    "model_names": "models",
    "peaks": "response",
    "phase_portrait": "analysis.portrait",
    "simulate": "simulation",
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
    "frequency_response",
    "load_model",
    "model_names",
    "peaks",
    "phase_portrait",
    "simulate",
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
