"""The generated models by name, and what a module must offer to be run as one.

A model is the generated module itself: data (`STATE`, `INPUTS`, `PARAMETERS`, ...) and functions
(`rhs`, `jacobian`, energies, ...) of state, inputs and parameters. Nothing wraps it, so a module
that someone copied or wrote by hand runs just as well.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from delagrange import checks

_MODULES = {
    ("equal_biaxial", None, None): "equal_biaxial",
    ("uniaxial", None, None): "uniaxial",
    ("pure_shear", "consistent", "held"): "pure_shear_consistent",
    ("pure_shear", "consistent", "free"): "pure_shear_consistent_free",
    ("pure_shear", "as_printed", "held"): "pure_shear_as_printed",
}
_DEFAULTS = {"formulation": "consistent", "lateral_dashpot": "held"}
_NEEDED = (
    "MODEL", "FORMULATION", "COORDINATE_COUNT", "STATE", "INPUTS", "PARAMETERS",
    "rhs", "principal_stretches", "reference_state",
)  # fmt: skip


def model_names() -> tuple[str, ...]:
    """Names of all generated models."""
    return tuple(_MODULES.values())


def load_model(
    model: str | ModuleType, formulation: str | None = None, lateral_dashpot: str | None = None
) -> ModuleType:
    """The module of a model, by its load case or its full name; hyphens count as underscores.

    `formulation` ("consistent", the default, or "as_printed") and `lateral_dashpot` ("held", the default,
    or "free") choose among the models of pure shear. A module with the interface is returned as it is.

    Raises:
        ValueError: no such model, formulation or choice of lateral dashpot; the message lists what there is.
    """
    if isinstance(model, ModuleType):
        _refuse_choice(model.__name__, formulation, lateral_dashpot)
        return _checked(model)
    name = str(model).replace("-", "_")
    choices = [key for key in _MODULES if key[0] == name]
    if choices:
        return _import(_pick(name, choices, formulation, lateral_dashpot))
    if name in _MODULES.values():
        _refuse_choice(name, formulation, lateral_dashpot)
        return _import(name)
    known = tuple(dict.fromkeys([*(key[0] for key in _MODULES), *model_names()]))
    near = checks.did_you_mean(name, known)
    raise ValueError(f"unknown model {model!r}{near}; known are {', '.join(known)}")


def _pick(name: str, choices: list[tuple], formulation: str | None, lateral_dashpot: str | None) -> str:
    if choices == [(name, None, None)]:
        _refuse_choice(name, formulation, lateral_dashpot)
        return _MODULES[choices[0]]
    formulation = _normalised(formulation) or _DEFAULTS["formulation"]
    lateral_dashpot = lateral_dashpot or _DEFAULTS["lateral_dashpot"]
    checks.choice(f"formulation of {name}", formulation, dict.fromkeys(key[1] for key in choices))
    dashpots = dict.fromkeys(key[2] for key in choices if key[1] == formulation)
    checks.choice(f"lateral_dashpot of {name} {formulation}", lateral_dashpot, dashpots)
    return _MODULES[name, formulation, lateral_dashpot]


def _normalised(formulation: str | None) -> str | None:
    return formulation if formulation is None else str(formulation).replace("-", "_")


def _refuse_choice(name: str, formulation: str | None, lateral_dashpot: str | None) -> None:
    """A model without alternatives accepts `formulation="consistent"`, which it is, and nothing else."""
    if _normalised(formulation) not in (None, "consistent"):
        raise ValueError(
            f"formulation {formulation!r}: {name} comes in one formulation only; leave formulation out"
        )
    if lateral_dashpot is not None:
        raise ValueError(f"lateral_dashpot {lateral_dashpot!r}: {name} leaves no choice; leave it out")


def _import(name: str) -> ModuleType:
    return _checked(import_module(f"delagrange.generated.{name}"))


def _checked(module: ModuleType) -> ModuleType:
    missing = [name for name in _NEEDED if not hasattr(module, name)]
    if missing:
        raise ValueError(f"module {module.__name__!r} is not a model: it lacks {', '.join(missing)}")
    return module


def coordinate_names(model: ModuleType) -> tuple[str, ...]:
    """Names of the coordinates, the first `COORDINATE_COUNT` entries of the state."""
    return tuple(variable.name for variable in model.STATE[: model.COORDINATE_COUNT])
