"""`delagrange figures`: the paper's figures, drawn again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from delagrange.cli import options as o
from delagrange.cli.interruption import interruptible
from delagrange.common.files import prepare_folder

Only = Annotated[
    str | None,
    typer.Option(metavar="NUMBERS", help="Some of the figures, e.g. 4,7.", show_default="all, 4 to 12"),
]


def figures(out: o.OutFolder = Path("out/figures"), only: Only = None, quiet: o.Quiet = False) -> None:
    """Draw Figs. 4-12 of the paper from the emitted models, all panels.

    Figs. 4, 7, 10: amplitude of the stretch (half of peak to peak, transient
    included) over the frequency of the field in Hz. Figs. 5, 8, 11: stretches
    over time in s at half, one and two times the resonance. Figs. 6, 9, 12:
    phase paths and Poincaré maps of the same runs. Each as PNG and PDF, with the
    data that it was drawn from beside it as NetCDF and CSV.

    [bold]Example[/]

      delagrange figures --out figures --only 4,7
    """
    wanted = _figure_numbers(only)
    prepare_folder(out)
    with interruptible(f"what was finished is in {out} and is used again"):
        from delagrange.reproduction.figures.gallery import draw_all

        written = draw_all(out, wanted, not quiet)
    print(f"written: {len(written)} files in {out}")


def _figure_numbers(only: str | None) -> tuple[int, ...] | None:
    if only is None:
        return None
    from delagrange.reproduction.figures.gallery import NUMBERS

    known = [str(number) for number in NUMBERS]
    texts = [text.strip() for text in only.split(",")]
    for text in texts:
        if text not in known:
            raise ValueError(f"only must be figure numbers among {', '.join(known)}, got {text!r}")
    return tuple(dict.fromkeys(map(int, texts)))
