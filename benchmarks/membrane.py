"""The membrane that all contestants have: that of Sheng et al. (2015)."""

from __future__ import annotations

import numpy as np

import delagrange
from delagrange.problem.problem import make_problem


def parameter_values(model: str) -> list[float]:
    """Values [SI units] of a model's PARAMETERS."""
    module = delagrange.load_model(model)
    problem = make_problem(module, delagrange.SHENG_2015, {}, None, 0.0, 0.0)
    return [float(np.asarray(value)) for value in problem.parameters]
