"""The table of quantities: every option of every command, with its unit, its meaning and its default.

A command takes the rows that name it, in this order; its help shows them by their panels.
"""

from __future__ import annotations

from dataclasses import fields

from delagrange.cli.options import (
    ARGUMENT,
    COUNT,
    FILE,
    FILE_ARGUMENT,
    FLAG,
    NUMBER,
    NUMBERS,
    RAMP,
    SPAN,
    TEXT,
    TEXTS,
    WINDOW,
    Option,
    checked_file,
)
from delagrange.cli.results import check_netcdf, check_plot
from delagrange.common.files import check_file, check_writable
from delagrange.common.units import with_unit
from delagrange.drives.inputs import CHARGE_DENSITY, CURRENT_DENSITY
from delagrange.model.parameters import CHANGEABLE_UNITS, SHENG_2015, Parameters

_MODEL = "Model"
_FORCE = "Force on each loaded edge"
_FIELD = "Nominal electric field (voltage over reference thickness)"
_INSTEAD = "Charge or current, of a model that is driven by it"
_START = "State at t = 0"
_MATERIAL = "Membrane (default: the paper's)"
_STEADY = "Steady response"
_STATICS = "At rest"
_MOTION = "Kind of motion"
_MEASURES = "What is measured"
_NUMERICS = "Integration"
_PASTED = "Equations of your own"
_OUTPUT = "Output"

_ANALYSES = "simulate sweep response equilibrium modes classify"
_SINGLE, _MANY = "simulate response equilibrium classify", "sweep modes"  # of one membrane, or of many
_RUNS = "simulate sweep response classify"  # over time
_DASHPOTS = "dashpots"

_MODELS = (
    Option("model", "MODEL", None,
           "equal-biaxial, uniaxial or pure-shear; the full name of a generated module; or the path of a model of "
           "your own, a Python file that you trust or a folder with one", {ARGUMENT: _ANALYSES}, required=True),
    Option("model", "[MODEL]", None,
           "What to check against: a membrane described in TOML, or equal-biaxial, uniaxial, pure-shear, biaxial",
           {ARGUMENT: "verify"}, default_text="the paper's models and equations"),
    Option("model", "[FILE]", None, "A membrane of your own, described in TOML", {FILE_ARGUMENT: "derive"},
           default_text="the paper's models"),
    Option("formulation", "NAME", _MODEL,
           "Of pure shear: 'consistent' (constrained variation; the force of the frame is an output) or 'as_printed' "
           "(Eqs. 18-20 of the paper: that force put into the potential before the variation)",
           {TEXT: f"{_ANALYSES} verify"}, default_text="consistent"),
    Option("lateral_dashpot", "NAME", _MODEL,
           "Of pure shear, the inelastic stretch along the held axis: 'held' at the held stretch, as in the paper, or "
           "'free' to flow by Eq. (6)", {TEXT: f"{_ANALYSES} verify"}, default_text="held"),
    Option("held_stretch", "1", _MODEL, "Stretch at which pure shear holds axis 2, a pure number; needed there only",
           {NUMBER: _SINGLE, NUMBERS: _MANY}),
)  # fmt: skip

_FORCES = (
    Option("force", "N", _FORCE, "Force in N, applied at t = 0 and kept; the amplitude, with --force-frequency",
           {NUMBER: "simulate classify"}, default_text="0 N"),
    Option("force", "N", _FORCE, "Constant force in N", {NUMBERS: "sweep modes", SPAN: "response"},
           default_text="0 N"),
    Option("force", "N", _FORCE, "Constant force in N, there before the field", {NUMBER: "equilibrium"},
           default_text="0 N"),
    Option("map_force", "N", _FORCE, "Find the critical field at these forces in N, in place of equilibria",
           {NUMBERS: "equilibrium"}),
    Option("force_frequency", "Hz", _FORCE, "Drive the force by bias + force sin(2 pi f t + phase); f in Hz",
           {NUMBER: "simulate classify"}),
    Option("force_bias", "N", _FORCE, "Bias of a sine force, in N", {NUMBER: "simulate classify"},
           default_text="0 N"),
    Option("force_phase", "rad", _FORCE, "Phase of a sine force, in rad", {NUMBER: "simulate classify"},
           default_text="0 rad"),
    Option("force_step_time", "s", _FORCE, "Apply --force from this time on, in s, not at t = 0",
           {NUMBER: "simulate"}),
    Option("force_ramp", "N", _FORCE,
           "START:STOP:DURATION, or :BEGIN after it: from START to STOP in N, linearly, times in s",
           {RAMP: "simulate"}),
    Option("force_csv", "FILE", _FORCE, "CSV file of two columns, time in s and force in N; linear between",
           {FILE: "simulate"}),
    Option("input", "NAME=VALUES", _FORCE,
           "Any other input of the model, constant, in its SI unit, as force_2=0.3; a range where the command takes "
           "many values. May be repeated", {TEXTS: _ANALYSES}, default_text="0"),
)  # fmt: skip

_FIELDS = (
    Option("field_amplitude", "V/m", _FIELD,
           "Amplitude of a sine field with --frequency, else a constant field, in V/m",
           {NUMBER: "simulate classify"}, default_text="0 V/m"),
    Option("field_amplitude", "V/m", _FIELD, "Amplitude of the sine field, in V/m",
           {NUMBERS: "sweep", SPAN: "response"}, default_text="needed where the model has a field"),
    Option("frequency", "Hz", _FIELD, "Drive the field by bias + amplitude sin(2 pi f t + phase); f in Hz",
           {NUMBER: "simulate classify"}),
    Option("frequency", "Hz", _FIELD, "Frequency of the sine field, charge or current, in Hz; increasing",
           {NUMBERS: "sweep"}, required=True),
    Option("frequency", "Hz", _FIELD, "Frequency of the sine field, charge or current, in Hz", {SPAN: "response"},
           required=True),
    Option("field_bias", "V/m", _FIELD, "Bias of the sine field, in V/m",
           {NUMBER: "simulate classify", NUMBERS: "sweep", SPAN: "response"}, default_text="0 V/m"),
    Option("field_phase", "rad", _FIELD, "Phase of the sine field, in rad", {NUMBER: "simulate classify"},
           default_text="0 rad", flags=("--field-phase", "--phase")),
    Option("field_phase", "rad", _FIELD, "Phase of the sine field, in rad", {NUMBERS: "sweep"}, default_text="0 rad"),
    Option("field_step_time", "s", _FIELD, "Apply --field-amplitude from this time on, in s, not at t = 0",
           {NUMBER: "simulate"}),
    Option("field_ramp", "V/m", _FIELD,
           "START:STOP:DURATION, or :BEGIN after it: from START to STOP in V/m, linearly, times in s",
           {RAMP: "simulate"}),
    Option("field_csv", "FILE", _FIELD, "CSV file of two columns, time in s and field in V/m; linear between",
           {FILE: "simulate"}),
    Option("field", "V/m", _FIELD, "Constant field, in V/m", {NUMBERS: "equilibrium modes"},
           default_text="as described above"),
    Option("voltage", "V", _FIELD, "Constant voltage in V, in place of --field", {NUMBERS: "equilibrium"}),
)  # fmt: skip


def _sine_instead(electrical, commands: dict) -> tuple[Option, ...]:
    """Of a charge or current, in a model that is driven by it."""
    sine = f"the sine {electrical.long_name}"
    with_phase = {NUMBERS: commands[NUMBERS]}
    return tuple(
        Option(f"{electrical.stem}_{part}", unit, _INSTEAD, f"{part.capitalize()} of {sine}, in {unit}", taken,
               default_text="none")
        for part, unit, taken in (
            ("amplitude", electrical.unit, commands), ("bias", electrical.unit, commands), ("phase", "rad", with_phase),
        )
    )  # fmt: skip


_CHARGES = (
    *_sine_instead(CHARGE_DENSITY, {NUMBER: "classify", NUMBERS: "sweep", SPAN: "response"}),
    *_sine_instead(CURRENT_DENSITY, {NUMBERS: "sweep", SPAN: "response"}),
)

_STATE = "as stretch=1.1 (a pure number) or stretch_rate=2 (1/s)"
_RELAXED = "'equilibrium': at rest and relaxed under the forces at t = 0, without field, charge or current"
_AT_REST = "at rest in the reference state"
_STARTS = (
    Option("initial", "NAME=VALUES", _START, f"State variable at t = 0, {_STATE}; or {_RELAXED}",
           {TEXTS: "simulate classify"}, default_text=_AT_REST),
    Option("initial", "NAME=VALUES", _START,
           f"State variable at t = 0, {_STATE}, or stretch_1=1:2:0.1 for an axis. Or {_RELAXED}", {TEXTS: "sweep"},
           default_text=_AT_REST),
    Option("initial", "NAME=VALUES", _START, f"State variable at t = 0, {_STATE}",
           {TEXTS: "response equilibrium modes"}, default_text=_AT_REST),
)  # fmt: skip

_MEANINGS = {entry.name: entry.metadata.get("meaning") for entry in fields(Parameters)} | {
    "relaxation_time": "viscoelastic relaxation time of the dashpot, viscosity over shear modulus β"
}
_PARAMETERS = (
    *(
        Option(name, unit, _MATERIAL, f"{_MEANINGS[name][0].upper()}{_MEANINGS[name][1:]}, in {unit}",
               {NUMBER: _SINGLE, NUMBERS: _MANY}, default_text=with_unit(getattr(SHENG_2015, name), unit))
        for name, unit in CHANGEABLE_UNITS.items()
    ),
    Option("parameter", "NAME=VALUES", _MATERIAL,
           "Any parameter of the model, in its SI unit, as locking_alpha=40 or viscosity_2=1e3; a range where the "
           "command takes many values. May be repeated", {TEXTS: _ANALYSES}, default_text="the model's own"),
)  # fmt: skip

_ANALYSED = (
    Option("steady", "", _STEADY,
           "Branches of periodic motions, stable and unstable, with Floquet multipliers and bifurcations; without it "
           "the transient amplitude alone", {FLAG: "response"}, False),
    Option(_DASHPOTS, "NAME", _STEADY,
           "Of the periodic motions: 'frozen' in the reference state (or --initial), without any damping, or "
           "'relaxed', flowing and periodic with the motion", {TEXT: "response"}, default_text="frozen"),
    Option("largest_amplitude", "1", _STEADY, "Amplitude of the first stretch at which branches end, a pure number",
           {NUMBER: "response"}, default_text="none"),
    Option("period_multiple", "COUNT", _STEADY,
           "Periods of the forcing in a period of the motion; 2 finds motions of doubled period", {COUNT: "response"},
           1),
    Option("most_points", "COUNT", _STEADY, "Points of a branch, each way from its start", {COUNT: "response"}, 400),
    Option("sweeps", "", _STEADY,
           "Step the frequency up and down as well, the motion carried on; with --dashpots relaxed",
           {FLAG: "response"}, False),
    Option(_DASHPOTS, "NAME", _STATICS, "'relaxed': at rest, too; 'frozen' in the reference state or --initial",
           {TEXT: "equilibrium"}, default_text="relaxed"),
    Option(_DASHPOTS, "NAME", _STATICS, "'relaxed': at rest, too; 'frozen' in the reference state or --initial",
           {TEXT: "modes"}, "frozen"),
    Option("breakdown_field", "V/m", _STATICS, "True field in V/m that the undeformed material stands",
           {NUMBER: "equilibrium"}, default_text="no breakdown"),
    Option("breakdown_exponent", "1", _STATICS,
           "The strength grows with the equal-biaxial stretch to this power, that is the thickness stretch to -1/2 "
           "of it", {NUMBER: "equilibrium"}, 0.0),
    Option("smallest_tension", "Pa", _STATICS, "Nominal stress on an edge, in Pa, below which tension counts as lost",
           {NUMBER: "equilibrium"}, 0.0),
    Option(_DASHPOTS, "NAME", _MOTION,
           "'frozen' at t = 0; 'evolving' with the motion; 'relaxed': evolving, transients waited for however long "
           "they are", {TEXT: "classify"}, "frozen"),
    Option("duration", "s", _MOTION, "Time for which the motion is followed, in s", {NUMBER: "classify"},
           default_text="8000 periods of the fastest small vibration, at least 4000 of the forcing"),
    Option("transient", "s", _MOTION, "Time that is left out before, in s", {NUMBER: "classify"},
           default_text="none with frozen dashpots, else until transients have died out, if that is not too long"),
)  # fmt: skip

_MEASURED = (
    Option("averages", "", _MEASURES, "Give mean and root mean square over the window as well", {FLAG: "sweep"}, False),
    Option("final_state", "", _MEASURES, "Give the state at the end of every run as well", {FLAG: "sweep"}, False),
    Option("section_points", "COUNT", _MEASURES,
           "Give the state at so many last times at which the sine's argument is --section-phase", {COUNT: "sweep"},
           default_text="none"),
    Option("section_phase", "rad", _MEASURES, "Phase of the section, of 2 pi f t + phase, in rad", {NUMBER: "sweep"},
           0.0, "0 rad"),
    Option("sample_interval", "s", _MEASURES,
           "Give the trajectories too, the state every so many seconds; not with --section-points",
           {NUMBER: "sweep"}, default_text="none"),
    Option("energies", "", _MEASURES, "Give energies in J and powers in W as well", {FLAG: "simulate"}, False),
)  # fmt: skip

_INTEGRATED = (
    Option("duration", "s", _NUMERICS, "Duration of a run from t = 0, in s, 1e-9 to 1e6", {NUMBER: "simulate sweep"},
           required=True),
    Option("duration", "s", _NUMERICS, "Time from rest in which the transient amplitude is taken, in s",
           {NUMBER: "response"}, 0.1, "0.1 s"),
    Option("samples", "COUNT", _NUMERICS,
           "Number of output times, evenly spaced from 0 to the duration, 2 to 10000000", {COUNT: "simulate"},
           default_text="at most 25e-6 s apart up to 25 s, then 1000001"),
    Option("window", "s", _NUMERICS, "START:STOP in s, the time in which extrema and averages are taken",
           {WINDOW: "sweep"}, default_text="the whole duration"),
    Option("method", "NAME", _NUMERICS,
           "DOP853 or RK45; for short relaxation times Radau, BDF or LSODA with the Jacobian; auto chooses",
           {TEXT: "simulate"}, "DOP853"),
    Option("method", "NAME", _NUMERICS, "DOP853 or RK45", {TEXT: "sweep"}, "DOP853"),
    Option("rtol", "1", _NUMERICS, "Relative tolerance of the local error, a pure number, 1e-13 to 1e-2",
           {NUMBER: "simulate sweep"}, 1e-9),
    Option("atol", "1", _NUMERICS,
           "Absolute tolerance of the local error, in the unit of each state variable, 1e-18 to 1e-2",
           {NUMBER: "simulate sweep"}, 1e-12),
    Option("tolerance", "1", _NUMERICS, "Tolerance of the local error, in units of typical sizes of the state",
           {NUMBER: "classify"}, 1e-11),
    Option("smallest_stretch", "1", _NUMERICS,
           "A run is lost, collapsed, where a principal stretch falls below this pure number", {NUMBER: _RUNS},
           default_text="0.001"),
    Option("largest_stretch", "1", _NUMERICS, "A run is lost, diverged, where a stretch passes this pure number",
           {NUMBER: _RUNS}, default_text="100"),
    Option("engine", "NAME", _NUMERICS,
           "compiled: all runs side by side, on all cores; core: the same by the integrator in C; numpy: on one, "
           "without compiling; scipy: one by one (slow, a witness); auto: the fastest that can",
           {TEXT: "sweep"}, "auto"),
    Option("threads", "COUNT", _NUMERICS,
           "Threads of the compiled engines, at least 1; the result does not depend on it", {COUNT: "sweep"},
           default_text="all cores"),
    Option("step_control", "NAME", _NUMERICS,
           "scipy, or ode45 for the controller of MATLAB's ode45 (with --method RK45); pi: of the compiled engine",
           {TEXT: "sweep"}, default_text="the engine's own"),
    Option("extrema", "NAME", _NUMERICS,
           "dense: extrema between steps, to the tolerance; samples: at the quarters of steps; steps: at their ends",
           {TEXT: "sweep"}, "dense"),
)  # fmt: skip

_CHECKED = (
    Option("equation", "LATEX", _PASTED, "An equation as printed; may be repeated", {TEXTS: "verify"}),
    Option("equations", "FILE", _PASTED,
           "Several: TOML with \\[\\[equation]] tables of number and latex, or text with one a line",
           {FILE: "verify"}),
    Option("symbols", "FILE", _PASTED, "TOML whose table \\[symbols] says what the LaTeX symbols stand for",
           {FILE: "verify"}, default_text="the model's own"),
    Option("quantity", "NAME", _PASTED, "What each --equation states, such as equation_of_motion_1",
           {TEXT: "verify"}, default_text="found from what stands in it"),
    Option("details", "", _OUTPUT, "Show terms without partner, corrections, faulty units and notes as well",
           {FLAG: "verify"}, default_text="details of equations of your own", flags=("--details/--brief",)),
    Option("details", "", _OUTPUT, "Show terms without partner, corrections, faulty units and notes as well",
           {FLAG: "derive"}, False, flags=("--details/--brief",)),
    Option("markdown", "FILE", _OUTPUT, "Write the table as Markdown, too", {checked_file(check_file): "verify"}),
    Option("out", "DIR", _OUTPUT, "Folder of the modules", {FILE: "derive"}, default_text="delagrange.generated"),
    Option("check", "", _OUTPUT, "Write nothing: compare the folder, byte for byte, with what is emitted",
           {FLAG: "derive"}, False),
    Option("only", "NUMBERS", _OUTPUT, "Some of the figures, e.g. 4,7", {TEXT: "figures"},
           default_text="all, 4 to 12"),
    Option("out", "DIR", _OUTPUT, "Folder for the files; made if missing", {FILE: "figures"}, "out/figures"),
    Option("out", "DIR", _OUTPUT, "Folder for the files; made if missing", {FILE: "reproduce"}, "out"),
)  # fmt: skip

_WRITTEN = (
    Option("out", "FILE", _OUTPUT,
           "Write the result: .nc (NetCDF: everything, with units and provenance) or .csv (CSV: names and units in "
           "the header). Without it the summary alone is printed",
           {checked_file(check_writable): "simulate sweep response equilibrium modes"}),
    Option("out", "FILE", _OUTPUT, "Write the result and all its evidence: .nc (NetCDF)",
           {checked_file(check_netcdf): "classify"}, default_text="none"),
    Option("plot", "FILE", _OUTPUT, "Draw the result: .png or .pdf", {checked_file(check_plot): _ANALYSES},
           default_text="none"),
    Option("quiet", "", _OUTPUT, "Show no progress", {FLAG: f"{_ANALYSES} verify derive figures reproduce"}, False),
)  # fmt: skip

TABLE = (
    *_MODELS, *_FORCES, *_FIELDS, *_CHARGES, *_STARTS, *_PARAMETERS, *_ANALYSED, *_MEASURED, *_INTEGRATED,
    *_CHECKED, *_WRITTEN,
)  # fmt: skip
