"""Equations as printed: verbatim LaTeX with number and source, as data.

They are one of two independent witnesses, and never read the derivation; `verify` compares the two.
"""

from __future__ import annotations

from dataclasses import dataclass

from delagrange.derive.printed.latex import Equation, SymbolTable, read_equation


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
    quantity: str  # what it states, one of `derived_equations`: "equation_of_motion_1"
    load: str  # the kind of load of the models that it speaks of: "pure_shear"
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
