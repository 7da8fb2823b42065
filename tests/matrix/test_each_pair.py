"""Laws of mechanics over material x rheology x control x constraint, each two choices together in some membrane."""

from __future__ import annotations

import pytest
from every_membrane import CHEAP, MATRIX, check_laws


@pytest.mark.parametrize("cell", CHEAP, ids=str)
def test_the_laws_of_a_membrane(cell, rng):
    check_laws(cell, rng)


def test_each_two_choices_stand_together():
    assert pairs_of(CHEAP) == pairs_of(cell for cell in MATRIX if cell.cost <= 4)
    assert len(CHEAP) < len(MATRIX) / 20


def pairs_of(cells):
    return {pair for cell in cells for pair in cell.pairs}
