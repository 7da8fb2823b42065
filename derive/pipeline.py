"""The whole road, walked once: description -> membrane -> load case -> equations -> verdicts -> kernel -> text.

Whosever a membrane is, it walks this road. `description_equations` goes as far as to the equations; a description of
a paper is checked against what that printed, any other has nothing to be checked against.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from difflib import get_close_matches

from delagrange.derive.check.record import departures, recorded
from delagrange.derive.check.verdict import Verdict
from delagrange.derive.check.verify import verify
from delagrange.derive.emit.targets import Modules, emitted
from delagrange.derive.equations.described import description_equations
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.kernel.spec import KernelSpec, Origin
from delagrange.derive.membrane.checks import check_texts
from delagrange.derive.membrane.description import Description
from delagrange.derive.membrane.strain_energy import StrainEnergy
from delagrange.derive.papers.paper import Paper, papers

_LEAKAGE = "Foo et al. (2012), J. Appl. Phys. 111, 034102"


# --- one membrane ----------------------------------------------------------------------------------


def derive_description(description: Description) -> Modules:
    """File name and text of all that is emitted for a membrane, a file of each target.

    Raises:
        ValueError: the description is not whole, or at odds with itself or with what emitted code is written with.
        DimensionError: a term of what is derived has another unit than the others.
    """
    return emitted(description_spec(description))


def description_spec(description: Description) -> KernelSpec:
    """The description of the modules of a membrane."""
    return _spec(description, description_equations(description))


def _spec(
    description: Description, eom: EquationsOfMotion, verdicts: tuple[Verdict, ...] = (), citation: str = ""
) -> KernelSpec:
    _check_defaults(description, eom)
    sources = _sources(description)
    check_texts(description, (*sources, citation), eom.quantities)
    origin = Origin(description.notation.source, citation, sources)
    return kernel(eom, verdicts, origin, description.defaults)


def _check_defaults(description: Description, eom: EquationsOfMotion) -> None:
    names = [parameter.name for parameter in eom.parameters]
    for name in description.defaults or {}:
        if name not in names:
            near = get_close_matches(name, names, n=1, cutoff=0.0)
            raise ValueError(
                f"model {description.name}: default of {name}, which is no parameter of it; nearest is {near[0]}"
            )


def _sources(description: Description) -> tuple[str, ...]:
    energies: list[StrainEnergy] = [description.equilibrium_spring]
    energies += [branch.energy for branch in description.branches]
    own = [f"{energy.name}: {energy.source}" for energy in energies if energy.source]
    leakage = [] if description.dielectric.leakage is None else [f"leakage: {_LEAKAGE}"]
    return tuple(dict.fromkeys([*own, *leakage, *description.sources]))


# --- the papers ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class CheckedPaper:
    """The membranes of a paper, and what its printed equations are beside theirs."""

    paper: Paper
    models: tuple[EquationsOfMotion, ...]  # one a description
    verdicts: tuple[Verdict, ...]

    @property
    def departures(self) -> tuple[str, ...]:
        """Where the verdicts are not as recorded, a line each; raises as `recorded`."""
        return departures(self.verdicts, recorded(self.paper))

    @property
    def modules(self) -> Modules:
        """What is emitted of it."""
        walked = zip(self.paper.descriptions, self.models, strict=True)
        specs = (self._spec(*each) for each in walked if each[0].name not in self.paper.not_emitted)
        return tuple(module for spec in specs for module in emitted(spec))

    def _spec(self, description: Description, eom: EquationsOfMotion) -> KernelSpec:
        own = tuple(verdict for verdict in self.verdicts if verdict.model == description.name)
        return _spec(description, eom, own, self.paper.citation)


@dataclass(frozen=True)
class Derivation:
    """What one walk of the road gives for the papers."""

    checked: tuple[CheckedPaper, ...]
    modules: Modules = ()

    @property
    def verdicts(self) -> tuple[Verdict, ...]:
        return tuple(verdict for each in self.checked for verdict in each.verdicts)

    @property
    def departures(self) -> tuple[str, ...]:
        """Where they are not as recorded, a line each; raises as `recorded`."""
        return tuple(line for each in self.checked for line in each.departures)


def check(of: tuple[Paper, ...] | None = None) -> Derivation:
    """Derive the membranes of some papers, of all that there are where none are given, and check what they printed."""
    return Derivation(tuple(_checked(paper) for paper in (papers() if of is None else of)))


def walk(of: tuple[Paper, ...] | None = None) -> Derivation:
    """The same, and emit the modules of the membranes."""
    found = check(of)
    return replace(found, modules=tuple(module for each in found.checked for module in each.modules))


def _checked(paper: Paper) -> CheckedPaper:
    models = tuple(description_equations(description) for description in paper.descriptions)
    return CheckedPaper(paper, models, tuple(verdict for eom in models for verdict in verify(eom, paper)))
