"""A load case: what a frame does to the full membrane.

It says how the coordinates of the body depend on fewer generalised coordinates (a holonomic constraint), which
forces are applied, and which force is a reaction.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from delagrange.derive.membrane.description import CONSTRAINED_VARIATION
from delagrange.derive.notation.symbols import Quantity, TimeDependent


@dataclass(frozen=True)
class LoadCase:
    """A constraint on the full membrane, with the loads that are applied to it."""

    name: str  # name of the emitted module
    family: str  # the kind of load
    title: str
    coordinates: tuple[TimeDependent, ...]  # what moves freely
    internals: tuple[TimeDependent, ...]  # inelastic stretches that flow
    inputs: tuple[Quantity, ...]
    stretches: tuple[sp.Expr, ...]  # lambda_1, lambda_2 in the coordinates
    inelastic_stretches: tuple[sp.Expr, ...]  # xi_1, xi_2 of each branch in the internals
    forces: tuple[sp.Expr, ...]  # P_1, P_2: an input or zero, and a reaction where the axis is held
    reactions: tuple[Quantity, ...] = ()
    parameters: tuple[Quantity, ...] = ()  # beyond those of the membrane
    formulation: str = CONSTRAINED_VARIATION
    remark: str = ""  # what a user of the emitted module must know
    start: tuple[sp.Expr, ...] | None = None  # of the coordinates, in the reference state; None: all 1
