"""The engines that integrate lanes, what each of them can do, and which one "auto" stands for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from delagrange import checks
from delagrange.ensemble import integrate_lanes
from delagrange.extrema import EXTREMA
from delagrange.lanes import Outcome
from delagrange.oracle import integrate_one_by_one
from delagrange.step_control import STEP_CONTROLS

AUTO = "auto"
METHODS = ("DOP853", "RK45")


@dataclass(frozen=True)
class Engine:
    """A way to integrate lanes, how many of them it should be given at a time, and what it can do."""

    integrate: Callable[..., Outcome]  # (problem, initial_state, settings, sampling=None, report=None)
    chunk: int  # for "numpy" long enough to spread the cost of a call, short enough for the cache
    step_controls: tuple[str, ...] = STEP_CONTROLS  # the first is the engine's own
    extrema: tuple[str, ...] = EXTREMA


ENGINES: Mapping[str, Engine] = {
    "numpy": Engine(integrate_lanes, 4096),
    "scipy": Engine(integrate_one_by_one, 4096, step_controls=("scipy",), extrema=("dense",)),
}


@dataclass(frozen=True)
class Numerics:
    """The names of what a sweep is integrated with, each settled."""

    method: str
    engine: str
    step_control: str
    extrema: str


def resolve_numerics(method: str, engine: str, control: str | None, extrema: str) -> Numerics:
    """The numerics, with the engine settled where "auto", and its own step control where None.

    Raises:
        ValueError: an unknown name, or choices that do not go together.
    """
    checks.choice("method", method, METHODS)
    checks.choice("engine", engine, (AUTO, *ENGINES))
    if control is not None:
        checks.choice("step_control", control, STEP_CONTROLS)
    checks.choice("extrema", extrema, EXTREMA)
    if control == "ode45" and method != "RK45":
        raise ValueError(f"step_control 'ode45' belongs to method 'RK45', got method {method!r}")
    engine = resolve_engine(engine, method, control, extrema)
    able = ENGINES[engine]
    control = able.step_controls[0] if control is None else control
    if control not in able.step_controls or extrema not in able.extrema:
        raise ValueError(
            f"engine {engine!r} has step_control {_quoted(able.step_controls)} and extrema "
            f"{_quoted(able.extrema)} only, got {control!r}, {extrema!r}"
        )
    return Numerics(method, engine, control, extrema)


def resolve_engine(engine: str, method: str, control: str | None, extrema: str) -> str:
    """The name of an engine: as given, or the one that "auto" stands for with these numerics."""
    return "numpy" if engine == AUTO else engine


def _quoted(names: tuple[str, ...]) -> str:
    return ", ".join(map(repr, names))
