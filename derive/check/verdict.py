"""What the check of one printed equation found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import sympy as sp


class Outcome(StrEnum):
    EQUAL = "equal"
    SCALED = "equal after scaling"
    DIFFERS = "differs"
    MISSING = "missing in the text"


@dataclass(frozen=True)
class Verdict:
    """The verdict on one printed equation against one derivation.

    `factor` is what the derived equation is multiplied by to become the printed one. Derived terms
    are text in the notation of the paper, printed ones LaTeX; each correction is one edit of the
    printed equation that makes it equal. `derived` is the derived right side where the text lost
    the printed one.
    """

    number: str  # as printed, e.g. "21"
    model: str  # the derivation it was checked against, e.g. "pure_shear_as_printed"
    quantity: str  # what the equation gives, e.g. "equation_of_motion_1"
    outcome: Outcome
    factor: sp.Expr = sp.S.One
    factor_text: str = "1"  # the same in the notation of the model
    derived_unmatched: tuple[str, ...] = ()
    printed_unmatched: tuple[str, ...] = ()
    corrections: tuple[str, ...] = ()
    unit_faults: tuple[str, ...] = ()
    derived: str = ""
    note: str = ""

    @property
    def agrees(self) -> bool:
        return self.outcome in (Outcome.EQUAL, Outcome.SCALED)
