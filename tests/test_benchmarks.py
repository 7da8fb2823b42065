"""The benchmark: its arithmetic, its report, its peers on a few runs, and what it refuses."""

from __future__ import annotations

import json
import math
import platform
import re
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import DOP853

sys.path.insert(0, str(Path(__file__).parents[1]))  # the benchmark is no installed package

from benchmarks.__main__ import main
from benchmarks.accuracy import ALWAYS_BELOW, NOT_REACHED, Point, errors, ratio, time_at
from benchmarks.cases import CASES, Case, spread
from benchmarks.child import in_child
from benchmarks.contestant import refusal
from benchmarks.contestants import CONTESTANTS, available
from benchmarks.engines import chosen_engine, has_compiled_engine
from benchmarks.figure import save_figure
from benchmarks.machine import facts
from benchmarks.operation_count import error_operations, operations_per_evaluation, stage_operations
from benchmarks.parts import PARTS, checked_parts
from benchmarks.peer_delagrange import NUMPY
from benchmarks.report import report
from benchmarks.run import run
from benchmarks.scaling import thread_counts
from benchmarks.series import equal_error_ratios, series_points
from benchmarks.store import Store
from benchmarks.targets import NOT_MEASURED, TARGETS, Target, targets_section
from benchmarks.timing import Timed, interleaved
from benchmarks.vector_width import NOT_FULL, arithmetic, failures, summary
from benchmarks.work_precision import measure, prepared
from delagrange.engines.tableau import tableau
from delagrange.reproduction.runs.cases import CurveLoad, Panel

THREE_RUNS = Case(
    "three", "equal_biaxial", (Panel("a", "force", (CurveLoad(0.5, 5e6),)),), np.array([185.0, 371.0, 742.0]), 0.02
)


def _points(*triples: tuple[float, float, float]) -> list[Point]:
    return [Point(tolerance, error, 3 * error, (time,)) for tolerance, error, time in triples]


# --- arithmetic ------------------------------------------------------------------------------------


def test_time_at_equal_error_on_a_power_law():
    law = _points(*((10.0**-k, 10.0**-k, 2.0 * 10 ** (k / 8)) for k in (3, 5, 9)))
    for error in (3e-4, 1e-6, 1e-8):
        assert time_at(law, error) == pytest.approx(2.0 * error ** (-1 / 8), rel=1e-12)
    assert time_at(law[::-1], 1e-6) == time_at(law, 1e-6)
    assert time_at(law, 1e-5) == law[1].time


def test_nothing_is_extrapolated():
    series = _points((1e-4, 1e-5, 1.0), (1e-8, 1e-7, 2.0))
    assert time_at(series, 1e-8) == NOT_REACHED
    assert time_at(series, 1e-4) == ALWAYS_BELOW
    assert time_at([], 1e-4) == NOT_REACHED
    lost = _points((1e-2, math.inf, 0.5), (1e-4, 1e-5, 1.0))
    assert time_at(lost, 1e-4) == ALWAYS_BELOW


def test_the_shortest_of_several_crossings_counts():
    series = _points((1e-3, 1e-3, 1.0), (1e-4, 1e-6, 1.5), (1e-5, 1e-4, 2.0), (1e-6, 1e-7, 3.0))
    assert 1.0 < time_at(series, 1e-5) < 1.5


def test_time_is_the_median_of_repeats():
    assert Point(1e-3, 1.0, 1.0, (9.0, 1.0, 2.0)).time == 2.0


def test_ratio_of_what_has_no_number():
    assert ratio(6.0, 2.0) == 3.0
    assert ratio(NOT_REACHED, 2.0) == NOT_REACHED
    assert ratio(6.0, ALWAYS_BELOW) == ALWAYS_BELOW


def test_errors_of_amplitudes():
    rms, largest = errors(np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.0, 3.5]))
    assert (rms, largest) == (pytest.approx(0.5 / math.sqrt(3)), 0.5)
    assert errors(np.array([1.0, np.nan]), np.ones(2)) == (math.inf, math.inf)
    with pytest.raises(ValueError, match="differ in shape"):
        errors(np.ones(3), np.ones(2))


def test_lost_runs_have_no_error_in_the_raw_numbers():
    lost = {"label": "lost", "points": {"0.01": {"times": [1.0], "rms_error": None, "maximum_error": None}}}
    assert series_points(lost) == [Point(0.01, math.inf, math.inf, (1.0,))]


def test_repeats_are_interleaved():
    tasks = [Timed(lambda: np.zeros(1), 3), Timed(lambda: np.ones(1), 1)]
    assert [place for place, _, _ in interleaved(tasks)] == [0, 1, 0, 0]


def test_six_curves_and_a_subset_over_all_of_them():
    case = CASES["equal_biaxial"]
    runs = case.runs
    assert len(runs) == 4206 and case.duration == 0.1
    some = runs.take(spread(len(runs), 24))
    assert len(some) == 24
    assert {*zip(some.force, some.field_amplitude)} == {*zip(runs.force, runs.field_amplitude)}
    assert some.frequency.min() < 200 and some.frequency.max() > 700


def test_a_subset_of_whole_batches():
    places = spread(20, 8, group=4)
    np.testing.assert_array_equal(places, [0, 1, 2, 3, 16, 17, 18, 19])
    np.testing.assert_array_equal(spread(18, 8, group=4), [0, 1, 2, 3, 16, 17])
    np.testing.assert_array_equal(spread(5, 8, group=4), np.arange(5))


def test_operations_of_a_step():
    pair = tableau("DOP853")
    a, b = np.count_nonzero(DOP853.A), np.count_nonzero(DOP853.B)
    assert stage_operations(pair) == 2 * (a + b)
    terms = np.count_nonzero(DOP853.E5) + np.count_nonzero(DOP853.E3)
    assert error_operations(pair, 3) == 3 * (2 * terms + 2 * 2 + 3) + 8
    kernel = SimpleNamespace(STATE_COUNT=3, OPERATIONS_PER_EVALUATION=73)
    parts = operations_per_evaluation(kernel)
    total = parts["rates_and_sine"] + parts["stage_sums"] + parts["error_estimate"]
    assert parts["total"] == total == pytest.approx(73 + (3 * 2 * (a + b) + error_operations(pair, 3)) / 12)


def test_arithmetic_in_an_assembly():
    lines = (
        "vfmadd213pd\t%zmm1, %zmm2, %zmm3", "vfnmsub231pd\t(%rax){1to8}, %zmm2, %zmm3", "vdivpd\t%ymm1, %ymm2, %ymm3",
        "addpd\t%xmm1, %xmm2", "vfmadd213sd\t%xmm1, %xmm2, %xmm3", "vmulsd\t8(%rax), %xmm2, %xmm3",
        "vmovupd\t%zmm1, (%rax)", "vaddps\t%zmm1, %zmm2, %zmm3",
    )  # fmt: skip
    counts = arithmetic("\n".join(f"\t{line}" for line in lines))
    assert counts == {"zmm": 2, "ymm": 1, "xmm": 1, "scalar": 2}
    found = summary(counts, "zmm")
    assert (found["width"], found["full"]) == ("zmm", True) and found["share"] == pytest.approx(2 / 6)


def test_a_kernel_that_is_not_vectorised_is_told():
    narrow = {"zmm": 1, "ymm": 9, "xmm": 0, "scalar": 3}
    numbers = {"machine_width": "zmm", "models": {"some": summary(narrow, "zmm")}}
    assert failures(numbers) == [f"{NOT_FULL}: some, ymm where the machine has zmm"]
    assert summary(narrow, "ymm")["full"]
    assert not summary(dict.fromkeys(narrow, 0), "xmm")["full"]
    assert f"- **{NOT_FULL}: some" in report({"vectors": numbers})


def test_thread_counts():
    assert [thread_counts(cores) for cores in (1, 2, 6, 8)] == [[1], [1, 2], [1, 2, 4, 6], [1, 2, 4, 8]]


# --- peers -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def by_numpy() -> np.ndarray:
    return NUMPY.prepare(THREE_RUNS, np.arange(3), 1e-9)()


@pytest.mark.parametrize(
    "contestant",
    [one for one in CONTESTANTS if one.accuracy_of is None and one is not NUMPY],
    ids=lambda one: one.name,
)
def test_peers_agree(contestant, by_numpy):
    if contestant.missing():
        pytest.skip(refusal(contestant))
    found = contestant.prepare(THREE_RUNS, np.arange(3), 1e-9)()
    np.testing.assert_allclose(found, by_numpy, rtol=0, atol=1e-6)


def test_reference_agrees_and_is_kept(tmp_path, by_numpy):
    pytest.importorskip("heyoka")
    from benchmarks.reference import reference

    said = []
    first = reference(THREE_RUNS, tmp_path, said.append)
    np.testing.assert_allclose(first, by_numpy, rtol=0, atol=1e-8)
    np.testing.assert_array_equal(reference(THREE_RUNS, tmp_path, said.append), first)
    assert len(said) == 1
    reference(replace(THREE_RUNS, duration=0.01), tmp_path, said.append)
    assert len(said) == 2


def test_extrema_within_a_step():
    pytest.importorskip("numba")
    from benchmarks.step_extrema import step_callback

    start, length = (
        np.linspace(0.1, 1.5, 8),
        np.full(8, 1.2),
    )  # sin(start + t): its top, at pi / 2, within the step
    order = np.arange(16)
    factorial = np.array([math.factorial(k) for k in range(17)])
    sine = np.array([np.sin(start + k * np.pi / 2) / factorial[k] for k in order])
    cosine = np.array([np.cos(start + k * np.pi / 2) / factorial[k] for k in order])
    end = np.stack([np.sin(start + length), np.cos(start + length)])
    maximum, minimum = np.sin(start), np.sin(start)
    passes = start + length > np.pi / 2
    assert step_callback(np.stack([sine, cosine]), length, end, 1, maximum, minimum)(None)
    np.testing.assert_allclose(maximum[passes], 1.0, rtol=1e-10)
    np.testing.assert_array_equal(maximum[~passes], np.sin(start)[~passes])
    np.testing.assert_array_equal(minimum, np.sin(start))
    assert 0 < passes.sum() < 8


def test_multiply_add_chains():
    pytest.importorskip("numba")
    from benchmarks.multiply_add_peak import _CHAINS, _FACTOR, _TERM, chains, fused_instructions

    states = np.array([1.0 + place / 8 for place in range(_CHAINS)])
    for _ in range(5):
        states = states * _FACTOR + _TERM
    assert chains(4)(5) == pytest.approx(4 * states.sum(), rel=1e-14)
    text = "\tvfmadd213pd\t%zmm1, %zmm2, %zmm3\n\tvfmsub231pd\t%ymm1, %ymm2, %ymm3\n\tvfmadd213sd\t%xmm1, %xmm2, %xmm3"
    assert fused_instructions(text) == {"ymm": 1, "zmm": 1}


def test_rate_of_the_kernel():
    if not has_compiled_engine():
        pytest.skip("the compiled engine cannot run here")
    from benchmarks.kernel_rate import measured

    found = measured(every=700, repeats=1, keep=lambda numbers: None)
    for one in found["cases"].values():
        assert one["runs"] == 12 and one["evaluations"] % 12 == 0 and one["evaluations"] > 12 * 12 * 100
        assert one["nanoseconds"] * one["evaluations"] == pytest.approx(1e9 * one["times"][0])
        assert 0 < one["share_of_peak"] < 1
    assert "Peak, measured in between" in report({"kernel": found})


def test_a_child_measures_a_sweep():
    sizes = {"frequencies": 5, "amplitudes": 4, "duration": 1e-3, "rtol": 1e-6}
    found = in_child("ensemble", {"engine": "numpy", **sizes})
    assert found["trajectories"] == 20 and found["result"] > 20 * 8
    assert 0 < found["time"] < 60 and found["peak"] >= found["before"] > 10_000_000


def test_a_child_that_fails_says_why():
    with pytest.raises(RuntimeError, match="engine must be one of"):
        in_child("first_sweep", {"engine": "no_such", "duration": 1e-3, "rtol": 1e-3})


def test_work_and_precision_of_three_runs(by_numpy):
    both = {"tolerances": (1e-3, 1e-6), "repeats": None}
    alone = replace(NUMPY, name="alone", accuracy_of="numpy", **both)
    entries = prepared(THREE_RUNS, [replace(NUMPY, **both), alone], repeats=2)
    kept = []
    found = measure(THREE_RUNS, entries, by_numpy, lambda numbers: kept.append(len(numbers["contestants"])))
    points = found["contestants"]["numpy"]["points"]
    assert found["runs"] == 3 and len(kept) == 8
    assert 1e-9 < points["1e-06"]["rms_error"] <= points["1e-06"]["maximum_error"] < 1e-4
    assert points["0.001"]["rms_error"] > points["1e-06"]["rms_error"] and len(points["0.001"]["times"]) == 2
    assert found["contestants"]["alone"]["points"]["1e-06"]["rms_error"] == points["1e-06"]["rms_error"]


# --- report, store, refusals -----------------------------------------------------------------------


def _series(label: str, factor: float, timed_runs: int = 4206) -> dict:
    points = {
        f"{10.0**-k:g}": {
            "times": [factor * k, factor * k],
            "rms_error": 10.0**-k,
            "maximum_error": 10.0 ** (1 - k),
        }
        for k in (3, 5, 7, 9)
    }
    about = {"label": label, "method": "by hand", "timed_runs": timed_runs, "accuracy_of": None}
    return about | {"points": points}


def _numbers() -> dict:
    contestants = {"compiled": _series("ours", 0.25), "scipy": _series("theirs", 5.0, 24)}
    del contestants["scipy"]["points"]["1e-09"]
    grid = {"first_frequency": 100.0, "last_frequency": 800.0, "frequencies": 701, "duration": 0.1}
    case = {"runs": 4206, **grid, "contestants": contestants, "refusals": ["third: left out"]}
    threads = {"engine": "compiled", "rtol": 1e-6, "sweeps": 5, "counts": [
        {"threads": 1, "runs": 4206, "times": [2.0, 2.0]}, {"threads": 2, "runs": 4206, "times": [1.0, 1.0]},
    ]}  # fmt: skip
    return {"equal_biaxial": case, "threads": threads, "peak": {"left_out": "Left out: numba not installed."}}


def test_report_of_given_numbers():
    text = report(_numbers())
    row = next(line for line in text.splitlines() if line.startswith("| theirs | 19.4 s (20x) |"))
    assert row.endswith("not reached |") and row.count("(20x)") == 2
    assert "24 runs spread over all were timed, the time scaled to 4206" in text
    assert "| ours | 1e-09 | 1.0e-09 | 1.0e-08 | 2.25 |" in text
    assert "| 2 | 4206 | 1 | 2.00 |" in text
    assert "- third: left out" in text and "Left out: numba not installed." in text


def test_targets_beside_what_was_measured():
    rows = {target.what: target.row(_numbers()) for target in TARGETS}
    assert rows["speed-up on two cores"][1:] == ("1.8 x", "1.95 x", "2 x", "aim met")
    assert rows["equal-biaxial against solve_ivp and lambdify, error 1e-06"][3:] == ("20 x", "not met")
    assert rows["equal-biaxial against heyoka.py, batch 8, error 1e-06"][3:] == (NOT_MEASURED, NOT_MEASURED)
    assert len(targets_section({}).splitlines()) == len(TARGETS) + 4
    quick = targets_section({"threads": _numbers()["threads"] | {"quick": True}})
    assert quick.count("not judged: quick") == len(TARGETS)


def test_verdicts():
    more = Target("", "x", 10, 20, lambda numbers: 0.0)
    assert [more.verdict(value) for value in (9.9, 10, 20)] == ["not met", "met", "aim met"]
    less = Target("", "s", 12, 3, lambda numbers: 0.0, smaller=True)
    assert [less.verdict(value) for value in (12.1, 12, 3)] == ["not met", "met", "aim met"]
    assert more.verdict(NOT_REACHED) == NOT_MEASURED


def test_a_record_is_of_a_full_run(tmp_path, monkeypatch):
    monkeypatch.setitem(PARTS, "peak", lambda plan, keep: keep({"left_out": "none"}))
    with pytest.raises(ValueError, match=r"--record is for a full run"):
        run(tmp_path, ["peak"], True, "numpy", tmp_path / "results")
    assert run(tmp_path, ["peak"], True, "numpy") == 0
    with pytest.raises(ValueError, match=r"quick parts \(peak\)"):
        run(tmp_path, ["machine"], False, "numpy", tmp_path / "results")
    assert run(tmp_path, ["peak"], False, "numpy", tmp_path / "results") == 0
    assert {path.name for path in (tmp_path / "results").iterdir()} == {"benchmark.json", "benchmark.md"}


def test_ratios_for_the_raw_numbers():
    found = equal_error_ratios(_numbers()["equal_biaxial"]["contestants"])
    assert found["compiled"] == {"0.0001": 1.0, "1e-06": 1.0, "1e-08": 1.0}
    assert found["scipy"]["1e-06"] == pytest.approx(20.0) and found["scipy"]["1e-08"] == NOT_REACHED


def test_figure_of_given_numbers(tmp_path):
    assert save_figure({}, tmp_path) is None
    assert save_figure(_numbers(), tmp_path).stat().st_size > 5000


def test_an_interrupted_run_keeps_what_it_finished(tmp_path, monkeypatch):
    def interrupted(plan, keep):
        keep({"left_out": "half"})
        raise KeyboardInterrupt

    monkeypatch.setitem(PARTS, "peak", interrupted)
    assert run(tmp_path, ["peak", "threads"], True, "numpy") == 130
    kept = json.loads((tmp_path / "benchmark.json").read_text())
    assert set(kept) == {"machine", "peak"} and kept["machine"]["packages"]["numpy"] == np.__version__
    assert "half" in (tmp_path / "benchmark.md").read_text()


def test_no_host_name_and_no_path_in_the_machine_facts():
    text = json.dumps(facts())
    assert platform.node() not in re.findall(r"[\w.-]+", text)
    assert str(Path.home()) not in text and sys.prefix not in text


def test_what_is_not_installed_is_left_out_with_a_line():
    absent = replace(NUMPY, label="Peer", needs=("no_such_module", "numpy"), engine="no_such_engine")
    assert absent.missing() == ("no_such_module", "engine 'no_such_engine'")
    assert refusal(absent) == "Peer: left out, not installed here: no_such_module, engine 'no_such_engine'"
    assert NUMPY in available()


def test_refusals(tmp_path, monkeypatch, capsys):
    with pytest.raises(ValueError, match=r"part must be one of machine, .*got 'peek' \(did you mean 'peak'"):
        checked_parts(["peek"])
    with pytest.raises(ValueError, match=r"engine must be one of .*got 'fortran'"):
        chosen_engine("fortran")
    (tmp_path / "benchmark.json").write_text("{")
    with pytest.raises(ValueError, match=r"benchmark\.json is no JSON .*remove it"):
        Store(tmp_path).load()
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    assert main(["--only", "peek", "--out", str(tmp_path)]) == 2
    assert "part must be one of" in capsys.readouterr().err
