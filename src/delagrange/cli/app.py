"""The commands put together, and how each way of ending becomes an exit code.

0: fine. 1: a check failed. 2: bad input. 130: interrupted from the keyboard. All but the first say why
in one line on standard error.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from typing import Annotated

import typer

import delagrange
from delagrange.cli import quantities
from delagrange.cli.classify import classify
from delagrange.cli.derive import derive
from delagrange.cli.equilibrium import equilibrium
from delagrange.cli.modes import modes
from delagrange.cli.options import with_options
from delagrange.cli.reproduce import figures, reproduce
from delagrange.cli.response import response
from delagrange.cli.results import Interrupted
from delagrange.cli.simulate import simulate
from delagrange.cli.sweep import sweep
from delagrange.cli.verify import verify

_COMMANDS = (
    verify, derive, simulate, sweep, response, equilibrium, modes, classify, figures, reproduce,
)  # fmt: skip
_BAD_INPUT, _INTERRUPTED = 2, 130
_UsageError = typer.BadParameter.__base__  # what Typer raises for all that it cannot read


def application() -> typer.Typer:
    """The Typer application `delagrange`."""
    app = typer.Typer(
        name="delagrange", add_completion=False, rich_markup_mode="rich", pretty_exceptions_enable=False
    )
    app.callback()(_delagrange)
    for command in _COMMANDS:
        app.command()(with_options(command, quantities.TABLE))
    return app


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; without `arguments`, those of the process. Returns the exit code."""
    _print_what_can_be_printed()
    given = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    command = typer.main.get_command(application())
    try:
        return command.main(args=given, prog_name="delagrange", standalone_mode=False) or 0
    except Interrupted as interruption:
        return _say(f"interrupted: {interruption}", _INTERRUPTED)
    except _UsageError as error:
        where = f"; try '{error.ctx.command_path} --help'" if error.ctx else ""
        return _say(f"error: {error.format_message().rstrip('.')}{where}", _BAD_INPUT)
    except ValueError as error:
        return _say(f"error: {error}", _BAD_INPUT)
    except OSError as error:  # a disk that is full, a folder taken away meanwhile
        return _say(f"error: {error.filename or 'a file'}: {error.strerror or error}", _BAD_INPUT)


def _print_what_can_be_printed() -> None:
    """A terminal without Greek letters shall get question marks, not an error."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def _say(text: str, code: int) -> int:
    print("delagrange:", *text.split(), file=sys.stderr)
    return code


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"delagrange {delagrange.__version__}")
        raise typer.Exit


def _delagrange(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version and stop."),
    ] = False,
) -> None:
    """Dielectric-elastomer membranes: derived, checked, emitted, integrated, drawn.

    The membrane of Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384:
    a square of sides 2L and thickness 2H, of two parallel springs, one of them
    in series with a dashpot, pulled by forces and squeezed by an electric field.
    All equations follow from its energies by machine; those that the paper
    prints are checked against them.

    Bare numbers are in SI units without prefixes, as each option says: N, V/m, Hz,
    s, Pa, m; others carry their unit: 500mN, 5MV/m, 0.3kHz. Stretches are pure
    numbers.

    [bold]Begin with[/]

      delagrange verify
      delagrange simulate equal-biaxial --force 0.5 --duration 0.1
      delagrange reproduce --out out

    Exit codes: 0 fine, 1 a check failed, 2 bad input, 130 interrupted.
    """
