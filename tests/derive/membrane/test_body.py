"""A body of another shape comes in by the door that the rectangle has: a thin ring that expands, by hand."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
import sympy as sp

from delagrange.common.roles import Role
from delagrange.derive.equations.described import description_equations
from delagrange.derive.membrane.body import Body, Domain, Extent, Face, kinetic_energy, volume_of
from delagrange.derive.membrane.description import (
    CHARGE,
    EQUAL_BIAXIAL,
    FREE,
    Attachment,
    Description,
    Dielectric,
    Load,
    MaxwellBranch,
    numbered,
)
from delagrange.derive.membrane.rectangle import rectangle
from delagrange.derive.membrane.strain_energy import neo_hookean
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import quantity
from delagrange.derive.pipeline import derive_description

RADIUS = quantity("R", "radius", "R", "R", "m", "radius in the reference state", Role.SIZE)
WIDTH = quantity("W", "half_width", "W", "W", "m", "half the width in the reference state", Role.SIZE)
PUSH = quantity("F", "radial_force", "F", "F", "N", "sum of the radial forces", Role.FORCE, positive=False)
ANGLE, Z = sp.symbols("Theta Z", real=True)
Q, R, W, H = m.STRETCH.value.symbol, RADIUS.symbol, WIDTH.symbol, s.HALF_THICKNESS.symbol


def ring() -> Body:
    """A thin ring under radial forces: its hoop stretch, and the others alike by incompressibility."""
    across = 1 / sp.sqrt(Q)
    place = (Q * R * sp.cos(ANGLE), Q * R * sp.sin(ANGLE), across * Z)
    extents = (Extent(ANGLE, sp.S.Zero, 2 * sp.pi), Extent(Z, -W, W))
    return Body(
        text="A thin ring of radius R, width 2 W and thickness 2 H in the reference state",
        sizes=(RADIUS, WIDTH, s.HALF_THICKNESS),
        density=s.DENSITY,
        coordinates=(m.STRETCH,),
        principal_stretches=(Q, across, across),
        place=place,
        domain=Domain(extents, 2 * H * R),
        forces=(PUSH,),
        conjugates=(Q * R,),
        on_edges="the ring",
        faces=(Face(place, Domain(extents, R), count=2),),
    )


RING = Description(
    name="ring",
    title="A ring that expands",
    load=Load(FREE),
    equilibrium_spring=neo_hookean(s.SHEAR_MODULUS_ALPHA),
    branches=(MaxwellBranch(neo_hookean(s.SHEAR_MODULUS_BETA), s.VISCOSITY),),
    body=ring(),
    medium_damping=m.MEDIUM_DAMPING,
)
VALUES = {
    "radius": 0.03, "half_width": 0.01, "half_thickness": 5e-4, "density": 1.1e3, "permittivity": 4e-11,
    "shear_modulus_alpha": 2e4, "shear_modulus_beta": 1e4, "viscosity": 50.0, "medium_damping": 3.0,
}  # fmt: skip


@pytest.fixture(scope="module")
def module():
    """The emitted NumPy module of the ring; its two kernels are emitted and compile as Python beside it."""
    (name, text), (header, _), *kernels = derive_description(RING)
    assert (name, header) == ("ring.py", "ring.h")
    assert [each for each, _ in kernels] == ["ring_lanes.py", "ring_variational.py"]
    for each, code in kernels:
        compile(code, each, "exec")
    made = ModuleType("ring")
    exec(compile(text, name, "exec"), made.__dict__)
    return made


def test_the_kinetic_energy_is_that_of_a_ring_by_hand():
    """T = m/2 (R^2 + W^2/(12 lambda^3)) lambda'^2: hoop, and the width that shrinks."""
    rate = m.STRETCH.rate.symbol
    mass = s.DENSITY.symbol * volume_of(ring())
    assert volume_of(ring()) == 8 * sp.pi * R * W * H
    assert sp.simplify(kinetic_energy(ring()) - mass / 2 * (R**2 + W**2 / (12 * Q**3)) * rate**2) == 0


def test_its_rates_are_those_by_hand(module, rng):
    parameters = [VALUES[each.name] for each in module.PARAMETERS]
    radius, width, thickness, density, epsilon, alpha, beta, eta, drag = VALUES.values()
    volume = 8 * np.pi * radius * width * thickness
    for _ in range(5):
        stretch, xi = rng.uniform(0.9, 1.6, 2)
        rate, force, field = rng.uniform(-20, 20), rng.uniform(-1, 1), rng.uniform(0, 4e6)
        inertia = density * volume * (radius**2 + width**2 / (12 * stretch**3))
        quadratic = (
            -density * volume * width**2 / (8 * stretch**4) * rate**2
        )  # half of its slope by the stretch
        elastic = stretch / xi
        stress = (
            alpha * (stretch - stretch**-2) + beta * (elastic - elastic**-2) / xi - epsilon * field**2 / 2
        )
        faces = 2 * 2 * np.pi * radius * 2 * width
        dragged = drag * faces * (radius**2 + width**2 / (12 * stretch**3)) * rate
        net = force * radius - volume * stress - quadratic - dragged
        found = module.rhs((stretch, rate, xi), (force, field), parameters)
        flow = xi * beta / (3 * eta) * (elastic**2 - 1 / elastic)
        np.testing.assert_allclose(found, (rate, net / inertia, flow), rtol=1e-12)


def test_its_energy_falls_at_the_rate_that_is_lost(module):
    parameters = [VALUES[each.name] for each in module.PARAMETERS]
    state, inputs = np.array([1.3, 8.0, 1.1]), (0.4, 2e6)
    moved = state + 1e-200j * module.rhs(state, inputs, parameters)
    energies = (module.kinetic_energy, module.potential_energy)
    change = sum(energy(moved, inputs, parameters).imag for energy in energies) * 1e200
    assert change == pytest.approx(-module.dashpot_power(state, inputs, parameters), rel=1e-11)


def test_its_module_says_what_it_is(module):
    assert (
        "A thin ring of radius R, width 2 W and thickness 2 H in the reference state; SI units"
        in module.__doc__
    )
    assert [each.name for each in module.STATE] == ["stretch", "stretch_rate", "inelastic_stretch"]
    assert [each.name for each in module.INPUTS] == ["radial_force", "nominal_electric_field"]
    assert module.LOAD_CASE == FREE
    parameters = [VALUES[each.name] for each in module.PARAMETERS]
    rest = module.reference_state(parameters)
    np.testing.assert_array_equal(module.rhs(rest, (0.0, 0.0), parameters), 0.0)
    stretches = module.principal_stretches((1.44, 0.0, 1.0), (0.0, 0.0), parameters)
    np.testing.assert_allclose(stretches, (1.44, 1 / 1.2, 1 / 1.2))
    (pull,) = module.edge_forces((1.2, 0.0, 1.2), (0.0, 0.0), parameters)
    volume = 8 * np.pi * VALUES["radius"] * VALUES["half_width"] * VALUES["half_thickness"]
    assert pull == pytest.approx(volume * 2e4 * (1.2 - 1.2**-2) / VALUES["radius"], rel=1e-12)


def test_two_branches_have_an_inelastic_stretch_each():
    branches = tuple(
        MaxwellBranch(neo_hookean(numbered(s.SHEAR_MODULUS_BETA, n)), numbered(s.VISCOSITY, n))
        for n in (1, 2)
    )
    eom = description_equations(replace(RING, branches=branches))
    assert [each.name for each in eom.state[2:]] == ["inelastic_stretch_1", "inelastic_stretch_2"]


def test_charge_that_leaks_flows_through_the_deformed_ring():
    """Ohm: sigma D / epsilon for a constant permittivity, whatever the body."""
    leaky = Dielectric(control=CHARGE, leakage=m.CONDUCTIVITY)
    balance = description_equations(replace(RING, dielectric=leaky)).charge_balance
    expected = m.CONDUCTIVITY.symbol * m.CHARGE_DENSITY.symbol / s.PERMITTIVITY.symbol
    assert sp.simplify(balance.leakage_current - expected) == 0


@pytest.mark.parametrize(
    ("description", "says"),
    [
        (replace(RING, load=Load(EQUAL_BIAXIAL)), "'equal_biaxial' of a body without two axes; allowed is 'free'"),
        (replace(RING, attachments=(Attachment(1, m.EDGE_MASS),)), "attached to axis 1; the body has no edges"),
        (replace(RING, body=replace(ring(), faces=())), "a medium damps a body that has no faces"),
        (replace(RING, body=replace(ring(), forces=())), "0 forces; allowed is one for each coordinate"),
        (
            replace(RING, body=replace(ring(), principal_stretches=(1 / Q**2, Q, Q))),
            "allowed is one coordinate or two that are the first of them, got lambda",
        ),
        (
            replace(RING, body=replace(ring(), principal_stretches=(Q, Q, Q))),
            r"its volume changes by lambda\*\*3; allowed is an incompressible body",
        ),
        (replace(RING, body=replace(ring(), conjugates=(Q,))), "has dimension"),
        (replace(RING, body=replace(ring(), text='A "ring"')), "the text .* allowed are printable characters"),
    ],
    ids=["load", "edges", "faces", "forces", "coordinates", "volume", "unit", "text"],
)  # fmt: skip
def test_a_body_that_makes_no_sense_is_refused_in_one_line(description, says):
    with pytest.raises(ValueError, match=says) as refusal:
        derive_description(description)
    assert "\n" not in str(refusal.value)


def test_a_rectangle_says_what_it_is():
    assert rectangle().text == "A square membrane of sides 2 L and thickness 2 H in the reference state"
    both = rectangle(m.HALF_LENGTH_1, m.HALF_LENGTH_2)
    assert both.text.startswith("A rectangular membrane of sides 2 L_1 and 2 L_2 and thickness 2 H")
    assert both.unlike and not rectangle().unlike
    L, B = m.HALF_LENGTH_1.symbol, m.HALF_LENGTH_2.symbol
    assert volume_of(both) == 8 * L * B * H


def test_the_medium_drags_both_faces_of_a_rectangle():
    """The drag of the medium is the integral of the squared velocity over both faces, by hand for the rectangle."""
    eom = description_equations(
        Description(
            "wet", "", Load(FREE), neo_hookean(s.SHEAR_MODULUS_ALPHA), medium_damping=m.MEDIUM_DAMPING
        )
    )
    L, c = s.HALF_LENGTH.symbol, m.MEDIUM_DAMPING.symbol
    l1, l2 = s.STRETCH_1.value.symbol, s.STRETCH_2.value.symbol
    v1, v2 = s.STRETCH_1.rate.symbol, s.STRETCH_2.rate.symbol
    v3 = -v1 / (l1**2 * l2) - v2 / (l1 * l2**2)
    (medium,) = eom.dissipation.rayleigh
    expected = c / 2 * 8 * L**2 * (L**2 / 3 * (v1**2 + v2**2) + H**2 * v3**2)
    assert sp.simplify(medium.function - expected) == 0
