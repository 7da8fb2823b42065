"""`delagrange verify`: printed equations against what energies give, the paper's or a user's own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from delagrange.cli import console
from delagrange.cli import options as o
from delagrange.cli.interruption import interruptible
from delagrange.cli.verdicts import as_markdown, show
from delagrange.cli.verify_pasted import list_model, verify_pasted
from delagrange.common.files import check_file

if TYPE_CHECKING:
    from delagrange.derive.check.verdict import Verdict

_DETAILS = "Show terms without partner, corrections, faulty units and notes as well."
Details = Annotated[bool, typer.Option("--details/--brief", help=_DETAILS)]
DetailsOrNot = Annotated[
    bool | None,
    typer.Option("--details/--brief", help=_DETAILS, show_default="details of equations of your own"),
]
Markdown = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write the table as Markdown, too.", show_default=False)
]
_PASTED = "Equations of your own"
Model = Annotated[
    str | None,
    typer.Argument(
        metavar="[MODEL]",
        help="What to check against: a membrane described in TOML, or equal-biaxial, uniaxial, pure-shear, biaxial.",
        show_default="the paper's models and equations",
    ),
]
Equation = Annotated[
    list[str] | None,
    typer.Option(
        metavar="LATEX",
        help="An equation as printed; may be repeated.",
        rich_help_panel=_PASTED,
        show_default=False,
    ),
]
Equations = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Several: TOML with \\[\\[equation]] tables of number and latex, or text with one a line.",
        rich_help_panel=_PASTED,
        show_default=False,
    ),
]
Symbols = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="TOML whose table \\[symbols] says what the LaTeX symbols stand for.",
        rich_help_panel=_PASTED,
        show_default="the model's own",
    ),
]
Quantity = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        help="What each --equation states, such as equation_of_motion_1.",
        rich_help_panel=_PASTED,
        show_default="found from what stands in it",
    ),
]


def verify(
    model: Model = None,
    equation: Equation = None,
    equations: Equations = None,
    symbols: Symbols = None,
    quantity: Quantity = None,
    formulation: o.Formulation = None,
    lateral_dashpot: o.LateralDashpot = None,
    details: DetailsOrNot = None,
    markdown: Markdown = None,
    quiet: o.Quiet = False,
) -> None:
    r"""Derive all equations and check each printed one against them.

    The Lagrange function l = T - Π is put together from the energies of the
    paper's membrane; the Euler-Lagrange equation and the dashpot law give what
    Eqs. (4)-(22) ought to say. The verdict on each printed equation is 'equal',
    'equal after scaling' by a nonzero factor, 'differs' (yellow where one edit
    of the print mends it), or 'missing in the text'. Each is proved symbolically
    and confirmed at random points in high precision. Takes some seconds.

    With a MODEL, equations of your own against that model; without equations,
    its symbols and its equations in LaTeX, to copy from. What an equation states
    is found from the unknown that stands in it: an acceleration, d xi/dt, T, Π, a
    reaction, else a force at rest. It is read as text, never run.

    Exit code 1 where a verdict is not the recorded one or, of your own
    equations, one differs.

    [bold]Examples[/]

      delagrange verify
      delagrange verify --details --markdown verdicts.md
      delagrange verify my_membrane.toml
      delagrange verify equal-biaxial --equation \
          'T = \frac{8}{3} \rho L^2 H (L^2 + 2 H^2 \lambda^{-6}) \dot{\lambda}^2'
      delagrange verify my_membrane.toml --equations eqs.toml --symbols table.toml
    """
    _check_together(model, {
        "--equation": equation, "--equations": equations, "--symbols": symbols, "--quantity": quantity,
        "--formulation": formulation, "--lateral-dashpot": lateral_dashpot, "--markdown": markdown,
    })  # fmt: skip
    if markdown is not None:
        check_file(markdown)
    if model is None:
        verdicts = _of_the_paper(quiet)
    elif equation or equations is not None:
        given = (equation or [], equations, symbols, quantity)
        verdicts = verify_pasted(model, formulation, lateral_dashpot, *given, quiet)
    else:
        list_model(model, formulation, lateral_dashpot, quiet)
        return
    detailed = model is not None if details is None else details
    show(verdicts, detailed)
    if markdown is not None:
        markdown.write_text(as_markdown(verdicts, detailed), encoding="utf-8")
        print(f"written: {markdown}")
    if not (as_recorded(verdicts) if model is None else all(verdict.agrees for verdict in verdicts)):
        raise typer.Exit(1)


def _of_the_paper(quiet: bool) -> tuple[Verdict, ...]:
    with interruptible("nothing was written"), console.messages(quiet).status("deriving and checking"):
        from delagrange.derive import pipeline

        return pipeline.check()


def _check_together(model: str | None, given: dict[str, object]) -> None:
    """Refuse options that have nothing to work on.

    Raises:
        ValueError: an option needs a model or an equation, and there is none.
    """
    options = [name for name, value in given.items() if value]
    needing = [name for name in options if name != "--markdown"]
    if model is None and needing:
        raise ValueError(f"{', '.join(needing)} needs a MODEL: a membrane in TOML, or the name of a model")
    if "--quantity" in options and "--equation" not in options:
        raise ValueError("--quantity says what each --equation states; give one")
    pasted = "--equation" in options or "--equations" in options
    idle = [name for name in ("--symbols", "--markdown") if name in options]
    if model is not None and not pasted and idle:
        raise ValueError(f"{' and '.join(idle)} needs equations: give --equation or --equations")


def as_recorded(verdicts: tuple[Verdict, ...]) -> bool:
    """Whether all verdicts are the recorded ones; those that are not are named on standard error."""
    from delagrange.derive.check.record import departures, recorded

    lines = departures(verdicts, recorded())
    for line in lines:
        console.complain(f"not as recorded: {line}")
    if not lines:
        console.output().print("[green]all as recorded[/]")
    return not lines
