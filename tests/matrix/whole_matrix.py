"""Laws of mechanics of every membrane of the matrix; no file of tests by name: `make test-matrix` asks for it."""

from __future__ import annotations

import pytest
from every_membrane import MATRIX, check_laws


@pytest.mark.parametrize("cell", MATRIX, ids=str)
def test_the_laws_of_a_membrane(cell, rng):
    check_laws(cell, rng)
