"""The options of a charge that drives the electrodes, of models under charge control."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from delagrange.cli.drives import DriveOptions
from delagrange.cli.quantities import reader
from delagrange.drives.drive import Drive
from delagrange.drives.inputs import CHARGE_DENSITY

_PANEL = "Charge, under charge control"
_SPAN = "START:STOP or START:STOP:STEP if it is what varies"
_UNIT = CHARGE_DENSITY.unit
_OF_A_FIELD = ("field_amplitude", "field_bias", "field_phase")  # which it takes the place of


def _option(kind: type, name: str, text: str) -> Any:
    parser = None if kind is str else reader(_UNIT)
    option = typer.Option(
        name, metavar=_UNIT, help=text, parser=parser, rich_help_panel=_PANEL, show_default=False
    )
    return Annotated[kind | None, option]


_AMPLITUDE = f"Amplitude of the sine of the nominal charge density, in {_UNIT}, with --frequency."
_BIAS = f"Bias of the sine of the nominal charge density, in {_UNIT}."
ChargeAmplitude = _option(float, "--charge-amplitude", _AMPLITUDE)
ChargeBias = _option(float, "--charge-bias", _BIAS)
SpannedChargeAmplitude = _option(str, "--charge-amplitude", f"{_AMPLITUDE} {_SPAN}.")
SpannedChargeBias = _option(str, "--charge-bias", f"{_BIAS} {_SPAN}.")


def with_charge(inputs: Mapping[str, Any] | None, given: Mapping[str, Any]) -> dict[str, Any]:
    """The inputs with the charge that a command's options, by name, give.

    Raises:
        ValueError: a field is given, too, or the charge by --input as well; or as `DriveOptions.drive`.
    """
    for name in _OF_A_FIELD:
        if given.get(name) is not None:
            option = f"--{name.replace('_', '-')}"
            raise ValueError(
                f"the electrodes are driven by {option} and --charge-amplitude at once; give one"
            )
    if CHARGE_DENSITY.name in (inputs or {}):
        raise ValueError(f"{CHARGE_DENSITY.name} is given by --charge-amplitude and by --input; give one")
    return {**(inputs or {}), CHARGE_DENSITY.name: _drive(given)}


def _drive(given: Mapping[str, Any]) -> Drive:
    return DriveOptions(
        CHARGE_DENSITY.stem,
        _UNIT,
        "--charge-amplitude",
        "--frequency",
        value=given["charge_amplitude"],
        frequency=given["frequency"],
        bias=given["charge_bias"],
    ).drive()
