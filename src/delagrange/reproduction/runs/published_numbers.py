"""The numbers that Sec. III of the paper quotes, as data.

Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384. Nothing computed stands here.
"""

from __future__ import annotations

from dataclasses import dataclass

from delagrange.reproduction.runs.cases import CurveLoad


@dataclass(frozen=True)
class Peak:
    """A quoted peak of an amplitude-frequency curve."""

    figure: int
    panel: str
    load: CurveLoad
    frequency: float  # [Hz]
    amplitude: float | None  # of the stretch [1]; None where the paper says "very large"


PEAKS: tuple[Peak, ...] = (
    Peak(4, "a", CurveLoad(0.2, 1e6), 431.0, 0.05206),
    Peak(4, "a", CurveLoad(0.5, 1e6), 385.0, 0.1248),
    Peak(4, "a", CurveLoad(0.8, 1e6), 340.0, 0.2373),
    Peak(4, "b", CurveLoad(0.5, 5e6), 371.0, 0.7120),
    Peak(7, "a", CurveLoad(0.2, 1e6), 455.0, 0.07724),
    Peak(7, "a", CurveLoad(0.5, 1e6), 438.0, 0.1827),
    Peak(7, "a", CurveLoad(0.8, 1e6), 425.0, 0.3079),
    Peak(7, "b", CurveLoad(0.5, 5e6), 424.0, 0.4897),
    Peak(10, "a", CurveLoad(0.1, 3e6, 2.0), 381.0, 1.2271),
    Peak(10, "a", CurveLoad(0.3, 3e6, 2.0), 366.0, 1.2854),
    Peak(10, "a", CurveLoad(0.5, 3e6, 2.0), 351.0, 1.3139),
    Peak(10, "b", CurveLoad(0.1, 5e6, 2.0), 391.0, None),
    Peak(10, "c", CurveLoad(0.1, 3e6, 3.0), 391.0, None),
    Peak(10, "c", CurveLoad(0.1, 3e6, 4.0), 401.0, None),
)
