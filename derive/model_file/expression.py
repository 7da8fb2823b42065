"""A user's formula as an exact SymPy expression, read by a grammar of its own and by nothing else.

    sum     = product { ("+" | "-") product }
    product = signed { ("*" | "/") signed }
    signed  = { "+" | "-" } power
    power   = atom [ ("^" | "**") signed ]
    atom    = number | name | function "(" sum ")" | "(" sum ")"

It binds as in Python: -x^2 is -(x^2), a^b^c is a^(b^c). Numbers are exact rationals. No text of a user is
ever evaluated or given to a parser of SymPy's: a formula can name what it is given, and call the functions
of `FUNCTIONS`. Bounds on length, depth, numbers and exponents keep each formula cheap.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction
from types import MappingProxyType

import sympy as sp

from delagrange.derive.model_file.expression_tokens import ExpressionError, Token, shown, tokenize

FUNCTIONS: Mapping[str, type[sp.Function]] = MappingProxyType(
    {
        "exp": sp.exp, "log": sp.log, "sqrt": sp.sqrt, "sinh": sp.sinh, "cosh": sp.cosh, "tanh": sp.tanh,
        "sin": sp.sin, "cos": sp.cos,
    }
)  # fmt: skip
_DEEPEST = 40  # parentheses, functions and exponents within each other
_LARGEST_EXPONENT = 64
_FINEST_EXPONENT = 10**9  # largest denominator of an exponent
_MOST_BITS = 1024  # of the numerator or the denominator of an exact number
_LARGEST_ARGUMENT = 200  # of a function of a number alone: exp(200) is 7e86
_POWER_MARKS = ("^", "**")


def read_expression(text: str, names: Mapping[str, sp.Expr]) -> sp.Expr:
    """The expression that a formula writes.

    Args:
        text: the formula.
        names: what each name in it stands for; they must not be names of `FUNCTIONS`.

    Raises:
        ExpressionError: the text is no formula of the grammar, has a name that is not given (the nearest one
            is said), a value that is not a finite real number, or goes beyond a bound; line, column, what
            stands there and what is allowed.
    """
    reader = _Reader(text, tokenize(text), names)
    expression, end = reader.sum(0, 0)
    if reader.tokens[end].kind != "end":
        raise reader.unexpected(end, "an operator or the end")
    return expression


@dataclass(frozen=True)
class _Reader:
    """Recursive descent. Each rule takes the index of its first token and the depth, and returns what it
    has read and the index after it."""

    text: str
    tokens: tuple[Token, ...]
    names: Mapping[str, sp.Expr]

    def unexpected(self, at: int, expected: str) -> ExpressionError:
        token = self.tokens[at]
        found = shown(token.text) if token.kind != "end" else "the end"
        return ExpressionError(self.text, token.position, f"found {found}, expected {expected}")

    def refused(self, at: int, reason: str) -> ExpressionError:
        return ExpressionError(self.text, self.tokens[at].position, reason)

    def mark(self, at: int, allowed: Iterable[str]) -> str:
        """The mark at a place where it is one of those allowed, else nothing."""
        token = self.tokens[at]
        return token.text if token.kind == "mark" and token.text in allowed else ""

    def sum(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        if depth > _DEEPEST:
            raise self.refused(at, f"nested more than {_DEEPEST} deep, which is not allowed")
        start = at
        first, at = self.product(at, depth)
        terms = [first]
        while sign := self.mark(at, "+-"):
            term, at = self.product(at + 1, depth)
            terms.append(term if sign == "+" else -term)
        return self.checked(sp.Add(*terms), start), at

    def product(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        start = at
        first, at = self.signed(at, depth)
        factors = [first]
        while operator := self.mark(at, "*/"):
            factor, after = self.signed(at + 1, depth)
            if operator == "/" and factor.is_zero:
                raise self.refused(at + 1, "division by zero is not allowed")
            factors.append(factor if operator == "*" else 1 / factor)
            at = after
        return self.checked(sp.Mul(*factors), start), at

    def signed(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        negative = False
        while sign := self.mark(at, "+-"):
            negative ^= sign == "-"
            at += 1
        value, at = self.power(at, depth)
        return (-value if negative else value), at

    def power(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        start = at
        base, at = self.atom(at, depth)
        if not self.mark(at, _POWER_MARKS):
            return base, at
        if depth >= _DEEPEST:
            raise self.refused(at, f"nested more than {_DEEPEST} deep, which is not allowed")
        exponent, end = self.signed(at + 1, depth + 1)
        self.check_power(base, exponent, at + 1)
        return self.checked(base**exponent, start), end

    def check_power(self, base: sp.Expr, exponent: sp.Expr, at: int) -> None:
        """Refuse a power before it is computed."""
        if not exponent.is_number:
            return
        fine = exponent.is_Rational and exponent.q <= _FINEST_EXPONENT and abs(exponent) <= _LARGEST_EXPONENT
        if not fine or _bits(base) * abs(exponent) > _MOST_BITS:
            allowed = (
                f"rational exponents from -{_LARGEST_EXPONENT} to {_LARGEST_EXPONENT}, numbers up to 1e300"
            )
            raise self.refused(at, f"a power too large; allowed are {allowed}")
        if exponent.is_negative and base.is_zero:
            raise self.refused(at, "division by zero is not allowed")

    def atom(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        token = self.tokens[at]
        if token.kind == "number":
            number = Fraction(token.text)
            return sp.Rational(number.numerator, number.denominator), at + 1
        if token.kind == "name":
            return self.named(at, depth)
        if self.mark(at, "("):
            return self.parenthesis(at, depth)
        raise self.unexpected(at, "a number, a name, a function or '('")

    def parenthesis(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        """From the opening mark to the one that closes it."""
        value, at = self.sum(at + 1, depth + 1)
        if not self.mark(at, ")"):
            raise self.unexpected(at, "an operator or ')'")
        return value, at + 1

    def named(self, at: int, depth: int) -> tuple[sp.Expr, int]:
        name, called = self.tokens[at].text, bool(self.mark(at + 1, "("))
        if called and name in FUNCTIONS:
            argument, end = self.parenthesis(at + 1, depth)
            return self.applied(name, argument, at), end
        if not called and name in self.names:
            return self.names[name], at + 1
        raise self.refused(at, self.unknown(name, called))

    def applied(self, name: str, argument: sp.Expr, at: int) -> sp.Expr:
        if argument.is_number and not abs(sp.N(argument)) <= _LARGEST_ARGUMENT and name != "log":
            allowed = f"numbers from -{_LARGEST_ARGUMENT} to {_LARGEST_ARGUMENT}"
            raise self.refused(at, f"the argument of {name} is too large; allowed are {allowed}")
        return self.checked(FUNCTIONS[name](argument), at)

    def unknown(self, name: str, called: bool) -> str:
        """Why a name cannot be read, and which one is near."""
        if called and name in self.names:
            return f"{name!r} is no function: between factors a * is needed"
        if not called and name in FUNCTIONS:
            return f"the function {name!r} needs an argument in parentheses"
        allowed = sorted(FUNCTIONS) if called else sorted(self.names)
        near = get_close_matches(name, allowed, n=1, cutoff=0.5)
        hint = f" (did you mean {near[0]!r}?)" if near else ""
        kind = "function" if called else "symbol"
        return f"unknown {kind} {shown(name)}{hint}; allowed are {', '.join(allowed) or 'numbers only'}"

    def checked(self, value: sp.Expr, at: int) -> sp.Expr:
        """The value, if it is real and finite as far as can be known, and within the bounds."""
        if value.has(sp.I, sp.nan, sp.zoo, sp.oo, -sp.oo) or value.is_extended_real is False:
            raise self.refused(at, "the value from here on is not a finite real number")
        if _bits(value) > _MOST_BITS:
            raise self.refused(
                at, "the number from here on is too large or too long; allowed are up to 1e300"
            )
        if value.is_Pow and value.exp.is_number and not abs(value.exp) <= _LARGEST_EXPONENT:
            raise self.refused(at, f"a power too large; allowed are exponents up to {_LARGEST_EXPONENT}")
        return value


def _bits(value: sp.Expr) -> int:
    """Length of an exact number in bits; 0 for all else."""
    if not value.is_Rational:
        return 0
    return max(int(value.p).bit_length(), int(value.q).bit_length())
