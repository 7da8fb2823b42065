"""A second paper: what a newcomer adds, and nothing else."""

from __future__ import annotations

from pathlib import Path

from delagrange.derive.papers.paper import Paper
from more_papers.second_paper.equations import EQUATIONS, TABLE
from more_papers.second_paper.membranes import DESCRIPTIONS
from more_papers.second_paper.symbols import CITATION

PAPER = Paper(CITATION, EQUATIONS, TABLE, DESCRIPTIONS, Path(__file__).parent)
