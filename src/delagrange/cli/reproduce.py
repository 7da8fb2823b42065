"""`delagrange reproduce`: the whole paper, end to end."""

from __future__ import annotations

from pathlib import Path

import typer

from delagrange.cli import options as o
from delagrange.cli.interruption import interruptible
from delagrange.common.files import prepare_folder


def reproduce(out: o.OutFolder = Path("out"), quiet: o.Quiet = False) -> None:
    """Derive, check, emit, integrate, draw; each printed number beside ours.

    The table has the frequency (Hz) and amplitude (half of peak to peak of the
    stretch) of every quoted peak, and each statement of Secs. III and IV with
    yes, no or only as printed; in two numerics, an accurate one with its error
    and the paper's own. It is printed, and written as Markdown and CSV beside
    the figures and their data. Takes some 3 minutes on two cores.

    Exit code 1 where a check failed.

    [bold]Example[/]

      delagrange reproduce --out out
    """
    prepare_folder(out)
    with interruptible(f"what was finished is in {out} and is used again"):
        from delagrange.reproduction.reproduce import reproduce as walk

        status = walk(out, not quiet)
    if status:
        raise typer.Exit(status)
