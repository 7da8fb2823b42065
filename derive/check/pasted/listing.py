"""What a model gives, in LaTeX: its symbols and its equations, to copy from and to compare with."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.check.pasted.latex import LatexPrinter
from delagrange.derive.check.pasted.symbols import symbols_of_model
from delagrange.derive.equations.derived_equations import DerivedEquation, derived_equations
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.notation.symbols import Quantity


@dataclass(frozen=True)
class ListedSymbol:
    """A printed symbol and what it stands for."""

    latex: str
    quantity: Quantity


@dataclass(frozen=True)
class ListedEquation:
    """An equation of a model, by the name of what it states."""

    quantity: str
    latex: str


def listed_symbols(eom: EquationsOfMotion) -> tuple[ListedSymbol, ...]:
    """The symbol of each quantity of a model by default; accelerations of inelastic stretches stand nowhere."""
    names = symbols_of_model(eom).names
    nowhere = {internal.acceleration for internal in eom.load_case.internals}
    return tuple(
        ListedSymbol(str(names[each.symbol]), each) for each in eom.quantities if each not in nowhere
    )


def listed_equations(eom: EquationsOfMotion) -> tuple[ListedEquation, ...]:
    """The equations of a model in its own symbols, each as the reader of printed equations takes it."""
    latex = LatexPrinter(symbols_of_model(eom).names)
    return tuple(
        ListedEquation(name, _stated(equation, latex)) for name, equation in derived_equations(eom).items()
    )


def _stated(equation: DerivedEquation, latex: LatexPrinter) -> str:
    """`unknown = ...` where the residual is that, else `residual = 0`."""
    unknown = equation.unknown.symbol
    right = sp.expand(unknown - equation.residual) if equation.residual.diff(unknown) == 1 else None
    if right is None or right.has(unknown):
        return f"{latex(equation.residual)} = 0"
    return f"{latex(unknown)} = {latex(unknown - equation.residual)}"
