"""The potential of a membrane as an ordered list of named parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import sympy as sp


@dataclass(frozen=True)
class EnergyPart:
    """One part of the potential, and what its force is the force of."""

    name: str  # "spring_alpha"
    meaning: str  # of what pulls, "spring α"
    expression: sp.Expr  # [J]


@dataclass(frozen=True)
class Energies:
    """The parts of the potential [J], in the order in which emitted code lists them."""

    parts: tuple[EnergyPart, ...]

    @property
    def total(self) -> sp.Expr:
        return sp.Add(*(part.expression for part in self.parts))

    def __getitem__(self, name: str) -> sp.Expr:
        """The part of that name [J].

        Raises:
            KeyError: there is none.
        """
        return {part.name: part.expression for part in self.parts}[name]

    def mapped(self, change: Callable[[str, sp.Expr], sp.Expr]) -> Energies:
        """The same parts with their expressions changed, from name and expression."""
        return Energies(
            tuple(replace(part, expression=change(part.name, part.expression)) for part in self.parts)
        )

    def with_part(self, name: str, expression: sp.Expr) -> Energies:
        """The same parts, one of them replaced."""
        return self.mapped(lambda own, old: expression if own == name else old)
