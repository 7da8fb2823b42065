"""Rest and vibration where the coordinate is no stretch: it may be zero or negative, and of any size."""

from __future__ import annotations

from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from charge_membranes import MU, ONE_BRANCH, VOLTAGE, Q, derived
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

import delagrange as dl
from delagrange.derive.membrane.description import Relation
from delagrange.derive.notation.symbols import quantity
from delagrange.equilibrium.chart import make_chart, within_limits
from delagrange.problem.problem import make_problem

BUILT_IN = {"shear_modulus_alpha": MU, "shear_modulus_beta": 4.2e4, "viscosity": 100.0}
SCALE = quantity("s", "scale", "s", "s", "1", "stretch per unit of the coordinate")
q = Q.value.symbol


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("relations")


@pytest.fixture(scope="module")
def equal(folder) -> ModuleType:
    """Both stretches are 1 + s q: the equal-biaxial membrane, from q = 0."""
    stretch = 1 + SCALE.symbol * q
    relation = Relation(Q, (stretch, stretch), sp.S.Zero, (True, True), (SCALE,))
    return derived(folder, "equal", relation=relation, control=VOLTAGE, more=ONE_BRANCH)


@pytest.fixture(scope="module")
def filed(folder) -> ModuleType:
    """The equal-biaxial membrane again, from a file, by its strain q from 0, with its kernels."""
    load = 'kind = "relation"\ncoordinate = "q"\nlambda_1 = "1 + s*q"\nlambda_2 = "1 + s*q"\nstart = 0\n'
    load += "forces = [1, 2]\nparameters = { s = 1 }"
    return derived(folder, "filed", kernels=True, control=VOLTAGE, more=ONE_BRANCH, load=load)


@pytest.fixture(scope="module")
def strained(folder) -> ModuleType:
    """Axis 1 strained by q, axis 2 by -q/4, from a strain of -0.2."""
    relation = Relation(Q, (sp.exp(q), sp.exp(-q / 4)), sp.Rational(-1, 5), (True, False))
    return derived(folder, "strained", relation=relation, control=VOLTAGE)


def pulled(force: float) -> dict[str, float]:
    return {"force_1": force, "force_2": force}


@pytest.mark.parametrize("dashpots", ["relaxed", "frozen"])
@pytest.mark.parametrize(("force", "scale"), [(0.2, 1.0), (-0.3, 1e3), (0.2, 1e-3)])
def test_it_rests_where_the_same_membrane_by_its_stretch_does(equal, dashpots, force, scale):
    fields = np.linspace(0.0, 2.4e7, 5)
    found = dl.equilibria(equal, field=fields, inputs=pulled(force), dashpots=dashpots, scale=scale)
    one = dl.equilibria("equal_biaxial", field=fields, force=force, dashpots=dashpots, **BUILT_IN)
    np.testing.assert_allclose(1 + scale * found["q"], one["stretch"], rtol=1e-9)
    np.testing.assert_array_equal(found["stability"], one["stability"])
    np.testing.assert_allclose(found["limit_field"], one["limit_field"], rtol=1e-9)
    np.testing.assert_array_equal(found["limit_kind"], one["limit_kind"])
    np.testing.assert_allclose(found["edge_force_1"], one["edge_force_1"], rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(found["inelastic_stretch_1"], one["inelastic_stretch"], rtol=1e-9)
    assert "stretch" not in found and found.attrs["coordinates"] == "q"


def test_it_pulls_in_and_vibrates_as_the_same_membrane_does(equal):
    given = {"force": 0.1, **BUILT_IN}
    ours = {"inputs": pulled(0.1), "scale": 40.0}
    slow, one = dl.pull_in(equal, **ours), dl.pull_in("equal_biaxial", **given)
    assert float(slow["field"]) == pytest.approx(float(one["field"]), rel=1e-10)
    assert 1 + 40 * float(slow["q"]) == pytest.approx(float(one["stretch"]), rel=1e-5)  # flat there
    sudden, same = (
        dl.dynamic_pull_in(model, resolution=1e-2, duration=2e-3, **options)
        for model, options in ((equal, ours), ("equal_biaxial", given))
    )
    assert float(sudden["field"]) == pytest.approx(float(same["field"]), rel=1e-9)
    assert 1 + 40 * float(sudden["q"]) == pytest.approx(float(same["stretch"]), rel=1e-8)
    for dashpots in ("frozen", "relaxed"):
        vibrations, others = (
            dl.modes(model, field=[0.0, 1e7], dashpots=dashpots, **options)
            for model, options in ((equal, ours), ("equal_biaxial", given))
        )
        np.testing.assert_allclose(vibrations["frequency"], others["frequency"], rtol=1e-9)


@pytest.mark.parametrize("force", [-0.6, 0.0, 0.5])
def test_its_equilibria_are_all_the_zeros_of_the_emitted_rate(strained, force):
    """Brent's method between the changes of sign of the acceleration, over all that the limits allow."""
    limits = dl.Limits(0.05, 20.0)
    for field in (0.0, 2e7):
        found = dl.equilibria(strained, field=field, inputs={"force": force}, limits=limits)
        problem = make_problem(strained, None, {}, None, 0.0, field, {"force": force})

        def acceleration(value, problem=problem):
            return float(problem.rhs(0.0, np.array([value, 0.0]))[1])

        places = np.linspace(-2.91, 2.9, 2001)  # ln 20 = 2.996
        rates = np.array([acceleration(value) for value in places])
        changes = np.flatnonzero(rates[:-1] * rates[1:] < 0)
        zeros = [brentq(acceleration, places[at], places[at + 1], xtol=1e-15) for at in changes]
        assert zeros or field > 0
        rests = found["q"].values[np.isfinite(found["q"].values)]
        np.testing.assert_allclose(np.sort(rests), zeros, atol=1e-11)
    if force < 0:
        assert float(found["q"].min()) < 0


def test_a_chart_goes_there_and_back(strained, equal):
    for model, reference in ((strained, -0.2), (equal, 0.0)):
        problem = make_problem(
            model, None, {"scale": 1e-4} if model is equal else {}, None, 0.0, 0.0
        )
        chart = make_chart(problem, np.array([0]))
        assert not chart.logarithmic[0]
        values = reference + chart.size[0] * np.array([[-3e6, -0.9, -1e-9, 0.0, 1e-7, 2.0, 5e8]])
        x = chart.x_of(values)
        np.testing.assert_allclose(chart.values(x), values, rtol=1e-12, atol=1e-12 * chart.size[0])
        step = 1e-6  # a witness of the slopes, at some cost in digits
        slopes = (chart.values(x + step) - chart.values(x - step)) / (2 * step)
        np.testing.assert_allclose(chart.slopes(values), slopes, rtol=1e-8)
        np.testing.assert_allclose(chart.moved(values, 0.1), chart.values(x + 0.1), rtol=1e-12)


def test_the_size_of_a_coordinate_strains_the_membrane_by_about_one_half(equal):
    for scale in (1e-6, 1.0, 3e5):
        problem = make_problem(equal, None, {"scale": scale}, None, 0.0, 0.0)
        size = make_chart(problem, np.array([0])).size[0]
        assert 0.5 <= -2 * np.log(1 - scale * size) <= 1.0  # of the thickness, where the stretches shrink
        rest = np.asarray(equal.reference_state(problem.parameters), dtype=float)
        values = within_limits(problem, rest, 0, 400, dl.Limits(0.05, 10.0))
        stretches = 1 + scale * values
        assert stretches.min() == pytest.approx(0.05, rel=0.1)
        assert stretches.max() == pytest.approx(0.05**-0.5, rel=0.01)  # where the thickness is the limit
        assert np.max(np.abs(np.diff(np.log(stretches)))) < 0.05


@pytest.mark.parametrize("dashpots", ["relaxed", "frozen"])
def test_from_a_file_it_rests_and_pulls_in_as_the_built_in_one(filed, dashpots):
    fields = np.linspace(0.0, 2.4e7, 5)
    found = dl.equilibria(filed, field=fields, inputs=pulled(-0.2), dashpots=dashpots)
    one = dl.equilibria("equal_biaxial", field=fields, force=-0.2, dashpots=dashpots, **BUILT_IN)
    assert float(found["coordinate_q"].min()) < 0
    np.testing.assert_allclose(1 + found["coordinate_q"], one["stretch"], rtol=1e-9)
    np.testing.assert_array_equal(found["stability"], one["stability"])
    slow = dl.pull_in(filed, inputs=pulled(0.1), dashpots=dashpots)
    other = dl.pull_in("equal_biaxial", force=0.1, dashpots=dashpots, **BUILT_IN)
    assert float(slow["field"]) == pytest.approx(float(other["field"]), rel=1e-10)


def test_from_a_file_it_moves_as_the_built_in_one(filed):
    """Pressed below its start and pulled beyond it."""
    sine = {"field": dl.Sine(4e6, 300.0), "duration": 0.01, "rtol": 1e-11, "atol": 1e-13}
    force = dl.Sine(0.3, 450.0)
    run = dl.simulate(filed, inputs={"force_1": force, "force_2": force}, energies=True, **sine)
    one = dl.simulate("equal_biaxial", force=force, energies=True, **sine, **BUILT_IN)
    assert float(run["coordinate_q"].min()) < -0.01 and float(run["coordinate_q"].max()) > 0.01
    np.testing.assert_allclose(1 + run["coordinate_q"], one["stretch"], atol=1e-9)
    np.testing.assert_allclose(run["inelastic_stretch_2"], one["inelastic_stretch"], atol=1e-9)
    np.testing.assert_allclose(run["total_energy"], one["total_energy"], atol=1e-12)


@pytest.mark.parametrize("scale", [1.0, 1e3])
def test_from_a_file_its_periodic_motions_are_those_of_the_built_in_one(filed, scale):
    """Large ones, in a coordinate of whatever size."""
    load = {
        "field_amplitude": 9e6,
        "frequency": (420.0, 450.0),
        "dashpots": "relaxed",
        "resolution": 10,
        "seeds": 2,
    }
    found = dl.steady_response(filed, inputs=pulled(0.2), relation_s=scale, **load)
    one = dl.steady_response("equal_biaxial", force=0.2, **load, **BUILT_IN)
    # Points lie at equal lengths of arc, measured in the sizes of the coordinates, which differ a little
    np.testing.assert_allclose(found["frequency"], one["frequency"], rtol=1e-5)
    expected = CubicSpline(one["frequency"], one["amplitude"])(found["frequency"])
    np.testing.assert_allclose(scale * found["amplitude"], expected, rtol=1e-6)
    np.testing.assert_array_equal(found["stability"], one["stability"])


def test_a_coordinate_that_may_be_negative_has_the_equations_of_its_sign(folder):
    """Stretches of q^2: to -q belongs the acceleration -f(q), also where a power is no integer."""
    ogden = 'material = "Ogden"\nogden_modulus_1 = 3e4\nogden_exponent_1 = 1.3'
    load = 'kind = "relation"\ncoordinate = "q"\nlambda_1 = "q^2"\nlambda_2 = "sqrt(q^2 + 1)*q^-2/sqrt(2)"\nstart = -1'
    membrane = derived(folder, "mirrored", control=VOLTAGE, spring=ogden, load=load)
    values = [membrane.DEFAULTS[entry.name] for entry in membrane.PARAMETERS]
    assert list(membrane.reference_state(values)) == [-1.0, 0.0]
    for place in (0.8, 1.0, 1.3):
        here, there = (
            membrane.rhs(np.array([sign * place, sign * 12.0]), [0.2, 3e6], values)[1] for sign in (1.0, -1.0)
        )
        assert np.isfinite(here) and here == pytest.approx(-there, rel=1e-12)


def test_it_is_drawn_by_its_own_name(equal):
    from delagrange.figures.equilibrium_figure import draw_equilibria

    found = dl.equilibria(equal, field=np.linspace(0.0, 2.6e7, 6), inputs=pulled(0.1), scale=1.0)
    axes = draw_equilibria(found).axes[0]
    assert "coordinate of the relation" in axes.get_ylabel()


def test_a_state_of_nothing_but_zeros_begins_to_move_in_every_engine(folder):
    """Without branches, a strain and its rate are all there is; a first step in proportion to them would be 0."""
    load = 'kind = "relation"\ncoordinate = "q"\nlambda_1 = "1 + q"\nlambda_2 = "1 + q"\nstart = 0\nforces = [1, 2]'
    membrane = derived(folder, "elastic", kernels=True, control=VOLTAGE, load=load)
    given = {
        "field_amplitude": 2e6, "frequency": [200.0, 300.0], "duration": 0.02, "rtol": 1e-9,
        "initial_state": {"coordinate_q": [0.0, 1e-13]},
    }  # fmt: skip
    found, one = (dl.frequency_response(membrane, engine=engine, **given) for engine in ("compiled", "numpy"))
    assert set(found["status"].values.ravel()) == {"completed"}
    np.testing.assert_allclose(found["amplitude"], one["amplitude"], rtol=1e-6)
