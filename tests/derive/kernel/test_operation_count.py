"""Compiled kernels take at most twice the operations of equations of motion written well by hand."""

from __future__ import annotations

import numpy as np
import pytest
from described import branches, value_of
from emitted_once import executed
from hand_written import constants, count, gent_uniaxial, neo_hookean_uniaxial, yeoh_equal_biaxial

from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.kernel.compiled_spec import lane_spec
from delagrange.derive.membrane.description import EQUAL_BIAXIAL, UNIAXIAL, Attachment, Description, Load
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.notation import more_symbols as m
from delagrange.derive.pipeline import description_spec

EDGES = (Attachment(1, m.EDGE_MASS), Attachment(2, m.EDGE_MASS))


def uniaxial(alpha, *beta):
    return Description("own", "A membrane", Load(UNIAXIAL), MATERIALS[alpha](ALPHA), branches(*beta))


CASES = {
    "the paper's": (uniaxial("neo-Hookean", "neo-Hookean"), neo_hookean_uniaxial),
    "Gent, one branch": (uniaxial("Gent", "Gent"), gent_uniaxial),
    "Gent, three branches": (uniaxial("Gent", "Gent", "Gent", "Gent"), gent_uniaxial),
    "Yeoh, attached masses": (
        Description(
            "own", "A membrane", Load(EQUAL_BIAXIAL), MATERIALS["Yeoh"](ALPHA),
            parallel_viscosity=m.PARALLEL_VISCOSITY, attachments=EDGES,
        ),
        yeoh_equal_biaxial,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_kernel_takes_at_most_twice_the_operations_of_hand_written_code(name, rng):
    description, by_hand = CASES[name]
    spec = description_spec(description)
    values = {entry.name: value_of(entry.name, entry.unit) for entry in spec.parameters}
    state = 1 + 0.2 * rng.random(len(spec.state))
    written, operations = count(by_hand, state, 0.3, 2e6, values, constants(values))
    parameters = tuple(values[entry.name] for entry in spec.parameters)
    rates = executed(emit(spec), spec.title).rhs(state, (0.3, 2e6), parameters)
    np.testing.assert_allclose(written, rates, rtol=1e-11)  # the same equations
    assert lane_spec(spec).operations <= 2 * operations
