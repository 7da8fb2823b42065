"""Shared by the tests: the paper's membranes, derived once for all workers."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from kept import FOLDER, forget_old, kept, locked

from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.membrane.membrane import Membrane, membrane
from delagrange.derive.papers.sheng_2015.paper import PAPER
from delagrange.derive.pipeline import Derivation
from delagrange.model import kernels

pytest.register_assert_rewrite("every_membrane", "tidy")
settings.register_profile(
    "delagrange", deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("delagrange")

HASH_SEED = "4711"
LONGEST = (  # the first two compile other kernels than each other
    "test_emit_lanes.py", "test_guide.py", "test_charge_control.py", "test_each_pair.py", "test_compiled.py",
    "test_locking.py", "test_examples.py", "test_emit.py", "test_benchmarks.py", "test_limits.py",
    "test_classify.py", "test_load.py", "test_figures.py", "test_compiled_faults.py", "test_relation_statics.py",
    "test_cli_verify.py", "test_runs.py", "test_leakage_engines.py", "test_flow.py", "test_steady_response.py",
    "test_pull_in.py",
)  # fmt: skip


@cache
def walk() -> Derivation:
    """The whole road, walked once for all workers under a hash seed of its own, and kept."""
    return kept("walk", HASH_SEED, lambda: walked_under(HASH_SEED))


def walked_under(hash_seed: str) -> Derivation:
    """The whole road, walked by another process."""
    code = (
        "import sys; sys.path.append(sys.argv[1]); from kept import pickled; from delagrange.derive import pipeline;"
        "sys.stdout.buffer.write(pickled(pipeline.walk()))"
    )
    command = [sys.executable, "-c", code, str(Path(__file__).parent)]
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
    return pickle.loads(subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True).stdout)


def derived(name: str) -> EquationsOfMotion:
    """Of a membrane of the paper."""
    return next(eom for each in walk().checked for eom in each.models if eom.load_case.name == name)


def paper_membrane(alpha=None, beta=None) -> Membrane:
    """The full membrane of the paper, with other springs where they are given."""
    paper = PAPER.description("biaxial")
    branch = replace(paper.branches[0], energy=beta or paper.branches[0].energy)
    return membrane(replace(paper, equilibrium_spring=alpha or paper.equilibrium_spring, branches=(branch,)))


@pytest.fixture(scope="session")
def walked() -> Derivation:
    return walk()


@pytest.fixture(scope="session")
def equations():
    """`equations("uniaxial")` -> EquationsOfMotion of that membrane of the paper."""
    return derived


@pytest.fixture(scope="session", autouse=True)
def compiled_once():
    """A worker waits for a kernel that another one compiles, and finds it then on disk."""
    compile_kernel = kernels._compile

    def one_at_a_time(kernel):
        with locked(FOLDER / "compiling" / kernel.__name__):
            return compile_kernel(kernel)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernels, "_compile", one_at_a_time)
        yield


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files that take long come first, so that no worker is left with one of them alone at the end."""
    places = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: places.get(item.path.name, len(LONGEST)))


def pytest_sessionfinish(session: pytest.Session) -> None:
    if not hasattr(session.config, "workerinput"):
        forget_old()


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20150225)


# Sheng et al. (2015), Sec. III, in the order of the generated modules' PARAMETERS; viscosity = tau_v mu_beta
PAPER_VALUES = (5e-3, 1e-3, 1.2e3, 6.198e-11, 1.8e4, 4.2e4, 400.0 * 4.2e4)
