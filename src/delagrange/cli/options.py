"""The options that commands share: each with its unit in the help."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Annotated

import typer
from typer.models import OptionInfo

from delagrange.cli.quantities import reader
from delagrange.parameters import CHANGEABLE_UNITS, SHENG_2015, Parameters
from delagrange.units import with_unit

_MODEL = "Model"
_FORCE = "Force on each loaded edge"
_FIELD = "Nominal electric field (voltage over reference thickness)"
_START = "State at t = 0"
_MATERIAL = "Membrane (default: the paper's)"
_MEASURES = "What is measured"
_NUMERICS = "Integration"
_OUTPUT = "Output"
_MEANINGS = {entry.name: entry.metadata.get("meaning") for entry in fields(Parameters)} | {
    "relaxation_time": "viscoelastic relaxation time of the dashpot, viscosity over shear modulus β"
}
_RANGE = "A number, a comma list or START:STOP:STEP; may be repeated"


def _number(unit: str, text: str, panel: str, *names: str, default: str | None = None) -> OptionInfo:
    return typer.Option(
        *names,
        parser=reader(unit),
        metavar=unit,
        help=text,
        rich_help_panel=panel,
        show_default=default or True,
    )


def _values(unit: str, text: str, panel: str, *names: str, default: str | None = None) -> OptionInfo:
    return typer.Option(
        *names, metavar=unit, help=f"{text}. {_RANGE}.", rich_help_panel=panel, show_default=default or True
    )


def _text(metavar: str, text: str, panel: str, *names: str, default: str | None = None) -> OptionInfo:
    return typer.Option(
        *names, metavar=metavar, help=text, rich_help_panel=panel, show_default=default or True
    )


def _material(name: str, make=_number) -> OptionInfo:
    unit = CHANGEABLE_UNITS[name]
    default = with_unit(getattr(SHENG_2015, name), unit)
    return make(
        unit, f"{_MEANINGS[name][0].upper()}{_MEANINGS[name][1:]}, in {unit}", _MATERIAL, default=default
    )


# Model
Model = Annotated[
    str,
    typer.Argument(
        metavar="MODEL",
        help="equal-biaxial, uniaxial or pure-shear; or the full name of a generated module.",
        show_default=False,
    ),
]
Formulation = Annotated[
    str | None,
    _text(
        "NAME",
        "Of pure shear: 'consistent' (constrained variation; the force of the frame is an output) or "
        "'as_printed' (Eqs. 18-20 of the paper: that force put into the potential before the variation).",
        _MODEL,
        default="consistent",
    ),
]
LateralDashpot = Annotated[
    str | None,
    _text(
        "NAME",
        "Of pure shear, the inelastic stretch along the held axis: 'held' at the held stretch, as in the "
        "paper, or 'free' to flow by Eq. (6).",
        _MODEL,
        default="held",
    ),
]
HeldStretch = Annotated[
    float | None,
    _number("1", "Stretch at which pure shear holds axis 2, a pure number; needed there only.", _MODEL),
]
HeldStretches = Annotated[
    list[str] | None,
    _values("1", "Stretch at which pure shear holds axis 2, a pure number; needed there only", _MODEL),
]

# Force
Force = Annotated[
    float | None,
    _number(
        "N",
        "Force in N, applied at t = 0 and kept; the amplitude, with --force-frequency.",
        _FORCE,
        default="0 N",
    ),
]
ForceFrequency = Annotated[
    float | None, _number("Hz", "Drive the force by bias + force sin(2 pi f t + phase); f in Hz.", _FORCE)
]
ForceBias = Annotated[float | None, _number("N", "Bias of a sine force, in N.", _FORCE, default="0 N")]
ForcePhase = Annotated[
    float | None, _number("rad", "Phase of a sine force, in rad.", _FORCE, default="0 rad")
]
ForceStepTime = Annotated[
    float | None, _number("s", "Apply --force from this time on, in s, not at t = 0.", _FORCE)
]
ForceRamp = Annotated[
    str | None,
    _text(
        "RAMP",
        "START:STOP:DURATION, or :BEGIN after it: from START to STOP in N, linearly, times in s.",
        _FORCE,
    ),
]
ForceTable = Annotated[
    Path | None,
    _text(
        "FILE", "CSV file of two columns, time in s and force in N; linear between.", _FORCE, "--force-csv"
    ),
]
Forces = Annotated[
    list[str] | None, _values("N", "Constant force in N, applied at t = 0", _FORCE, "--force", default="0 N")
]

# Field
FieldAmplitude = Annotated[
    float | None,
    _number(
        "V/m",
        "Amplitude of a sine field with --frequency, else a constant field, in V/m.",
        _FIELD,
        default="0 V/m",
    ),
]
Frequency = Annotated[
    float | None, _number("Hz", "Drive the field by bias + amplitude sin(2 pi f t + phase); f in Hz.", _FIELD)
]
FieldBias = Annotated[float | None, _number("V/m", "Bias of a sine field, in V/m.", _FIELD, default="0 V/m")]
FieldPhase = Annotated[
    float | None,
    _number("rad", "Phase of a sine field, in rad.", _FIELD, "--phase", "--field-phase", default="0 rad"),
]
FieldStepTime = Annotated[
    float | None, _number("s", "Apply --field-amplitude from this time on, in s, not at t = 0.", _FIELD)
]
FieldRamp = Annotated[
    str | None,
    _text(
        "RAMP",
        "START:STOP:DURATION, or :BEGIN after it: from START to STOP in V/m, linearly, times in s.",
        _FIELD,
    ),
]
FieldTable = Annotated[
    Path | None,
    _text(
        "FILE", "CSV file of two columns, time in s and field in V/m; linear between.", _FIELD, "--field-csv"
    ),
]
FieldAmplitudes = Annotated[
    list[str], _values("V/m", "Amplitude of the sine field, in V/m", _FIELD, "--field-amplitude")
]
FieldBiases = Annotated[
    list[str] | None,
    _values("V/m", "Bias of the sine field, in V/m", _FIELD, "--field-bias", default="0 V/m"),
]
FieldPhases = Annotated[
    list[str] | None,
    _values("rad", "Phase of the sine field, in rad", _FIELD, "--field-phase", default="0 rad"),
]
Frequencies = Annotated[
    list[str], _values("Hz", "Frequency of the sine field, in Hz; increasing", _FIELD, "--frequency")
]

# Start
Initial = Annotated[
    list[str] | None,
    typer.Option(
        "--initial",
        metavar="NAME=VALUES",
        help="State variable at t = 0, as stretch=1.1 or stretch_1=1:2:0.1; a stretch is a pure number, its "
        f"rate in 1/s. {_RANGE}.",
        rich_help_panel=_START,
        show_default="at rest in the reference state",
    ),
]

# Membrane: one value, or many
HalfLength = Annotated[float | None, _material("half_length")]
HalfThickness = Annotated[float | None, _material("half_thickness")]
Density = Annotated[float | None, _material("density")]
Permittivity = Annotated[float | None, _material("permittivity")]
ShearModulusAlpha = Annotated[float | None, _material("shear_modulus_alpha")]
ShearModulusBeta = Annotated[float | None, _material("shear_modulus_beta")]
Viscosity = Annotated[float | None, _material("viscosity")]
RelaxationTime = Annotated[float | None, _material("relaxation_time")]
HalfLengths = Annotated[list[str] | None, _material("half_length", _values)]
HalfThicknesses = Annotated[list[str] | None, _material("half_thickness", _values)]
Densities = Annotated[list[str] | None, _material("density", _values)]
Permittivities = Annotated[list[str] | None, _material("permittivity", _values)]
ShearModuliAlpha = Annotated[list[str] | None, _material("shear_modulus_alpha", _values)]
ShearModuliBeta = Annotated[list[str] | None, _material("shear_modulus_beta", _values)]
Viscosities = Annotated[list[str] | None, _material("viscosity", _values)]
RelaxationTimes = Annotated[list[str] | None, _material("relaxation_time", _values)]

# Integration
Duration = Annotated[float, _number("s", "Duration of a run from t = 0, in s, 1e-9 to 1e6.", _NUMERICS)]
Rtol = Annotated[
    float, _number("1", "Relative tolerance of the local error, a pure number, 1e-13 to 1e-2.", _NUMERICS)
]
Atol = Annotated[
    float,
    _number(
        "1",
        "Absolute tolerance of the local error, in the unit of each state variable, 1e-18 to 1e-2.",
        _NUMERICS,
    ),
]
Method = Annotated[
    str,
    _text(
        "NAME",
        "DOP853 or RK45; for short relaxation times Radau, BDF or LSODA with the Jacobian; auto chooses.",
        _NUMERICS,
    ),
]
SweepMethod = Annotated[str, _text("NAME", "DOP853 or RK45.", _NUMERICS, "--method")]
Engine = Annotated[
    str,
    _text(
        "NAME",
        "compiled: all runs side by side, on all cores; numpy: the same on one, without compiling; scipy: one "
        "by one (slow, a witness); auto: the fastest that can.",
        _NUMERICS,
    ),
]
Threads = Annotated[
    int | None,
    typer.Option(
        metavar="COUNT",
        help="Threads of the compiled engine, at least 1; the result does not depend on it.",
        rich_help_panel=_NUMERICS,
        show_default="all cores",
    ),
]
StepControl = Annotated[
    str | None,
    _text(
        "NAME",
        "scipy, or ode45 for the controller of MATLAB's ode45 (with --method RK45); pi: of the compiled engine.",
        _NUMERICS,
        default="the engine's own",
    ),
]
Extrema = Annotated[
    str,
    _text(
        "NAME",
        "dense: extrema between steps, to the tolerance; samples: at the quarters of steps; steps: at "
        "their ends.",
        _NUMERICS,
    ),
]
Window = Annotated[
    str | None,
    _text(
        "WINDOW",
        "START:STOP in s, the time in which extrema and averages are taken.",
        _NUMERICS,
        default="the whole duration",
    ),
]

# What is measured
Averages = Annotated[
    bool,
    typer.Option(
        "--averages",
        help="Give mean and root mean square over the window as well.",
        rich_help_panel=_MEASURES,
    ),
]
FinalState = Annotated[
    bool,
    typer.Option(
        "--final-state", help="Give the state at the end of every run as well.", rich_help_panel=_MEASURES
    ),
]
SectionPoints = Annotated[
    int | None,
    typer.Option(
        metavar="COUNT",
        help="Give the state at so many last times at which the sine's argument is --section-phase.",
        rich_help_panel=_MEASURES,
        show_default="none",
    ),
]
SectionPhase = Annotated[
    float,
    _number("rad", "Phase of the section, of 2 pi f t + phase, in rad.", _MEASURES, default="0 rad"),
]
SampleInterval = Annotated[
    float | None,
    _number(
        "s",
        "Give the trajectories too, the state every so many seconds; not with --section-points.",
        _MEASURES,
        default="none",
    ),
]

# Output
Samples = Annotated[
    int | None,
    typer.Option(
        metavar="COUNT",
        help="Number of output times, evenly spaced from 0 to the duration, 2 to 10000000.",
        rich_help_panel=_OUTPUT,
        show_default="at most 25e-6 s apart up to 25 s, then 1000001",
    ),
]
Energies = Annotated[
    bool,
    typer.Option("--energies", help="Give energies in J and powers in W as well.", rich_help_panel=_OUTPUT),
]
OutFile = Annotated[
    Path | None,
    _text(
        "FILE",
        "Write the result: .nc (NetCDF: everything, with units and provenance) or .csv (CSV: names and "
        "units in the header). Without it the summary alone is printed.",
        _OUTPUT,
        "--out",
    ),
]
OutFolder = Annotated[Path, _text("DIR", "Folder for the files; made if missing.", _OUTPUT, "--out")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Show no progress.", rich_help_panel=_OUTPUT)]
