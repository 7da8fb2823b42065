"""Expressions as C: for vectors of the core, every multiply-add said, or for plain doubles.

The order of terms and factors is SymPy's canonical printing order, as in `delagrange.derive.notation.printer`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from delagrange.derive.notation.printer import FUNCTIONS

_SUM, _PRODUCT, _ATOM = range(3)  # binding strength
_LONGEST_PRODUCT = 4  # the highest power of a name that is written as a product

@dataclass(frozen=True)
class Text:
    """A piece of C, how strongly it binds, and whether it is a number known when it is compiled."""

    code: str
    strength: int
    number: bool = False

    def within(self, strength: int) -> str:
        """The piece, in brackets where what stands around it binds more strongly."""
        return self.code if self.strength >= strength else f"({self.code})"


@dataclass(frozen=True)
class CPrinter:
    """Prints sums, products, powers and named functions of doubles; `name_of` names a symbol."""

    name_of: Callable[[sp.Symbol], str]
    prefix = ""  # of functions

    def __call__(self, expression: sp.Expr) -> str:
        return self.visit(expression).code

    def visit(self, expression: sp.Expr) -> Text:
        if expression.is_Symbol:
            return Text(self.name_of(expression), _ATOM)
        if expression.is_number:
            return _number(expression)
        match expression:
            case sp.Add():
                return self.sum(expression)
            case sp.Mul():
                return self.product(expression)
            case sp.exp():
                return self.function(expression)
            case sp.Pow():
                return self.power(expression)
        return self.function(expression)

    def sum(self, expression: sp.Add) -> Text:
        """Term after term."""
        code = ""
        for term in expression.as_ordered_terms():
            negative, size = _sign(term)
            text = self.visit(size).within(_PRODUCT)
            sign = "-" if negative else "+"
            code = f"{code} {sign} {text}" if code else text if sign == "+" else f"-{text}"
        return Text(code, _SUM)

    def product(self, expression: sp.Mul) -> Text:
        negative, size = _sign(expression)
        if negative:
            return Text(f"-{self.visit(size).within(_PRODUCT)}", _SUM)
        above, below = self.factors(size)
        over = " * ".join(above) or "1.0"
        if not below:
            return Text(over, _PRODUCT)
        return Text(f"{over} / {below[0] if len(below) == 1 else '(' + ' * '.join(below) + ')'}", _PRODUCT)

    def factors(self, product: sp.Expr) -> tuple[list[str], list[str]]:
        """Factors above and below the line."""
        above: list[str] = []
        below: list[str] = []
        for factor in sp.Mul(product, evaluate=False).as_ordered_factors():
            if factor.is_Pow and factor.exp.is_number and factor.exp.is_negative:
                below.append(self.visit(1 / factor).within(_ATOM))
            elif factor.is_Integer and factor == 1:
                continue
            else:
                above.append(self.visit(factor).within(_ATOM if above else _PRODUCT))
        return above, below

    def power(self, expression: sp.Pow) -> Text:
        base, exponent = expression.args
        if exponent.is_number and exponent.is_negative:
            return Text(f"1.0 / {self.visit(base**-exponent).within(_ATOM)}", _PRODUCT)
        if exponent == sp.Rational(1, 2):
            return Text(f"{self.prefix}sqrt({self(base)})", _ATOM)
        if exponent.is_Integer and base.is_Symbol and exponent <= _LONGEST_PRODUCT:
            name = self(base)
            written = (
                f"({name} * {name}) * ({name} * {name})" if exponent == 4 else " * ".join([name] * exponent)
            )
            return Text(written, _PRODUCT)
        return Text(f"{self.prefix}pow({self(base)}, {self.argument(exponent)})", _ATOM)

    def argument(self, expression: sp.Expr) -> str:
        return self(expression)

    def function(self, expression: sp.Expr) -> Text:
        name = FUNCTIONS.get(type(expression))
        if name is None:
            raise TypeError(f"no way to write {type(expression).__name__} in C: {expression}")
        return Text(f"{self.prefix}{name}({', '.join(self.argument(a) for a in expression.args)})", _ATOM)


@dataclass(frozen=True)
class VectorPrinter(CPrinter):
    """Prints for the core's vectors: what is multiplied and added goes through `madd`, which rounds once."""

    prefix = "vec_"

    def argument(self, expression: sp.Expr) -> str:
        """A vector, also where the expression is a number."""
        text = self.visit(expression)
        return f"all({text.code})" if text.number else text.code

    def sum(self, expression: sp.Add) -> Text:
        """From the first term that is no product on; a product and what is there become one operation."""
        terms = [_sign(term) for term in expression.as_ordered_terms()]
        start = next((term for term in terms if not _is_product(term[1])), terms[0])
        terms.remove(start)
        negative, size = start
        total = Text(f"-{self.visit(size).within(_PRODUCT)}", _SUM) if negative else self.visit(size)
        if size.is_number:
            total = Text(total.code, total.strength, True)
        for negative, size in terms:
            total = self._added(total, negative, size)
        return total

    def _added(self, total: Text, negative: bool, size: sp.Expr) -> Text:
        factors = self._two_factors(size)
        if factors is None:
            sign = "-" if negative else "+"
            return Text(f"{total.code} {sign} {self.visit(size).within(_PRODUCT)}", _SUM)
        one, other = factors
        rest = f"all({total.code})" if total.number else total.code
        if one.number:
            return Text(
                f"maddc({'-' if negative else ''}{one.within(_PRODUCT)}, {other.code}, {rest})", _ATOM
            )
        return Text(f"madd({'-' if negative else ''}{one.within(_PRODUCT)}, {other.code}, {rest})", _ATOM)

    def _two_factors(self, size: sp.Expr) -> tuple[Text, Text] | None:
        """A product as one of two, the second its last factor; None where it is none, or is divided."""
        if not _is_product(size):
            return None
        if size.is_Pow:
            name = self.visit(size.base)
            rest = size.base ** (size.exp - 1)
            return (self.visit(rest), name) if size.exp <= _LONGEST_PRODUCT and size.base.is_Symbol else None
        *before, last = size.as_ordered_factors()
        if any(factor.is_Pow and not _is_product(factor) for factor in (*before, last)):
            return None
        return self.visit(sp.Mul(*before)), self.visit(last)

    def function(self, expression: sp.Expr) -> Text:
        if isinstance(expression, sp.Min):
            return self._least(sorted(expression.args, key=sp.default_sort_key))
        return super().function(expression)

    def _least(self, arguments: list[sp.Expr]) -> Text:
        first, *others = arguments
        if not others:
            return self.visit(first)
        return Text(f"smaller_known({self(first)}, {self._least(others).code})", _ATOM)


def _is_product(expression: sp.Expr) -> bool:
    return bool(expression.is_Mul or (expression.is_Pow and expression.exp.is_Integer and expression.exp > 1))


def _sign(term: sp.Expr) -> tuple[bool, sp.Expr]:
    """Whether a term is negative, and its size."""
    negative = bool(not term.is_Add and term.as_coeff_Mul()[0].is_negative)
    return negative, -term if negative else term


def _number(expression: sp.Expr) -> Text:
    """A number as a constant: a ratio of whole ones as that, else rounded from many digits."""
    if expression.is_Rational:
        strength = _SUM if expression < 0 else _ATOM if expression.q == 1 else _PRODUCT
        code = f"{expression.p}.0" if expression.q == 1 else f"{expression.p}.0 / {expression.q}.0"
        return Text(code, strength, True)
    value = repr(float(expression.evalf(30)))
    return Text(value, _SUM if value.startswith("-") else _ATOM, True)
