"""The same equations through SymPy's `lambdify`: a witness for the emitted modules.

It shares nothing with `kernel` and `emit` but the equations, and has the call signature of a
generated module, so that the two can be compared function by function.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion

Function = Callable[[Sequence[Any], Sequence[Any], Sequence[Any]], np.ndarray]


@dataclass(frozen=True)
class LambdifiedModel:
    """Functions of (state, inputs, parameters) with the layout of the generated module of the same name."""

    rhs: Function
    jacobian: Function
    input_jacobian: Function
    mass_matrix: Function
    kinetic_energy: Function
    potential_energy: Function
    force_power: Function
    dashpot_power: Function
    reaction_forces: Function
    edge_forces: Function
    principal_stretches: Function


def lambdified(eom: EquationsOfMotion) -> LambdifiedModel:
    """Lambdify everything that a generated module offers."""
    load_case = eom.load_case
    accelerations = {
        c.acceleration.symbol: value for c, value in zip(load_case.coordinates, eom.acceleration, strict=True)
    }
    velocities = [c.rate.symbol for c in load_case.coordinates]
    arguments = [[q.symbol for q in group] for group in (eom.state, load_case.inputs, eom.parameters)]

    def function(expression: sp.Expr | sp.MatrixBase) -> Function:
        return sp.lambdify(arguments, expression.subs(accelerations), "numpy")

    def column(entries: Sequence[sp.Expr]) -> Function:
        compiled = [function(sp.sympify(entry)) for entry in entries]
        return lambda state, inputs, parameters: np.array([f(state, inputs, parameters) for f in compiled])

    return LambdifiedModel(
        rhs=column([*velocities, *accelerations.values(), *eom.internal_rates]),
        jacobian=function(eom.jacobian),
        input_jacobian=function(eom.input_jacobian),
        mass_matrix=function(eom.mass_matrix),
        kinetic_energy=function(eom.kinetic_energy),
        potential_energy=function(eom.potential_energy),
        force_power=function(eom.force_power),
        dashpot_power=function(eom.dashpot_power),
        reaction_forces=column(eom.reaction_forces),
        edge_forces=column(eom.edge_forces),
        principal_stretches=column(eom.principal_stretches),
    )
