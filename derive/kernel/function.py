"""One function of a module: symbols by their names in code, and what is shared computed once."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.kernel.powers import share_powers
from delagrange.derive.kernel.shared import share_subexpressions
from delagrange.derive.kernel.spec import Assignment, KernelFunction
from delagrange.derive.notation.symbols import Quantity

_VOLUME = sp.Symbol("volume", positive=True)


def named(expression: sp.Expr, quantities: tuple[Quantity, ...]) -> sp.Expr:
    """Replace the symbols of the algebra by the names that code uses."""
    names = {quantity.symbol: sp.Symbol(quantity.name) for quantity in quantities}
    return expression.xreplace(names)


def _in_volume(expression: sp.Expr, volume: sp.Expr) -> sp.Expr:
    """Write a product of the volume of the body as that: 8 H L^2 mu becomes volume * mu."""
    quotient = expression / volume
    lengths = [f for f in sp.Mul.make_args(quotient) if f.as_base_exp()[0] in volume.free_symbols]
    whole = expression.is_Mul and all(length.as_base_exp()[1].is_positive for length in lengths)
    return quotient * _VOLUME if whole else expression


def _pairs(pairs: tuple[tuple[str, sp.Expr], ...], comment: str) -> tuple[Assignment, ...]:
    return tuple(
        Assignment(name, expression, comment if number == 0 else "", helper=True)
        for number, (name, expression) in enumerate(pairs)
    )


def _volume_assignment(expressions: Iterable[sp.Expr], eom: EquationsOfMotion) -> tuple[Assignment, ...]:
    used = any(_VOLUME in expression.free_symbols for expression in expressions)
    volume = named(eom.membrane.volume, eom.quantities)
    return (Assignment("volume", volume, "volume of the membrane [m^3]", True),) if used else ()


def kernel_function(
    eom: EquationsOfMotion,
    name: str,
    summary: str,
    unit: str,
    shape: tuple[int, ...],
    assignments: Iterable[Assignment],
    outputs: Iterable[sp.Expr],
    *,
    accelerations: tuple[str, ...] = (),
) -> KernelFunction:
    """Name symbols, the volume, and the powers of moving quantities, in the order of their use."""
    assignments = tuple(assignments)
    raw = (*(a.expression for a in assignments), *(sp.sympify(output) for output in outputs))
    in_code = tuple(named(_in_volume(expression, eom.membrane.volume), eom.quantities) for expression in raw)
    powers, in_powers = share_powers(in_code, frozenset(quantity.name for quantity in eom.state))
    constants = frozenset((_VOLUME.name, *(parameter.name for parameter in eom.parameters)))
    common, expressions = share_subexpressions(in_powers, constants, frozenset(a.name for a in assignments))
    shared = _pairs(powers, "powers of the state") + _pairs(common, "shared by what follows")
    rewritten = tuple(
        Assignment(a.name, expression, a.comment)
        for a, expression in zip(assignments, expressions, strict=False)
    )
    return KernelFunction(
        name, summary, unit, shape,
        (*_volume_assignment(in_powers, eom), *shared, *rewritten),
        expressions[len(assignments):], accelerations,
    )  # fmt: skip
