"""The state in which a membrane rests under constant loads: one number for each state variable."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

import numpy as np

from delagrange.common import checks
from delagrange.common.units import with_unit
from delagrange.drives.inputs import Inputs, constant_inputs, input_name
from delagrange.equilibrium.branches import acting_forces, at_zero_field, connected_pieces, stable_until
from delagrange.equilibrium.continuation import Lost, parameter_of
from delagrange.equilibrium.pieces import FOLD, Piece, point_at, trace
from delagrange.equilibrium.seeds import same
from delagrange.equilibrium.statics import (
    ENDLESS_CHARGE,
    Statics,
    input_place,
    is_endless,
    make_statics,
    unloaded,
)
from delagrange.equilibrium.vibration import growing_directions
from delagrange.model.parameters import Parameters
from delagrange.problem.dashpots import RELAXED
from delagrange.problem.problem import Problem, make_specimen
from delagrange.problem.status import Limits, checked_limits


def rest_state(
    model: str | ModuleType,
    *,
    force: float = 0.0,
    inputs: Inputs | None = None,
    field: float = 0.0,
    held_stretch: float | None = None,
    dashpots: str = RELAXED,
    formulation: str | None = None,
    lateral_dashpot: str | None = None,
    parameters: Parameters | None = None,
    limits: Limits | None = None,
    **material: float,
) -> dict[str, float]:
    """The state at the stable equilibrium that the unloaded membrane reaches under forces, then field or charge.

    It can be given to a run as its `initial_state`, which there may also be "equilibrium": that is this state under
    the forces of the run, without field.

    Args:
        force: on each loaded edge [N].
        inputs: single numbers of any input by its name, as {"force_2": 0.3} or, under charge control,
            {"nominal_charge_density": 1e-4} [C/m^2]. Under a current [A/m^2] the charge rests where as much leaks.
        field: constant nominal field [V/m].
        dashpots: "relaxed", at rest as well; or "frozen" in the reference state.
        model, held_stretch, formulation, lateral_dashpot, parameters, limits, material: as in `modes`.

    Returns:
        Every state variable by its name, in its unit and in the order of `model.STATE`; the rates are 0.

    Raises:
        ValueError: something given makes no sense, or there is no such equilibrium; the message names the load, and up
            to which there is one.
    """
    specimen = make_specimen(model, formulation, lateral_dashpot, parameters)
    given = constant_inputs(specimen.model, inputs, "a state of rest")
    loads = _number("force", force, "N"), _number("field", field, "V/m")
    problem = specimen.single_problem(material, held_stretch, *loads, given)
    state = resting_state(problem, dashpots, checked_limits(limits))
    return {entry.name: float(value) for entry, value in zip(specimen.model.STATE, state)}


def resting_state(problem: Problem, dashpots: str, limits: Limits) -> np.ndarray:
    """The state of rest, (n_state,), of a problem whose drives are constant single numbers.

    Raises:
        ValueError: there is no stable equilibrium under its loads.
    """
    statics = make_statics(problem, dashpots, None, limits)
    value = float(problem.inputs(0.0)[statics.varied])
    if is_endless(statics, value):
        raise ValueError(f"{_nowhere(problem)}: {ENDLESS_CHARGE}")
    try:
        x = _equilibrium(statics, abs(value))
        grows = growing_directions(statics, x)
    except Lost as reason:
        raise ValueError(f"{_nowhere(problem)}: {_farthest(statics) or reason}") from None
    if grows > 0:
        raise ValueError(
            f"{_nowhere(problem)}: the equilibrium is unstable{_stable_up_to(statics, abs(value))}"
        )
    return statics.signed_state(x, value)


def _equilibrium(statics: Statics, value: float) -> np.ndarray:
    """x at a value of the electrical input, which is not negative.

    Raises:
        Lost: there is none.
    """
    if value == 0.0:
        return at_zero_field(statics)
    piece = connected_pieces(statics, value)[0]
    if not piece.covers(value):
        raise Lost(_up_to(statics, statics.electrical.name, piece, value))
    return point_at(statics, piece, value).x


def _stable_up_to(statics: Statics, value: float) -> str:
    """`; it is stable up to ...`, where the electrical input is what makes it unstable."""
    if value == 0.0:
        return ""
    point = stable_until(statics, connected_pieces(statics, value)[0])
    if point is None or parameter_of(point) == 0.0:
        return ""
    return f"; it is stable up to {_text(statics.electrical.name, parameter_of(point), statics)}"


def _farthest(statics: Statics) -> str:
    """`there is one up to ...`, the force that is too large; nothing where none is."""
    try:
        for name, value, piece in _grown_forces(statics):
            if not piece.covers(value):
                return _up_to(statics, name, piece, value)
    except Lost:
        pass
    return ""


def _up_to(statics: Statics, name: str, piece: Piece, value: float) -> str:
    """`there is one up to force = 9 N, ...` and why it ends there: the end of a piece on the way to a value."""
    most, end = (piece.high, piece.upper_end) if value > 0 else (piece.low, piece.lower_end)
    why = "the limit point" if end == FOLD else f"where it ends ({end})"
    return f"there is one up to {_text(name, most, statics)}, {why}"


def _grown_forces(statics: Statics) -> Iterator[tuple[str, float, Piece]]:
    """Every force that acts, in the model's order, with the piece of its curve on which it grows from zero.

    Raises:
        Lost: it does not grow from zero.
    """
    x, growing = unloaded(statics), acting_forces(statics)
    grown = {statics.electrical.name: 0.0} | dict.fromkeys(growing, 0.0)
    for name, value in growing.items():
        along, x = statics.varying(name, **grown), np.append(x[:-1], 0.0)
        piece = _through(along, x, trace(along, x, min(value, 0.0), max(value, 0.0)))
        yield name, value, piece
        x, grown[name] = point_at(along, piece, value).x, value


def _through(statics: Statics, x: np.ndarray, pieces: list[Piece]) -> Piece:
    for piece in pieces:
        if piece.covers(0.0) and same(point_at(statics, piece, 0.0).x, x):
            return piece
    raise Lost("no curve of equilibria begins without load")


def _nowhere(problem: Problem) -> str:
    """`uniaxial has no stable equilibrium under force = 9 N and field = 0 V/m`."""
    entries = zip(problem.model.INPUTS, problem.inputs(0.0))
    loads = [f"{input_name(entry.name)} = {with_unit(float(value), entry.unit)}" for entry, value in entries]
    return f"{problem.model.MODEL} has no stable equilibrium under {' and '.join(loads)}"


def _text(name: str, value: float, statics: Statics) -> str:
    unit = statics.problem.model.INPUTS[input_place(statics.problem, name)].unit
    return f"{input_name(name)} = {value:.7g} {unit}"


def _number(name: str, value: object, unit: str) -> float:
    return checks.scalar(name, checks.finite(name, value, unit), unit)
