"""`delagrange classify`: what kind of motion is it?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.text import Text

from delagrange.cli import console
from delagrange.cli.drives import electrical_drives, force_drive
from delagrange.cli.membrane import arguments, limits_given, loaded, single_start
from delagrange.cli.options import Given
from delagrange.cli.results import interruptible, tell_written, write, write_plot

if TYPE_CHECKING:
    import xarray as xr
    from rich.table import Table

_COLOURS = {"undecided": "yellow", "lost": "yellow"}
_MOST_LINES = 12  # of the printed table; the file has all


def classify(given: Given) -> None:
    """Kind of motion: at rest, periodic, quasi-periodic, chaotic, or not to be said.

    Three witnesses are heard: the Lyapunov spectrum from the variational
    equations, the lines of the spectrum and the base frequencies that they are
    made of, and the 0-1 test for chaos. Where they leave room for doubt the
    verdict is 'undecided', with the duration that would do. A field without bias
    enters squared and forces at twice its frequency; so does a charge, with
    --charge-amplitude and --frequency.

    [bold]Examples[/]

      delagrange classify equal-biaxial --force 0.5 --field-amplitude 5e6 \\
          --frequency 371 --plot motion.png
      delagrange classify uniaxial --force 0.25 --force-bias 0.25 \\
          --force-frequency 490 --relaxation-time 0.01 --dashpots evolving
    """
    module = loaded(given)
    taken = arguments(given, module, single_start(given, module))
    taken |= {"force": force_drive(given), **electrical_drives(given, taken["inputs"])}
    with interruptible("the motion was not followed to the end, nothing was written"):
        from delagrange.analysis.motion.classify import classify as judge

        motion = judge(
            module,
            **taken,
            **given.some("dashpots", "duration", "transient", "tolerance"),
            limits=limits_given(given),
            progress=not given.quiet,
        )
        write(motion, given)
    _report(motion)
    tell_written(given)
    if given.plot is not None:
        from delagrange.figures.motion_figure import draw_motion

        write_plot(given.plot, draw_motion, motion)


def _report(motion: xr.Dataset) -> None:
    verdict = motion["verdict"].item()
    output = console.output()
    told = (verdict, f"bold {_COLOURS.get(verdict, 'green')}")
    output.print(Text.assemble(f"{motion.attrs['model']}: ", told))
    for sentence in motion["evidence"].item().split("; "):
        output.print(Text(f"  {sentence}"))
    if motion.sizes["exponent"] and np.all(np.isfinite(motion["lyapunov_exponents"])):
        console.show("Lyapunov spectrum", _exponents(motion))
    if motion.sizes["line"]:
        console.show(f"strongest of {motion.sizes['line']} spectral lines", _lines(motion))


def _exponents(motion: xr.Dataset) -> Table:
    table = console.table("exponent [1/s]", "uncertainty [1/s]")
    for exponent, uncertainty in zip(
        motion["lyapunov_exponents"].values, motion["lyapunov_uncertainty"].values
    ):
        table.add_row(f"{exponent:.6g}", f"{uncertainty:.2g}")
    return table


def _lines(motion: xr.Dataset) -> Table:
    """The strongest lines, with the integers by which the base frequencies make them."""
    made = "line_integers" in motion
    bases = [f"x {value:.7g} Hz" for value in motion["base_frequencies"].values] if made else []
    table = console.table("frequency [Hz]", "amplitude [1]", *bases)
    for place in range(min(_MOST_LINES, motion.sizes["line"])):
        line = motion.isel(line=place)
        integers = [str(k) for k in line["line_integers"].values] if made else []
        table.add_row(
            f"{line['line_frequency'].item():.9g}", f"{line['line_amplitude'].item():.4g}", *integers
        )
    return table
