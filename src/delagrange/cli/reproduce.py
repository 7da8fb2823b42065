"""`delagrange reproduce`: the whole paper, end to end; and `delagrange figures`: its figures alone."""

from __future__ import annotations

import typer

from delagrange.cli.options import Given
from delagrange.cli.results import interruptible
from delagrange.common.files import prepare_folder


def reproduce(given: Given) -> None:
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
    prepare_folder(given.out)
    with interruptible(f"what was finished is in {given.out} and is used again"):
        from delagrange.reproduction.reproduce import reproduce as walk

        status = walk(given.out, not given.quiet)
    if status:
        raise typer.Exit(status)


def figures(given: Given) -> None:
    """Draw Figs. 4-12 of the paper from the emitted models, all panels.

    Figs. 4, 7, 10: amplitude of the stretch (half of peak to peak, transient
    included) over the frequency of the field in Hz. Figs. 5, 8, 11: stretches
    over time in s at half, one and two times the resonance. Figs. 6, 9, 12:
    phase paths and Poincaré maps of the same runs. Each as PNG and PDF, with the
    data that it was drawn from beside it as NetCDF and CSV.

    [bold]Example[/]

      delagrange figures --out figures --only 4,7
    """
    wanted = _figure_numbers(given.only)
    prepare_folder(given.out)
    with interruptible(f"what was finished is in {given.out} and is used again"):
        from delagrange.reproduction.figures.gallery import draw_all

        written = draw_all(given.out, wanted, not given.quiet)
    print(f"written: {len(written)} files in {given.out}")


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
