"""The electrical side of a membrane: its energy, what its electrodes carry, and what leaks between them.

Field and charge are conjugate by the energy. The leakage obeys Ohm's law in the deformed membrane, beside the
dielectric that holds the charge, as in Foo, Cai, Koh, Bauer and Suo (2012), J. Appl. Phys. 111, 034102,
doi:10.1063/1.3680878.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import sympy as sp

from delagrange.derive.membrane.description import CHARGE, Dielectric
from delagrange.derive.membrane.strain_energy import Stretches
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import Quantity


@dataclass(frozen=True)
class Electrodes:
    """Nominal electric field and nominal charge density, one of them given and the other its conjugate."""

    field: sp.Expr  # [V/m], voltage over the thickness in the reference state
    charge: sp.Expr  # [C/m^2], charge over the area of an electrode in the reference state

    def mapped(self, change: Callable[[sp.Expr], sp.Expr]) -> Electrodes:
        """The same with both expressions changed."""
        return Electrodes(change(self.field), change(self.charge))


@dataclass(frozen=True)
class ChargeBalance:
    """Of electrodes that a current feeds, over their area in the reference state: dD/dt = j - leakage current."""

    leakage_current: sp.Expr  # nominal density [A/m^2]
    source_density: sp.Expr  # power that the source puts in, by volume of the reference body [W/m^3]
    leakage_density: sp.Expr  # power that the leakage dissipates, likewise [W/m^3]
    charge: Quantity = m.CHARGE_DENSITY  # D, part of the state
    rate: Quantity = m.CHARGE_RATE  # dD/dt
    source: Quantity = m.CURRENT_DENSITY  # j, an input

    @property
    def law(self) -> sp.Expr:
        """dD/dt [A/m^2]."""
        return self.source.symbol - self.leakage_current

    def mapped(self, change: Callable[[sp.Expr], sp.Expr]) -> ChargeBalance:
        """The same with all expressions changed."""
        return replace(
            self,
            leakage_current=change(self.leakage_current),
            source_density=change(self.source_density),
            leakage_density=change(self.leakage_density),
        )


def input_of(dielectric: Dielectric) -> Quantity:
    """What drives the electrodes: a field, a charge or, where that leaks, a current."""
    if dielectric.control != CHARGE:
        return s.FIELD
    return m.CHARGE_DENSITY if dielectric.leakage is None else m.CURRENT_DENSITY


def electrostatic_energy_density(stretches: Stretches, dielectric: Dielectric) -> sp.Expr:
    """Electrostatic energy [J/m^3] by what drives the electrodes.

    Under voltage control with the source's work, -epsilon E^2/2 of the field in the deformed thickness; under
    charge control D^2/(2 epsilon), with the charge spread over the deformed area.
    """
    permittivity = dielectric.permittivity.of_stretches(stretches)
    if dielectric.control == CHARGE:
        return (m.CHARGE_DENSITY.symbol * stretches[2]) ** 2 / (2 * permittivity)
    true_field = s.FIELD.symbol / stretches[2]
    return -permittivity / 2 * true_field**2


def electrodes(stretches: Stretches, dielectric: Dielectric) -> Electrodes:
    """Field and charge by the slope of the electrostatic energy; with the source's work in it, by minus that."""
    density = electrostatic_energy_density(stretches, dielectric)
    field, charge = s.FIELD.symbol, m.CHARGE_DENSITY.symbol
    if dielectric.control == CHARGE:
        return Electrodes(density.diff(charge), charge)
    return Electrodes(field, -density.diff(field))


def charge_balance(stretches: Stretches, dielectric: Dielectric) -> ChargeBalance | None:
    """Ohm's law in the deformed membrane; None where nothing leaks.

    The true current density is the conductivity times the true field, which is the voltage over the deformed
    thickness, and flows through the deformed area.
    """
    if dielectric.leakage is None:
        return None
    nominal_field = electrodes(stretches, dielectric).field
    true_field = nominal_field / stretches[2]
    true_current = dielectric.leakage.symbol * true_field
    return ChargeBalance(
        leakage_current=true_current * (stretches[0] * stretches[1]),
        source_density=m.CURRENT_DENSITY.symbol * nominal_field,
        leakage_density=true_current * true_field * sp.Mul(*stretches),
    )
