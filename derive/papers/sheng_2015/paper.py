"""Sheng et al. (2015), J. Appl. Phys., doi:10.1063/1.4913384: its printed equations beside its membranes."""

from __future__ import annotations

from pathlib import Path

from delagrange.derive.papers.paper import Paper
from delagrange.derive.papers.sheng_2015.equations import EQUATIONS, TABLE
from delagrange.derive.papers.sheng_2015.membranes import DESCRIPTIONS, NOT_EMITTED
from delagrange.derive.papers.sheng_2015.symbols import CITATION

PAPER = Paper(CITATION, EQUATIONS, TABLE, DESCRIPTIONS, Path(__file__).parent, NOT_EMITTED)
