"""Shared by the tests: each derivation is made once a session."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

from delagrange.derive import pipeline
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.membrane.load_cases import BIAXIAL, EMITTED, LoadCase
from delagrange.derive.membrane.membrane import Membrane

pytest.register_assert_rewrite("every_membrane")
settings.register_profile(
    "delagrange", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("delagrange")

CASES = {case.name: case for case in (BIAXIAL, *EMITTED)}


@cache
def paper_membrane() -> Membrane:
    return pipeline.paper_membrane()


@cache
def derived(name: str) -> EquationsOfMotion:
    return pipeline.derive(paper_membrane(), CASES[name])


@pytest.fixture(scope="session")
def equations():
    """`equations("uniaxial")` -> EquationsOfMotion of that load case, derived once."""
    return derived


@pytest.fixture(scope="session")
def load_case():
    def get(name: str) -> LoadCase:
        return CASES[name]

    return get


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20150225)


# Sheng et al. (2015), Sec. III, in the order of the generated modules' PARAMETERS; viscosity = tau_v mu_beta
PAPER_VALUES = (5e-3, 1e-3, 1.2e3, 6.198e-11, 1.8e4, 4.2e4, 400.0 * 4.2e4)
