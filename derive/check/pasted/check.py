"""Equations that a user pastes, against those that her model gives.

Like `verify`, this is a place where the two witnesses meet: the derived side is read from no pasted text, and
the printed side knows of the model its symbols alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from delagrange.common.checks import did_you_mean
from delagrange.common.units import shown
from delagrange.derive.check.compare import Witness, compare, witness
from delagrange.derive.check.explain import fewest_unmatched
from delagrange.derive.check.pasted.abbreviation import substituted
from delagrange.derive.check.pasted.bounds import check_length, check_size, in_brief
from delagrange.derive.check.pasted.symbols import ModelSymbols, SymbolEntry, entries_of, symbols_of_model
from delagrange.derive.check.verdict import Verdict
from delagrange.derive.check.verify import verdict_on
from delagrange.derive.equations.derived_equations import DerivedEquation, derived_equations
from delagrange.derive.equations.described import description_equations
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.membrane.description import Description
from delagrange.derive.notation.symbols import Quantity
from delagrange.derive.printed.latex import read_equation
from delagrange.derive.printed.symbol_table import label_at
from delagrange.derive.printed.tokens import LatexError, Source, tokenize
from delagrange.derive.printed.tree import Equation, Variable, walk

# What an equation may state, in the order in which it is asked: an energy is one whatever else stands in it
_KINDS = (
    ("kinetic_energy", "potential_energy", "potential_with_reactions"), ("reaction_force",),
    ("equation_of_motion", "acceleration"), ("dashpot_rate",), ("charge_rate",), ("static_balance",),
)  # fmt: skip
_VARIED = ("equation_of_motion", "acceleration")  # of several, each is compared: all may hold an acceleration


@dataclass(frozen=True)
class PastedEquation:
    """An equation as a user gives it."""

    latex: str
    number: str = ""  # "" takes that of its \tag or, without one, its place in the list
    quantity: str | None = None  # what it states, "equation_of_motion_1"; None: found from what stands in it
    note: str = ""
    place: str = ""  # what errors begin with: "file, line 3: "


def check_equations(
    model: EquationsOfMotion | Description,
    equations: Iterable[str | PastedEquation],
    symbols: Mapping[str, object] | tuple[SymbolEntry, ...] = (),
) -> tuple[Verdict, ...]:
    r"""The verdict on each of some equations, against those of a model.

    Args:
        model: a described membrane, or equations of motion that are derived already.
        equations: LaTeX as printed, such as r"\frac{d\xi}{dt} = ...".
        symbols: what the LaTeX symbols of the source stand for, beside the model's own notation: the name of
            a quantity, or an abbreviation; {r"\mu_0": "shear_modulus_alpha", "c": {"latex": r"\mu_0/\rho"}}
            as `delagrange.derive.check.pasted.symbols` has it.

    Returns:
        A verdict an equation, in their order: equal, equal after scaling by a factor, or differs, and then
        which terms have no partner and which single edit mends it.

    Raises:
        ValueError: an equation or symbol is not understood, or states nothing that the model gives; one line.
        DimensionError: a term of a described membrane has another unit than the others.
    """
    eom = description_equations(model) if isinstance(model, Description) else model
    entries = entries_of(symbols) if isinstance(symbols, Mapping) else symbols
    subject = _Subject(eom, symbols_of_model(eom, entries))
    given = (each if isinstance(each, PastedEquation) else PastedEquation(each) for each in equations)
    return tuple(subject.verdict(each, place) for place, each in enumerate(given, start=1))


@dataclass(frozen=True)
class _Subject:
    """A model, and what has been made of it for comparing."""

    eom: EquationsOfMotion
    symbols: ModelSymbols

    @cached_property
    def derived(self) -> dict[str, DerivedEquation]:
        return dict(derived_equations(self.eom)) | _solved(self.eom)

    @cached_property
    def witnesses(self) -> dict[str, Witness]:
        return {}

    def witness(self, name: str) -> Witness:
        if name not in self.witnesses:
            equation = self.derived[name]
            self.witnesses[name] = witness(equation)
        return self.witnesses[name]

    def verdict(self, pasted: PastedEquation, place: int) -> Verdict:
        """Raises: ValueError: as `check_equations`."""
        try:
            tree = read_pasted(pasted, self.symbols, pasted.number or _tag(pasted.latex) or str(place))
            names = self.candidates(tree, pasted.quantity)
        except LatexError as error:
            raise ValueError(f"{pasted.place}{in_brief(error)}{_hint(error)}") from None
        except ValueError as error:
            raise ValueError(f"{pasted.place}{error}") from None
        name, note = self.nearest(tree, names)
        found = verdict_on(tree, self.witness(name))
        return replace(found, note="; ".join(filter(None, (found.note, note, pasted.note))))

    def candidates(self, tree: Equation, quantity: str | None) -> tuple[str, ...]:
        """What an equation may state: what is given, else what is found from the unknowns that stand in it."""
        if quantity is not None:
            return (self.named(tree, quantity),)
        present = {part.quantity for _, part in walk(tree) if isinstance(part, Variable)}
        for kind in _KINDS:
            names = [name for name in self.derived if name.startswith(kind)]
            hit = [name for name in names if self.derived[name].unknown in present]
            if hit:
                return self.varied(names, present) if kind == _VARIED else tuple(hit)
        raise ValueError(f"Eq. ({tree.number}) states nothing that {self.about}")

    def varied(self, names: list[str], present: set[Quantity]) -> tuple[str, ...]:
        """All equations of motion; solved ones only where one acceleration alone stands in what is printed."""
        accelerations = {each.acceleration for each in self.eom.load_case.coordinates} & present
        return tuple(name for name in names if len(accelerations) == 1 or not name.startswith("acceleration"))

    def named(self, tree: Equation, quantity: str) -> str:
        name = quantity.strip().replace(" ", "_").replace("-", "_")
        if name not in self.derived:
            near = did_you_mean(name, self.derived)
            raise ValueError(
                f"Eq. ({tree.number}): {shown(quantity)} is no equation of {self.eom.load_case.name}{near}; there "
                f"are {', '.join(self.derived)}"
            )
        return name

    @property
    def about(self) -> str:
        """The unknowns of the model's equations, in words for an error."""
        names: dict[Quantity, str] = {each.unknown: name for name, each in reversed(self.derived.items())}
        known = [f"{self.symbols.names[each.symbol]} ({name})" for each, name in reversed(names.items())]
        return f"{self.eom.load_case.name} has an equation for; those are about {', '.join(known)}"

    def nearest(self, tree: Equation, names: tuple[str, ...]) -> tuple[str, str]:
        """The first equation that is equal, else the one with the fewest terms without partner, with a note."""
        equal = (name for name in names if compare(tree, self.witness(name)).equal)
        if (name := next(equal, None)) is not None:
            return name, ""
        if len(names) == 1:
            return names[0], ""
        counts = {name: self.unmatched(tree, name) for name in names}
        nearest = min(names, key=counts.__getitem__)
        words = ", ".join(name.replace("_", " ") for name in names)
        return nearest, f"the nearest of {words}: the fewest terms without partner"

    def unmatched(self, tree: Equation, name: str) -> int:
        from_derivation, from_print = fewest_unmatched(tree, self.derived[name])
        return len(from_derivation) + len(from_print)


def _solved(eom: EquationsOfMotion) -> dict[str, DerivedEquation]:
    """Of two coordinates, the equations of motion solved for each acceleration: a paper may print them so."""
    coordinates = eom.load_case.coordinates
    if len(coordinates) == 1:
        return {}
    return {
        f"acceleration_{number}": DerivedEquation(
            eom.load_case.name, f"acceleration_{number}", each.acceleration,
            each.acceleration.symbol - solved, eom.quantities, eom.validity,
        )
        for number, (each, solved) in enumerate(zip(coordinates, eom.acceleration, strict=True), start=1)
    }  # fmt: skip


def read_pasted(pasted: PastedEquation, symbols: ModelSymbols, number: str) -> Equation:
    """The tree of a pasted equation, abbreviations written out.

    Raises:
        LatexError: it is not understood, or larger than what a person prints.
    """
    check_length(pasted.latex, number)
    read = read_equation(pasted.latex, symbols.table, number=number)
    tree = substituted(read, symbols.abbreviations, symbols.table)
    check_size(tree)
    return tree


def _tag(latex: str) -> str:
    r"""The number of a `\tag`, "" without one."""
    at = latex.rfind(r"\tag")
    if at < 0 or len(latex) - at > 60:
        return ""
    tokens = tokenize(Source("", latex[at:].replace("$", "")))
    return label_at(tokens, 1) if len(tokens) > 1 else ""


def _hint(error: LatexError) -> str:
    if not error.expected.startswith("a symbol of the table"):
        return ""
    return "; a table of symbols says what the symbols of a source stand for"
