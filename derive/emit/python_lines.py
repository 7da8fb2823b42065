"""Statements of Python with NumPy, broken into lines as a person would break them."""

from __future__ import annotations

from keyword import kwlist

import sympy as sp

from delagrange.derive.kernel.spec import Assignment
from delagrange.derive.notation.printer import FUNCTIONS, ExpressionPrinter

NUMPY = ExpressionPrinter(
    {function: f"np.{name}" for function, name in FUNCTIONS.items()}, root="np.sqrt", least="np.minimum", pi="np.pi"
)
PYTHON_WORDS = frozenset({*kwlist, "np", "min", "max", "range"})  # that no quantity may be called in its code
WIDTH = 110


def assignment_lines(assignment: Assignment, indent: str = "    ") -> list[str]:
    """`name = expression`, with its comment before it."""
    comment = [f"{indent}# {assignment.comment}"] if assignment.comment else []
    return comment + broken(f"{assignment.name} = ", assignment.expression, NUMPY, indent)


def _folded(text: str, indent: str, times: str) -> list[str]:
    """A term inside brackets, folded before factors where it is too long."""
    first, *others = _factors(text, times)
    lines = [f"{indent}{first}"]
    for factor in others:
        if len(lines[-1]) + len(times) + len(factor) > WIDTH:
            lines.append(f"{indent}    {times.lstrip()}{factor}")
        else:
            lines[-1] += f"{times}{factor}"
    return lines


def _factors(text: str, times: str) -> list[str]:
    """The factors of a printed product that stand outside of brackets."""
    pieces, depth, start = [], 0, 0
    for place, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth == 0 and text.startswith(times, place) and times.strip():
            pieces.append(text[start:place])
            start = place + len(times)
    return [*pieces, text[start:]]


def broken(head: str, expression: sp.Expr, printer: ExpressionPrinter, indent: str) -> list[str]:
    """`head expression` on one line, or in brackets over several where it is too long."""
    line = f"{indent}{head}{printer(expression)}"
    if len(line) <= WIDTH:
        return [line]
    if isinstance(expression, sp.Add):
        return _broken_sum(head, expression, printer, indent)
    return _broken_product(head, expression, printer, indent)


def _broken_sum(head: str, expression: sp.Add, printer: ExpressionPrinter, indent: str) -> list[str]:
    """A term a line."""
    first, *others = printer.terms(expression)
    first = first[2:] if first.startswith("+ ") else "-" + first[2:]
    body = [line for term in (first, *others) for line in _folded(term, f"{indent}    ", printer.times)]
    return [f"{indent}{head}(", *body, f"{indent})"]


def _broken_product(head: str, expression: sp.Expr, printer: ExpressionPrinter, indent: str) -> list[str]:
    """The factors on one line and the longest sum among them over the next; or folded, where there is none."""
    sums = [factor for factor in sp.Mul.make_args(expression) if isinstance(factor, sp.Add)]
    if not sums:
        return [
            f"{indent}{head}(",
            *_folded(printer(expression), f"{indent}    ", printer.times),
            f"{indent})",
        ]
    longest = max(sums, key=lambda factor: len(printer(factor)))
    rest = expression / longest
    before = printer(rest) if sp.denom(rest) == 1 else f"({printer(rest)})"
    return _broken_sum(f"{head}{before}{printer.times}", longest, printer, indent)


def unpacked(names: list[str], source: str) -> list[str]:
    """`a, b = source`, a name a line where it is too long."""
    joined = f"    {', '.join(names)}{',' if len(names) == 1 else ''} = {source}"
    if len(joined) <= WIDTH:
        return [joined]
    return ["    (", *(f"        {name}," for name in names), f"    ) = {source}"]
