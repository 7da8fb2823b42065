"""Equations as printed: verbatim LaTeX with number, source and symbol table, as data.

This is one of two independent witnesses. It never reads the derivation; `verify` compares the two.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from delagrange.derive.printed.latex import Equation, SymbolTable, read_equation

LoadCaseName = Literal["membrane", "equal_biaxial", "uniaxial", "pure_shear"]
QuantityName = Literal[
    "kinetic_energy", "potential_energy", "potential_with_reactions", "equation_of_motion_1",
    "equation_of_motion_2", "dashpot_rate_1", "dashpot_rate_2", "reaction_force",
]  # fmt: skip


@dataclass(frozen=True)
class TextRepair:
    """A glyph that the text extraction got wrong: `old` stands in the text, `new` in print."""

    old: str
    new: str
    reason: str


@dataclass(frozen=True)
class PrintedEquation:
    """One printed equation, or the note that the text lost it."""

    number: str  # "9"
    quantity: QuantityName  # what it states
    load_case: LoadCaseName  # "membrane" is the general one
    source: str  # author, year, journal, number
    latex: str | None  # verbatim from the text; None where the text lost it
    repairs: tuple[TextRepair, ...] = ()
    note: str = ""

    @property
    def reading(self) -> str:
        """The LaTeX with its repairs made.

        Raises:
            ValueError: the text lost the equation, or what a repair replaces does not stand there once.
        """
        if self.latex is None:
            raise ValueError(f"Eq. ({self.number}) is missing in the text: {self.note}")
        text = self.latex
        for repair in self.repairs:
            if (count := text.count(repair.old)) != 1:
                raise ValueError(f"Eq. ({self.number}) has {repair.old!r} {count} times; allowed is once")
            text = text.replace(repair.old, repair.new)
        return text

    def read(self, table: SymbolTable) -> Equation:
        """The tree of the equation, repairs made.

        Raises:
            LatexError: the reader does not understand it.
            ValueError: as `reading`.
        """
        return read_equation(self.reading, table, number=self.number)


@dataclass(frozen=True)
class Paper:
    """What one source printed, and what its symbols mean."""

    citation: str
    equations: tuple[PrintedEquation, ...]
    table: SymbolTable

    def __getitem__(self, number: str) -> PrintedEquation:
        for equation in self.equations:
            if equation.number == number:
                return equation
        known = ", ".join(equation.number for equation in self.equations)
        raise ValueError(f"equation {number!r} is not stored; there are {known}")

    def read(self, number: str) -> Equation:
        """The tree of one equation; raises as `PrintedEquation.read`."""
        return self[number].read(self.table)

    @property
    def readable(self) -> tuple[PrintedEquation, ...]:
        """The equations that the text has."""
        return tuple(equation for equation in self.equations if equation.latex is not None)
