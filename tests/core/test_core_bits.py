"""The same bits from every compiler, level of optimisation and width, whatever runs lie beside a run."""

from __future__ import annotations

import platform

import numpy as np
import pytest
from core_builds import (
    assert_same_bits,
    compilers,
    core_of,
    even_samples,
    integrated,
    march,
    mixed_lanes,
    settings_of,
    start_of,
)

from delagrange.core.levels import processor_level
from delagrange.core.structures import FREQUENCY
from delagrange.engines.core_drives import piece_rows
from delagrange.engines.core_engine import parameter_rows

FUSES = processor_level() in ("x86-64-v3", "x86-64-v4") or platform.machine() in ("arm64", "aarch64")
FOUND = compilers()
BUILDS = [("gcc", "-O2", width) for width in (8, 4, 2, 1)] + [("gcc", "-O1", None)]
BUILDS += [(name, "-O2", width) for name in FOUND if name != "gcc" for width in (None, 4, 1)]
MODEL, LANES, DURATION = "equal_biaxial", 71, 4e-3


def built(part, compiler, optimisation, width, folder):
    wide = () if width is None else (f"-DWIDTH={width}",)
    options = (march(compiler), optimisation, *wide)
    return core_of(MODEL, part, folder, *options, command=FOUND[compiler])


@pytest.fixture(scope="module")
def lanes():
    rng = np.random.default_rng(7)
    problem = mixed_lanes(MODEL, LANES, rng)
    return problem, start_of(problem, LANES), settings_of(DURATION, 1e-7), even_samples(LANES, DURATION, 9)


@pytest.fixture(scope="module")
def usual(lanes, tmp_path_factory):
    core = built("lanes", "gcc", "-O2", None, tmp_path_factory.mktemp("usual"))
    outcome = integrated(core, *lanes)
    assert 0 < np.count_nonzero(outcome.status) < LANES
    return core, outcome


@pytest.mark.skipif(
    not FUSES, reason="this processor rounds twice, and each width of it has the bits of plain C"
)
@pytest.mark.parametrize("build", BUILDS, ids=str)
def test_every_build_of_the_lanes_gives_the_same_bits(build, lanes, usual, tmp_path):
    assert_same_bits(usual[1], integrated(built("lanes", *build, tmp_path), *lanes))


@pytest.mark.parametrize("compiler", FOUND)
def test_without_fusing_there_is_one_family_as_well(compiler, lanes, usual, tmp_path):
    """Plain C99 and vectors without a fused multiply-add; within the tolerance of the other family."""
    plain, vectors = (
        integrated(core_of(MODEL, "lanes", tmp_path, *more, command=FOUND[compiler]), *lanes)
        for more in (("-DWIDTH=1", "-std=c99"), ("-DWIDTH=2",))
    )
    assert_same_bits(plain, vectors)
    np.testing.assert_array_equal(plain.status, usual[1].status)
    np.testing.assert_allclose(plain.maximum, usual[1].maximum, rtol=1e-5)


def test_order_and_company_change_no_bit(lanes, usual):
    problem, state, settings, sampling = lanes
    core, whole = usual
    order = np.random.default_rng(3).permutation(LANES)
    assert_same_bits(
        whole, integrated(core, problem.take(order), state[:, order], settings, sampling.take(order)), order
    )
    for lane in (0, 17, LANES - 1):
        alone = integrated(core, problem.take([lane]), state[:, [lane]], settings, sampling.take([lane]))
        assert_same_bits(whole, alone, [lane])


def test_lanes_that_are_no_numbers_spoil_no_neighbour(lanes, usual):
    problem, state, settings, sampling = lanes
    core, whole = usual
    spoilt = state.copy()
    spoilt[0, ::5], spoilt[1, 1::5], spoilt[2, 2::5] = np.nan, np.inf, 1e300
    found = integrated(core, problem, spoilt, settings, sampling)
    kept = np.flatnonzero(np.isin(np.arange(LANES) % 5, (3, 4)))
    assert np.all(found.status[np.isin(np.arange(LANES) % 5, (0, 1, 2))] != 0)
    for name in ("maximum", "minimum", "mean", "state", "status", "steps", "samples"):
        np.testing.assert_array_equal(
            getattr(found, name)[..., kept], getattr(whole, name)[..., kept], err_msg=name
        )


def one_run(core, problem, lane, times, rtol):
    """The trajectory of a lane."""
    single = problem.take([lane])
    drives = np.ascontiguousarray(piece_rows(single, [(0.0, DURATION)])[..., 0])
    assert np.all(drives[:, FREQUENCY, 1] > 0)
    call = core.run(
        parameter_rows(single)[:, 0].copy(), start_of(single, 1)[:, 0].copy(), np.array([[0.0, DURATION, 1.0]]), drives,
        times, rtol=rtol, atol=np.full(core.states, 1e-3 * rtol), smallest=0.2, largest=2.2,
    )  # fmt: skip
    while call.go_on(13):
        pass
    return call


@pytest.mark.skipif(not FUSES, reason="this processor rounds twice")
@pytest.mark.parametrize("compiler", FOUND)
def test_a_single_trajectory_has_the_bits_of_its_lane(compiler, lanes, usual, tmp_path):
    """The same steps; what an interpolant gives differs by rounding: a lane takes a step anew to look into it."""
    problem, whole = lanes[0], usual[1]
    core = core_of(MODEL, "trajectory", tmp_path, march(compiler), command=FOUND[compiler])
    times = np.arange(9) * (DURATION / 8)
    for lane in range(0, LANES, 7):
        call = one_run(core, problem, lane, times, 1e-7)
        assert call.job.status == whole.status[lane] and call.job.steps == whole.steps[lane]
        if call.job.status == 0:
            assert call.job.status_time == whole.status_time[lane]
            np.testing.assert_array_equal(call.last_state, whole.state[:, lane])
        size = np.nanmax(np.abs(call.states), axis=0)
        np.testing.assert_allclose(call.job.status_time, whole.status_time[lane], rtol=1e-12)
        np.testing.assert_allclose(call.states / size, whole.samples[:, :, lane] / size, rtol=0, atol=1e-12)


@pytest.mark.skipif(not FUSES, reason="this processor rounds twice")
def test_every_build_of_the_tangents_gives_the_same_bits(lanes, tmp_path):
    problem = lanes[0].take([20])
    size = len(problem.model.STATE)
    drives = np.ascontiguousarray(piece_rows(problem, [(0.0, DURATION)])[0, :, :, 0])
    sources = np.full((size + 3, 2), -1)
    sources[size:] = [[1, 3], [1, 4], [0, 0]]
    columns = np.vstack([np.eye(size), np.zeros((3, size))])
    found = []
    for build in BUILDS:
        call = built("tangents", *build, tmp_path).tangent(
            parameter_rows(problem)[:, 0].copy(),
            start_of(problem, 1)[:, 0].copy(),
            drives,
            np.linspace(0, DURATION, 4),
            columns,
            sources,
            weights=np.ones(size),
            tolerance=1e-9,
            smallest=0.2,
            largest=2.2,
            normalise=False,
        )
        while call.go_on(50):
            pass
        assert call.job.status == 0
        found.append(call.outcome)
    for other in found[1:]:
        for name in ("states", "divergence", "maximum", "minimum", "last_columns"):
            np.testing.assert_array_equal(getattr(other, name), getattr(found[0], name), err_msg=name)
