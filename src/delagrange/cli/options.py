"""The options that commands share: each with its unit in the help."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Annotated

import typer
from typer.models import OptionInfo

from delagrange.cli.quantities import reader
from delagrange.common.units import with_unit
from delagrange.model.parameters import CHANGEABLE_UNITS, SHENG_2015, Parameters

_MODEL = "Model"
_FORCE = "Force on each loaded edge"
_FIELD = "Nominal electric field (voltage over reference thickness)"
_INSTEAD = "Charge or current, of a model that is driven by it"
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
        help="equal-biaxial, uniaxial or pure-shear; the full name of a generated module; or the path of a model "
        "of your own, a Python file that you trust or a folder with one.",
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
    list[str] | None,
    _values(
        "V/m",
        "Amplitude of the sine field, in V/m",
        _FIELD,
        "--field-amplitude",
        default="needed where the model has a field",
    ),
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
    list[str],
    _values("Hz", "Frequency of the sine field, charge or current, in Hz; increasing", _FIELD, "--frequency"),
]


def _instead(unit: str, text: str, name: str) -> OptionInfo:
    """Of a charge or current, in a model that is driven by it."""
    return _values(unit, f"{text}, in {unit}", _INSTEAD, name, default="none")


ChargeAmplitudes = Annotated[
    list[str] | None, _instead("C/m^2", "Amplitude of the sine nominal charge density", "--charge-amplitude")
]
ChargeBiases = Annotated[
    list[str] | None, _instead("C/m^2", "Bias of the sine nominal charge density", "--charge-bias")
]
ChargePhases = Annotated[
    list[str] | None, _instead("rad", "Phase of the sine nominal charge density", "--charge-phase")
]
CurrentAmplitudes = Annotated[
    list[str] | None,
    _instead("A/m^2", "Amplitude of the sine nominal current density", "--current-amplitude"),
]
CurrentBiases = Annotated[
    list[str] | None, _instead("A/m^2", "Bias of the sine nominal current density", "--current-bias")
]
CurrentPhases = Annotated[
    list[str] | None, _instead("rad", "Phase of the sine nominal current density", "--current-phase")
]

# Start
_STATE_VARIABLE = (
    "State variable at t = 0, as stretch=1.1 or stretch_1=1:2:0.1; a stretch is a pure number, its rate in 1/s. "
    f"{_RANGE}."
)


def _initial(text: str) -> OptionInfo:
    return typer.Option(
        "--initial",
        metavar="NAME=VALUES",
        help=text,
        rich_help_panel=_START,
        show_default="at rest in the reference state",
    )


Initial = Annotated[list[str] | None, _initial(_STATE_VARIABLE)]
_EQUILIBRIUM = (
    "'equilibrium': at rest and relaxed under the forces at t = 0, without field, charge or current."
)
Starts = Annotated[list[str] | None, _initial(f"{_STATE_VARIABLE} Or {_EQUILIBRIUM}")]
Start = Annotated[
    list[str] | None,
    _initial(
        f"State variable at t = 0, as stretch=1.1 (a pure number) or stretch_rate=2 (1/s); or {_EQUILIBRIUM}"
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

# Of a model of one's own
NamedParameters = Annotated[
    list[str] | None,
    typer.Option(
        "--parameter",
        metavar="NAME=VALUES",
        help="Any parameter of the model, in its SI unit, as locking_alpha=40 or viscosity_2=1e3; a range where the "
        "command takes many values. May be repeated.",
        rich_help_panel=_MATERIAL,
        show_default="the model's own",
    ),
]
NamedInputs = Annotated[
    list[str] | None,
    typer.Option(
        "--input",
        metavar="NAME=VALUES",
        help="Any other input of the model, constant, in its SI unit, as force_2=0.3; a range where the command "
        "takes many values. May be repeated.",
        rich_help_panel=_FORCE,
        show_default="0",
    ),
]

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
PlotFile = Annotated[
    Path | None, _text("FILE", "Draw the result: .png or .pdf.", _OUTPUT, "--plot", default="none")
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Show no progress.", rich_help_panel=_OUTPUT)]

# Steady response
_STEADY = "Steady response"
_SPAN = "A number, or START:STOP, or START:STOP:STEP, of what varies; one of the load must"
SpannedForce = Annotated[
    str | None,
    _text("N", f"Constant force in N. {_SPAN}.", _FORCE, "--force", default="0 N"),
]
SpannedFieldAmplitude = Annotated[
    str, _text("V/m", f"Amplitude of the sine field, in V/m. {_SPAN}.", _FIELD, "--field-amplitude")
]
SpannedFieldBias = Annotated[
    str | None,
    _text("V/m", f"Bias of the sine field, in V/m. {_SPAN}.", _FIELD, "--field-bias", default="0 V/m"),
]
SpannedFrequency = Annotated[
    str, _text("Hz", f"Frequency of the sine field, in Hz. {_SPAN}.", _FIELD, "--frequency")
]
Steady = Annotated[
    bool,
    typer.Option(
        "--steady",
        help="Branches of periodic motions, stable and unstable, with Floquet multipliers and bifurcations; without "
        "it the transient amplitude alone.",
        rich_help_panel=_STEADY,
    ),
]
SteadyDashpots = Annotated[
    str | None,
    _text(
        "NAME",
        "Of the periodic motions: 'frozen' in the reference state (or --initial), without any damping, or 'relaxed', "
        "flowing and periodic with the motion.",
        _STEADY,
        "--dashpots",
        default="frozen",
    ),
]
Sweeps = Annotated[
    bool,
    typer.Option(
        "--sweeps",
        help="Step the frequency up and down as well, the motion carried on; with --dashpots relaxed.",
        rich_help_panel=_STEADY,
    ),
]
LargestAmplitude = Annotated[
    float | None,
    _number(
        "1", "Amplitude of the first stretch at which branches end, a pure number.", _STEADY, default="none"
    ),
]
PeriodMultiple = Annotated[
    int,
    typer.Option(
        metavar="COUNT",
        help="Periods of the forcing in a period of the motion; 2 finds motions of doubled period.",
        rich_help_panel=_STEADY,
    ),
]
MostPoints = Annotated[
    int,
    typer.Option(
        metavar="COUNT", help="Points of a branch, each way from its start.", rich_help_panel=_STEADY
    ),
]
TransientDuration = Annotated[
    float,
    _number(
        "s",
        "Time from rest in which the transient amplitude is taken, in s.",
        _NUMERICS,
        "--duration",
        default="0.1 s",
    ),
]

# Equilibria and modes
_STATICS = "At rest"
StaticForce = Annotated[
    float, _number("N", "Constant force in N, there before the field.", _FORCE, default="0 N")
]
MapForces = Annotated[
    list[str] | None,
    _values(
        "N", "Find the critical field at these forces in N, in place of equilibria", _FORCE, "--map-force"
    ),
]
StaticFields = Annotated[
    list[str] | None,
    _values("V/m", "Constant field, in V/m", _FIELD, "--field", default="as described above"),
]
Voltages = Annotated[
    list[str] | None, _values("V", "Constant voltage in V, in place of --field", _FIELD, "--voltage")
]
StaticDashpots = Annotated[
    str,
    _text(
        "NAME",
        "'relaxed': at rest, too; 'frozen' in the reference state or --initial.",
        _STATICS,
        "--dashpots",
    ),
]
BreakdownField = Annotated[
    float | None,
    _number(
        "V/m", "True field in V/m that the undeformed material stands.", _STATICS, default="no breakdown"
    ),
]
BreakdownExponent = Annotated[
    float,
    _number(
        "1",
        "The strength grows with the equal-biaxial stretch to this power, that is the thickness stretch to -1/2 of it.",
        _STATICS,
    ),
]
SmallestTension = Annotated[
    float, _number("Pa", "Nominal stress on an edge, in Pa, below which tension counts as lost.", _STATICS)
]

# Kind of motion
_MOTION = "Kind of motion"
MotionDuration = Annotated[
    float | None,
    _number(
        "s",
        "Time for which the motion is followed, in s.",
        _MOTION,
        "--duration",
        default="8000 periods of the fastest small vibration, at least 4000 of the forcing",
    ),
]
Transient = Annotated[
    float | None,
    _number(
        "s",
        "Time that is left out before, in s.",
        _MOTION,
        default="none with frozen dashpots, else until transients have died out, if that is not too long",
    ),
]
MotionDashpots = Annotated[
    str,
    _text(
        "NAME",
        "'frozen' at t = 0; 'evolving' with the motion; 'relaxed': evolving, transients waited for however long "
        "they are.",
        _MOTION,
        "--dashpots",
    ),
]
MotionTolerance = Annotated[
    float,
    _number(
        "1", "Tolerance of the local error, in units of typical sizes of the state.", _NUMERICS, "--tolerance"
    ),
]
MotionFile = Annotated[
    Path | None,
    _text("FILE", "Write the result and all its evidence: .nc (NetCDF).", _OUTPUT, "--out", default="none"),
]
