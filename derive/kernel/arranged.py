"""The same expressions arranged for speed.

What does not move is computed once a run, products are shared, and an evaluation divides once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import sympy as sp

from delagrange.derive.kernel.constants import Constants
from delagrange.derive.kernel.products import share_products
from delagrange.derive.kernel.reciprocals import denominators, share_division, without_division
from delagrange.derive.kernel.shared import share_subexpressions
from delagrange.derive.kernel.spec import Assignment, KernelFunction, KernelSpec

NUMBERED = frozenset({"constant", "factor", "product", "reciprocal", "shared", "denominator"})  # names given here


def operations_of(function: KernelFunction) -> int:
    """How many floating-point operations one evaluation of a function takes."""
    return operations((*(a.expression for a in function.assignments), *function.outputs))


def operations(expressions: Iterable[sp.Expr]) -> int:
    """Additions, products, divisions and calls; an integer power counts as its products."""
    return sum(_operations_of(expression) for expression in expressions)


def _operations_of(expression: sp.Expr) -> int:
    inner = operations(expression.args)
    match expression:
        case sp.Add():
            return inner + len(expression.args) - 1
        case sp.Mul():
            return inner + len(expression.args) - 1 - (expression.args[0] == -1)
        case sp.Pow(args=(_, sp.Integer(p=exponent))):
            return inner + max(abs(exponent) - 1, 0) + (exponent < 0)
        case sp.Atom():
            return 0
    return inner + 1


def volume_of(function: KernelFunction) -> Assignment | None:
    """The volume of the body in terms of the parameters, where a function uses it."""
    return next((a for a in function.assignments if a.name == "volume"), None)


def constants_for(spec: KernelSpec) -> Constants:
    """Nothing folded yet; parameters, and the volume as `rhs` knows it, are what does not move."""
    rhs = next(function for function in spec.functions if function.name == "rhs")
    return Constants(frozenset(sp.Symbol(p.name) for p in spec.parameters) | _symbols_named("volume", rhs))


def _symbols_named(name: str, function: KernelFunction) -> frozenset[sp.Symbol]:
    """The symbol of that name as the function's expressions know it, with its assumptions."""
    free = (a.expression.free_symbols for a in function.assignments)
    return frozenset(symbol for symbols in free for symbol in symbols if symbol.name == name)


def arranged(function: KernelFunction, spec: KernelSpec, constants: Constants) -> KernelFunction:
    """The function with one division, shared products and named constants, which are added to `constants`."""
    kept, outputs = without_helpers(function)
    kept, outputs, below = _simple_denominators(kept, outputs)
    below, kept, outputs = _mapped(constants.fold, below, _used(kept, outputs), outputs)
    bases = denominators(_expressions((kept, outputs)))
    kept, outputs = _mapped(without_division, kept, outputs)
    common, (kept, outputs) = _common_sums(constants, kept, outputs)
    pairs, expressions = share_products(tuple(_expressions((below, common, kept, outputs))))
    below, common, kept, outputs = _refilled((below, common, kept, outputs), expressions)
    given = frozenset(entry.name for entry in (*spec.state, *spec.inputs)) | _names(constants)
    early, late = _split(pairs, given)
    division = _helpers(share_division(bases), "one division for all denominators")
    assignments = (
        *_helpers(early, "products"),
        *below,
        *division,
        *_helpers(late, "products of what that gave"),
        *common,
        *kept,
    )
    ordered = _used(_in_order(assignments, given), outputs)
    return KernelFunction(function.name, function.summary, function.unit, function.shape, ordered, outputs)


def without_helpers(function: KernelFunction) -> tuple[tuple[Assignment, ...], tuple[sp.Expr, ...]]:
    """The assignments that mean something, with every helper but the volume written out."""
    written_out: dict[sp.Expr, sp.Expr] = {}
    kept = []
    for assignment in function.assignments:
        expression = assignment.expression.xreplace(written_out)
        if not assignment.helper:
            kept.append(_changed(assignment, expression))
        elif assignment.name != "volume":
            written_out[sp.Symbol(assignment.name)] = expression
    return tuple(kept), tuple(output.xreplace(written_out) for output in function.outputs)


def _simple_denominators(
    kept: tuple[Assignment, ...], outputs: tuple[sp.Expr, ...]
) -> tuple[tuple[Assignment, ...], tuple[sp.Expr, ...], tuple[Assignment, ...]]:
    """Write every denominator that is not a variable as a polynomial over a product of powers.

    Returns:
        The assignments and outputs with those denominators by name, and what the names stand for.
    """
    definitions = {sp.Symbol(a.name): a.expression for a in kept}
    compound = [
        base
        for base in denominators((*(a.expression for a in kept), *outputs))
        if base in definitions or not base.is_Symbol
    ]
    replaced: dict[sp.Expr, sp.Expr] = {}
    below: dict[sp.Expr, Assignment] = {}  # by numerator: forms of one denominator share it
    for base in compound:
        above, under = _fraction(_written_out(base, definitions))
        sign = -1 if -above in below else 1
        own = base.name if base.is_Symbol else f"denominator_{len(below) + 1}"
        named = Assignment(f"{own}_numerator", above, "" if below else "denominators, cleared of fractions")
        name = below.setdefault(sign * above, named).name
        replaced[base] = sign * under / sp.Symbol(name)
    kept, outputs = _mapped(lambda expression: _without_compound(expression, replaced), kept, outputs)
    return kept, outputs, tuple(below.values())


def _without_compound(expression: sp.Expr, reciprocals: Mapping[sp.Expr, sp.Expr]) -> sp.Expr:
    """The expression with every negative integer power of a denominator as a power of its reciprocal."""
    powers = {
        power: reciprocals[power.base] ** -power.exp
        for power in expression.atoms(sp.Pow)
        if power.base in reciprocals and power.exp.is_Integer and power.exp.is_negative
    }
    return expression.xreplace(powers)


def _written_out(expression: sp.Expr, definitions: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    while expression.free_symbols & set(definitions):
        expression = expression.xreplace(definitions)
    return expression


def _fraction(expression: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Numerator, with all constants in it, and denominator, a product of powers."""
    above, below = sp.fraction(sp.cancel(expression))
    number, below = below.as_coeff_Mul()
    return sp.expand(above / number), below


def _changed(assignment: Assignment, expression: sp.Expr) -> Assignment:
    return Assignment(assignment.name, expression, assignment.comment, assignment.helper)


Group = tuple[Assignment, ...] | tuple[sp.Expr, ...]


def _expressions(groups: Iterable[Group]) -> list[sp.Expr]:
    return [item.expression if isinstance(item, Assignment) else item for group in groups for item in group]


def _refilled(groups: tuple[Group, ...], expressions: Iterable[sp.Expr]) -> tuple[Group, ...]:
    """The groups with their expressions replaced, in order."""
    given = iter(expressions)
    return tuple(
        tuple(_changed(item, next(given)) if isinstance(item, Assignment) else next(given) for item in group)
        for group in groups
    )


def _mapped(change: Callable[[sp.Expr], sp.Expr], *groups: Group) -> tuple[Group, ...]:
    return _refilled(groups, [change(expression) for expression in _expressions(groups)])


def _names(constants: Constants) -> frozenset[str]:
    return frozenset(name.name for name in constants.values.values())


def _common_sums(constants: Constants, *groups: Group) -> tuple[tuple[Assignment, ...], tuple[Group, ...]]:
    later = frozenset(item.name for group in groups for item in group if isinstance(item, Assignment))
    pairs, expressions = share_subexpressions(
        tuple(_expressions(groups)), _names(constants), later, worth=1, sums_only=True
    )
    return _helpers(pairs, "shared by what follows"), _refilled(groups, expressions)


Pairs = tuple[tuple[str, sp.Expr], ...]


def _split(pairs: Pairs, given: frozenset[str]) -> tuple[Pairs, Pairs]:
    """The pairs that need nothing but what is given, and the others."""
    known, early, late = set(given), [], []
    for name, product in pairs:
        if {symbol.name for symbol in product.free_symbols} <= known:
            known.add(name)
            early.append((name, product))
        else:
            late.append((name, product))
    return tuple(early), tuple(late)


def _in_order(assignments: tuple[Assignment, ...], given: frozenset[str]) -> tuple[Assignment, ...]:
    """The assignments with each after what it needs, else in the order they have."""
    known, waiting, ordered = set(given), list(assignments), []
    while waiting:
        ready = next(a for a in waiting if {symbol.name for symbol in a.expression.free_symbols} <= known)
        waiting.remove(ready)
        known.add(ready.name)
        ordered.append(ready)
    return tuple(ordered)


def _helpers(pairs: Iterable[tuple[str, sp.Expr]], comment: str) -> tuple[Assignment, ...]:
    return tuple(
        Assignment(name, expression, "" if number else comment, helper=True)
        for number, (name, expression) in enumerate(pairs)
    )


def _used(assignments: tuple[Assignment, ...], outputs: tuple[sp.Expr, ...]) -> tuple[Assignment, ...]:
    """The assignments that something needs."""
    needed = {symbol.name for output in outputs for symbol in output.free_symbols}
    used = []
    for assignment in reversed(assignments):
        if assignment.name in needed:
            used.append(assignment)
            needed |= {symbol.name for symbol in assignment.expression.free_symbols}
    return tuple(reversed(used))
