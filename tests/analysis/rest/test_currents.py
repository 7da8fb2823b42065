"""Membranes that leak, at rest under a current: closed forms, and the same membranes under charge control."""

from __future__ import annotations

from functools import cache
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from electrical_membranes import CONDUCTIVITY, PERMITTIVITY, VALUES, emitted
from scipy.optimize import minimize_scalar

import delagrange as dl
from delagrange.analysis.rest.critical_map import critical_map
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.membrane.description import CHARGE as HELD
from delagrange.derive.membrane.description import (
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    RELATION,
    UNIAXIAL,
    Description,
    Dielectric,
    Load,
    Permittivity,
)
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.pipeline import description_spec

CHARGE, CURRENT = "nominal_charge_density", "nominal_current_density"
MAXWELL_TIME = PERMITTIVITY / CONDUCTIVITY  # [s]
CHARGES = np.array([0.0, 1e-3, 2.5e-3, 4e-3])  # [C/m^2]
GROWTH = 3  # [1], of the logarithm of a permittivity by either stretch


def rates(module, state, electrical, force=0.0, **changes):
    """Right-hand side by hand, with the defaults of the module."""
    parameters = [{**module.DEFAULTS, **changes}[entry.name] for entry in module.PARAMETERS]
    return np.asarray(module.rhs(np.asarray(state), (force, electrical), parameters))


@pytest.mark.parametrize("dashpots", ["relaxed", "frozen"])
@pytest.mark.parametrize("kind", [EQUAL_BIAXIAL, UNIAXIAL, PURE_SHEAR])
def test_over_a_current_it_rests_as_over_the_charge_that_it_holds(kind, dashpots):
    """With a constant permittivity D = i ε / σ at any stretch."""
    given = {"force": 0.2, "dashpots": dashpots}
    held = dl.equilibria(emitted("charge", kind), inputs={CHARGE: CHARGES}, **given)
    fed = dl.equilibria(emitted("current", kind), inputs={CURRENT: CHARGES / MAXWELL_TIME}, **given)
    assert fed[CURRENT].units == "A/m^2" and fed.attrs["varied_input"] == CURRENT
    assert fed.sizes["branch"] == held.sizes["branch"] == 1
    first = fed.attrs["coordinates"].split(", ")[0]
    for name in (first, "true_field", "edge_force_1", "edge_force_2", "thickness_stretch"):
        np.testing.assert_allclose(fed[name], held[name], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(fed[CHARGE][:, 0], CHARGES, rtol=1e-9, atol=1e-16)
    assert set(fed["stability"].values.ravel()) == {"stable"}
    np.testing.assert_array_equal(fed["tension_lost"], held["tension_lost"])


@pytest.mark.parametrize("kind", [EQUAL_BIAXIAL, UNIAXIAL, RELATION])
def test_its_branch_is_that_of_the_state_of_rest(kind):
    """With a permittivity that falls with the stretches, so that the charge knows them."""
    model, currents = emitted("current", kind, "softening"), np.array([-0.3, -0.1, 0.2])
    found = dl.equilibria(model, inputs={CURRENT: currents})
    about = dl.modes(model, inputs={CURRENT: currents}, dashpots="relaxed")
    for place, current in enumerate(currents):
        rest = dl.rest_state(model, inputs={CURRENT: current})
        for entry in model.STATE:
            value = pytest.approx(rest[entry.name], rel=1e-9, abs=1e-15)
            assert float(found[entry.name][place, 0]) == value
            assert float(about[entry.name][place]) == value
        assert rates(model, list(rest.values()), current)[-1] == pytest.approx(0.0, abs=1e-10 * abs(current))


@pytest.mark.parametrize("dashpots", ["relaxed", "frozen"])
def test_modes_are_those_at_a_constant_charge_and_its_leak(dashpots):
    """With a constant permittivity the charge does not know the stretches, and leaks as it does."""
    fed, held = emitted("current", UNIAXIAL), emitted("charge", UNIAXIAL)
    found = dl.modes(fed, force=0.1, inputs={CURRENT: 0.25}, dashpots=dashpots)
    state = [float(found[entry.name]) for entry in held.STATE]
    frozen = {"viscosity": np.inf} if dashpots == "frozen" else {}
    parameters = [{**held.DEFAULTS, **frozen}[entry.name] for entry in held.PARAMETERS]
    values = np.linalg.eigvals(held.jacobian(state, (0.1, 0.25 * MAXWELL_TIME), parameters))
    vibrating = sorted(values[values.imag > 1.0], key=lambda value: value.imag)
    np.testing.assert_allclose(found["frequency"], [value.imag / (2 * np.pi) for value in vibrating], rtol=1e-9)
    np.testing.assert_allclose(found["decay_rate"], [-value.real for value in vibrating], rtol=1e-8)
    assert np.min(np.abs(found["relaxation_rate"] - 1 / MAXWELL_TIME)) < 1e-7
    assert found["relaxation_rate"].size == (1 if dashpots == "frozen" else 3)
    assert found["resonant_current_frequency"].attrs["explanation"].startswith("the charge enters squared")


@cache
def growing() -> ModuleType:
    """A neo-Hookean membrane whose permittivity ε exp(3 (λ_1 + λ_2 - 2)) grows so fast that a current pulls it in."""
    law = Permittivity(
        (s.PERMITTIVITY,),
        lambda stretches: s.PERMITTIVITY.symbol * sp.exp(GROWTH * (stretches[0] + stretches[1] - 2)),
    )
    described = Description(
        "growing",
        "A membrane whose permittivity grows",
        Load(EQUAL_BIAXIAL),
        MATERIALS["neo-Hookean"](ALPHA),
        dielectric=Dielectric(law, HELD, m.CONDUCTIVITY),
    )
    module = ModuleType("growing")
    exec(compile(emit(description_spec(described)), module.__name__, "exec"), module.__dict__)
    module.DEFAULTS = {entry.name: VALUES[entry.name] for entry in module.PARAMETERS}
    return module


def current_that_holds(stretch: float) -> float:
    """Closed form: 2 μ (λ - λ^-5) = -D^2 d/dλ (λ^-4 / 2 ε(λ)), i = σ D / ε(λ)."""
    growth = np.exp(2 * GROWTH * (stretch - 1))
    permittivity = PERMITTIVITY * growth
    elastic = 2 * VALUES["shear_modulus_alpha"] * (stretch - stretch**-5)
    charge = np.sqrt(elastic * 2 * permittivity * stretch**4 / (4 / stretch + 2 * GROWTH))
    return CONDUCTIVITY * charge / permittivity


def test_a_slowly_growing_current_pulls_in_where_it_is_largest():
    best = minimize_scalar(lambda stretch: -current_that_holds(stretch), bounds=(1.01, 3.0), method="bounded")
    current = -float(best.fun)
    found = dl.pull_in(growing())
    assert found["found"].item() == "pull-in"
    assert float(found[CURRENT]) == pytest.approx(current, rel=1e-10)
    assert float(found["stretch"]) == pytest.approx(float(best.x), rel=1e-5)
    both = dl.equilibria(growing(), inputs={CURRENT: 0.9 * current})
    assert both["stability"].values.tolist() == ["stable", "unstable"]
    for stretch in both["stretch"].values:
        assert current_that_holds(stretch) == pytest.approx(0.9 * current, rel=1e-9)
    beyond = dl.modes(growing(), inputs={CURRENT: 1.01 * current})
    assert "no equilibrium: beyond the limit point" in beyond["status"].item()
    with pytest.raises(ValueError, match=f"there is one up to {CURRENT} = {current:.5g}"):
        dl.rest_state(growing(), inputs={CURRENT: 1.01 * current})


def test_a_sudden_current_pulls_in_by_integration():
    """A little beyond the current of static pull-in, which is passed slowly, and where runs by themselves are lost."""
    given = {"duration": 0.15, "conductivity": 6e-8, "limits": dl.Limits(largest_stretch=1.35)}
    found = dl.dynamic_pull_in(growing(), resolution=1e-2, engine="numpy", **given)
    assert found["found"].item() == "dynamic pull-in" and found["method"].item() == "integration"
    assert not any("energy" in name for name in found)
    middle, half = float(found[CURRENT]), float(found["bracket_width"]) / 2
    assert 1.0 < middle / float(found[f"static_{CURRENT}"]) < 1.05
    for current, stands in ((middle - half, True), (middle + half, False)):
        run = dl.simulate(growing(), inputs={CURRENT: current}, **given)
        assert (run.attrs["status"] == "completed") == stands


ENDLESS = "its charge does not leak, and under a constant current grows without end"
REFUSED = {
    "equilibria": (dl.equilibria, {"inputs": {CURRENT: [0.0, 0.1]}}, f"has no rest under a current: {ENDLESS}"),
    "modes": (dl.modes, {"inputs": {CURRENT: 0.1}}, f"has no rest under a current: {ENDLESS}"),
    "pull-in": (dl.pull_in, {}, f"has no rest under a current: {ENDLESS}"),
    "a sudden one": (dl.dynamic_pull_in, {}, f"has no rest under a current: {ENDLESS}"),
    "a map": (critical_map, {"force": [0.0, 0.1]}, f"has no rest under a current: {ENDLESS}"),
    "a state of rest": (dl.rest_state, {"inputs": {CURRENT: 0.1}}, ENDLESS),
    "a response": (
        dl.steady_response,
        {"frequency": (200.0, 210.0), "current_amplitude": 0.1},
        f"has no periodic motion of its own under a current: {ENDLESS}",
    ),
    "a stepped sweep": (
        dl.stepped_sweep,
        {"frequency": [200.0], "current_amplitude": 0.1, "current_bias": 0.01},
        f"has no rest to begin from under a current: {ENDLESS}",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_leak_does_not_rest_under_a_current(case):
    analysis, given, says = REFUSED[case]
    with pytest.raises(ValueError, match=says) as refusal:
        analysis(emitted("current"), conductivity=0.0, **given)
    assert "\n" not in str(refusal.value)


def test_without_current_it_rests_though_it_does_not_leak():
    model = emitted("current")
    found = dl.equilibria(model, force=0.2, inputs={CURRENT: 0.0}, conductivity=0.0)
    leaking = dl.equilibria(model, force=0.2, inputs={CURRENT: 0.0})
    np.testing.assert_allclose(found["stretch"], leaking["stretch"], rtol=1e-12)
    assert dl.modes(model, force=0.2, conductivity=0.0)["frequency"].item() > 0


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"field": 1e6}, "field given as 1000000, but the electrical input of .* is nominal_current_density"),
        ({}, r"inputs nominal_current_density \[A/m\^2\] must be given, got none"),
        ({"inputs": {CURRENT: [0.2, 0.1]}}, "inputs nominal_current_density must be strictly increasing"),
    ],
)
def test_another_input_or_none_is_refused(given, says):
    with pytest.raises(ValueError, match=says):
        dl.equilibria(emitted("current"), **given)


def test_a_charge_that_leaks_slowly_is_never_sudden():
    with pytest.raises(ValueError, match=r"duration \[s\] must be given: the charge leaks within 1e\+03 s"):
        dl.dynamic_pull_in(emitted("current"), conductivity=6e-14)


def test_a_field_by_its_name_is_that_by_its_argument():
    model, fields = emitted("voltage"), [0.0, 1e6, 3e6]
    by_name = dl.equilibria(model, force=0.1, inputs={"field": fields})
    assert by_name.identical(dl.equilibria(model, force=0.1, field=fields))
    by_name = dl.modes(model, inputs={"nominal_electric_field": 1e6})
    assert by_name.identical(dl.modes(model, field=1e6))
