"""A paper: what it printed, the membranes that it speaks of, and where both stand.

A paper is a package in this folder with a module `paper` that has it as `PAPER`; nothing else has to know of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from delagrange.derive.membrane.description import Description
from delagrange.derive.papers.printed_equation import PrintedEquation
from delagrange.derive.printed.latex import Equation, SymbolTable

_HERE = "delagrange.derive.papers"


@dataclass(frozen=True)
class Paper:
    """What one source printed, what its symbols mean, and which membranes its equations are checked against."""

    citation: str
    equations: tuple[PrintedEquation, ...]
    table: SymbolTable
    descriptions: tuple[Description, ...]
    folder: Path  # where its verdicts are recorded
    not_emitted: tuple[str, ...] = ()  # names of descriptions that only the check needs

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

    def description(self, model: str) -> Description:
        """The membrane of a name.

        Raises:
            ValueError: there is none.
        """
        for each in self.descriptions:
            if each.name == model:
                return each
        known = ", ".join(each.name for each in self.descriptions)
        raise ValueError(f"model {model!r} is none of {self.citation}; there are {known}")


def papers(package: str = _HERE) -> tuple[Paper, ...]:
    """The papers that stand in a package, each a package of its own, in the order of their names."""
    folders = sorted(each.name for each in iter_modules(import_module(package).__path__) if each.ispkg)
    return tuple(import_module(f"{package}.{name}.paper").PAPER for name in folders)
