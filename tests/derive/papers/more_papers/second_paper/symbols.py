"""What the symbols of the second paper are, and who printed it."""

from __future__ import annotations

from delagrange.common.roles import Role
from delagrange.derive.membrane.materials import ALPHA, MATERIALS
from delagrange.derive.notation.symbols import moving

CITATION = "A made-up letter (2020), Journal of the Tests 1, 1"
SIDE = moving("x", "side_stretch", "x", "x", "side over its length in the reference state", Role.STRETCH)
GENT = MATERIALS["Gent"](ALPHA)
MODULUS, LOCKING = GENT.parameters
