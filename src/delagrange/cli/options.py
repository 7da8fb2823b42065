"""How a command gets its options: each is a row of the table of quantities, and what is typed is read once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from inspect import Parameter, Signature
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any

import typer

from delagrange.cli import values

Read = Callable[[str, Any, str], Any]  # option, what was typed, unit -> its value


def _as_typed(_option: str, typed: Any, _unit: str) -> Any:
    return typed


@dataclass(frozen=True)
class Kind:
    """What a person types for an option, and what a command gets for it."""

    typed: Any  # type, as Typer sees it
    read: Read = _as_typed
    metavar: str = ""  # where it is not the unit
    form: str = ""  # told behind the meaning
    positional: bool = False


NUMBER = Kind(str, values.finite)
NUMBERS = Kind(
    list[str], values.axis, form=". A number, a comma list or START:STOP:STEP; may be repeated."
)  # a number, or an array
SPAN = Kind(
    str,
    values.span,
    form=". A number, or START:STOP, or START:STOP:STEP, of what varies; one of the load must.",
)
RAMP = Kind(str, values.ramp, "RAMP")
WINDOW = Kind(str, values.window, "WINDOW")
COUNT = Kind(int, metavar="COUNT")
FLAG = Kind(bool)
TEXT = Kind(str)
TEXTS = Kind(list[str])
FILE = Kind(Path)
ARGUMENT = Kind(str, positional=True)
FILE_ARGUMENT = Kind(Path, positional=True)


def checked_file(check: Callable[[Path], Path]) -> Kind:
    """A file that is refused before anything is computed if it could not be written."""
    return Kind(Path, lambda _option, path, _unit: check(path))


def flag_of(name: str) -> str:
    """`field_bias` -> `--field-bias`."""
    return f"--{name.replace('_', '-')}"


@dataclass(frozen=True)
class Option:
    """One row: a quantity or a choice, and the commands that take it."""

    name: str
    takes: str  # its unit, or in capitals what else is typed
    panel: str | None
    meaning: str
    commands: Mapping[Kind, str]  # that take it in the same form, by their names
    default: Any = None
    default_text: str | None = None  # where the help does not show the default itself
    flags: tuple[str, ...] = ()
    required: bool = False

    @property
    def flag(self) -> str:
        """As a person types it, and as errors call it."""
        return self.flags[0] if self.flags else flag_of(self.name)

    def kind(self, command: str) -> Kind | None:
        """How a command takes it; None where it does not."""
        return next((kind for kind, names in self.commands.items() if command in names.split()), None)

    def parameter(self, kind: Kind) -> Parameter:
        """Of a function that Typer makes a command of."""
        shown = {
            "metavar": None if kind is FLAG else kind.metavar or self.takes,
            "help": f"{self.meaning}{kind.form or '.'}",
            "show_default": self.default_text or self.default is not None,
            "rich_help_panel": self.panel,
        }
        about = typer.Argument(**shown) if kind.positional else typer.Option(*self._flags(), **shown)
        typed = kind.typed if self.required else kind.typed | None
        default = Parameter.empty if self.required else self.default
        return Parameter(
            self.name, Parameter.KEYWORD_ONLY, default=default, annotation=Annotated[typed, about]
        )

    def _flags(self) -> tuple[str, ...]:
        return self.flags or (self.flag,)

    def value(self, kind: Kind, typed: Any) -> Any:
        """What the command gets.

        Raises:
            ValueError: what was typed is no such quantity; the message names the option, the text and the unit.
        """
        return None if typed is None or typed == [] else kind.read(self.flag, typed, self.takes)


@dataclass(frozen=True)
class Given:
    """The values of a command's options, each an attribute by its name; None where one was left out."""

    values: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        try:
            return self.values[name]
        except KeyError:
            raise AttributeError(f"the command has no option {name}") from None

    def get(self, name: str) -> Any:
        """The value; None, too, where the command has no such option."""
        return self.values.get(name)

    def some(self, *names: str) -> dict[str, Any]:
        """Those of some options that have a value, by name."""
        return {name: self.values[name] for name in names if self.get(name) is not None}


def with_options(command: Callable[[Given], None], table: tuple[Option, ...]) -> Callable[..., None]:
    """The command as Typer wants it: with a parameter for each of its rows in the table."""
    name = command.__name__
    rows = [(option, kind) for option in table if (kind := option.kind(name)) is not None]

    def run(**typed: Any) -> None:
        command(
            Given(
                MappingProxyType(
                    {option.name: option.value(kind, typed[option.name]) for option, kind in rows}
                )
            )
        )

    parameters = [option.parameter(kind) for option, kind in rows]
    run.__name__, run.__doc__ = name, command.__doc__
    run.__signature__ = Signature(parameters)
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run
