"""The explicit pair DOP853 as data for an emitted integrator.

Hairer, Nørsett & Wanner (1993), Solving Ordinary Differential Equations I, Sec. II.5 and II.6; the
coefficients are those that `scipy.integrate` publishes with its solver class. The NumPy engine reads them there as
well (`delagrange.engines.tableau`), with its interpolant multiplied out; neither side may import the other.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from scipy.integrate import DOP853
from sympy.integrals.quadrature import gauss_legendre

_DIGITS = 30

Row = tuple[tuple[int, float], ...]  # (stage, coefficient) of the coefficients that are not zero


@dataclass(frozen=True)
class Stage:
    """Where a stage is evaluated: time + node * step, state + step * (sum of row over the rates)."""

    number: int
    node: float
    row: Row


@dataclass(frozen=True)
class Pair:
    """Stage 0 is the rate at the start of a step, stage `last` that at its end."""

    stages: tuple[Stage, ...]  # 1 .. last
    weights: Row  # of the solution over stages 0 .. last - 1
    errors: tuple[Row, Row]  # of order 5 and 3, combined as in Sec. II.10
    extra_stages: tuple[Stage, ...]  # that only the interpolant needs
    interpolant: tuple[Row, ...]  # terms 3 .. 6 of the interpolant of Sec. II.6, over the step

    @property
    def last(self) -> int:
        """Number of the stage at the end of a step."""
        return len(self.stages)


def _row(coefficients: Iterable[float]) -> Row:
    return tuple((stage, float(c)) for stage, c in enumerate(coefficients) if c != 0)


def dop853() -> Pair:
    """The pair of order 8 with its error estimates and its interpolant of order 7."""
    inner = zip(DOP853.C[1:], DOP853.A[1:])
    stages = [*inner, (1.0, DOP853.B)]
    extra = zip(DOP853.C_EXTRA, DOP853.A_EXTRA)
    count = len(stages)
    return Pair(
        stages=tuple(Stage(number, float(c), _row(row)) for number, (c, row) in enumerate(stages, start=1)),
        weights=_row(DOP853.B),
        errors=(_row(DOP853.E5), _row(DOP853.E3)),
        extra_stages=tuple(
            Stage(number, float(c), _row(row)) for number, (c, row) in enumerate(extra, start=count + 1)
        ),
        interpolant=tuple(_row(row) for row in DOP853.D),
    )


def quadrature(count: int) -> tuple[tuple[float, float], ...]:
    """(node, weight) of Gauss and Legendre on 0 .. 1, exact to degree 2 count - 1.

    Rounded from many digits, and so the same on every machine.
    """
    nodes, weights = gauss_legendre(count, _DIGITS)
    return tuple((float((1 + node) / 2), float(weight / 2)) for node, weight in zip(nodes, weights))
