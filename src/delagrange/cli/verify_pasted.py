"""`delagrange verify MODEL`: a user's equations against a model, or the model's own to copy from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

from delagrange.cli import console
from delagrange.cli.options import Given
from delagrange.cli.results import interruptible
from delagrange.model.load import is_path, load_model

if TYPE_CHECKING:
    from delagrange.derive.check.verdict import Verdict
    from delagrange.derive.equations.euler_lagrange import EquationsOfMotion


def verify_pasted(given: Given) -> tuple[Verdict, ...]:
    """The verdicts on equations as pasted and those of a file; all is read before anything is derived.

    Raises:
        ValueError: a model, a file, an equation or a symbol is not understood.
    """
    from delagrange.derive.check.pasted.check import PastedEquation, check_equations
    from delagrange.derive.check.pasted.file import PastedFile, read_equations, read_symbols

    found = PastedFile(()) if given.equations is None else read_equations(given.equations)
    entries = found.symbols + (() if given.symbols is None else read_symbols(given.symbols))
    pasted = [PastedEquation(latex, quantity=given.quantity) for latex in given.equation or ()]
    equations = (*pasted, *found.equations)
    eom = _equations_of(given)
    with interruptible("nothing was written"), console.messages(given.quiet).status("checking"):
        return check_equations(eom, equations, entries)


def list_model(given: Given) -> None:
    """Print the symbols and the equations of a model; raises as `verify_pasted`."""
    from delagrange.derive.check.pasted.listing import listed_equations, listed_symbols

    eom = _equations_of(given)
    table = console.table("symbol", "quantity", "unit", "meaning")
    for each in listed_symbols(eom):
        quantity = each.quantity
        table.add_row(Text(each.latex), quantity.name, Text(quantity.unit), Text(quantity.meaning))
    console.show(f"Symbols of {eom.load_case.name}", table)
    console.output().print(Text(f"\nEquations of {eom.load_case.name}", style="bold"))
    for equation in listed_equations(eom):
        print(f"\n{equation.quantity}:\n  {equation.latex}")


def _equations_of(given: Given) -> EquationsOfMotion:
    model = given.model
    with interruptible("nothing was written"), console.messages(given.quiet).status(f"deriving {model}"):
        if model.endswith(".toml"):
            if given.some("formulation", "lateral_dashpot"):
                raise ValueError(
                    f"--formulation and --lateral-dashpot choose a built-in model; {model} says its own"
                )
            return _described(Path(model))
        return _built_in(model, given.formulation, given.lateral_dashpot)


def _described(path: Path) -> EquationsOfMotion:
    from delagrange.derive.equations.described import description_equations
    from delagrange.derive.model_file.file import read_model_file

    description = read_model_file(path)
    try:
        return description_equations(description)
    except ValueError as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from error


def _built_in(model: str, formulation: str | None, lateral_dashpot: str | None) -> EquationsOfMotion:
    """A model by the name that all commands know; `biaxial`, which has no module, is the membrane of two forces."""
    from delagrange.derive.equations.described import description_equations
    from delagrange.derive.papers.paper import papers

    name = model.replace("-", "_")
    without_module = [each for paper in papers() for each in paper.not_emitted]
    if name not in without_module:
        if is_path(model):
            raise ValueError(
                f"model {model}: a module holds code, not its derivation; give the membrane in TOML (.toml) that "
                "it was derived from"
            )
        name = load_model(model, formulation, lateral_dashpot).MODEL
    elif formulation is not None or lateral_dashpot is not None:
        raise ValueError(f"{name} has one formulation: leave --formulation and --lateral-dashpot out")
    descriptions = {each.name: each for paper in papers() for each in paper.descriptions}
    return description_equations(descriptions[name])
