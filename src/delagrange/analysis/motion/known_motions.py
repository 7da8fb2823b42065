"""Motions whose kind is known beyond doubt: what a test of the kind of a motion is tested with.

How the chaotic one was found: the membrane of Sheng et al. (2015) was run from rest under some 2700 random
loads, and the tangent was followed for a second or two. Under a field alone, chaos comes with motions so large
that most of them pull in sooner or later; of 872 runs with short relaxation times under sinusoidal fields, with
and without a bias, none was chaotic. Under a sinusoidal force there is nothing to pull in: of 245 damped runs 20
were chaotic. The one kept has round numbers, is pulled all the time (the force goes from 0 to 0.5 N), and loses
its memory in a hundredth of a second. Its two largest Lyapunov exponents, about 52 and 15 per second, are
positive. In 20 s the stretches stay below 6.5, and the same attractor is reached from any phase of the force.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

from delagrange.analysis.motion.verdict import CHAOTIC, PERIODIC, QUASI_PERIODIC
from delagrange.drives.drive import Sine
from delagrange.problem.dashpots import EVOLVING, FROZEN


@dataclass(frozen=True)
class KnownMotion:
    """A membrane of Sheng et al. (2015) under a load, and the kind of its motion."""

    kind: str
    model: str
    force: Sine | float  # [N]
    field: Sine | float = 0.0  # [V/m]
    dashpots: str = FROZEN
    material: Mapping[str, float] = dataclasses.field(default_factory=dict)  # unlike the paper, SI units

    def arguments(self) -> dict[str, object]:
        """What `delagrange.classify` is to be given."""
        drives = {"force": self.force, "field": self.field}
        return {"model": self.model, **drives, "dashpots": self.dashpots, **self.material}


CHAOTIC_MEMBRANE = KnownMotion(
    CHAOTIC, "uniaxial", Sine(0.25, 490.0, bias=0.25), 0.0, EVOLVING, {"relaxation_time": 0.01}
)
PERIODIC_MEMBRANE = KnownMotion(
    PERIODIC, "equal_biaxial", 0.5, Sine(3e6, 371.0), EVOLVING, {"relaxation_time": 0.01}
)
QUASI_PERIODIC_MEMBRANE = KnownMotion(QUASI_PERIODIC, "equal_biaxial", 0.5, Sine(5e6, 185.0))
