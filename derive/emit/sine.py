"""A polynomial for the sine over a quarter turn, for loops that a compiler can turn into vectors."""

from __future__ import annotations

import mpmath

_DIGITS = 60


def sine_coefficients(count: int) -> tuple[float, ...]:
    """c with sin(2 pi x) = x (c_0 + c_1 x^2 + ...) for -1/4 <= x <= 1/4, nearly minimax, rounded to doubles."""
    with mpmath.workdps(_DIGITS):
        highest_first = mpmath.chebyfit(_over_its_angle, [0, mpmath.mpf(1) / 16], count)
        return tuple(float(coefficient) for coefficient in reversed(highest_first))


def _over_its_angle(square: mpmath.mpf) -> mpmath.mpf:
    """sin(2 pi x) / x as a function of x^2."""
    angle = mpmath.sqrt(square)
    return mpmath.sin(2 * mpmath.pi * angle) / angle if angle else 2 * mpmath.pi
