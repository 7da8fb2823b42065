"""`delagrange verify`: what the paper prints against what its energies give."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from delagrange.cli import console
from delagrange.cli import options as o
from delagrange.cli.interruption import interruptible
from delagrange.cli.verdicts import as_markdown, show
from delagrange.files import check_file

if TYPE_CHECKING:
    from delagrange.derive.verdict import Verdict

Details = Annotated[
    bool,
    typer.Option(
        "--details/--brief", help="Show terms without partner, corrections, faulty units and notes as well."
    ),
]
Markdown = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write the table as Markdown, too.", show_default=False)
]


def verify(details: Details = False, markdown: Markdown = None, quiet: o.Quiet = False) -> None:
    """Derive all equations and check each printed one against them.

    The Lagrange function l = T - Π is put together from the energies of the
    paper's membrane; the Euler-Lagrange equation and the dashpot law give what
    Eqs. (4)-(22) ought to say. The verdict on each printed equation is 'equal',
    'equal after scaling' by a nonzero factor, 'differs' (yellow where one edit
    of the print mends it), or 'missing in the text'. Each is proved symbolically
    and confirmed at random points in high precision. Takes some seconds.

    Exit code 1 where a verdict is not the recorded one.

    [bold]Examples[/]

      delagrange verify
      delagrange verify --details --markdown verdicts.md
    """
    if markdown is not None:
        check_file(markdown)
    with interruptible("nothing was written"), console.messages(quiet).status("deriving and checking"):
        from delagrange.derive import pipeline

        verdicts = pipeline.check()
    show(verdicts, details)
    if markdown is not None:
        markdown.write_text(as_markdown(verdicts, details), encoding="utf-8")
        print(f"written: {markdown}")
    if not as_recorded(verdicts):
        raise typer.Exit(1)


def as_recorded(verdicts: tuple[Verdict, ...]) -> bool:
    """Whether all verdicts are the recorded ones; those that are not are named on standard error."""
    from delagrange.derive.record import departures, recorded

    lines = departures(verdicts, recorded())
    for line in lines:
        console.complain(f"not as recorded: {line}")
    if not lines:
        console.output().print("[green]all as recorded[/]")
    return not lines
