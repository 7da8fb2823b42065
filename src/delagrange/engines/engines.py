"""The engines that integrate lanes, what each of them can do, and which one "auto" stands for."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType

from delagrange.common import checks
from delagrange.core.kernel import NoCompiler, load_core
from delagrange.drives.drive import Drive
from delagrange.engines.compiled import integrate_compiled
from delagrange.engines.core_engine import integrate_by_core
from delagrange.engines.extrema import EXTREMA
from delagrange.engines.kernel_drives import is_known
from delagrange.engines.lanes import Outcome
from delagrange.engines.numpy_engine import integrate_lanes
from delagrange.engines.scipy_engine import integrate_one_by_one
from delagrange.engines.step_control import STEP_CONTROLS
from delagrange.model.kernels import kernel_name, load_kernel, why_not_compiled

AUTO = "auto"
METHODS = ("DOP853", "RK45")


@dataclass(frozen=True)
class Engine:
    """A way to integrate lanes, how many of them it should be given at a time, and what it can do."""

    integrate: Callable[..., Outcome]  # (problem, initial_state, settings, sampling=None, report=None)
    chunk: int  # for "numpy" long enough to spread the cost of a call, short enough for the cache
    methods: tuple[str, ...]
    step_controls: tuple[str, ...]  # the first is the engine's own
    extrema: tuple[str, ...]


ENGINES: Mapping[str, Engine] = {
    "compiled": Engine(integrate_compiled, 1 << 16, ("DOP853",), ("pi",), ("dense",)),
    "core": Engine(integrate_by_core, 1 << 16, ("DOP853",), ("pi",), ("dense",)),
    "numpy": Engine(integrate_lanes, 4096, METHODS, ("scipy", "ode45"), EXTREMA),
    "scipy": Engine(integrate_one_by_one, 4096, METHODS, ("scipy",), ("dense",)),
}


@dataclass(frozen=True)
class Numerics:
    """The names of what a sweep is integrated with, each settled."""

    method: str
    engine: str
    step_control: str
    extrema: str


def resolve_numerics(
    method: str,
    engine: str,
    control: str | None,
    extrema: str,
    model: ModuleType,
    drives: Sequence[object] = (),
) -> Numerics:
    """The numerics, with the engine settled where "auto", and its own step control where None.

    Raises:
        ValueError: an unknown name, choices that do not go together, or an engine that cannot run the model.
    """
    checks.choice("method", method, METHODS)
    checks.choice("engine", engine, (AUTO, *ENGINES))
    if control is not None:
        checks.choice("step_control", control, STEP_CONTROLS)
    checks.choice("extrema", extrema, EXTREMA)
    if control == "ode45" and method != "RK45":
        raise ValueError(f"step_control 'ode45' belongs to method 'RK45', got method {method!r}")
    engine = resolve_engine(engine, method, control, extrema, model, drives)
    chosen = ENGINES[engine]
    control = chosen.step_controls[0] if control is None else control
    if not _suits(chosen, method, control, extrema):
        raise ValueError(
            f"engine {engine!r} has method {_quoted(chosen.methods)}, step_control "
            f"{_quoted(chosen.step_controls)} and extrema {_quoted(chosen.extrema)} only, "
            f"got {method!r}, {control!r}, {extrema!r}"
        )
    return Numerics(method, engine, control, extrema)


def resolve_engine(
    engine: str, method: str, control: str | None, extrema: str, model: ModuleType, drives: Sequence[object]
) -> str:
    """The name of an engine: as given, or the fastest one for "auto" that can do what is asked for.

    Warns where compiled code would do and cannot run on this machine.

    Raises:
        ValueError: a compiled engine is asked for by name and cannot run.
    """
    if engine == "core" and (obstacle := _obstacle_to_the_core(model, drives)):
        raise ValueError(f"engine 'core' cannot run this: {obstacle}; use 'numpy', or 'auto'")
    if engine not in (AUTO, "compiled"):
        return engine
    if engine == AUTO and not _suits(ENGINES["compiled"], method, control, extrema):
        return "numpy"
    obstacle = _obstacle(model, drives)
    broken = None if obstacle else _why_not_compiled(model)
    if not (obstacle or broken):
        return "compiled"
    if engine == "compiled":
        raise ValueError(f"engine 'compiled' cannot run this: {obstacle or broken}; use 'numpy', or 'auto'")
    if broken:
        warnings.warn(f"{broken}; the sweep runs on engine 'numpy', more slowly", stacklevel=4)
    return "numpy"


def _suits(chosen: Engine, method: str, control: str | None, extrema: str) -> bool:
    """Whether an engine has the numerics; its own step control where None."""
    return method in chosen.methods and control in (None, *chosen.step_controls) and extrema in chosen.extrema


def _obstacle(model: ModuleType, drives: Sequence[object]) -> str | None:
    """What of the task itself a compiled kernel cannot do."""
    if kernel_name(model) is None:
        return f"no kernel stands beside the module of the model {model.MODEL}"
    return _unknown_drive(drives)


def _unknown_drive(drives: Sequence[object]) -> str | None:
    for drive in drives:
        if isinstance(drive, Drive) and not is_known(drive):
            return f"a drive is {drive}, which is not made of lines and sines"
    return None


def _obstacle_to_the_core(model: ModuleType, drives: Sequence[object]) -> str | None:
    """Why the core in C does not run this, or not on this machine."""
    return why_no_core(model, "lanes") or _unknown_drive(drives)


def why_no_core(model: ModuleType, part: str) -> str | None:
    """Why a part of the core in C cannot be had for a model; None where it can, and it then is compiled.

    Raises:
        ValueError: the header beside the module is not that of the module.
    """
    core = load_core(model)
    if core is None:
        return f"no header stands beside the module of the model {model.MODEL}"
    try:
        core.part(part)
    except NoCompiler as error:
        return str(error)
    return None


def _why_not_compiled(model: ModuleType) -> str | None:
    """Why compiled code does not run on this machine."""
    reason = why_not_compiled()
    if reason is not None:
        return f"compiled code cannot run here ({reason})"
    try:
        load_kernel(kernel_name(model))
    except RuntimeError as error:
        return f"compiled code cannot run here ({error})"
    return None


def _quoted(names: tuple[str, ...]) -> str:
    return ", ".join(map(repr, names))
