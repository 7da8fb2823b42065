"""Described membranes through the whole road: laws of mechanics, and limits, of the modules that are emitted."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from described import (
    CURVED,
    KINDS,
    RECTANGLE,
    SOFTENING,
    VALUES,
    described,
    emitted,
    inputs_of,
    parameters_of,
    plain,
    slope,
    state_of,
)

from delagrange.common.roles import Role
from delagrange.derive.equations.described import description_equations
from delagrange.derive.membrane.constraint import constrain, kinematics, loads
from delagrange.derive.membrane.description import (
    BIAXIAL,
    CHARGE,
    EQUAL_BIAXIAL,
    PURE_SHEAR,
    REACTION_IN_POTENTIAL,
    RELATION,
    UNIAXIAL,
    Attachment,
    Dielectric,
    Load,
    Notation,
)
from delagrange.derive.membrane.strain_energy import neo_hookean
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import moving, quantity
from delagrange.derive.pipeline import derive_description, description_spec
from delagrange.generated import (
    equal_biaxial,
    pure_shear_as_printed,
    pure_shear_consistent,
    pure_shear_consistent_free,
    uniaxial,
)

CASES = {
    "equal-biaxial, no branch": described(EQUAL_BIAXIAL),
    "equal-biaxial, Gent, three branches": described(
        EQUAL_BIAXIAL, "Gent", "neo-Hookean", "Gent", "Mooney-Rivlin"
    ),
    "equal-biaxial, Ogden beside Ogden": described(EQUAL_BIAXIAL, "Ogden", "Ogden"),
    "equal-biaxial, charge, masses and springs": described(
        EQUAL_BIAXIAL, "neo-Hookean", "neo-Hookean", dielectric=Dielectric(control=CHARGE),
        attachments=tuple(Attachment(axis, m.EDGE_MASS, m.EDGE_STIFFNESS) for axis in (1, 2)),
    ),
    "uniaxial, Gent, one branch": described(UNIAXIAL, "Gent", "neo-Hookean"),
    "uniaxial, Arruda-Boyce, no branch": described(UNIAXIAL, "Arruda-Boyce"),
    "biaxial, rectangular, Mooney-Rivlin, two branches": described(
        BIAXIAL, "Mooney-Rivlin", "neo-Hookean", "neo-Hookean", body=RECTANGLE,
        attachments=(Attachment(1, m.EDGE_MASSES[0], m.EDGE_STIFFNESSES[0]),),
    ),
    "pure shear, Yeoh, one branch": described(PURE_SHEAR, "Yeoh", "neo-Hookean", body=RECTANGLE),
    "pure shear, Gent, two branches held": described(
        PURE_SHEAR, "Gent", "neo-Hookean", "neo-Hookean", load=Load(PURE_SHEAR, lateral_dashpots_free=False)
    ),
    "relation, softening permittivity, one branch": described(
        RELATION, "neo-Hookean", "neo-Hookean", load=Load(RELATION, relation=CURVED), body=RECTANGLE,
        dielectric=Dielectric(SOFTENING),
    ),
}  # fmt: skip


def imported(path) -> ModuleType:
    spec = spec_from_file_location(path.stem, path)
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("case", CASES)
def test_energy_is_lost_at_the_rate_at_which_it_dissipates(rng, case):
    """d(T + Pi)/dt at constant inputs is minus what dashpots and medium dissipate."""
    module = emitted(CASES[case])
    parameters, inputs = parameters_of(module), inputs_of(module)
    for _ in range(5):
        state = state_of(module, rng, parameters)

        def energy(at):
            return module.kinetic_energy(at, inputs, parameters) + module.potential_energy(
                at, inputs, parameters
            )

        rate = module.rhs(state, inputs, parameters)
        lost = module.dashpot_power(state, inputs, parameters)
        assert lost > 0
        scale = abs(slope(lambda at: module.kinetic_energy(at, inputs, parameters), state, rate)) + lost
        assert slope(energy, state, rate) == pytest.approx(-lost, abs=1e-11 * scale, rel=1e-11)


@pytest.mark.parametrize("case", CASES)
def test_the_jacobians_are_the_derivatives_of_the_rates(rng, case):
    module = emitted(CASES[case])
    parameters, inputs = parameters_of(module), np.array(inputs_of(module))
    state = state_of(module, rng, parameters)
    for name, values, rates in (
        ("jacobian", state, lambda at: module.rhs(at, inputs, parameters)),
        ("input_jacobian", inputs, lambda at: module.rhs(state, at, parameters)),
    ):
        columns = [slope(rates, values, direction) for direction in np.eye(len(values))]
        found = getattr(module, name)(state, inputs, parameters)
        expected = np.transpose(columns)
        assert np.allclose(found, expected, rtol=1e-10, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("case", [case for case in CASES if not case.startswith(("pure shear", "relation"))])
def test_an_undeformed_membrane_without_load_stays_where_it_is(case):
    module = emitted(CASES[case])
    parameters = parameters_of(module)
    state = module.reference_state(parameters)
    moved = module.rhs(state, [0.0] * len(module.INPUTS), parameters)
    assert np.allclose(moved, 0, atol=1e-6)


# --- the paper's membrane is one case ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("load", "builtin"),
    [
        (Load(EQUAL_BIAXIAL), equal_biaxial),
        (Load(UNIAXIAL), uniaxial),
        (Load(PURE_SHEAR), pure_shear_consistent_free),
        (Load(PURE_SHEAR, lateral_dashpots_free=False), pure_shear_consistent),
        (Load(PURE_SHEAR, False, formulation=REACTION_IN_POTENTIAL), pure_shear_as_printed),
    ],
    ids=lambda each: getattr(each, "MODEL", ""),
)
def test_the_papers_membrane_comes_out_of_its_description(rng, load, builtin):
    module = emitted(plain(load.kind, "neo-Hookean", load=load))
    for label in ("STATE", "INPUTS", "PARAMETERS"):
        assert [e.name for e in getattr(module, label)] == [e.name for e in getattr(builtin, label)]
    parameters, inputs = parameters_of(module), inputs_of(module)
    state = state_of(module, rng, parameters)
    for name in ("rhs", "jacobian", "input_jacobian", "potential_energy", "dashpot_power", "edge_forces"):
        found, expected = (getattr(each, name)(state, inputs, parameters) for each in (module, builtin))
        assert np.allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max()), name


# --- general forms in their limits -------------------------------------------------------------------


def test_equal_branches_are_one_with_the_sum_of_their_moduli(rng):
    one, three = emitted(plain(UNIAXIAL, "neo-Hookean")), emitted(plain(UNIAXIAL, *["neo-Hookean"] * 3))
    single = parameters_of(one)
    shared = {
        f"{entry.name}_{number}": value / 3
        for entry, value in zip(one.PARAMETERS, single, strict=True)
        for number in (1, 2, 3)
        if entry.name in ("shear_modulus_beta", "viscosity")
    }
    split = parameters_of(three, **shared)
    state, inputs = state_of(one, rng, single), inputs_of(one)
    found = three.rhs([*state[:4], *[*state[4:]] * 3], inputs, split)
    expected = one.rhs(state, inputs, single)
    assert np.allclose(found, [*expected[:4], *[*expected[4:]] * 3], rtol=1e-12)
    assert three.dashpot_power([*state[:4], *[*state[4:]] * 3], inputs, split) == pytest.approx(
        one.dashpot_power(state, inputs, single), rel=1e-12
    )


def test_equal_forces_along_both_axes_give_the_equal_biaxial_motion(rng):
    parts = {"parallel_viscosity": m.PARALLEL_VISCOSITY, "medium_damping": m.MEDIUM_DAMPING}
    both = emitted(plain(BIAXIAL, "neo-Hookean", alpha="Mooney-Rivlin", **parts))
    equal = emitted(plain(EQUAL_BIAXIAL, "neo-Hookean", alpha="Mooney-Rivlin", **parts))
    parameters = parameters_of(equal)
    assert parameters == parameters_of(both)
    stretch, rate, inelastic = state_of(equal, rng, parameters)
    found = both.rhs([stretch, stretch, rate, rate, inelastic, inelastic], [0.4, 0.4, 4e6], parameters)
    expected = equal.rhs([stretch, rate, inelastic], [0.4, 4e6], parameters)
    assert np.allclose(found, np.repeat(expected, 2), rtol=1e-11)


def test_a_gent_membrane_that_never_locks_is_neo_hookean(rng):
    gent, soft = (emitted(plain(EQUAL_BIAXIAL, name, alpha=name)) for name in ("Gent", "neo-Hookean"))
    parameters = parameters_of(soft)
    by_name = dict(zip((entry.name for entry in soft.PARAMETERS), parameters, strict=True))
    state, inputs = state_of(soft, rng, parameters), inputs_of(soft)
    expected = soft.rhs(state, inputs, parameters)
    errors = [
        np.abs(
            gent.rhs(state, inputs, parameters_of(gent, **by_name, locking_alpha=far, locking_beta=far))
            / expected
            - 1
        ).max()
        for far in (1e4, 1e6, 1e8)
    ]
    assert errors[0] < 1e-2
    assert errors[1] == pytest.approx(errors[0] / 100, rel=0.05)
    assert errors[2] == pytest.approx(errors[1] / 100, rel=0.05)


def test_without_branches_nothing_is_lost(rng):
    module = emitted(plain(UNIAXIAL))
    parameters = parameters_of(module)
    state = state_of(module, rng, parameters)
    assert module.dashpot_power(state, inputs_of(module), parameters) == 0
    assert len(module.STATE) == 4


def test_the_energy_under_charge_falls_as_the_membrane_thins():
    """By hand: volume D^2 lambda^-4/(2 epsilon), of the charge over the area that the stretch gives it."""
    module = emitted(CASES["equal-biaxial, charge, masses and springs"])
    parameters, charge = parameters_of(module), 1.3e-4
    volume = 8 * VALUES["half_length"] ** 2 * VALUES["half_thickness"]
    for stretch in (1.0, 1.5, 2.5):
        state = [stretch, 0.0, 1.0]
        with_charge, without = (
            module.potential_energy(state, [0.0, density], parameters) for density in (charge, 0.0)
        )
        expected = volume * charge**2 / (2 * VALUES["permittivity"] * stretch**4)
        assert with_charge - without == pytest.approx(expected, rel=1e-9)


# --- constraints and what is attached ----------------------------------------------------------------


def test_reactions_are_what_an_unconstrained_membrane_would_need(rng):
    """The free membrane under applied forces plus the reactions moves as the constrained one does."""
    case = "relation, softening permittivity, one branch"
    held, free = emitted(CASES[case]), emitted(replace(CASES[case], load=Load(BIAXIAL)))
    parameters, inputs = parameters_of(held), inputs_of(held)
    state = state_of(held, rng, parameters)
    q, rate, *inelastic = state
    acceleration = held.rhs(state, inputs, parameters)[1]
    reactions = held.reaction_forces(state, inputs, parameters)
    across = 2 * VALUES["slope"] * q  # d lambda_2 / dq
    stretches = [q, 1 + VALUES["slope"] * (q**2 - 1)]
    full = [*stretches, rate, across * rate, *inelastic]
    by_name = dict(zip((entry.name for entry in held.PARAMETERS), parameters, strict=True))
    found = free.rhs(
        full, [inputs[0] + reactions[0], inputs[1] + reactions[1], inputs[2]], parameters_of(free, **by_name)
    )
    expected = [acceleration, across * acceleration + 2 * VALUES["slope"] * rate**2]
    assert np.allclose(found[2:4], expected, rtol=1e-10)
    levers = (VALUES["half_length_1"], VALUES["half_length_2"] * across)
    assert np.dot(reactions, levers) == pytest.approx(0, abs=1e-12 * abs(reactions[0] * levers[0]))


def test_masses_on_the_edges_add_their_inertia():
    with_mass = emitted(CASES["biaxial, rectangular, Mooney-Rivlin, two branches"])
    without = emitted(replace(CASES["biaxial, rectangular, Mooney-Rivlin, two branches"], attachments=()))
    state = with_mass.reference_state(parameters_of(with_mass))
    heavy, light = (
        module.mass_matrix(state, inputs_of(module), parameters_of(module)) for module in (with_mass, without)
    )
    extra = 2 * VALUES["edge_mass_1"] * VALUES["half_length_1"] ** 2
    assert np.allclose(heavy - light, [[extra, 0], [0, 0]], rtol=1e-9, atol=1e-15)


def test_the_limit_of_a_gent_spring_is_where_its_invariant_locks():
    module = emitted(plain(EQUAL_BIAXIAL, "neo-Hookean", alpha="Gent"))
    parameters = parameters_of(module)
    rest = module.reference_state(parameters)
    assert module.validity(rest, inputs_of(module), parameters) == KINDS["locking"]
    stretch = np.linspace(1.0, 9.0, 2001)
    room = module.validity([stretch, 0.0, stretch], inputs_of(module), parameters)
    locks = stretch[np.argmax(room <= 0)]
    assert 2 * locks**2 + locks**-4 - 3 == pytest.approx(KINDS["locking"], rel=2e-3)
    assert not hasattr(emitted(plain(UNIAXIAL)), "validity")


def test_the_force_of_the_frame_is_put_into_the_potential_of_whoever_asks_for_it():
    """Each part W of the potential but the forces becomes W - lambda_2 dW/dlambda_2 where lambda_2 is held."""
    load = Load(PURE_SHEAR, formulation=REACTION_IN_POTENTIAL)
    inserted = description_equations(described(PURE_SHEAR, "Gent", "neo-Hookean", "Gent", load=load))
    free, load_case = inserted.membrane, inserted.load_case
    held = free.coordinates[1].value.symbol
    substitution = kinematics(free, load_case) | loads(free, load_case)
    assert [part.name for part in free.energies.parts if part.name != "forces"] == [
        "spring_alpha", "spring_beta_1", "spring_beta_2", "electrostatic",
    ]  # fmt: skip
    for part in free.energies.parts:
        if part.name != "forces":
            expected = constrain(part.expression - held * part.expression.diff(held), substitution)
            assert sp.simplify(inserted.energies[part.name] - expected) == 0
    assert "a step that a workless constraint does not allow" in emitted(
        described(PURE_SHEAR, "Gent", load=load)
    ).__doc__.replace("\n", " ")


def test_a_description_may_have_a_notation_of_its_own(rng):
    """The names stay unless it gives others; the motion is the same, written otherwise."""
    side = moving("x", "side", "x", "x", "side over its length at rest", Role.STRETCH)
    usual = plain(EQUAL_BIAXIAL, "neo-Hookean")
    own, same = emitted(replace(usual, notation=Notation((side,), source="A letter (2020)"))), emitted(usual)
    assert [each.name for each in own.STATE] == ["side", "side_rate", "inelastic_stretch"]
    assert "Governing equations, in the notation of A letter (2020):" in own.__doc__
    parameters, inputs = parameters_of(own), inputs_of(own)
    state = state_of(own, rng, parameters)
    assert np.array_equal(own.rhs(state, inputs, parameters), same.rhs(state, inputs, parameters))


# --- what is refused, and what a module carries -----------------------------------------------------


def test_a_module_carries_the_values_of_its_description(tmp_path):
    values = {"half_length": 0.05, "shear_modulus_alpha": 2e4}
    files = derive_description(plain(EQUAL_BIAXIAL, defaults=values, sources=("A book (1999)",)))
    assert [name for name, _ in files] == ["own.py", "own.h", "own_lanes.py", "own_variational.py"]
    path = tmp_path / "own.py"
    path.write_text(files[0][1], encoding="utf-8")
    module = imported(path)
    assert values == module.DEFAULTS
    assert "A book (1999)" in module.__doc__
    assert "Treloar (1943)" in module.__doc__


def constant_relation(**parts) -> Load:
    return Load(RELATION, relation=replace(CURVED, **parts))


@pytest.mark.parametrize(
    ("description", "says"),
    [
        (plain("twisting"), r"load 'twisting'; allowed is one of equal_biaxial"),
        (plain(RELATION), r"needs the relation"),
        (plain(RELATION, load=constant_relation(stretches=(sp.S(2), sp.S(1)))), r"leaves no freedom"),
        (
            plain(RELATION, load=constant_relation(parameters=())),
            r"lambda_2 depends on s; allowed are stretch",
        ),
        (plain(EQUAL_BIAXIAL, body=RECTANGLE), r"sides are different quantities"),
        (plain(EQUAL_BIAXIAL, attachments=(Attachment(1, m.EDGE_MASS),)), r"axis 1 than on axis 2"),
        (plain(UNIAXIAL, attachments=(Attachment(3, m.EDGE_MASS),)), r"axis 3; allowed are 1 and 2"),
        (plain(UNIAXIAL, dielectric=Dielectric(control="power")), r"'power' control"),
        (
            plain(UNIAXIAL, load=Load(UNIAXIAL, formulation="printed")),
            r"formulation 'printed'; allowed are consistent",
        ),
        (
            plain(UNIAXIAL, load=Load(UNIAXIAL, formulation=REACTION_IN_POTENTIAL)),
            r"'as_printed' of a load that holds no axis alone; allowed is consistent",
        ),
        (
            plain(RELATION, load=Load(RELATION, relation=CURVED, formulation=REACTION_IN_POTENTIAL)),
            r"'as_printed' of a load that holds no axis alone",
        ),
        (
            plain(UNIAXIAL, notation=Notation((s.STRETCH_1,))),
            r"notation has 1 coordinates; allowed are the 2 of its",
        ),
        (
            plain(UNIAXIAL, notation=Notation(internals=(s.INELASTIC_STRETCH_1,))),
            r"notation has 1 inelastic stretches; allowed are the 0 of its load",
        ),
        (
            plain(RELATION, load=Load(RELATION, relation=CURVED), notation=Notation((s.STRETCH_1,))),
            r"notation has a coordinate; allowed is that of its relation alone",
        ),
        (plain(UNIAXIAL, remark='of "mine"'), r"the text .*; allowed are printable characters"),
        (plain(UNIAXIAL, defaults={"half_lenght": 1.0}), r"half_lenght, .* nearest is half_length"),
        (replace(plain(UNIAXIAL), name="my-model"), r"model name 'my-model'"),
        (
            replace(
                plain(UNIAXIAL),
                equilibrium_spring=neo_hookean(replace(s.DENSITY, symbol=sp.Symbol("mu"), unit="Pa")),
            ),
            r"share a name or symbol",
        ),
        (
            replace(
                plain(UNIAXIAL), equilibrium_spring=neo_hookean(replace(s.SHEAR_MODULUS_ALPHA, unit="N"))
            ),
            r"has dimension",
        ),
    ],
    ids=lambda each: each if isinstance(each, str) else "",
)
def test_what_is_at_odds_with_itself_is_refused_in_one_line(description, says):
    with pytest.raises(ValueError, match=says) as caught:
        description_spec(description)
    assert "\n" not in str(caught.value)


def test_equations_of_a_description_need_no_global_table():
    """A quantity that is in no table goes the whole road."""
    own = quantity("zeta", "stiffness_of_mine", "ζ", r"\zeta", "Pa", "a stiffness of mine")
    eom = description_equations(replace(plain(UNIAXIAL), equilibrium_spring=neo_hookean(own)))
    assert own in eom.quantities
    assert own not in vars(s).values()
