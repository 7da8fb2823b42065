"""Whether what a module offers as a model has the shapes of one: seen once, where it is loaded from a user's file."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from delagrange.common.units import shown
from delagrange.model.variables import role_of, sign_of

_TABLES = ("STATE", "INPUTS", "PARAMETERS")
_TOLD = ("name", "symbol", "unit", "meaning")  # of every entry of a table
_LONGEST = 200  # characters of another's message


def fault(module: ModuleType) -> str | None:
    """What is wrong with the tables of a module or with the shapes that its functions return; None if nothing is.

    The functions are tried in the reference state, unloaded, with the module's defaults, or 1 for what has none.
    """
    return _fault_of_tables(module) or _fault_of_functions(module)


def _fault_of_tables(module: ModuleType) -> str | None:
    for name in ("MODEL", "FORMULATION"):
        if not isinstance(getattr(module, name), str):
            return f"{name} must be text, got {shown(getattr(module, name))}"
    for table in _TABLES:
        entries = getattr(module, table)
        if not isinstance(entries, tuple | list):
            return f"{table} must be a tuple of variables, got {shown(entries)}"
        for entry in entries:
            if not all(isinstance(getattr(entry, told, None), str) for told in _TOLD):
                return f"each of {table} must have a {', '.join(_TOLD)}, all text, got {shown(entry)}"
            try:
                role_of(entry), sign_of(entry)
            except ValueError as wrong:
                return f"{table}: {wrong}"
    count, size = module.COORDINATE_COUNT, len(module.STATE)
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= size // 2:
        return f"COORDINATE_COUNT must be an integer from 1 to half the {size} of STATE, got {shown(count)}"
    defaults = getattr(module, "DEFAULTS", {})
    return None if isinstance(defaults, dict) else f"DEFAULTS must be a dict, got {shown(defaults)}"


def _fault_of_functions(module: ModuleType) -> str | None:
    states, inputs = len(module.STATE), len(module.INPUTS)
    parameters = [_number(getattr(module, "DEFAULTS", {}).get(entry.name)) for entry in module.PARAMETERS]
    try:
        start = _returned(module, "reference_state", (parameters,), (states,))
        wanted = {
            "rhs": (states,),
            "principal_stretches": (3,),
            "jacobian": (states, states),
            "input_jacobian": (states, inputs),
            "validity": (),
        }
        for name, shape in wanted.items():
            if hasattr(module, name):
                _returned(module, name, (start, (0.0,) * inputs, parameters), shape)
    except _Fault as wrong:
        return str(wrong)
    except ArithmeticError:  # of the numbers, and not of the shapes
        pass
    return None


class _Fault(Exception):
    """A function that is not as it must be."""


def _number(value: object) -> float:
    """The value where it is a number; what is none is refused where it is used."""
    return float(value) if isinstance(value, int | float) else 1.0


def _returned(module: ModuleType, name: str, arguments: tuple, shape: tuple[int, ...]) -> np.ndarray:
    try:
        with np.errstate(all="ignore"):
            returned = np.asarray(getattr(module, name)(*arguments), dtype=float)
    except ArithmeticError:
        raise
    except Exception as error:  # whatever a user's function may do
        text = " ".join(str(error).split())[:_LONGEST]
        raise _Fault(f"{name} raises {type(error).__name__}: {text}") from error
    if returned.shape != shape:
        raise _Fault(f"{name} returns an array of shape {returned.shape}, needed is {shape}")
    return returned
