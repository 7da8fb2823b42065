"""What the modules that Numba compiles have in common: the model, its equations placed in loops, rows of arrays.

The rest that their templates share stands in `templates/compiled.py.jinja`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from delagrange.derive.emit.python_lines import NUMPY, PYTHON_WORDS, assignment_lines, broken, unpacked
from delagrange.derive.kernel.compiled_spec import CompiledSpec
from delagrange.derive.kernel.spec import Assignment, KernelFunction
from delagrange.derive.notation.symbols import Quantity

COMPILED_WORDS = PYTHON_WORDS | {"numba", "parameters", "out", "least", "most", "CONSTANT", "INPUT"}
# Of the PI controller, exponents of squared errors. Gustafsson's, 0.7 / 8 and 0.4 / 8 of errors, reach the same
# accuracy in as many steps to a few per cent, and reject several times as many.
_CONTROL = {"safety": 0.9, "growth": 0.03, "memory": 0.015}


@dataclass(frozen=True)
class Places:
    """What the code of a kernel calls a state variable, an input and a constant, by its number among them."""

    state: Callable[[int], str]
    input: Callable[[int], str]
    constant: Callable[[int], str]


def compiled_view(spec: CompiledSpec, places: Places) -> dict[str, Any]:
    """What the templates of all compiled modules place, ready as text."""
    model, validity = spec.model, spec.validity
    return {
        **_CONTROL,
        "title": model.title,
        "name": model.name,
        "digest": model.digest,
        "sympy_version": sp.__version__,
        "operations": spec.operations,
        "state_count": len(model.state),
        "coordinate_count": model.coordinate_count,
        "input_count": len(model.inputs),
        "constant_count": len(spec.constants),
        "constants_body": "\n".join(constants_lines(model.parameters, spec.volume, spec.constants)),
        "stretches_body": "\n".join(_stretches_lines(spec, places)),
        "has_limits": validity is not None,
        "validity_body": "" if validity is None else "\n".join(_validity_lines(validity, spec, places)),
    }


def body_lines(function: KernelFunction, spec: CompiledSpec, places: Places, indent: str) -> list[str]:
    """What a function needs of state, inputs and constants, and its named values."""
    groups = (
        (places.state, spec.model.state),
        (places.input, spec.model.inputs),
        (places.constant, spec.constants),
    )
    loads = [
        f"{indent}{entry.name} = {place(number)}"
        for place, entries in groups
        for number, entry in enumerate(entries)
        if function.uses(entry.name)
    ]
    return [*loads, *(line for each in function.assignments for line in assignment_lines(each, indent))]


def _validity_lines(validity: KernelFunction, spec: CompiledSpec, places: Places) -> list[str]:
    return [*body_lines(validity, spec, places, "    "), *broken("return ", validity.outputs[0], NUMPY, "    ")]


def _stretches_lines(spec: CompiledSpec, places: Places) -> list[str]:
    """`least` of the principal stretches and `most` of those in the plane, and both returned."""
    first, second, thickness = map(NUMPY, spec.principal_stretches.outputs)
    in_plane = (first,) if first == second else (first, second)
    return [
        *body_lines(spec.principal_stretches, spec, places, "    "),
        f"    least = {_nested('min', (*in_plane, thickness))}",
        f"    most = {_nested('max', in_plane)}",
        "    return least, most",
    ]


def _nested(function: str, values: Sequence[str]) -> str:
    first, *others = values
    return f"{function}({first}, {_nested(function, others)})" if others else first


def constants_lines(
    parameters: tuple[Quantity, ...], volume: Assignment | None, constants: tuple[Assignment, ...]
) -> list[str]:
    """Body of the function that computes what does not move from the parameters."""
    values = [a.expression for a in constants]
    uses_volume = volume is not None and any(volume.name in names_in(value) for value in values)
    needed = [volume.expression, *values] if uses_volume else values
    used = {name for value in needed for name in names_in(value)}
    names = [p.name if p.name in used else "_" for p in parameters]
    return [
        *(unpacked(names, "parameters") if used else []),
        *(assignment_lines(volume) if uses_volume else []),
        *(line for a in constants for line in assignment_lines(a)),
        *_listed([a.name for a in constants]),
    ]


def names_in(expression: sp.Expr) -> set[str]:
    """Names of the symbols that an expression needs."""
    return {symbol.name for symbol in expression.free_symbols}


def _listed(names: Iterable[str]) -> list[str]:
    return ["    return [", *(f"        {name}," for name in names), "    ]"]


@dataclass(frozen=True)
class Rows:
    """Some rows of an array under one name."""

    name: str
    start: int
    count: int
    meaning: str


def placed(entries: Iterable[tuple[str, int, str]]) -> tuple[Rows, ...]:
    """Rows one after the other, from (name, count, meaning)."""
    rows, start = [], 0
    for name, count, meaning in entries:
        rows.append(Rows(name, start, count, meaning))
        start += count
    return tuple(rows)


def total(rows: tuple[Rows, ...]) -> int:
    """How many rows there are in all."""
    return rows[-1].start + rows[-1].count
