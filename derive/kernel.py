"""From equations to a language-neutral description of code.

A `KernelSpec` says which functions a model module has, what each returns, and through which named
intermediate values; it holds SymPy expressions, never text of a language. `emit` places it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from . import symbols as s
from .euler_lagrange import EquationsOfMotion
from .powers import share_powers
from .shared import share_subexpressions
from .symbols import Quantity
from .verdict import Verdict

_VOLUME = sp.Symbol("volume", positive=True)


@dataclass(frozen=True)
class Assignment:
    """A named intermediate value."""

    name: str
    expression: sp.Expr
    comment: str = ""


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
    formulas: tuple[tuple[sp.Expr, sp.Expr], ...]  # governing equations, left = right, in the paper's symbols
    verdicts: tuple[Verdict, ...]
    digest: str


def _named(expression: sp.Expr) -> sp.Expr:
    """Replace the symbols of the algebra by the names that code uses."""
    names = {
        symbol: sp.Symbol(s.quantity_of(symbol).name) for symbol in expression.free_symbols if _known(symbol)
    }
    return expression.subs(names, simultaneous=True)


def _known(symbol: sp.Symbol) -> bool:
    return any(quantity.symbol == symbol for quantity in s.QUANTITIES)


def _in_volume(expression: sp.Expr, volume: sp.Expr) -> sp.Expr:
    """Write a product of the volume of the body as that: 8 H L^2 mu becomes volume * mu."""
    quotient = expression / volume
    lengths = [f for f in sp.Mul.make_args(quotient) if f.as_base_exp()[0] in volume.free_symbols]
    whole = expression.is_Mul and all(length.as_base_exp()[1].is_positive for length in lengths)
    return quotient * _VOLUME if whole else expression


def _entry(name: str, *indices: int, size: int) -> str:
    """`mass` for one coordinate, `mass_12` for several."""
    return name if size == 1 else f"{name}_{''.join(str(index + 1) for index in indices)}"


def _mass_assignments(eom: EquationsOfMotion) -> tuple[Assignment, ...]:
    n = eom.mass_matrix.rows
    return tuple(
        Assignment(
            _entry("mass", row, column, size=n),
            eom.mass_matrix[row, column],
            "mass matrix [kg m^2]" if row == column == 0 else "",
        )
        for row in range(n)
        for column in range(row, n)
    )


def _mass_symbols(n: int) -> sp.Matrix:
    return sp.Matrix(n, n, lambda row, column: sp.Symbol(_entry("mass", *sorted((row, column)), size=n)))


def _solved(n: int, right_side: sp.Matrix) -> sp.Matrix:
    """M^-1 times a matrix, M by name; its determinant is the intermediate `mass_determinant`."""
    mass = _mass_symbols(n)
    if n == 1:
        return right_side / mass[0, 0]
    return mass.adjugate() * right_side / sp.Symbol("mass_determinant")


def _determinant_assignment(n: int) -> tuple[Assignment, ...]:
    return () if n == 1 else (Assignment("mass_determinant", _mass_symbols(n).det()),)


def _force_assignments(eom: EquationsOfMotion) -> tuple[Assignment, ...]:
    n = eom.mass_matrix.rows
    return tuple(
        Assignment(
            _entry(term.name, row, size=n),
            term.vector[row],
            f"generalised force of {term.meaning} [J]" if row == 0 else "",
        )
        for term in eom.force_terms
        for row in range(n)
        if term.vector[row] != 0
    )


def _net_force(eom: EquationsOfMotion) -> sp.Matrix:
    n = eom.mass_matrix.rows
    return sp.Matrix(
        [
            sp.Add(*(sp.Symbol(_entry(t.name, row, size=n)) for t in eom.force_terms if t.vector[row] != 0))
            for row in range(n)
        ]
    )


def _rhs(eom: EquationsOfMotion) -> KernelFunction:
    load_case, n = eom.load_case, eom.mass_matrix.rows
    forces = tuple(Assignment(_entry("net_force", row, size=n), f) for row, f in enumerate(_net_force(eom)))
    acceleration = _solved(n, sp.Matrix([sp.Symbol(a.name) for a in forces]))
    solved = tuple(
        Assignment(
            c.acceleration.name,
            acceleration[row],
            "mass matrix times acceleration = net force" if row == 0 else "",
        )
        for row, c in enumerate(load_case.coordinates)
    )
    rates = tuple(
        Assignment(i.rate.name, rate, "flow of the dashpot [1/s]" if row == 0 else "")
        for row, (i, rate) in enumerate(zip(load_case.internals, eom.internal_rates, strict=True))
    )
    moving = [*(c.rate for c in load_case.coordinates), *(c.acceleration for c in load_case.coordinates)]
    moving += [i.rate for i in load_case.internals]
    return _function(
        eom,
        "rhs",
        "Time derivative of the state.",
        "the unit of each state per second",
        (len(moving),),
        (
            *_mass_assignments(eom),
            *_determinant_assignment(n),
            *_force_assignments(eom),
            *forces,
            *solved,
            *rates,
        ),
        [quantity.symbol for quantity in moving],
    )


def _jacobian(eom: EquationsOfMotion) -> KernelFunction:
    """Rows of the accelerations through the mass matrix by name; the others as derived."""
    n, size = eom.mass_matrix.rows, len(eom.state)
    unbalanced = eom.unbalanced_jacobian
    named = [
        [
            sp.Symbol(f"force_slope_{row + 1}_{column + 1}") if unbalanced[row, column] != 0 else sp.S.Zero
            for column in range(size)
        ]
        for row in range(n)
    ]
    slopes = tuple(
        Assignment(
            f"force_slope_{row + 1}_{column + 1}",
            unbalanced[row, column],
            "slope of (net force - mass matrix times acceleration) with respect to the state"
            if (row, column) == (0, 0)
            else "",
        )
        for row in range(n)
        for column in range(size)
        if unbalanced[row, column] != 0
    )
    accelerations = _solved(n, sp.Matrix(named))
    dashpots = tuple(
        Assignment(
            f"dashpot_slope_{row - 2 * n + 1}_{column + 1}",
            eom.jacobian[row, column],
            "slope of the dashpot rates with respect to the state" if (row, column) == (2 * n, 0) else "",
        )
        for row in range(2 * n, size)
        for column in range(size)
        if eom.jacobian[row, column] != 0
    )
    dashpot_names = {a.name for a in dashpots}

    def entry(row: int, column: int) -> sp.Expr:
        name = f"dashpot_slope_{row - 2 * n + 1}_{column + 1}"
        if n <= row < 2 * n:
            return accelerations[row - n, column]
        return sp.Symbol(name) if name in dashpot_names else eom.jacobian[row, column]

    rows = [entry(row, column) for row in range(size) for column in range(size)]
    return _function(
        eom,
        "jacobian",
        "Derivative of `rhs` with respect to the state; entry [i, j] is d rhs_i / d state_j.",
        "per second, times the unit of state i over that of state j",
        (size, size),
        (*_mass_assignments(eom), *_determinant_assignment(n), *slopes, *dashpots),
        rows,
        accelerations=tuple(c.acceleration.name for c in eom.load_case.coordinates),
    )


def _reactions(eom: EquationsOfMotion) -> tuple[KernelFunction, ...]:
    reactions = eom.load_case.reactions
    if not reactions:
        return ()
    needed = {symbol for force in eom.reaction_forces for symbol in force.free_symbols}
    moving = any(c.acceleration.symbol in needed for c in eom.load_case.coordinates)
    assignments = tuple(
        Assignment(reaction.name, force)
        for reaction, force in zip(reactions, eom.reaction_forces, strict=True)
    )
    return (
        _function(
            eom,
            "reaction_forces",
            "Forces that hold the constrained axes"
            + ("." if moving else ", without inertia as in the paper."),
            "N",
            (len(reactions),),
            assignments,
            [reaction.symbol for reaction in reactions],
            accelerations=tuple(c.acceleration.name for c in eom.load_case.coordinates) if moving else (),
        ),
    )


def _scalar(
    eom: EquationsOfMotion, name: str, summary: str, unit: str, expression: sp.Expr
) -> KernelFunction:
    return _function(eom, name, summary, unit, (), (), [expression])


def _potential(eom: EquationsOfMotion) -> KernelFunction:
    parts = (
        ("spring_alpha_energy", eom.energies.spring_alpha),
        ("spring_beta_energy", eom.energies.spring_beta),
        ("force_potential", eom.energies.forces),
        ("electrostatic_energy", eom.energies.electrostatic),
    )
    total = sp.Add(*(sp.Symbol(name) for name, _ in parts), evaluate=True)
    return _function(
        eom,
        "potential_energy",
        "Potential energy of springs, applied forces and field.",
        "J",
        (),
        tuple(Assignment(name, part) for name, part in parts),
        [total],
    )


def _pairs(pairs: tuple[tuple[str, sp.Expr], ...], comment: str) -> tuple[Assignment, ...]:
    return tuple(
        Assignment(name, expression, comment if number == 0 else "")
        for number, (name, expression) in enumerate(pairs)
    )


def _volume_assignment(expressions: Iterable[sp.Expr], volume: sp.Expr) -> tuple[Assignment, ...]:
    used = any(_VOLUME in expression.free_symbols for expression in expressions)
    return (Assignment("volume", _named(volume), "volume of the membrane [m^3]"),) if used else ()


def _function(
    eom: EquationsOfMotion,
    name: str,
    summary: str,
    unit: str,
    shape: tuple[int, ...],
    assignments: Iterable[Assignment],
    outputs: Iterable[sp.Expr],
    *,
    accelerations: tuple[str, ...] = (),
) -> KernelFunction:
    """Name symbols, the volume, and the powers of moving quantities, in the order of their use."""
    assignments = tuple(assignments)
    raw = (*(a.expression for a in assignments), *(sp.sympify(output) for output in outputs))
    named = tuple(_named(_in_volume(expression, eom.membrane.volume)) for expression in raw)
    powers, in_powers = share_powers(named, frozenset(quantity.name for quantity in eom.state))
    constants = frozenset((_VOLUME.name, *(parameter.name for parameter in eom.parameters)))
    common, expressions = share_subexpressions(in_powers, constants, frozenset(a.name for a in assignments))
    shared = _pairs(powers, "powers of the state") + _pairs(common, "shared by what follows")
    rewritten = tuple(
        Assignment(a.name, expression, a.comment)
        for a, expression in zip(assignments, expressions, strict=False)
    )
    return KernelFunction(
        name, summary, unit, shape,
        (*_volume_assignment(in_powers, eom.membrane.volume), *shared, *rewritten),
        expressions[len(assignments):], accelerations,
    )  # fmt: skip


def reference_state(eom: EquationsOfMotion) -> tuple[sp.Expr, ...]:
    """At rest in the reference configuration; a dashpot along a held axis has relaxed to the held stretch."""
    load_case = eom.load_case
    held = dict(zip(load_case.inelastic_stretches, load_case.stretches, strict=True))
    coordinates = {c.value.symbol for c in load_case.coordinates}
    relaxed = [
        sp.Integer(1) if held[i.value.symbol] in coordinates else held[i.value.symbol]
        for i in load_case.internals
    ]
    n = len(load_case.coordinates)
    return tuple(_named(value) for value in (*[sp.Integer(1)] * n, *[sp.Integer(0)] * n, *relaxed))


def _formulas(eom: EquationsOfMotion) -> tuple[tuple[sp.Expr, sp.Expr], ...]:
    """The governing equations in the notation of the paper, for the docstring."""
    load_case = eom.load_case
    inertia = eom.mass_matrix * sp.Matrix([c.acceleration.symbol for c in load_case.coordinates])
    return (
        (s.KINETIC_ENERGY.symbol, eom.kinetic_energy),
        (s.POTENTIAL_ENERGY.symbol, eom.potential_energy),
        *zip(inertia, eom.force_vector, strict=True),
        *((i.rate.symbol, rate) for i, rate in zip(load_case.internals, eom.internal_rates, strict=True)),
        *((r.symbol, force) for r, force in zip(load_case.reactions, eom.reaction_forces, strict=True)),
    )


def _digest(formulas: tuple[tuple[sp.Expr, sp.Expr], ...]) -> str:
    """SHA-256 of the governing equations in canonical order, first 16 hexadecimal digits."""
    text = "\n".join(
        f"{sp.sstr(left, order='lex')} = {sp.sstr(right, order='lex')}" for left, right in formulas
    )
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def kernel(eom: EquationsOfMotion, verdicts: tuple[Verdict, ...]) -> KernelSpec:
    """Describe the module of one model, with the verdicts on the printed equations it was checked against."""
    load_case, n = eom.load_case, eom.mass_matrix.rows
    formulas = _formulas(eom)
    functions = (
        _rhs(eom),
        _jacobian(eom),
        _function(eom, "mass_matrix", "Mass matrix of the coordinates.", "kg m^2", (n, n), (), list(eom.mass_matrix)),
        _scalar(eom, "kinetic_energy", "Kinetic energy.", "J", eom.kinetic_energy),
        _potential(eom),
        _scalar(eom, "force_power", "Power that the applied forces put in.", "W", eom.force_power),
        _scalar(eom, "dashpot_power", "Power that the dashpots dissipate.", "W", eom.dashpot_power),
        *_reactions(eom),
        _function(
            eom,
            "principal_stretches", "Stretches along axes 1, 2 and through the thickness.", "1", (3,), (),
            eom.principal_stretches,
        ),
    )  # fmt: skip
    return KernelSpec(
        name=load_case.name,
        title=load_case.title,
        load_case=load_case.family,
        formulation=load_case.formulation,
        remark=load_case.remark,
        coordinate_count=n,
        state=eom.state,
        inputs=load_case.inputs,
        parameters=eom.parameters,
        reactions=load_case.reactions,
        functions=functions,
        reference_state=reference_state(eom),
        formulas=formulas,
        verdicts=verdicts,
        digest=_digest(formulas),
    )
