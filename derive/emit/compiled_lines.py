"""Statements that every kind of compiled kernel holds: assignments, the constants, the extreme stretches."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import sympy as sp

from delagrange.derive.emit.code_lines import broken, unpacked
from delagrange.derive.kernel.spec import Assignment, KernelFunction
from delagrange.derive.notation.printer import NUMPY_FUNCTIONS, ExpressionPrinter
from delagrange.derive.notation.symbols import Quantity

PRINTER = ExpressionPrinter(lambda symbol: symbol.name, NUMPY_FUNCTIONS)


def assignment_lines(assignment: Assignment, indent: str) -> list[str]:
    """`name = expression`, with its comment before it."""
    comment = [f"{indent}# {assignment.comment}"] if assignment.comment else []
    return comment + broken(f"{assignment.name} = ", assignment.expression, PRINTER, indent)


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
        *(assignment_lines(volume, "    ") if uses_volume else []),
        *(line for a in constants for line in assignment_lines(a, "    ")),
        *_listed([a.name for a in constants]),
    ]


def names_in(expression: sp.Expr) -> set[str]:
    """Names of the symbols that an expression needs."""
    return {symbol.name for symbol in expression.free_symbols}


def _listed(names: Iterable[str]) -> list[str]:
    return ["    return [", *(f"        {name}," for name in names), "    ]"]


def extreme_stretches_lines(principal_stretches: KernelFunction) -> list[str]:
    """`least` of the principal stretches and `most` of those in the plane, and both returned."""
    first, second, thickness = map(PRINTER, principal_stretches.outputs)
    in_plane = (first,) if first == second else (first, second)
    return [
        f"    least = {_nested('min', (*in_plane, thickness))}",
        f"    most = {_nested('max', in_plane)}",
        "    return least, most",
    ]


def _nested(function: str, values: Sequence[str]) -> str:
    first, *others = values
    return f"{function}({first}, {_nested(function, others)})" if others else first
