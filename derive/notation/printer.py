"""Expressions as text: one visitor, for the formulas of docstrings and for code in any language.

The order of terms and factors is SymPy's canonical printing order, so that the text does not depend
on hashes. Exact numbers stay exact (`8 / 3`), divisions are written as divisions.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from operator import attrgetter

import sympy as sp
from sympy.core.function import Application

from delagrange.derive.notation.symbols import Quantity

_KNOWN = (sp.log, sp.exp, sp.sin, sp.cos, sp.tan, sp.sinh, sp.cosh, sp.tanh)
FUNCTIONS: Mapping[type, str] = {function: function.__name__ for function in _KNOWN}  # that a law may be made of

_SUM, _PRODUCT, _POWER, _ATOM = range(4)  # binding strength


@dataclass(frozen=True)
class ExpressionPrinter:
    """Prints sums, products, powers and named functions.

    `functions` maps SymPy function classes to what they are called; `name_of` names a symbol; `times`
    stands between factors; `power` writes a base raised to a positive integer, `raised` stands between the
    base and the exponent of any other power; `root` names the square root, `least` the lesser of two and `pi`
    the number.
    """

    functions: Mapping[type, str]
    name_of: Callable[[sp.Symbol], str] = attrgetter("name")
    times: str = " * "
    power: Callable[[str, int], str] = "{}**{}".format
    raised: str = "**"
    root: str = "sqrt"
    least: str = "min"
    pi: str = "pi"

    def __call__(self, expression: sp.Expr) -> str:
        return self._visit(expression)[0]

    def unknown(self, expression: sp.Expr) -> list[sp.Expr]:
        """What it has no name for in an expression."""
        known = (sp.Min, *self.functions)
        return sorted((each for each in expression.atoms(Application) if not isinstance(each, known)), key=str)

    def terms(self, expression: sp.Expr) -> tuple[str, ...]:
        """The terms of a sum, each with its sign, in printing order; for breaking long lines."""
        return tuple(self._signed(term) for term in expression.as_ordered_terms())

    def _signed(self, term: sp.Expr) -> str:
        negative, text = self._term(term)
        return f"{'- ' if negative else '+ '}{text}"

    def _visit(self, expression: sp.Expr) -> tuple[str, int]:
        match expression:
            case sp.Add():
                return self._sum(expression), _SUM
            case sp.Rational() if expression.q != 1:
                return f"{expression.p} / {expression.q}", _PRODUCT
            case sp.Integer():
                return str(expression), _ATOM if expression >= 0 else _SUM
            case sp.Mul():
                return self._product(expression)
            case sp.Pow():
                return self._power(expression)
            case sp.Symbol():
                return self.name_of(expression), _ATOM
        return self._function(expression), _ATOM

    def _wrapped(self, expression: sp.Expr, strength: int) -> str:
        text, own = self._visit(expression)
        return text if own >= strength else f"({text})"

    def _term(self, term: sp.Expr) -> tuple[bool, str]:
        negative = term.could_extract_minus_sign() and not isinstance(term, sp.Add)
        return negative, self._wrapped(-term if negative else term, _PRODUCT)

    def _sum(self, expression: sp.Add) -> str:
        text = " ".join(self.terms(expression))
        return text[2:] if text.startswith("+ ") else "-" + text[2:]

    def _product(self, expression: sp.Mul) -> tuple[str, int]:
        if expression.could_extract_minus_sign() and expression.as_coeff_Mul()[0].is_negative:
            return f"-{self._wrapped(-expression, _PRODUCT)}", _SUM
        above, below = _fraction(expression)
        over = self.times.join(
            self._wrapped(factor, _PRODUCT if number == 0 else _POWER) for number, factor in enumerate(above)
        )
        if not below:
            return over, _PRODUCT
        under = self.times.join(self._wrapped(factor, _POWER) for factor in below)
        return f"{over or '1'} / {under if len(below) == 1 else f'({under})'}", _PRODUCT

    def _power(self, expression: sp.Pow) -> tuple[str, int]:
        base, exponent = expression.args
        if exponent.is_number and exponent.is_negative:
            return f"1 / {self._wrapped(base**-exponent, _POWER)}", _PRODUCT
        if not exponent.is_Integer:
            return self._general_power(base, exponent)
        return self.power(self._wrapped(base, _ATOM), int(exponent)), _POWER

    def _general_power(self, base: sp.Expr, exponent: sp.Expr) -> tuple[str, int]:
        if exponent == sp.Rational(1, 2):
            return f"{self.root}({self(base)})", _ATOM
        return f"{self._wrapped(base, _ATOM)}{self.raised}{self._wrapped(exponent, _ATOM)}", _POWER

    def _function(self, expression: sp.Expr) -> str:
        if isinstance(expression, sp.Min):
            return self._least(sorted(expression.args, key=sp.default_sort_key))
        if expression is sp.pi:
            return self.pi
        if expression is sp.E:
            return f"{self.functions[sp.exp]}(1)"
        for function, name in self.functions.items():
            if isinstance(expression, function):
                return f"{name}({', '.join(self(argument) for argument in expression.args)})"
        raise TypeError(f"no way to print {type(expression).__name__}: {expression}")

    def _least(self, arguments: list[sp.Expr]) -> str:
        first, *others = arguments
        return f"{self.least}({self(first)}, {self._least(others)})" if others else self(first)


def _fraction(expression: sp.Mul) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Factors above and below the line; a fractional number is split as 8 above, 3 below."""
    above: list[sp.Expr] = []
    below: list[sp.Expr] = []
    for factor in expression.as_ordered_factors():
        if factor.is_Rational and factor.q != 1:
            below.append(sp.Integer(factor.q))
            if factor.p != 1:
                above.append(sp.Integer(factor.p))
        elif factor.is_Pow and factor.exp.is_number and factor.exp.is_negative:
            below.append(1 / factor)
        else:
            above.append(factor)
    return above, below


_SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def _raised(base: str, exponent: int) -> str:
    return base + str(exponent).translate(_SUPERSCRIPTS)


def text_printer(quantities: tuple[Quantity, ...]) -> ExpressionPrinter:
    """Formulas for people, in the notation of the quantities: 8 H L² μ^α / 3."""
    notation = {quantity.symbol: quantity.text for quantity in quantities}
    return ExpressionPrinter(
        {**FUNCTIONS, sp.log: "ln"},
        notation.__getitem__,
        times=" ",
        power=_raised,
        raised="^",
        root="√",
        pi="π",
    )
