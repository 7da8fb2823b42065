"""The generated models by name, and what a module must offer to be run as one.

A model is the generated module itself: data (`STATE`, `INPUTS`, `PARAMETERS`, ...) and functions
(`rhs`, `jacobian`, energies, ...) of state, inputs and parameters. Nothing wraps it, so a module
that someone copied or wrote by hand runs just as well, as far as it offers what a run asks of it:
`jacobian` for an implicit method, `kinetic_energy` and the like for energies.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from types import ModuleType

from delagrange import checks
from delagrange.units import shown

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
    or "free") choose among the models of pure shear. With a full name they may be left out or say what that
    model is. A module with the interface is returned as it is.

    Raises:
        ValueError: no such model, formulation or choice of lateral dashpot, or one that the named model is
            not; the message lists what there is.
    """
    formulation = formulation if formulation is None else str(formulation).replace("-", "_")
    if isinstance(model, ModuleType):
        return _confirmed(_checked(model), formulation, lateral_dashpot)
    name = str(model).replace("-", "_")
    if name in _MODULES.values():
        return _confirmed(_import(name), formulation, lateral_dashpot)
    choices = [key for key in _MODULES if key[0] == name]
    if choices:
        return _import(_pick(name, choices, formulation, lateral_dashpot))
    known = tuple(dict.fromkeys([*(key[0] for key in _MODULES), *model_names()]))
    near = checks.did_you_mean(name, known)
    raise ValueError(f"unknown model {shown(model)}{near}; known are {', '.join(known)}")


def _pick(name: str, choices: list[tuple], formulation: str | None, lateral_dashpot: str | None) -> str:
    formulation = _DEFAULTS["formulation"] if formulation is None else formulation
    lateral_dashpot = _DEFAULTS["lateral_dashpot"] if lateral_dashpot is None else lateral_dashpot
    checks.choice(f"formulation of {name}", formulation, dict.fromkeys(key[1] for key in choices))
    dashpots = dict.fromkeys(key[2] for key in choices if key[1] == formulation)
    checks.choice(f"lateral_dashpot of {name} {formulation}", lateral_dashpot, dashpots)
    return _MODULES[name, formulation, lateral_dashpot]


def _confirmed(module: ModuleType, formulation: str | None, lateral_dashpot: str | None) -> ModuleType:
    """The module, if it is what was asked for: its name leaves nothing to choose."""
    dashpot = next((key[2] for key, name in _MODULES.items() if name == module.MODEL), None)
    given = {"formulation": (formulation, module.FORMULATION), "lateral_dashpot": (lateral_dashpot, dashpot)}
    for what, (wanted, has) in given.items():
        if wanted is not None and (has is None or wanted != has):
            allowed = "leave it out" if has is None else f"leave it out or give {has!r}, which it is"
            raise ValueError(f"{what} {shown(wanted)}: the model {module.MODEL} leaves no choice; {allowed}")
    return module


def check_offers(module: ModuleType, names: Iterable[str], purpose: str) -> None:
    """Refuse a module that lacks a function which the `purpose` of a run needs.

    Raises:
        ValueError: naming what is missing.
    """
    missing = [name for name in names if not hasattr(module, name)]
    if missing:
        raise ValueError(
            f"{purpose} needs {', '.join(missing)}, which the model {module.MODEL} does not offer"
        )


def _import(name: str) -> ModuleType:
    return _checked(import_module(f"delagrange.generated.{name}"))


def _checked(module: ModuleType) -> ModuleType:
    missing = [name for name in _NEEDED if not hasattr(module, name)]
    if missing:
        raise ValueError(f"module {module.__name__!r} is not a model: it lacks {', '.join(missing)}")
    return module
