"""Derived expressions as LaTeX that the reader of printed equations takes: for copying, and for a round trip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from delagrange.derive.printed.symbol_table import Name

_SUM, _PRODUCT, _POWER, _ATOM = range(4)  # binding strength
_FUNCTIONS = {
    sp.log: r"\ln", sp.exp: r"\exp", sp.sin: r"\sin", sp.cos: r"\cos", sp.tan: r"\tan", sp.sinh: r"\sinh",
    sp.cosh: r"\cosh", sp.tanh: r"\tanh",
}  # fmt: skip


@dataclass(frozen=True)
class LatexPrinter:
    """Prints sums, products, fractions, powers and named functions in the symbols of a model."""

    names: Mapping[sp.Symbol, Name]

    def __call__(self, expression: sp.Expr) -> str:
        return self._visit(expression)[0]

    def _visit(self, expression: sp.Expr) -> tuple[str, int]:
        match expression:
            case sp.Add():
                return self._sum(expression), _SUM
            case sp.Rational():
                return self._number(expression)
            case sp.Mul():
                return self._product(expression)
            case sp.Pow():
                return self._power(expression)
            case sp.Symbol():
                name = self.names[expression]
                return str(name), _POWER if name.label else _ATOM
        return self._function(expression)

    def _wrapped(self, expression: sp.Expr, strength: int) -> str:
        text, own = self._visit(expression)
        return text if own >= strength else rf"\left( {text} \right)"

    def _number(self, number: sp.Rational) -> tuple[str, int]:
        if number.q == 1:
            return str(number), _ATOM if number >= 0 else _SUM
        sign = "- " if number < 0 else ""
        return rf"{sign}\frac{{{abs(number.p)}}}{{{number.q}}}", _SUM if number < 0 else _PRODUCT

    def _sum(self, expression: sp.Add) -> str:
        text = " ".join(self._signed(term) for term in expression.as_ordered_terms())
        return text.removeprefix("+ ")

    def _signed(self, term: sp.Expr) -> str:
        negative = term.could_extract_minus_sign() and not isinstance(term, sp.Add)
        return f"{'-' if negative else '+'} {self._wrapped(-term if negative else term, _PRODUCT)}"

    def _product(self, expression: sp.Mul) -> tuple[str, int]:
        if expression.as_coeff_Mul()[0].is_negative:
            return f"- {self._wrapped(-expression, _PRODUCT)}", _SUM
        above, below = _split(expression)
        if not below:
            return self._factors(above), _PRODUCT
        return rf"\frac{{{self._factors(above)}}}{{{self._factors(below)}}}", _PRODUCT

    def _factors(self, factors: list[sp.Expr]) -> str:
        """Factors side by side; a number behind another factor needs its sign of multiplication."""
        if len(factors) < 2:
            return self(factors[0]) if factors else "1"
        first, *others = (self._wrapped(factor, _POWER) for factor in factors)
        return " ".join((first, *(rf"\times {text}" if text[0].isdigit() else text for text in others)))

    def _power(self, expression: sp.Pow) -> tuple[str, int]:
        base, exponent = expression.args
        if exponent == sp.Rational(1, 2):
            return rf"\sqrt{{{self(base)}}}", _ATOM
        if exponent.is_number and exponent.is_negative:
            return rf"\frac{{1}}{{{self(base**-exponent)}}}", _PRODUCT
        return f"{self._wrapped(base, _ATOM)}^{{{self(exponent)}}}", _POWER

    def _function(self, expression: sp.Expr) -> tuple[str, int]:
        for function, name in _FUNCTIONS.items():
            if isinstance(expression, function):
                return rf"{name}\left( {self(expression.args[0])} \right)", _POWER
        raise TypeError(f"no way to print {type(expression).__name__} as LaTeX: {expression}")


def _split(product: sp.Mul) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Factors above and below the line, in SymPy's printing order."""
    above: list[sp.Expr] = []
    below: list[sp.Expr] = []
    for factor in product.as_ordered_factors():
        if isinstance(factor, sp.Rational):
            above += [sp.Integer(factor.p)] if factor.p != 1 else []
            below += [sp.Integer(factor.q)] if factor.q != 1 else []
        elif isinstance(factor, sp.Pow) and factor.exp.could_extract_minus_sign():
            below.append(1 / factor)
        else:
            above.append(factor)
    return above, below
