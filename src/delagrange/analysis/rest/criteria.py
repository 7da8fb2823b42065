"""Limits that an equilibrium may pass though it is stable: loss of tension and electrical breakdown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange.common import checks
from delagrange.drives.inputs import ELECTRIC_FIELD
from delagrange.equilibrium.statics import Statics, input_place
from delagrange.problem.problem import Problem

_NEGLIGIBLE = (
    1e-9  # of the typical force and the electric one: an edge without load carries zero up to round-off
)
BREAKDOWN_DEFINITION = "true field reaches breakdown_field / (thickness stretch)^(breakdown_exponent / 2)"


@dataclass(frozen=True)
class Criteria:
    """What a user holds for too much.

    Raises:
        ValueError: a value that is not finite, or a strength that is not positive.
    """

    breakdown_field: float | None = None  # [V/m], true field that the undeformed material stands
    breakdown_exponent: float = 0.0  # [1], the strength grows as an equal-biaxial stretch to this power
    smallest_tension: float = 0.0  # [Pa], nominal stress below which the membrane counts as slack

    def __post_init__(self) -> None:
        if self.breakdown_field is not None:
            strength = checks.positive("breakdown_field", self.breakdown_field, "V/m")
            object.__setattr__(self, "breakdown_field", checks.scalar("breakdown_field", strength, "V/m"))
        for name, unit in (("breakdown_exponent", "1"), ("smallest_tension", "Pa")):
            value = checks.scalar(name, checks.finite(name, getattr(self, name), unit), unit)
            object.__setattr__(self, name, value)


def thickness_stretch(statics: Statics, x: np.ndarray) -> float:
    """λ_3 [1]"""
    return float(statics.problem.model.principal_stretches(*statics.arguments(x))[2])


def true_field(statics: Statics, x: np.ndarray) -> float:
    """Voltage over the thickness as it is [V/m]."""
    if statics.electrical is ELECTRIC_FIELD:
        nominal = statics.arguments(x)[1][input_place(statics.problem, statics.electrical.name)]
    else:
        nominal = statics.problem.model.electrodes(*statics.arguments(x))[0]
    return float(nominal) / thickness_stretch(statics, x)


def edge_forces(statics: Statics, x: np.ndarray) -> np.ndarray:
    """(2,) [N], on the edges of axes 1 and 2, pulling if positive."""
    return np.asarray(statics.problem.model.edge_forces(*statics.arguments(x)), dtype=float)


def breakdown_margin(statics: Statics, x: np.ndarray, criteria: Criteria) -> float:
    """How much of the strength [V/m] is left; infinite where none is given.

    Strength that grows with stretch: Koh, Li, Zhou, Zhao, Hong, Zhu & Suo (2011), J. Polym. Sci. B 49, 504;
    there as a power of the equal-biaxial stretch, which is the thickness stretch to the power -1/2.
    """
    if criteria.breakdown_field is None:
        return np.inf
    with np.errstate(over="ignore", under="ignore"):  # a strength beyond double precision is infinite or zero
        growth = np.power(thickness_stretch(statics, x), -criteria.breakdown_exponent / 2)
    return float(criteria.breakdown_field * growth - true_field(statics, x))


def tension_margin(statics: Statics, x: np.ndarray, criteria: Criteria) -> float:
    """Force [N] that the slacker edge has above the smallest tension; what is zero but for round-off counts as kept."""
    smallest = criteria.smallest_tension * cross_sections(statics) if criteria.smallest_tension else 0.0
    return float(np.min(edge_forces(statics, x)) - smallest) + negligible_force(statics, x)


def negligible_force(statics: Statics, x: np.ndarray) -> float:
    """Force [N] that counts as none, beside those of springs and field that balance there."""
    without = edge_forces(statics, statics.without_electricity(x))
    electric = np.max(np.abs(edge_forces(statics, x) - without))
    return _NEGLIGIBLE * (statics.typical_force + float(electric))


def cross_sections(statics: Statics) -> np.ndarray:
    """(2,) [m^2]: area 4 L H of the edges of axes 1 and 2 in the reference state, L that of the other axis."""
    return 4 * _half_lengths(statics)[::-1] * material(statics.problem, "half_thickness")


def _half_lengths(statics: Statics) -> np.ndarray:
    """(2,) [m]: L_1, L_2."""
    names = [entry.name for entry in statics.problem.model.PARAMETERS]
    lengths = ("half_length",) * 2 if "half_length" in names else ("half_length_1", "half_length_2")
    return np.array([material(statics.problem, name) for name in lengths])


def material(problem: Problem, name: str) -> float:
    """A parameter of the model by name.

    Raises:
        ValueError: it has none of that name.
    """
    for entry, value in zip(problem.model.PARAMETERS, problem.parameters):
        if entry.name == name:
            return float(value)
    raise ValueError(f"the model {problem.model.MODEL} has no parameter {name}, which this needs")
