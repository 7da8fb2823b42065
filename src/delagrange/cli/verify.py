"""`delagrange verify`: printed equations against what energies give, the paper's or a user's own."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

from delagrange.cli import console
from delagrange.cli.options import Given, flag_of
from delagrange.cli.results import interruptible
from delagrange.cli.verdicts import as_markdown, as_recorded, show
from delagrange.cli.verify_pasted import list_model, verify_pasted

if TYPE_CHECKING:
    from delagrange.derive.pipeline import Derivation

_CHECKED = ("equation", "equations", "symbols", "quantity", "formulation", "lateral_dashpot", "markdown")


def verify(given: Given) -> None:
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
    _check_together(given)
    derivation = None if given.model is not None else _of_the_papers(given.quiet)
    if derivation is not None:
        verdicts = derivation.verdicts
    elif given.equation or given.equations is not None:
        verdicts = verify_pasted(given)
    else:
        list_model(given)
        return
    detailed = given.model is not None if given.details is None else given.details
    show(verdicts, detailed)
    if given.markdown is not None:
        given.markdown.write_text(as_markdown(verdicts, detailed), encoding="utf-8")
        print(f"written: {given.markdown}")
    agreed = all(verdict.agrees for verdict in verdicts) if derivation is None else as_recorded(derivation)
    if not agreed:
        raise typer.Exit(1)


def _of_the_papers(quiet: bool) -> Derivation:
    with interruptible("nothing was written"), console.messages(quiet).status("deriving and checking"):
        from delagrange.derive import pipeline

        return pipeline.check()


def _check_together(given: Given) -> None:
    """Refuse options that have nothing to work on.

    Raises:
        ValueError: an option needs a model or an equation, and there is none.
    """
    options = [flag_of(name) for name in _CHECKED if given.get(name)]
    needing = [name for name in options if name != "--markdown"]
    if given.model is None and needing:
        raise ValueError(f"{', '.join(needing)} needs a MODEL: a membrane in TOML, or the name of a model")
    if "--quantity" in options and "--equation" not in options:
        raise ValueError("--quantity says what each --equation states; give one")
    pasted = "--equation" in options or "--equations" in options
    idle = [name for name in ("--symbols", "--markdown") if name in options]
    if given.model is not None and not pasted and idle:
        raise ValueError(f"{' and '.join(idle)} needs equations: give --equation or --equations")
