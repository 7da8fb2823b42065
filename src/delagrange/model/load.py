"""The generated models by name, and what a module must offer to be run as one.

A model is the generated module itself: data (`STATE`, `INPUTS`, `PARAMETERS`, ...) and functions
(`rhs`, `jacobian`, energies, ...) of state, inputs and parameters. Nothing wraps it, so a module
that someone copied or wrote by hand runs just as well, as far as it offers what a run asks of it:
`jacobian` for an implicit method, `kinetic_energy` and the like for energies. Where its variables do not say
what they are and which signs they may have, `delagrange.model.variables` has the rule.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType

from delagrange.common import checks
from delagrange.common.units import shown
from delagrange.model import user_files
from delagrange.model.kernels import LANES, VARIATIONAL
from delagrange.model.shapes import fault

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


def load(path: str | os.PathLike[str]) -> ModuleType:
    """The model in a file of yours, or in a folder that holds exactly one.

    The file is Python, as `delagrange derive` writes it or by hand: it is run as by any import, so load only what
    you trust. Its compiled kernels `<name>_lanes.py` and `<name>_variational.py` are found beside it, and what is
    compiled is kept there or, where nothing can be written, in Numba's folder for the user. A file that has
    changed is loaded anew.

    Raises:
        ValueError: no such file or folder, no model or more than one in the folder, a file that is not a model or
            does not fit itself, or a kernel beside it that is of other equations.
    """
    given = Path(path)
    file = _only_model(given) if given.is_dir() else given
    if not file.is_file():
        raise ValueError(f"model {file}: no such file or folder")
    if file.suffix != ".py" or "." in file.stem:
        raise ValueError(f"model {file} must be a Python file whose name has no dot but that of .py")
    _refuse_without(file, user_files.missing_names(file, _NEEDED))  # and run nothing of it
    module = user_files.import_model(file, (LANES, VARIATIONAL))
    _refuse_without(file, _missing(module))
    if wrong := fault(module):
        raise ValueError(f"{file} is not a model: {wrong}")
    return module


def _refuse_without(file: Path, missing: Sequence[str]) -> None:
    if missing:
        raise ValueError(f"{file} is not a model: it lacks {', '.join(missing)}{_kernel_hint(file)}")


def _only_model(folder: Path) -> Path:
    """The one file in a folder that defines what a model has; none of them is run."""
    files = sorted(folder.glob("*.py"))
    found = [file for file in files if not user_files.missing_names(file, _NEEDED)]
    if len(found) == 1:
        return found[0]
    held = f"{len(found)} models, {', '.join(file.name for file in found)}" if found else "no model"
    raise ValueError(f"folder {folder} holds {held}; {'give one of the files' if found else 'needed is one'}")


def _kernel_hint(file: Path) -> str:
    """For one who gives a kernel, the file that is the model."""
    for kind in (LANES, VARIATIONAL):
        if file.stem.endswith(f"_{kind}"):
            return (
                f"; the model of this kernel is {file.with_name(file.stem.removesuffix(f'_{kind}') + '.py')}"
            )
    return ""


def is_path(model: object) -> bool:
    """Whether a model is given by its place on disk: a path, or text that looks like one."""
    if isinstance(model, os.PathLike):
        return True
    looks = isinstance(model, str) and (model.endswith(".py") or "/" in model or os.sep in model)
    return looks or (isinstance(model, str) and model != "" and Path(model).is_dir())


def load_model(
    model: str | os.PathLike[str] | ModuleType,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
) -> ModuleType:
    """The module of a model, by its load case or its full name; hyphens count as underscores.

    A path (or text with a slash or ending in .py, or the name of a folder) is loaded as by `load`.

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
    if is_path(model):
        return _confirmed(load(model), formulation, lateral_dashpot)
    known = tuple(dict.fromkeys([*(key[0] for key in _MODULES), *model_names()]))
    near = checks.did_you_mean(name, known)
    raise ValueError(f"unknown model {shown(model)}{near}; known are {', '.join(known)}, and paths of files")


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
    if missing := _missing(module):
        raise ValueError(f"module {module.__name__!r} is not a model: it lacks {', '.join(missing)}")
    return module


def _missing(module: ModuleType) -> list[str]:
    return [name for name in _NEEDED if not hasattr(module, name)]
