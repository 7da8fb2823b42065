"""Reads an equation as printed into a tree, or says where and why it cannot.

Every construct is either read for certain or refused with its place: what looks ambiguous on the
page (a number behind a factor, an exponent on a fraction, `a/bc`) is refused too. SymPy's readers
are not used: one rejects `\\ddot{\\lambda}`, the other drops subscripts without a word.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from types import MappingProxyType

from delagrange.derive.printed.dimensions import PrintedTermDimension, check_printed
from delagrange.derive.printed.symbol_table import (
    DOTS,
    FONTS,
    GREEK,
    Name,
    SymbolTable,
    label_at,
    read_symbol,
    script_end,
    whole,
)
from delagrange.derive.printed.tokens import LatexError, Source, Span, Token, tokenize
from delagrange.derive.printed.tree import (
    Equation,
    Function,
    Group,
    Node,
    Number,
    Power,
    PrintedTerm,
    Quotient,
    Sum,
    Term,
    Variable,
    printed_terms,
    product_of,
    sum_of,
)
from delagrange.derive.printed.values import evaluate, to_sympy
from delagrange.derive.printed.write import to_latex

__all__ = [
    "Equation", "LatexError", "Name", "PrintedTerm", "PrintedTermDimension", "SymbolTable", "check_printed",
    "evaluate", "printed_terms", "read_equation", "to_latex", "to_sympy",
]  # fmt: skip

_CLOSING = MappingProxyType({"(": ")", "[": "]", r"\{": r"\}"})
_FRACTIONS = frozenset((r"\frac", r"\dfrac", r"\tfrac"))
_TIMES = frozenset((r"\times", r"\cdot"))
_FUNCTIONS = frozenset((r"\ln", r"\exp", r"\sin", r"\cos", r"\tan", r"\sinh", r"\cosh", r"\tanh"))
_SIGNS = MappingProxyType({"+": 1, "-": -1, "\u2212": -1})
_DEEPEST = 50  # nesting; far above any print, far below Python's own limit


def read_equation(latex: str, table: SymbolTable, *, number: str) -> Equation:
    """Read one equation.

    Args:
        latex: the source, with or without `$$`; several blocks are joined.
        table: what the symbols stand for.
        number: the printed number, "9"; a `\\tag` must agree with it.

    Raises:
        LatexError: a symbol is not in the table or a construct is not understood; the message has
            the equation, the place, what stands there and what was expected.
    """
    source = Source(number, latex)
    return _Reader(source, tokenize(source), table).equation()


class _Reader:
    """One pass over the tokens; `at` is the next one."""

    def __init__(self, source: Source, tokens: tuple[Token, ...], table: SymbolTable) -> None:
        self.source = source
        self.tokens = tokens
        self.table = table
        self.at = 0
        self.depth = 0

    # Moving along

    @property
    def token(self) -> Token:
        return self.tokens[self.at]

    def looks_at(self, *texts: str) -> bool:
        """Whether the next tokens are these."""
        ahead = self.tokens[self.at : self.at + len(texts)]
        return tuple(token.text for token in ahead) == texts

    def advance(self) -> Token:
        token = self.token
        self.at = min(self.at + 1, len(self.tokens) - 1)
        return token

    def expect(self, text: str) -> Token:
        if self.token.text != text:
            raise self.error(text)
        return self.advance()

    def error(self, expected: str) -> LatexError:
        return self.source.error(self.token.span, expected)

    # The equation

    def equation(self) -> Equation:
        lhs = self.sum()
        if self.token.text != "=":
            raise self.error("an operator, a factor or =")
        self.advance()
        rhs = self.sum()
        self.ending()
        return Equation(self.source.number, lhs, rhs, self.source.latex, self.table)

    def ending(self) -> None:
        """A comma or full stop and a tag, in either order."""
        for _ in range(2):
            if self.token.text in (",", ".", ";"):
                self.advance()
            elif self.token.text == r"\tag":
                self.tag()
        if self.token.kind != "end":
            raise self.error("an operator, a factor or the end")

    def tag(self) -> None:
        self.advance()
        end = script_end(self.source, self.tokens, self.at)
        if label_at(self.tokens, self.at) != self.source.number:
            raise self.source.error(whole(self.tokens, self.at, end), f"{{{self.source.number}}}")
        self.at = end

    # Sums and products

    def sum(self) -> Node:
        terms = [self.term()]
        while self.token.text in _SIGNS:
            terms.append(self.term())
        return sum_of(tuple(terms))

    def term(self) -> Term:
        start = self.token.span
        sign = _SIGNS[self.advance().text] if self.token.text in _SIGNS else 1
        node = self.product()
        return Term(sign, node, start.to(node.span))

    def product(self) -> Node:
        factors = [self.factor()]
        while self.token.text in _TIMES or self.starts_factor():
            if self.token.text in _TIMES:
                self.advance()
            elif self.looks_at_number():
                raise self.error("an operator before a number that follows a factor")
            factors.append(self.factor())
        return product_of(tuple(factors))

    def looks_at_number(self) -> bool:
        """Whether a number comes next, in braces or not: they do not show in print."""
        ahead = self.at
        while self.tokens[ahead].text == "{":
            ahead += 1
        return self.tokens[ahead].kind == "number"

    def starts_factor(self) -> bool:
        token = self.token
        if token.kind in ("number", "letter") or token.text in _CLOSING or token.text == "{":
            return True
        return token.kind == "command" and token.text not in (r"\right", r"\tag")

    # Factors

    def factor(self) -> Node:
        self.depth += 1
        if self.depth > _DEEPEST:
            raise self.error(f"no more than {_DEEPEST} levels of brackets")
        node = self.factor_here()
        self.depth -= 1
        return node

    def factor_here(self) -> Node:
        token = self.token
        if token.kind == "letter" or token.text in GREEK or token.text in DOTS:
            return self.symbol()
        if token.text in _FRACTIONS:
            return self.unraised(self.fraction())
        if token.text in _FUNCTIONS:
            return self.unraised(self.function())
        if token.text == r"\sqrt":
            return self.raised(self.root())
        if token.kind == "number":
            return self.raised(self.number())
        if token.text == "{":
            return self.raised(self.braced_factor())
        if token.text in _CLOSING or token.text == r"\left":
            return self.raised(self.group())
        raise self.error("a number, a symbol, a fraction, a function or an opening bracket")

    def raised(self, base: Node) -> Node:
        if self.token.text != "^":
            return base
        self.advance()
        exponent = self.exponent()
        return Power(base, exponent, base.span.to(self.tokens[self.at - 1].span))

    def unraised(self, node: Node) -> Node:
        if self.token.text == "^":
            raise self.error("brackets around what is raised to a power")
        return node

    def exponent(self) -> Node:
        """What follows `^`; a signed number is a number here."""
        if self.token.text == "{":
            self.advance()
            node = self.sum()
            self.expect("}")
            return _signed_number(node)
        script_end(self.source, self.tokens, self.at)
        return self.number() if self.token.kind == "number" else self.plain_symbol()

    def number(self) -> Number:
        token = self.advance()
        return Number(Fraction(token.text), token.span)

    def group(self) -> Group:
        start = self.token.span
        sized = self.token.text == r"\left"
        if sized:
            self.advance()
        if self.token.text not in _CLOSING:
            raise self.error(r"one of ( [ \{")
        bracket = self.advance().text
        inner = self.sum()
        if sized:
            self.closing(r"\right", _CLOSING[bracket])
        else:
            self.closing(_CLOSING[bracket])
        return Group(bracket, inner, start.to(self.tokens[self.at - 1].span))

    def closing(self, *texts: str) -> None:
        if not self.looks_at(*texts):
            raise self.error(f"an operator, a factor or {''.join(texts)}")
        self.at += len(texts)

    def braced_factor(self) -> Node:
        """Braces do not show in print: around more than one symbol they would mislead."""
        self.expect("{")
        node = self.factor()
        if isinstance(node, Power) or self.token.text != "}":
            raise self.error("} after one symbol: braces around more do not show in print")
        self.advance()
        return node

    def braced_sum(self) -> Node:
        self.expect("{")
        node = self.sum()
        if self.token.text != "}":
            raise self.error("an operator, a factor or }")
        self.advance()
        return node

    def fraction(self) -> Node:
        start = self.advance().span
        if (rate := self.rate(start)) is not None:
            return rate
        numerator = self.braced_sum()
        denominator = self.braced_sum()
        return Quotient(numerator, denominator, start.to(self.tokens[self.at - 1].span))

    def root(self) -> Function:
        start = self.advance().span
        argument = self.braced_sum()
        return Function("sqrt", argument, start.to(self.tokens[self.at - 1].span))

    def function(self) -> Function:
        """Without brackets the argument is one factor, and nothing may follow it that could belong.

        An exponent behind the argument could belong to the argument or to the function: both
        `\\ln(x)^2` and `\\ln x^2` are refused, `\\left(\\ln(x)\\right)^2` and `\\ln(x^2)` are read.
        """
        command = self.advance()
        argument = self.factor()
        if isinstance(argument, Power):
            raise self.source.error(argument.span, "brackets that show what is raised to a power")
        if not isinstance(argument, Group) and self.starts_factor():
            raise self.error("brackets around the argument of a function")
        return Function(command.text[1:], argument, command.span.to(argument.span))

    # Symbols

    def symbol(self) -> Node:
        """A symbol; its superscript is a label where the table has it with one, else an exponent."""
        start = self.at
        name, end, superscript = read_symbol(self.source, self.tokens, start)
        span = whole(self.tokens, start, end)
        if superscript is None:
            self.at = end
            return self.variable(name, span)
        labelled = replace(name, label=label_at(self.tokens, superscript))
        if labelled.label and (labelled in self.table or name not in self.table):
            self.at = end
            return self.variable(labelled, span)
        base = self.variable(name, whole(self.tokens, start, superscript - 1))
        self.at = superscript
        exponent = self.exponent()
        self.at = end
        return Power(base, exponent, span)

    def plain_symbol(self) -> Variable:
        token = self.advance()
        return self.variable(Name(token.text), token.span)

    def variable(self, name: Name, span: Span) -> Variable:
        if name not in self.table:
            nearest = ", ".join(self.table.nearest(name))
            raise self.source.error(span, f"a symbol of the table (nearest: {nearest})")
        return Variable(self.table[name], name, span)

    # d/dt

    def rate(self, start: Span) -> Variable | None:
        """`{d x}{dt}` and `{d^2 x}{dt^2}`; None where the fraction is an ordinary one."""
        if (above := self.differential(self.at)) is None:
            return None
        below = self.differential(script_end(self.source, self.tokens, self.at))
        if below is None or self.tokens[below].text != "t":
            return None
        order, self.at = self.order(above)
        quantity = self.rate_symbol(order)
        self.at = below
        self.denominator(order)
        return replace(quantity, span=start.to(self.tokens[self.at - 1].span))

    def rate_symbol(self, order: int) -> Variable:
        start = self.at
        name, end, superscript = read_symbol(self.source, self.tokens, start)
        if superscript is not None or self.tokens[end].text != "}":
            extra = self.tokens[superscript or end]
            raise self.source.error(extra.span, "one symbol without exponent under d/dt")
        span = whole(self.tokens, start, end)
        rate = replace(name, dots=name.dots + order)
        if rate not in self.table:
            self.variable(name, span)  # a symbol that is not there at all is the plainer error
            raise self.source.error(span, "a quantity that depends on time under d/dt")
        return Variable(self.table[rate], rate, span, differential=True)

    def denominator(self, order: int) -> None:
        self.expect("t")
        if order == 2:
            self.expect("^")
            braced = self.looks_at("{", "2", "}")
            if not braced and not self.looks_at("2"):
                raise self.error("2")
            self.at += 3 if braced else 1
        self.expect("}")

    def differential(self, at: int) -> int | None:
        """The index after an opening brace and the d of a differential, upright or not."""
        if self.tokens[at].text != "{":
            return None
        texts = tuple(token.text for token in self.tokens[at + 1 : at + 5])
        if texts[:1] == ("d",):
            return at + 2
        if texts[0] in FONTS and texts[1:4] == ("{", "d", "}"):
            return at + 5
        if texts[0] == "{" and texts[1] in FONTS and texts[2:4] == ("d", "}"):
            return at + 5
        return at + 3 if texts[0] in FONTS and texts[1] == "d" else None

    def order(self, at: int) -> tuple[int, int]:
        texts = tuple(token.text for token in self.tokens[at : at + 4])
        if texts == ("^", "{", "2", "}"):
            return 2, at + 4
        return (2, at + 2) if texts[:2] == ("^", "2") else (1, at)


def _signed_number(node: Node) -> Node:
    match node:
        case Sum((Term(-1, Number(value)),)):
            return Number(-value, node.span)
    return node
