"""A printed tree back to LaTeX, in one notation; what the reader makes of it has the same value."""

from __future__ import annotations

from fractions import Fraction
from types import MappingProxyType

from delagrange.derive.printed.tree import (
    Equation,
    Function,
    Group,
    Node,
    Number,
    Part,
    Power,
    Product,
    Quotient,
    Sum,
    Term,
    Variable,
)

_CLOSING = MappingProxyType({"(": ")", "[": "]", r"\{": r"\}"})


def to_latex(part: Part) -> str:
    """LaTeX of an equation, a term (with its sign) or any other part of a printed tree."""
    match part:
        case Number(value):
            return _number(value)
        case Variable():
            return _variable(part)
        case Power(base, exponent):
            return f"{_base(base)}^{{{to_latex(exponent)}}}"
        case Quotient(numerator, denominator):
            return rf"\frac{{{to_latex(numerator)}}}{{{to_latex(denominator)}}}"
        case Group(bracket, inner):
            return rf"\left{bracket} {to_latex(inner)} \right{_CLOSING[bracket]}"
        case Function("sqrt", argument):
            return rf"\sqrt{{{to_latex(argument)}}}"
        case Function(name, argument):
            return rf"\{name}{to_latex(_bracketed(argument))}"
        case Product(factors):
            return " ".join((to_latex(factors[0]), *(_further_factor(factor) for factor in factors[1:])))
        case Term(sign, node):
            return f"{'-' if sign < 0 else '+'} {to_latex(node)}"
        case Sum(terms):
            return " ".join(to_latex(term) for term in terms).removeprefix("+ ")
        case Equation():
            return f"{to_latex(part.lhs)} = {to_latex(part.rhs)}"
    raise TypeError(f"{type(part).__name__} is not a part of a printed tree")


def _number(value: Fraction) -> str:
    if value.denominator == 1:
        return str(value.numerator)
    sign = "-" if value < 0 else ""
    return rf"{sign}\frac{{{abs(value.numerator)}}}{{{value.denominator}}}"


def _variable(variable: Variable) -> str:
    if not variable.differential:
        return str(variable.name)
    name, order = variable.name, variable.name.dots
    power = "^{2}" if order == 2 else ""
    plain = str(type(name)(name.letter, name.subscript, name.label))
    return rf"\frac{{\mathrm{{d}}{power} {plain}}}{{\mathrm{{d}}t{power}}}"


def _further_factor(factor: Node) -> str:
    """A number behind another factor needs its operator."""
    first = factor.base if isinstance(factor, Power) else factor
    return rf"\times {to_latex(factor)}" if isinstance(first, Number) else to_latex(factor)


def _base(base: Node) -> str:
    match base:
        case Group() | Function("sqrt"):
            return to_latex(base)
        case Variable(name=name, differential=False) if not name.label:
            return to_latex(base)
        case Number(value) if value >= 0 and value.denominator == 1:
            return to_latex(base)
    return to_latex(_bracketed(base))


def _bracketed(node: Node) -> Group:
    return node if isinstance(node, Group) else Group("(", node, node.span)
