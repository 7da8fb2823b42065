"""A language-neutral description of a model module: SymPy expressions, never text of a language.

A `KernelSpec` says which functions the module has, what each returns, and through which named
intermediate values. `kernel` fills it; `emit` places it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from delagrange.derive.check.verdict import Verdict
from delagrange.derive.notation.symbols import Quantity


@dataclass(frozen=True)
class Assignment:
    """A named intermediate value."""

    name: str
    expression: sp.Expr
    comment: str = ""
    helper: bool = False  # a power or a shared part, with no meaning of its own


@dataclass(frozen=True)
class KernelFunction:
    """A function of (state, inputs, parameters); `outputs` fill `shape` in row-major order."""

    name: str
    summary: str
    unit: str
    shape: tuple[int, ...]  # () for a scalar field
    assignments: tuple[Assignment, ...]
    outputs: tuple[sp.Expr, ...]
    accelerations: tuple[str, ...] = ()  # names taken from rhs before anything else

    def uses(self, name: str) -> bool:
        expressions = (*(a.expression for a in self.assignments), *self.outputs)
        return any(sp.Symbol(name) in expression.free_symbols for expression in expressions)


@dataclass(frozen=True)
class SpringAtRest:
    """A spring, the constants of its strain energy, and the shear modulus [Pa] that they make at rest."""

    name: str
    constants: tuple[str, ...]
    shear_modulus: sp.Expr


@dataclass(frozen=True)
class Origin:
    """What a module says of where it comes from, beside its equations."""

    notation: str = ""  # whose notation the governing equations have, "" where they speak for themselves
    citation: str = ""  # of what printed the equations that it was checked against
    sources: tuple[str, ...] = ()  # of energies and values


@dataclass(frozen=True)
class KernelSpec:
    """A model module, whatever language it is written in."""

    name: str
    title: str
    load_case: str
    formulation: str
    remark: str
    coordinate_count: int
    state: tuple[Quantity, ...]
    inputs: tuple[Quantity, ...]
    parameters: tuple[Quantity, ...]
    reactions: tuple[Quantity, ...]
    functions: tuple[KernelFunction, ...]
    reference_state: tuple[sp.Expr, ...]
    formulas: tuple[
        tuple[sp.Expr, sp.Expr], ...
    ]  # governing equations, left = right, in the symbols of the algebra
    verdicts: tuple[Verdict, ...]
    digest: str
    quantities: tuple[Quantity, ...]  # all that the formulas are written in
    body: str  # what it is, a sentence without its full stop
    start: str  # what `reference_state` is
    origin: Origin = field(default_factory=Origin)
    defaults: Mapping[str, float] | None = None  # values of parameters by name; None: the module has none
    springs: tuple[SpringAtRest, ...] = ()
