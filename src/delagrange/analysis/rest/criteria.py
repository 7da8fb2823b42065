"""Limits that an equilibrium may pass though it is stable: loss of tension and electrical breakdown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from delagrange import checks
from delagrange.analysis.rest.statics import FIELD, Statics, input_place
from delagrange.problem import Problem

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
    place = input_place(statics.problem, FIELD)
    return statics.arguments(x)[1][place] / thickness_stretch(statics, x)


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
    smallest = criteria.smallest_tension * cross_section(statics)
    return float(np.min(edge_forces(statics, x)) - smallest) + negligible_force(statics, x)


def negligible_force(statics: Statics, x: np.ndarray) -> float:
    """Force [N] that counts as none, beside those of springs and field that balance there."""
    without = x.copy()
    without[-1] = 0.0
    electric = np.max(np.abs(edge_forces(statics, x) - edge_forces(statics, without)))
    return _NEGLIGIBLE * (statics.typical_force + float(electric))


def cross_section(statics: Statics) -> float:
    """Area 4 L H of an edge in the reference state [m^2]."""
    return 4 * material(statics.problem, "half_length") * material(statics.problem, "half_thickness")


def material(problem: Problem, name: str) -> float:
    """A parameter of the model by name.

    Raises:
        ValueError: it has none of that name.
    """
    for entry, value in zip(problem.model.PARAMETERS, problem.parameters):
        if entry.name == name:
            return float(value)
    raise ValueError(f"the model {problem.model.MODEL} has no parameter {name}, which this needs")
