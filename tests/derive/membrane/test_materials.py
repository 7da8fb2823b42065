"""A material is an energy: other springs and other load cases go the whole road, or are refused."""

from __future__ import annotations

import types
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from conftest import paper_membrane
from lambdified import lambdified

from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.equations.described import description_equations
from delagrange.derive.equations.euler_lagrange import equations_of_motion
from delagrange.derive.kernel.kernel import kernel
from delagrange.derive.membrane.description import numbered
from delagrange.derive.membrane.loads import load_case_of
from delagrange.derive.membrane.materials import ALPHA, BETA, MOST_OGDEN_TERMS, branch, material
from delagrange.derive.membrane.materials import MATERIALS as REGISTERED
from delagrange.derive.membrane.strain_energy import gent, mooney_rivlin, neo_hookean
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import quantity
from delagrange.derive.notation.time_derivative import time_derivative
from delagrange.derive.papers.sheng_2015 import symbols as paper
from delagrange.derive.papers.sheng_2015.paper import PAPER

SECOND = [
    quantity(f"mu_2_{of}", f"second_modulus_{of}", "μ_2", r"\mu_{2}", "Pa", "") for of in ("alpha", "beta")
]
LOCKING = [quantity(f"J_{of}", f"locking_{of}", "J", "J", "1", "") for of in ("alpha", "beta")]
MODULI = (s.SHEAR_MODULUS_ALPHA, s.SHEAR_MODULUS_BETA)
MATERIALS = {
    "gent": tuple(map(gent, MODULI, LOCKING)),
    "mooney_rivlin": tuple(map(mooney_rivlin, MODULI, SECOND)),
}
CASES = tuple(each.name for each in PAPER.descriptions if each.name not in PAPER.not_emitted)


def _with_springs(name, alpha, beta):
    """A membrane of the paper with other springs."""
    paper_one = PAPER.description(name)
    branch_of_it = replace(paper_one.branches[0], energy=beta)
    return replace(paper_one, equilibrium_spring=alpha, branches=(branch_of_it,))


def _module(eom):
    module = types.ModuleType(eom.load_case.name)
    exec(compile(emit(kernel(eom, ())), eom.load_case.name, "exec"), module.__dict__)
    return module


def _values(quantities, rng):
    ranges = {"1": (0.9, 1.2), "1/s": (-200, 200), "m": (1e-3, 5e-3), "Pa": (1e4, 5e4), "Pa s": (10, 100)}
    ranges |= {"kg/m^3": (900, 1300), "F/m": (3e-11, 7e-11), "N": (0, 0.5), "V/m": (0, 4e6)}
    return [30.0 if "locking" in q.name else rng.uniform(*ranges[q.unit]) for q in quantities]


@pytest.mark.parametrize(
    ("material", "case"),
    [
        *(("mooney_rivlin", case) for case in CASES),
        *(("gent", case) for case in ("equal_biaxial", "pure_shear_consistent")),
    ],
)
def test_other_springs_go_the_whole_road(material, case, rng):
    """Derived, every term with its unit, emitted, and equal to lambdify; energy is conserved but for the dashpots."""
    eom = description_equations(_with_springs(case, *MATERIALS[material]))
    module, witness = _module(eom), lambdified(eom)
    for _ in range(20):
        state, inputs = np.array(_values(eom.state, rng)), _values(eom.load_case.inputs, rng)
        parameters = _values(eom.parameters, rng)
        for function in ("rhs", "jacobian", "potential_energy", "dashpot_power"):
            ours = getattr(module, function)(state, inputs, parameters)
            theirs = np.asarray(getattr(witness, function)(state, inputs, parameters), dtype=float)
            scale = np.max(np.abs(theirs)) if function in ("rhs", "jacobian") else np.abs(theirs) + 1e-4
            assert np.all(np.abs(ours - theirs) <= 1e-10 * scale), function
        if case != "pure_shear_as_printed":
            moved = state + 1e-200j * module.rhs(state, inputs, parameters)
            energies = [
                f(moved, inputs, parameters).imag * 1e200
                for f in (module.kinetic_energy, module.potential_energy)
            ]
            lost = module.dashpot_power(state, inputs, parameters)
            assert sum(energies) == pytest.approx(
                -lost, abs=1e-9 * (abs(energies[0]) + abs(energies[1]) + abs(lost))
            )


def test_springs_that_share_a_modulus_keep_their_own_share_of_the_reaction():
    """As printed, with one modulus for both springs: the energies of alpha and beta stay apart."""
    both = description_equations(
        _with_springs("pure_shear_as_printed", *[neo_hookean(s.SHEAR_MODULUS_ALPHA)] * 2)
    )
    xi = paper.INELASTIC_STRETCH_PS.value.symbol
    assert not both.energies["spring_alpha"].has(xi)
    assert both.energies["spring_beta"].has(xi)


def _equal_biaxial_with(inelastic):
    internal = paper.INELASTIC_STRETCH_EB
    case = load_case_of(PAPER.description("equal_biaxial"), paper_membrane())
    return replace(case, inelastic_stretches=inelastic(internal.value.symbol))


def test_a_scaled_inelastic_stretch_flows_by_the_chain_rule(equations):
    model = paper_membrane()
    eom = equations_of_motion(model, _equal_biaxial_with(lambda xi: (2 * xi, 2 * xi)))
    plain = equations("equal_biaxial")
    xi = paper.INELASTIC_STRETCH_EB.value.symbol
    assert sp.simplify(2 * eom.internal_rates[0] - plain.internal_rates[0].subs(xi, 2 * xi)) == 0
    assert (
        time_derivative(2 * xi, (paper.INELASTIC_STRETCH_EB,)) == 2 * paper.INELASTIC_STRETCH_EB.rate.symbol
    )


@pytest.mark.parametrize("inelastic", [lambda xi: (xi, xi**2), lambda xi: (xi**2, xi)])
def test_inelastic_stretches_at_odds_with_the_dashpots_are_refused(inelastic):
    model = paper_membrane()
    with pytest.raises(ValueError, match="inelastic_stretch has two different dashpot rates"):
        equations_of_motion(model, _equal_biaxial_with(inelastic))


def test_an_inelastic_stretch_without_a_law_is_refused():
    model = paper_membrane()
    one = sp.Integer(1)
    with pytest.raises(ValueError, match="inelastic_stretch has no dashpot rate of its own"):
        equations_of_motion(model, _equal_biaxial_with(lambda xi: (one, one)))


def test_registered_materials_take_the_shear_moduli_of_the_symbol_table():
    assert REGISTERED["Gent"](ALPHA).parameters[0] == s.SHEAR_MODULUS_ALPHA
    assert REGISTERED["Mooney-Rivlin"](BETA).parameters[0] == s.SHEAR_MODULUS_BETA
    assert REGISTERED["Gent"](branch(1, of=1)).parameters == REGISTERED["Gent"](BETA).parameters


def test_registered_materials_number_the_quantities_of_a_branch():
    gent_of_second = REGISTERED["Gent"](branch(2, of=3))
    expected = tuple(numbered(each, 2) for each in REGISTERED["Gent"](BETA).parameters)
    assert gent_of_second.parameters == expected
    assert [each.name for each in expected] == ["shear_modulus_beta_2", "locking_beta_2"]


def test_no_two_parameters_of_a_membrane_share_a_name_or_a_symbol():
    """Whatever the material of each spring; positive and real symbols of one name would print alike."""
    springs = (ALPHA, BETA, *(branch(number, of=3) for number in (1, 2, 3)))
    for material_of_spring in REGISTERED.values():
        terms = MOST_OGDEN_TERMS if material_of_spring.name == "Ogden" else 1
        found = [q for spring in springs for q in material_of_spring(spring, terms).parameters]
        assert len({q.name for q in found}) == len({q.symbol.name for q in found}) == len(found)


@pytest.mark.parametrize("name", ["neo-Hookean", "Neo Hookean", "NEO_HOOKEAN", "arruda boyce"])
def test_a_name_is_found_however_it_is_written(name):
    assert "".join(filter(str.isalpha, material(name).name.lower())) == "".join(
        filter(str.isalpha, name.lower())
    )


@pytest.mark.parametrize(
    ("asked", "reason"),
    [
        (lambda: material("Gnet"), "material must be one of .*Gent.*did you mean 'Gent'"),
        (lambda: material(3), "material must be one of"),
        (
            lambda: REGISTERED["Ogden"](ALPHA, 10),
            "number of terms of Ogden must be an integer from 1 to 9, got 10",
        ),
        (
            lambda: REGISTERED["Gent"](ALPHA, 2),
            "number of terms of Gent must be an integer from 1 to 1, got 2",
        ),
        (lambda: branch(4, of=3), "number of a branch must be an integer from 1 to 3, got 4"),
    ],
)
def test_what_is_not_there_is_refused(asked, reason):
    with pytest.raises(ValueError, match=reason):
        asked()
