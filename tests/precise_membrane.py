"""The energies of the membrane written once more, for mpmath, as a witness of what is derived from them."""

from __future__ import annotations

from dataclasses import dataclass

import mpmath as mp

import delagrange as dl

P = dl.SHENG_2015


@dataclass(frozen=True)
class PreciseMembrane:
    """A membrane under force [N] on axis 1 and field [V/m], dashpots at `inelastic` stretches; None: relaxed.

    With axis 2 held, pass `held`: the only coordinate is then the first stretch.
    """

    force: float
    field: float
    inelastic: tuple[float, float] | None = (1.0, 1.0)
    held: float | None = None

    @property
    def volume(self):
        return 8 * mp.mpf(P.half_thickness) * mp.mpf(P.half_length) ** 2

    def stretches(self, coordinates):
        one, two = coordinates if self.held is None else (coordinates[0], mp.mpf(self.held))
        return one, two, 1 / (one * two)

    def potential(self, *coordinates):
        """Potential energy [J]; relaxed dashpots carry nothing."""
        one, two, three = self.stretches(coordinates)
        density = mp.mpf(P.shear_modulus_alpha) / 2 * (one**2 + two**2 + three**2 - 3)
        if self.inelastic is not None:
            x1, x2 = (mp.mpf(value) for value in self.inelastic)
            elastic = (one / x1) ** 2 + (two / x2) ** 2 + (x1 * x2 * three) ** 2 - 3
            density += mp.mpf(P.shear_modulus_beta) / 2 * elastic
        density -= mp.mpf(P.permittivity) * mp.mpf(self.field) ** 2 / 2 * (one * two) ** 2
        return density * self.volume - 2 * mp.mpf(P.half_length) * mp.mpf(self.force) * one

    def derivative(self, coordinates, *orders):
        return mp.diff(self.potential, tuple(coordinates), tuple(orders))

    def rest(self, *guess):
        """The equilibrium near a guess, by mpmath's Newton."""
        if len(guess) == 1:
            return [mp.findroot(lambda q: self.derivative((q,), 1), mp.mpf(guess[0]))]
        found = mp.findroot(
            lambda a, b: [self.derivative((a, b), 1, 0), self.derivative((a, b), 0, 1)],
            tuple(map(mp.mpf, guess)),
        )
        return list(found)

    def frequencies(self, coordinates):
        """Natural frequencies [Hz], ascending, with frozen dashpots."""
        count = len(coordinates)
        one, two, three = self.stretches(coordinates)
        slopes = [-three / one, -three / two][:count]
        factor = mp.mpf(P.density) * self.volume / 3
        length, thickness = mp.mpf(P.half_length), mp.mpf(P.half_thickness)
        mass, stiffness = mp.matrix(count), mp.matrix(count)
        for i in range(count):
            for j in range(count):
                mass[i, j] = factor * (length**2 * (i == j) + thickness**2 * slopes[i] * slopes[j])
                orders = [int(k == i) + int(k == j) for k in range(count)]
                stiffness[i, j] = self.derivative(coordinates, *orders)
        squares = mp.eig(mp.inverse(mass) * stiffness)[0]
        return sorted(mp.sqrt(mp.re(square)) / (2 * mp.pi) for square in squares)
