"""The governing equations of a module, as its docstring states them, and the digest that tells them apart."""

from __future__ import annotations

import hashlib

import sympy as sp

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.notation import symbols as s

Formulas = tuple[tuple[sp.Expr, sp.Expr], ...]  # left = right, in the symbols of the algebra


def governing_equations(eom: EquationsOfMotion) -> Formulas:
    """The governing equations in the notation of the model, for the docstring."""
    load_case, balance = eom.load_case, eom.charge_balance
    inertia = eom.mass_matrix * sp.Matrix([c.acceleration.symbol for c in load_case.coordinates])
    return (
        (s.KINETIC_ENERGY.symbol, eom.kinetic_energy),
        (s.POTENTIAL_ENERGY.symbol, eom.potential_energy),
        *zip(inertia, eom.force_vector, strict=True),
        *((i.rate.symbol, rate) for i, rate in zip(load_case.internals, eom.internal_rates, strict=True)),
        *(() if balance is None else ((balance.rate.symbol, balance.law),)),
        *((r.symbol, force) for r, force in zip(load_case.reactions, eom.reaction_forces, strict=True)),
    )


def digest(formulas: Formulas) -> str:
    """SHA-256 of the governing equations in canonical order, first 16 hexadecimal digits."""
    text = "\n".join(
        f"{sp.sstr(left, order='lex')} = {sp.sstr(right, order='lex')}" for left, right in formulas
    )
    return hashlib.sha256(text.encode()).hexdigest()[:16]
