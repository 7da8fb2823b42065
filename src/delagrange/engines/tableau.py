"""Embedded Runge-Kutta pairs as data, with their interpolants as polynomials in the step's fraction.

DOP853: Hairer, Nørsett & Wanner (1993), Solving Ordinary Differential Equations I, Sec. II.5, II.6.
RK45: Dormand & Prince (1980), J. Comput. Appl. Math. 6, 19, with the interpolant of Shampine (1986),
Math. Comp. 46, 135. The coefficients are those that `scipy.integrate` publishes with its solver classes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import Polynomial

Row = tuple[tuple[int, float], ...]  # (stage, coefficient) of the coefficients that are not zero


@dataclass(frozen=True)
class Tableau:
    """One explicit pair whose last stage is the first of the next step.

    Stages are numbered 0 to `stage_count` (the rate at the end of the step) and on over the extra
    stages that only the interpolant needs. The interpolant is
    y(x) = y_0 + h sum_j K_j sum_p interpolant[p][j] x^(p+1), 0 <= x <= 1.
    """

    name: str
    error_order: int  # order of the embedded solution that the error is estimated with
    nodes: tuple[float, ...]  # of stages 0 .. stage_count - 1
    coupling: tuple[Row, ...]
    weights: Row
    errors: tuple[Row, ...]  # one estimate, or two that DOP853 combines
    extra_nodes: tuple[float, ...]
    extra_coupling: tuple[Row, ...]
    interpolant: tuple[Row, ...]  # one row for each power of x, from 1

    @property
    def stage_count(self) -> int:
        """Stages of a step, without the one shared with the next step."""
        return len(self.nodes)

    @property
    def total_stages(self) -> int:
        """All stages, those of the interpolant included."""
        return self.stage_count + 1 + len(self.extra_nodes)


@cache
def tableau(name: str) -> Tableau:
    """The pair "DOP853", "RK45", or "RK45_MATLAB" (the same pair with the interpolant of MATLAB's `ode45`).

    Raises:
        KeyError: another name.
    """
    return {"DOP853": _dop853, "RK45": _rk45, "RK45_MATLAB": _rk45_matlab}[name]()


def _rows(matrix: np.ndarray) -> tuple[Row, ...]:
    return tuple(tuple((j, float(c)) for j, c in enumerate(row) if c != 0) for row in np.atleast_2d(matrix))


def _dop853() -> Tableau:
    from scipy.integrate import DOP853  # takes half a second, which an engine with its own pair need not wait

    return Tableau(
        name="DOP853",
        error_order=7,
        nodes=tuple(map(float, DOP853.C)),
        coupling=_rows(DOP853.A),
        weights=_rows(DOP853.B)[0],
        errors=_rows(np.array([DOP853.E5, DOP853.E3])),
        extra_nodes=tuple(map(float, DOP853.C_EXTRA)),
        extra_coupling=_rows(DOP853.A_EXTRA),
        interpolant=_rows(_dop853_interpolant().T),
    )


def _dop853_interpolant() -> np.ndarray:
    """(16, 7): the nested form of Hairer et al., Sec. II.6, multiplied out.

    y(x) - y_0 = x (F_0 + (1-x) (F_1 + x (F_2 + (1-x) (F_3 + ... )))), F linear in h K.
    """
    from scipy.integrate import DOP853

    stages, last = len(DOP853.D[0]), DOP853.n_stages
    increment = np.zeros(stages)
    increment[:last] = DOP853.B
    first, final = np.eye(stages)[0], np.eye(stages)[last]
    rows = [increment, first - increment, 2 * increment - final - first, *DOP853.D]
    interpolant, basis = np.zeros((stages, len(rows))), Polynomial([1.0])
    for power, row in enumerate(rows):
        basis = basis * (Polynomial([0.0, 1.0]) if power % 2 == 0 else Polynomial([1.0, -1.0]))
        interpolant[:, : power + 1] += np.outer(row, basis.coef[1:])
    return interpolant


def _rk45(interpolant: np.ndarray | None = None, name: str = "RK45") -> Tableau:
    from scipy.integrate import RK45

    return Tableau(
        name=name,
        error_order=4,
        nodes=tuple(map(float, RK45.C)),
        coupling=_rows(RK45.A),
        weights=_rows(RK45.B)[0],
        errors=_rows(RK45.E),
        extra_nodes=(),
        extra_coupling=(),
        interpolant=_rows((RK45.P if interpolant is None else interpolant).T),
    )


def _rk45_matlab() -> Tableau:
    """Interpolant of `ode45`: Shampine & Reichelt (1997), SIAM J. Sci. Comput. 18, 1."""
    interpolant = np.array(
        [
            [1, -183 / 64, 37 / 12, -145 / 128],
            [0, 0, 0, 0],
            [0, 1500 / 371, -1000 / 159, 1000 / 371],
            [0, -125 / 32, 125 / 12, -375 / 64],
            [0, 9477 / 3392, -729 / 106, 25515 / 6784],
            [0, -11 / 7, 11 / 3, -55 / 28],
            [0, 3 / 2, -4, 5 / 2],
        ]
    )
    return _rk45(interpolant, "RK45_MATLAB")
