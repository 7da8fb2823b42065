"""Equations of motion as an expert writes them by hand, sharing what can be shared, and numbers that count.

What does not move is prepared before (`constants`), so that only work on the moving state is counted, as
compiled kernels prepare it once a run. Forces, fields and stretches are the plain numbers of one trajectory.
"""

from __future__ import annotations

import math
from collections.abc import Mapping


class Counted:
    """A number that counts the additions, products, divisions and calls it takes part in."""

    operations = 0

    def __init__(self, value: float) -> None:
        self.value = float(value)

    def _made(self, value: float, cost: int = 1) -> Counted:
        Counted.operations += cost
        return Counted(value)

    def __add__(self, other):
        return self._made(self.value + _plain(other))

    def __sub__(self, other):
        return self._made(self.value - _plain(other))

    def __rsub__(self, other):
        return self._made(_plain(other) - self.value)

    def __mul__(self, other):
        return self._made(self.value * _plain(other))

    def __truediv__(self, other):
        return self._made(self.value / _plain(other))

    def __rtruediv__(self, other):
        return self._made(_plain(other) / self.value)

    def __pow__(self, exponent):
        if isinstance(exponent, int) and exponent > 0:
            return self._made(self.value**exponent, exponent - 1)
        return self._made(math.pow(self.value, exponent))

    __radd__, __rmul__ = __add__, __mul__


def _plain(number: Counted | float) -> float:
    return number.value if isinstance(number, Counted) else float(number)


def count(rates, *arguments) -> tuple[list[float], int]:
    """Values of a hand-written function of state, force and field, and the operations that they take."""
    state, force, field, *others = arguments
    Counted.operations = 0
    values = rates([Counted(number) for number in state], Counted(force), Counted(field), *others)
    return [_plain(value) for value in values], Counted.operations


def constants(values: Mapping[str, float]) -> dict[str, float]:
    """What is computed once a run."""
    half_length, half_thickness = values["half_length"], values["half_thickness"]
    volume = 8 * half_thickness * half_length**2
    return {
        "volume": volume,
        "edge": 2 * half_length,
        "in_plane": values["density"] * volume * half_length**2 / 3,
        "across": values["density"] * volume * half_thickness**2 / 3,
    }


def gent_uniaxial(state, force, field, values, c):
    """A Gent spring beside Gent branches, under uniaxial force: rates of l_1, l_2, their rates, inelastic stretches."""
    l1, l2, v1, v2, *inelastic = state
    i1, i2 = 1 / l1, 1 / l2
    l3 = i1 * i2
    third = l3 * l3
    maxwell = values["permittivity"] * field**2 / third
    squares = l1 * l1, l2 * l2
    coefficient = _gent(values, "alpha", squares[0] + squares[1] + third)
    stress1, stress2 = coefficient * (squares[0] - third), coefficient * (squares[1] - third)
    flow = []
    for number in range(len(inelastic) // 2):
        x1, x2 = inelastic[2 * number : 2 * number + 2]
        tail = f"beta_{number + 1}" if len(inelastic) > 2 else "beta"
        e1, e2, x12 = l1 / x1, l2 / x2, x1 * x2
        e1, e2, e3 = e1 * e1, e2 * e2, third * x12 * x12
        coefficient = _gent(values, tail, e1 + e2 + e3)
        s1, s2, s3 = coefficient * e1, coefficient * e2, coefficient * e3
        stress1, stress2 = stress1 + (s1 - s3), stress2 + (s2 - s3)
        sixth = 1 / (6 * values[tail.replace("beta", "viscosity")])
        flow += [x1 * sixth * (2 * s1 - s2 - s3), x2 * sixth * (2 * s2 - s1 - s3)]
    r1, r2 = v1 * i1, v2 * i2
    squared = c["across"] * third
    curvature = 2 * squared * (r1 * r1 + r2 * r2 + r1 * r2)
    f1 = (c["volume"] * (maxwell - stress1) + curvature) * i1 + c["edge"] * force
    f2 = (c["volume"] * (maxwell - stress2) + curvature) * i2
    m11, m22, m12 = c["in_plane"] + squared * i1 * i1, c["in_plane"] + squared * i2 * i2, squared * l3
    determinant = 1 / (m11 * m22 - m12 * m12)
    return [v1, v2, (m22 * f1 - m12 * f2) * determinant, (m11 * f2 - m12 * f1) * determinant, *flow]


def _gent(values, spring, invariant):
    """2 dW/dI_1 [Pa]"""
    modulus, locking = values[f"shear_modulus_{spring}"], values[f"locking_{spring}"]
    return modulus * locking / (locking + 3 - invariant)


def neo_hookean_uniaxial(state, force, field, values, c):
    """The paper's membrane under uniaxial force."""
    l1, l2, v1, v2, x1, x2 = state
    i1, i2 = 1 / l1, 1 / l2
    l3 = i1 * i2
    third = l3 * l3
    alpha, beta = values["shear_modulus_alpha"], values["shear_modulus_beta"]
    e1, e2, x12 = l1 / x1, l2 / x2, x1 * x2
    e1, e2, e3 = beta * e1 * e1, beta * e2 * e2, beta * third * x12 * x12
    common = values["permittivity"] * field**2 / third + alpha * third + e3
    r1, r2 = v1 * i1, v2 * i2
    squared = c["across"] * third
    curvature = 2 * squared * (r1 * r1 + r2 * r2 + r1 * r2)
    f1 = (c["volume"] * (common - alpha * l1 * l1 - e1) + curvature) * i1 + c["edge"] * force
    f2 = (c["volume"] * (common - alpha * l2 * l2 - e2) + curvature) * i2
    m11, m22, m12 = c["in_plane"] + squared * i1 * i1, c["in_plane"] + squared * i2 * i2, squared * l3
    determinant = 1 / (m11 * m22 - m12 * m12)
    sixth = 1 / (6 * values["viscosity"])
    flow = [x1 * sixth * (2 * e1 - e2 - e3), x2 * sixth * (2 * e2 - e1 - e3)]
    return [v1, v2, (m22 * f1 - m12 * f2) * determinant, (m11 * f2 - m12 * f1) * determinant, *flow]


def yeoh_equal_biaxial(state, force, field, values, c):
    """A Yeoh spring, a Kelvin-Voigt dashpot and masses on the edges, under equal forces."""
    stretch, rate = state
    square = stretch * stretch
    inverse = 1 / square
    third = inverse * inverse
    over = 2 * square + third - 3
    slope = values["yeoh_coefficient_1_alpha"] + over * (
        2 * values["yeoh_coefficient_2_alpha"] + 3 * values["yeoh_coefficient_3_alpha"] * over
    )
    elastic = 4 * slope * (square - third)
    maxwell = 2 * values["permittivity"] * field**2 * square * square
    relative = rate / stretch
    viscous = 12 * values["parallel_viscosity"] * relative
    squared = 4 * c["across"] * third * inverse
    attached = 4 * values["edge_mass"] * (0.5 * c["edge"]) ** 2
    net = (c["volume"] * (maxwell - elastic - viscous)) / stretch + 2 * c["edge"] * force
    net = net + 3 * squared * relative * rate
    return [rate, net / (2 * c["in_plane"] + attached + squared)]
