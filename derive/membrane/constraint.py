"""The variation and the constraint of a load case: the operator of Eq. (2), and what a frame substitutes.

Eq. (2) of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384, for any number of coordinates,
with the sign that makes the mass matrix positive: d/dt(dl/dq') - dl/dq = 0, l = T - Pi.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from delagrange.derive.membrane.load_case import LoadCase
from delagrange.derive.membrane.membrane import Membrane
from delagrange.derive.notation.symbols import TimeDependent
from delagrange.derive.notation.time_derivative import time_derivative

Substitution = Mapping[sp.Symbol, sp.Expr]


def euler_lagrange(lagrangian: sp.Expr, coordinates: tuple[TimeDependent, ...]) -> tuple[sp.Expr, ...]:
    """Euler-Lagrange expressions d/dt(dl/dq') - dl/dq, one a coordinate, Eq. (2)."""
    return tuple(
        time_derivative(lagrangian.diff(c.rate.symbol), coordinates) - lagrangian.diff(c.value.symbol)
        for c in coordinates
    )


def tidy(expression: sp.Expr) -> sp.Expr:
    """A short form: like terms collected, common factors in front.

    Powers of sums, such as those of an invariant or of what a locking limit leaves, keep their sums: expanded
    they would be much longer, and their kernels would take up to three times as many operations.
    """
    return sp.factor_terms(expression if _has_power_of_sum(expression) else sp.expand(expression))


def _has_power_of_sum(expression: sp.Expr) -> bool:
    return any(power.base.is_Add for power in expression.atoms(sp.Pow))


def kinematics(model: Membrane, load_case: LoadCase) -> dict[sp.Symbol, sp.Expr]:
    """Stretches and inelastic stretches of the full membrane, with their rates, under the constraint."""
    moving = load_case.coordinates + load_case.internals
    full = zip(
        model.coordinates + model.internals, load_case.stretches + load_case.inelastic_stretches, strict=True
    )
    substitution: dict[sp.Symbol, sp.Expr] = {}
    for variable, value in full:
        rate = time_derivative(value, moving)
        substitution[variable.value.symbol] = value
        substitution[variable.rate.symbol] = rate
        substitution[variable.acceleration.symbol] = time_derivative(rate, moving)
    return substitution


def loads(model: Membrane, load_case: LoadCase) -> dict[sp.Symbol, sp.Expr]:
    return {force.symbol: value for force, value in zip(model.forces, load_case.forces, strict=True)}


def constrain(expression: sp.Expr, substitution: Substitution) -> sp.Expr:
    return expression.subs(substitution, simultaneous=True)
