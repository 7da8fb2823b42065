"""How the inelastic stretches that a load case lets move flow, and what their dashpots lose."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from delagrange.derive.membrane.constraint import Substitution, constrain, tidy
from delagrange.derive.membrane.dissipation import RayleighTerm
from delagrange.derive.membrane.load_case import LoadCase
from delagrange.derive.membrane.membrane import Membrane
from delagrange.derive.notation.symbols import Quantity, TimeDependent
from delagrange.derive.notation.time_derivative import time_derivative


@dataclass(frozen=True)
class DashpotLoss:
    """What a branch's dashpot loses: deviatoric stresses [Pa] times strain rates [1/s], a volume.

    A dashpot that flows has its deviatoric stress over 2 eta as its strain rate, one whose inelastic stretch
    is held has none; what is left follows from incompressibility.
    """

    viscosity: Quantity
    deviators: tuple[sp.Expr, ...]  # along all three axes
    flowing: tuple[bool, ...]  # along the axes of the body's coordinates

    def strain_rates(self, deviators: tuple[sp.Expr, ...]) -> tuple[sp.Expr, ...]:
        """Strain rates in terms of deviatoric stresses, given as expressions or as names."""
        flow = tuple(deviator / (2 * self.viscosity.symbol) for deviator in deviators)
        if all(self.flowing):
            return flow
        own = [rate if moves else sp.S.Zero for rate, moves in zip(flow, self.flowing, strict=False)]
        rest = len(flow) - len(own)
        return (*own, *[-sp.Add(*own) / rest] * rest)

    @property
    def power_density(self) -> sp.Expr:
        """Power lost in a volume of the body [W/m^3]."""
        pairs = zip(self.deviators, self.strain_rates(self.deviators), strict=True)
        return sp.Add(*(deviator * rate for deviator, rate in pairs))


@dataclass(frozen=True)
class Dissipation:
    """All that dissipates under a load case."""

    dashpots: tuple[DashpotLoss, ...]  # one a branch
    rayleigh: tuple[RayleighTerm, ...]  # in the coordinates of the load case

    def power(self, volume: sp.Expr) -> sp.Expr:
        """What is lost [W]: in the dashpots, and twice every Rayleigh dissipation function."""
        return sp.Add(
            *(volume * dashpot.power_density for dashpot in self.dashpots),
            *(2 * term.function for term in self.rayleigh),
        )


def dissipation(model: Membrane, load_case: LoadCase, substitution: Substitution) -> Dissipation:
    """What the membrane loses under a load case."""
    internals = {internal.value.symbol for internal in load_case.internals}
    inelastic, axes = load_case.inelastic_stretches, len(model.coordinates)
    losses = []
    for number, each in enumerate(model.dashpots):
        deviators = tuple(tidy(constrain(deviator, substitution)) for deviator in each.deviators)
        own = inelastic[number * axes : (number + 1) * axes]
        flowing = tuple(bool(xi.free_symbols & internals) for xi in own)
        losses.append(DashpotLoss(each.viscosity, deviators, flowing))
    rayleigh = (
        replace(term, function=tidy(constrain(term.function, substitution))) for term in model.rayleigh
    )
    return Dissipation(tuple(losses), tuple(rayleigh))


def _equal(left: sp.Expr, right: sp.Expr) -> bool:
    return tidy(left - right) == 0 or sp.simplify(left - right) == 0


def internal_rates(model: Membrane, load_case: LoadCase, substitution: Substitution) -> tuple[sp.Expr, ...]:
    """Flow of the inelastic stretches that the load case lets move [1/s], Eqs. (5)-(6).

    Raises:
        ValueError: the dashpots of two axes ask for different rates of one inelastic stretch, or one has
            no rate at all.
    """
    laws = [tidy(constrain(rate, substitution)) for rate in model.dashpot_rates]
    rates = tuple(_rate_of(internal, laws, load_case) for internal in load_case.internals)
    flow = {internal.rate.symbol: rate for internal, rate in zip(load_case.internals, rates, strict=True)}
    for law, xi in zip(laws, load_case.inelastic_stretches, strict=True):
        moving = [internal for internal in load_case.internals if xi.has(internal.value.symbol)]
        if moving and not _equal(time_derivative(xi, load_case.internals).subs(flow), law):
            raise ValueError(
                f"load case {load_case.name}: {moving[0].value.name} has two different dashpot rates"
            )
    return rates


def _rate_of(internal: TimeDependent, laws: list[sp.Expr], load_case: LoadCase) -> sp.Expr:
    """From the first axis whose inelastic stretch it alone determines, by the chain rule."""
    others = {other.value.symbol for other in load_case.internals} - {internal.value.symbol}
    for law, xi in zip(laws, load_case.inelastic_stretches, strict=True):
        slope = xi.diff(internal.value.symbol)
        if slope != 0 and not xi.free_symbols & others:
            return tidy(law / slope)
    raise ValueError(f"load case {load_case.name}: {internal.value.name} has no dashpot rate of its own")
