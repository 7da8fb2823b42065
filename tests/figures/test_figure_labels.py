"""Figures of a membrane that is none of the paper's: its own symbols, and the forces that it has."""

from __future__ import annotations

import numpy as np
import pytest
from charge_membranes import VOLTAGE, derived
from matplotlib import pyplot

import delagrange as dl
from delagrange.figures.modes_figure import draw_modes
from delagrange.figures.steady_figure import draw_steady
from delagrange.figures.sweep_figure import draw_sweep

PULLED = {"force_1": 0.1, "force_2": 0.3}
LOADS = "P₁ = 0.1 N, P₂ = 0.3 N"
RELATION = """kind = "relation"
coordinate = "h"
lambda_1 = "exp(h)"
lambda_2 = "exp(h/2)"
start = 0
forces = [1]"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("labels")


@pytest.fixture(scope="module")
def plate(folder):
    return derived(folder, "plate", control=VOLTAGE, load='kind = "biaxial"')


@pytest.fixture(autouse=True)
def closed():
    yield
    pyplot.close("all")


def response(model, **loads):
    sweep = {"frequency": [100.0, 110.0], "duration": 0.005, "engine": "numpy", "rtol": 1e-6}
    return dl.frequency_response(model, field_amplitude=1e6, **sweep, **loads)


def test_a_transient_has_the_symbol_and_the_forces_of_the_model(plate):
    axes = draw_sweep(response(plate, inputs=PULLED), "frequency").axes[0]
    assert axes.get_ylabel() == r"amplitude of $\lambda_1$ [1]"
    assert LOADS in axes.get_title(loc="right") and "P = " not in axes.get_title(loc="right")


def test_a_coordinate_that_is_no_stretch_is_not_called_one(folder):
    hencky = derived(folder, "hencky", control=VOLTAGE, load=RELATION)
    axes = draw_sweep(response(hencky, force=0.2), "frequency").axes[0]
    assert axes.get_ylabel() == "amplitude of $h$ [1]"
    assert "P = 0.2 N" in axes.get_title(loc="right")


def test_the_paper_s_membranes_keep_its_symbols():
    axes = draw_sweep(response("equal_biaxial", force=0.2), "frequency").axes[0]
    assert axes.get_ylabel() == r"amplitude of $\lambda_\mathrm{EB}$ [1]"
    assert axes.get_title(loc="right") == "equal biaxial: P = 0.2 N, E₀ = 1 MV/m"


def test_a_response_of_which_every_run_is_lost_says_so_over_its_frequencies():
    axes = draw_sweep(response("equal_biaxial", force=1e4), "frequency").axes[0]
    assert "every run was lost" in [text.get_text() for text in axes.texts]
    assert axes.get_xlim() == (100.0, 110.0)


def test_modes_name_both_forces(plate):
    figure = draw_modes(dl.modes(plate, inputs=PULLED, field=np.array([0.0, 1e6])))
    assert LOADS in " ".join(" ".join(text.get_text() for text in figure.texts).split())


def test_periodic_motions_name_the_forces_of_the_model_where_none_is_found_too(plate):
    """Under such a force there is nothing to start from, which takes no time to find."""
    steady = dl.steady_response(
        plate, inputs={"force_1": 1e9}, field_amplitude=1e6, frequency=(100.0, 120.0), seeds=2, resolution=10
    )
    above = draw_steady(steady).axes[0]
    assert above.get_ylabel() == r"amplitude of $\lambda_1$ [1]"
    assert above.get_title(loc="right") == "plate: P₁ = 1e+09 N, P₂ = 0 N"
