"""Bad input: a ValueError of one line that names the thing, its value, its unit and what is allowed."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest

import delagrange as dl

NAN, INF = float("nan"), float("inf")


def _simulate(model="equal_biaxial", **options):
    return lambda: dl.simulate(model, **({"duration": 1e-3} | options))


def _sweep(model="equal_biaxial", **options):
    defaults = {"frequency": [300.0, 301.0], "field_amplitude": 1e6, "duration": 1e-3}
    return lambda: dl.frequency_response(model, **(defaults | options))


CASES = {
    "density zero": (_simulate(density=0.0), r"density must be positive and finite, got 0 kg/m\^3"),
    "modulus nan": (_simulate(shear_modulus_alpha=NAN), "shear_modulus_alpha must be finite, got nan Pa"),
    "relaxation time": (_simulate(relaxation_time=-1.0), "relaxation_time must be positive .* -1 s"),
    "unknown parameter": (_simulate(viscocity=1.0), "unknown parameter 'viscocity'.*'viscosity'"),
    "array parameter": (_simulate(density=[1.0, 2.0]), "density must be a single number"),
    "parameters type": (_simulate(parameters={}), "parameters must be a delagrange.Parameters"),
    "model": (_simulate("equibiaxial"), "unknown model 'equibiaxial'.*equal_biaxial.*known are"),
    "model none": (_simulate(None), "unknown model None"),
    "module": (_simulate(ModuleType("empty")), "'empty' is not a model: it lacks MODEL"),
    "formulation": (
        _simulate("pure_shear", formulation="x", held_stretch=2.0),
        "formulation .*consistent, as_printed",
    ),
    "no formulation": (
        _simulate("uniaxial", formulation="as_printed"),
        "formulation 'as_printed': the model uniaxial leaves no choice; .* give 'consistent'",
    ),
    "printed is not consistent": (
        _simulate("pure_shear_as_printed", formulation="consistent", held_stretch=2.0),
        "formulation 'consistent': the model pure_shear_as_printed leaves no choice; .* give 'as_printed'",
    ),
    "free is not held": (
        _simulate("pure_shear_consistent_free", lateral_dashpot="held", held_stretch=2.0),
        "lateral_dashpot 'held': the model pure_shear_consistent_free leaves no choice; .* give 'free'",
    ),
    "module is not consistent": (
        _simulate(dl.load_model("pure_shear_as_printed"), formulation="consistent", held_stretch=2.0),
        "formulation 'consistent': the model pure_shear_as_printed",
    ),
    "sweep is not consistent": (
        _sweep("pure_shear_as_printed", formulation="consistent", held_stretch=2.0),
        "formulation 'consistent': the model pure_shear_as_printed",
    ),
    "dashpot": (
        _simulate("pure_shear", lateral_dashpot="loose", held_stretch=2.0),
        "lateral_dashpot .* held, free",
    ),
    "printed dashpot": (
        _simulate("pure_shear", formulation="as_printed", lateral_dashpot="free", held_stretch=2.0),
        "lateral_dashpot of pure_shear as_printed must be one of held",
    ),
    "no dashpot": (
        _simulate(lateral_dashpot="held"),
        "lateral_dashpot 'held': the model equal_biaxial leaves no choice; leave it out",
    ),
    "held missing": (_simulate("pure_shear"), "held_stretch .* missing: pure_shear_consistent needs it"),
    "held refused": (_simulate(held_stretch=2.0), "held_stretch 2 .* equal_biaxial holds no stretch"),
    "held negative": (_simulate("pure_shear", held_stretch=-2.0), "held_stretch must be positive .* -2"),
    "force text": (_simulate(force="strong"), "force must be a number in N, got 'strong'"),
    "force nan": (_simulate(force=NAN), "force must be finite, got nan N"),
    "field inf": (_simulate(field=INF), "field must be finite, got inf V/m"),
    "force lanes": (_simulate(force=[0.1, 0.2]), "force must be a single number, got .* N"),
    "force huge": (_simulate(force=10**400), "force must be finite, got more than 1.8e308 N"),
    "force hugely negative": (
        _simulate(force=[-(10**400)]),
        "force must be finite, got .less than -1.8e308. N",
    ),
    "force complex": (_simulate(force=1 + 2j), r"force must be a number in N, got \(1\+2j\)"),
    "force complex array": (_simulate(force=np.array([0.1 + 1j])), "force must be a number in N"),
    "force complex scalar": (_simulate(force=np.complex128(0.1)), "force must be a number in N"),
    "force truth": (_simulate(force=np.array([True])), "force must be a number in N"),
    "force table": (
        _simulate(force=np.ones((2, 2))),
        r"force must be a single number, got \[1, 1, 1, 1\] of shape \(2, 2\) N",
    ),
    "density complex": (_simulate(density=1e3 + 1j), r"density must be a number in kg/m\^3"),
    "state complex": (_simulate(initial_state=np.array([1, 0, 1 + 1j])), "initial_state must be a number in"),
    "duration zero": (_simulate(duration=0.0), "duration must lie from 1e-09 s to 1000000 s, got 0 s"),
    "duration short": (_simulate(duration=1e-10), "duration must lie from 1e-09 s to .* got 1e-10 s"),
    "duration long": (_simulate(duration=1e7), "duration must lie from 1e-09 s to 1000000 s, got 10000000 s"),
    "duration nan": (_simulate(duration=NAN), "duration .* nan s"),
    "length beyond floats": (
        _simulate(half_length=1e300),
        "equations of equal_biaxial are beyond double precision with half_length = 1e[+]300 m",
    ),
    "length below floats": (_simulate(half_length=1e-300), "with half_length = 1e-300 m"),
    "viscosity below floats": (_simulate(viscosity=1e-320), "with viscosity = .*e-321 Pa s"),
    "field beyond floats": (_simulate(field=1e200), "with field = 1e[+]200 V/m"),
    "held beyond floats": (
        _simulate("pure_shear", held_stretch=1e120),
        "pure_shear_consistent are beyond double precision with held_stretch = 1e[+]120",
    ),
    "sweep beyond floats": (_sweep(half_thickness=1e200), "with half_thickness = 1e[+]200 m"),
    "limits tuple": (
        _simulate(limits=(1e-3, 100)),
        r"limits must be a delagrange.Limits, got \[0.001, 100\]",
    ),
    "limits none": (_simulate(limits=None), "limits must be a delagrange.Limits, got None"),
    "samples many": (
        _simulate(samples=10**12),
        "samples must be an integer from 2 to 10000000, got 1e[+]12",
    ),
    "rtol small": (_simulate(rtol=1e-15), "rtol must lie from 1e-13 to 0.01, got 1e-15"),
    "rtol large": (_simulate(rtol=1.0), "rtol must lie"),
    "atol zero": (_simulate(atol=0.0), "atol must lie from 1e-18"),
    "atol large": (
        _simulate(atol=1),
        "atol must lie from 1e-18 to 0.01 in the unit of each state variable, got 1$",
    ),
    "method": (_simulate(method="RK4"), "method must be one of DOP853, .*'RK4'"),
    "method array": (_simulate(method=np.ones((2, 2))), "method must be one of DOP853"),
    "model array": (_simulate(np.ones((9, 9))), "unknown model .* of shape"),
    "table short": (
        _simulate(field=dl.Tabulated([0.0, 5e-4], [0.0, 1e6])),
        "^field table covers 0 s to 0.0005 s .* 0 s to 0.001 s",
    ),
    "state length": (
        _simulate(initial_state=[1.0, 0.0]),
        r"initial_state must hold 3 values \(stretch \[1\]",
    ),
    "state sign": (_simulate(initial_state=[-1.0, 0.0, 1.0]), "initial_state stretch must be positive"),
    "state nan": (_simulate(initial_state=[1.0, NAN, 1.0]), "initial_state must be finite"),
    "time unsorted": (_simulate(time=[0.0, 5e-4, 2e-4]), "time must be strictly increasing"),
    "time outside": (_simulate(time=[0.0, 2e-3]), "time must lie from 0 s to 0.001 s"),
    "time twice": (_simulate(time=[0.0], samples=5), "time and samples = 5 both given"),
    "samples": (_simulate(samples=1), "samples must be an integer from 2 to 10000000, got 1"),
    "frequency empty": (_sweep(frequency=[]), "frequency must be .* at least one value in Hz"),
    "frequency unsorted": (
        _sweep(frequency=[400.0, 300.0]),
        "frequency must be strictly increasing, got .* Hz",
    ),
    "frequency repeated": (_sweep(frequency=[300.0, 300.0]), "frequency must be strictly increasing"),
    "frequency zero": (_sweep(frequency=[0.0, 300.0]), "frequency must be positive .* Hz"),
    "frequency nan": (_sweep(frequency=[300.0, NAN]), "frequency must be finite"),
    "frequency table": (_sweep(frequency=[[300.0], [400.0]]), "frequency must be a one-dimensional grid"),
    "force twice": (_sweep(force=[0.1, 0.1]), "force must not hold a value twice"),
    "force empty": (_sweep(force=[]), "force must be one value or a one-dimensional grid"),
    "force none": (_sweep(force=None), "force must be a number in N, got None"),
    "amplitude none": (_sweep(field_amplitude=None), "field_amplitude must be a number in V/m"),
    "sweep density": (
        _sweep(density=[1e3, -1e3]),
        r"density must be positive and finite, got \[1000, -1000\] kg/m\^3",
    ),
    "sweep unknown": (_sweep(densty=[1e3, 2e3]), "unknown parameter 'densty'.*'density'"),
    "sweep both": (_sweep(viscosity=1.0, relaxation_time=[1.0, 2.0]), "viscosity .* both given"),
    "sweep held": (_sweep(held_stretch=[2.0, 3.0]), "held_stretch .* equal_biaxial holds no stretch"),
    "sweep held missing": (_sweep("pure_shear"), "held_stretch .* missing"),
    "window": (_sweep(window=(0.0, 2e-3)), "window must be .* 0.001 s"),
    "window order": (_sweep(window=(5e-4, 1e-4)), "window must be strictly increasing"),
    "sweep method": (_sweep(method="Radau"), "method must be one of DOP853, RK45"),
    "field phase": (_sweep(field_phase=[0.0, NAN]), "field_phase must be finite, got .* rad"),
    "field phase text": (_sweep(field_phase="late"), "field_phase must be a number in rad, got 'late'"),
    "field phases twice": (_sweep(field_phase=[1.0, 1.0]), "field_phase must not hold a value twice"),
    "initial no mapping": (
        _sweep(initial_state=[1.0, 0.0, 1.0]),
        r"initial_state must map names .* got \[1, 0, 1\]; equal_biaxial has stretch \[1\], stretch_rate \[1/s\]",
    ),
    "initial name": (
        _sweep(initial_state={"strech": 1.1}),
        r"unknown state variable 'strech' in initial_state \(did you mean 'stretch'\?\); equal_biaxial has",
    ),
    "initial stretch": (
        _sweep(initial_state={"stretch": [1.0, -1.0]}),
        "initial_state stretch must be positive and finite",
    ),
    "initial inelastic stretch": (
        _sweep("uniaxial", initial_state={"inelastic_stretch_2": 0.0}),
        "initial_state inelastic_stretch_2 must be positive and finite, got 0$",
    ),
    "initial rate": (
        _sweep(initial_state={"stretch_rate": INF}),
        "initial_state stretch_rate must be finite, got inf 1/s",
    ),
    "initial grid": (
        _sweep(initial_state={"stretch_rate": [[1.0, 2.0]]}),
        "initial_stretch_rate must be one value or a one-dimensional grid .* 1/s",
    ),
    "averages": (_sweep(averages="yes"), "averages must be True or False, got 'yes'"),
    "final state": (_sweep(final_state=1), "final_state must be True or False, got 1"),
    "section points": (_sweep(section_points=0), "section_points must be an integer from 1 .* got 0"),
    "section points float": (_sweep(section_points=2.5), "section_points must be an integer .* got 2.5"),
    "too few sections": (
        _sweep(frequency=[2000.0, 3000.0], section_points=3, section_phase=1.0),
        "section_points must be at most 2, got 3: .* 0.001 s at frequency 2000 Hz passes the phase 1 rad",
    ),
    "far too many sections": (
        _sweep(section_points=10**9, frequency=[1.0, 1e300]),
        "section_points must be at most 1, got 1000000000",
    ),
    "no section": (
        _sweep(frequency=[3000.0], field_amplitude=[1e6, 2e6], section_points=5),
        "section_points must be at most 4, got 5: .* at frequency 3000 Hz",
    ),
    "section phase": (
        _sweep(section_points=1, section_phase=NAN),
        "section_phase must be finite, got nan rad",
    ),
    "section phases": (
        _sweep(section_points=1, section_phase=[0.0, 1.0]),
        "section_phase must be a single number, got .* rad",
    ),
    "phase alone": (_sweep(section_phase=1.0), "section_phase 1 rad given without section_points"),
    "two samplings": (
        _sweep(section_points=1, sample_interval=1e-4),
        "section_points 1 and sample_interval 0.0001 s both given",
    ),
    "sample interval": (
        _sweep(sample_interval=2e-3),
        "sample_interval must lie from 1e-12 s to 0.001 s, got 0.002 s",
    ),
    "sample interval zero": (_sweep(sample_interval=0.0), "sample_interval must lie from .* got 0 s"),
    "sample interval text": (_sweep(sample_interval="1 ms"), "sample_interval must be a number in s"),
    "memory": (
        _sweep(sample_interval=1e-12, duration=1e-3),
        "result of 2 runs would take .* GiB .* for 1000000001 samples of 3 state variables .* 8.00 GiB are allowed",
    ),
    "threads": (_sweep(threads=0), "threads must be an integer of at least 1, got 0"),
    "threads float": (_sweep(threads=1.5), "threads must be an integer of at least 1, got 1.5"),
    "engine": (_sweep(engine="fortran"), "engine must be one of auto, .*numpy, scipy"),
    "control": (_sweep(step_control="deadbeat"), "step_control must be one of scipy, ode45, pi"),
    "control of another engine": (
        _sweep(engine="numpy", step_control="pi"),
        "engine 'numpy' has method 'DOP853', 'RK45', step_control 'scipy', 'ode45' and .* got 'DOP853', 'pi'",
    ),
    "compiled control": (_sweep(engine="compiled", step_control="scipy"), "engine 'compiled' has .* only"),
    "compiled method": (
        _sweep(engine="compiled", method="RK45"),
        "engine 'compiled' has method 'DOP853', .*",
    ),
    "compiled extrema": (_sweep(engine="compiled", extrema="steps"), "engine 'compiled' has .* 'dense' only"),
    "control pair": (_sweep(step_control="ode45"), "step_control 'ode45' belongs to method 'RK45'"),
    "extrema": (_sweep(extrema="best"), "extrema must be one of dense, samples, steps"),
    "engine pair": (_sweep(engine="scipy", extrema="steps"), "engine 'scipy' has .* only"),
    "sweep rtol": (_sweep(rtol=0.0), "rtol must lie"),
    "sweep table": (_sweep(force=dl.Tabulated([0.0, 5e-4], [0.0, 0.1])), "force table covers"),
    "limits": (lambda: dl.Limits(smallest_stretch=2.0), "smallest_stretch below 1"),
    "limits sign": (lambda: dl.Limits(largest_stretch=-1.0), "largest_stretch must be positive"),
}


@pytest.mark.parametrize("case", CASES)
def test_refused_with_one_line_that_helps(case):
    call, message = CASES[case]
    with pytest.raises(ValueError, match=message) as caught:
        call()
    assert "\n" not in str(caught.value)


def _model_without(*names: str) -> ModuleType:
    """The equal-biaxial model with some inputs taken out of its list, as a model of one's own may be."""
    source = dl.load_model("equal_biaxial")
    module = ModuleType("unforced")
    vars(module).update({name: value for name, value in vars(source).items() if not name.startswith("__")})
    module.MODEL = "unforced"
    module.INPUTS = tuple(entry for entry in source.INPUTS if entry.name not in names)
    for name in ("rhs", "principal_stretches", "electrodes"):
        setattr(module, name, _unforced(getattr(source, name)))
    return module


def _unforced(function):
    return lambda state, inputs, parameters: function(state, (0.0, *inputs), parameters)


def test_a_force_where_the_model_has_none():
    unforced = _model_without("force")
    with pytest.raises(
        ValueError,
        match=r"force given as Constant\(value=0.5\), but unforced has no such input; it has field",
    ):
        dl.simulate(unforced, force=0.5, duration=1e-3)
    run = dl.simulate(unforced, field=1e6, duration=1e-3)
    same = dl.simulate("equal_biaxial", field=1e6, duration=1e-3)
    np.testing.assert_array_equal(run["stretch"], same["stretch"])
    assert "force" not in run


@pytest.mark.parametrize(
    ("lost", "options", "message"),
    [
        ("jacobian", {"method": "Radau"}, "method 'Radau' needs jacobian, which the model unforced does not"),
        ("jacobian", {"method": "auto"}, "method 'auto' needs jacobian"),
        ("force_power", {"energies": True}, "energies=True needs force_power, which the model unforced"),
    ],
)
def test_a_module_that_lacks_what_is_asked_of_it(lost, options, message):
    module = _model_without("force")
    delattr(module, lost)
    assert dl.simulate(module, field=1e6, duration=1e-3).attrs["status"] == "completed"
    with pytest.raises(ValueError, match=message):
        dl.simulate(module, field=1e6, duration=1e-3, **options)


def test_a_field_that_grows_beyond_floats_is_a_loss():
    run = dl.simulate("equal_biaxial", field=dl.Step(1e200, 5e-4), duration=1e-3)
    assert run.attrs["status"] in ("collapsed", "diverged")
    assert run.attrs["status_time"] == pytest.approx(5e-4)


@pytest.mark.parametrize(
    ("model", "choice"),
    [
        ("pure_shear_as_printed", {"formulation": "as-printed", "lateral_dashpot": "held"}),
        ("pure_shear_consistent", {"formulation": "consistent", "lateral_dashpot": "held"}),
        ("pure_shear_consistent_free", {"formulation": "consistent", "lateral_dashpot": "free"}),
        ("uniaxial", {"formulation": "consistent"}),
    ],
)
def test_a_full_name_may_be_said_again_in_words(model, choice):
    module = dl.load_model(model)
    assert dl.load_model(model, **choice) is dl.load_model(module, **choice) is module


def test_hyphens_full_names_and_modules_are_accepted():
    from delagrange.generated import pure_shear_as_printed

    for given in ("pure-shear-as-printed", "pure_shear_as_printed", pure_shear_as_printed):
        assert dl.load_model(given) is pure_shear_as_printed
    assert dl.load_model("pure-shear", formulation="as-printed") is pure_shear_as_printed
    assert dl.load_model("pure_shear").MODEL == "pure_shear_consistent"
    assert set(dl.model_names()) >= {"equal_biaxial", "uniaxial", "pure_shear_consistent_free"}
