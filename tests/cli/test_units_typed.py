"""Values with a unit of their own: the same as the bare SI value, and refused where the dimension is another."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from delagrange.cli import main, values
from delagrange.cli.options import NUMBER, NUMBERS, SPAN
from delagrange.cli.quantities import TABLE
from delagrange.common.dimension import Dimension
from delagrange.common.quantity_text import PREFIXED, PREFIXES

UNITS = sorted(
    {row.takes for row in TABLE for kind in row.commands if kind in (NUMBER, NUMBERS, SPAN)} - {"1"}
)
NUMBERS_TYPED = st.decimals("-1e6", "1e6", places=3).map(lambda number: f"{number:f}")


def prefixed(unit: str, prefix: str) -> tuple[str, Fraction]:
    """A unit whose first name has the prefix, and its size: `V/m` -> `kV/m`, 1000; kg has its prefix already."""
    if unit.startswith("kg"):
        return f"{prefix}{unit.removeprefix('k')}", PREFIXES[prefix] / 1000
    return f"{prefix}{unit}", PREFIXES[prefix]


def test_every_unit_of_the_table_is_one_that_can_be_typed():
    assert {"N", "V/m", "Hz", "s", "rad", "Pa s", "kg/m^3"} <= set(UNITS)
    for unit in UNITS:
        Dimension.of_unit(unit)


@given(NUMBERS_TYPED, st.sampled_from(UNITS), st.sampled_from(sorted(PREFIXES)), st.sampled_from(["", " "]))
def test_a_value_with_a_prefix_is_the_bare_si_value(number, unit, prefix, space):
    text, size = prefixed(unit, prefix)
    exact = float(Fraction(number) * size)
    assert values.number("--option", f"{number}{space}{text}", unit) == exact
    assert values.number("--option", repr(exact), unit) == exact
    assert values.number("--option", f"{number}{space}{unit}", unit) == float(number)


@given(
    st.lists(NUMBERS_TYPED, min_size=1, max_size=5), st.sampled_from(UNITS), st.sampled_from(["k", "m", "u"])
)
def test_lists_and_spans_take_units_as_single_values_do(numbers, unit, prefix):
    text, _ = prefixed(unit, prefix)
    single = [values.number("--option", f"{number}{text}", unit) for number in numbers]
    listed = values.axis("--option", [",".join(f"{number}{text}" for number in numbers)], unit)
    np.testing.assert_array_equal(np.atleast_1d(listed), single)
    if len({*single}) > 1:
        span = values.span("--option", f"{min(single)!r}:{max(single)!r} {unit}", unit)
        assert span.ends == (min(single), max(single))


@given(NUMBERS_TYPED, st.sampled_from([*UNITS, "1"]), st.sampled_from(sorted({*PREFIXED, *UNITS})))
def test_another_dimension_is_refused_by_option_value_and_unit(number, wanted, typed):
    if Dimension.of_unit("kg" if typed == "g" else typed) == Dimension.of_unit(wanted):
        return
    with pytest.raises(ValueError) as caught:
        values.number("--option", f"{number}{typed}", wanted)
    said = str(caught.value)
    assert said.startswith("--option = ") and f"{number}{typed}" in said and "\n" not in said
    assert f"needed is {'a pure number' if Dimension.of_unit(wanted).is_number else wanted}" in said


def test_a_range_in_mixed_units_is_the_range_in_si():
    typed = values.axis("--frequency", ["0.3kHz:0.5kHz:1Hz"], "Hz")
    np.testing.assert_array_equal(typed, np.arange(300.0, 501.0))
    assert values.ramp("--field-ramp", "0:3MV/m:50ms:1ms", "V/m") == [0.0, 3e6, 0.05, 1e-3]
    assert values.window("--window", "50ms:100 ms") == (0.05, 0.1)
    assert values.span("--frequency", "0.1kHz:800:1Hz", "Hz").values()[-1] == 800.0


def stored(tmp_path, *arguments: str) -> xr.Dataset:
    out = tmp_path / "out.nc"
    assert main([*arguments, "--out", str(out), "--quiet"]) == 0
    return xr.load_dataset(out)


def test_a_run_with_units_is_the_run_without(tmp_path):
    bare = stored(
        tmp_path, "simulate", "equal-biaxial", "--force", "0.5", "--field-amplitude", "5e6", "--frequency", "371",
        "--duration", "0.005", "--density", "1100", "--parameter", "viscosity=1e3", "--initial", "stretch_rate=20",
    )  # fmt: skip
    typed = stored(
        tmp_path, "simulate", "equal-biaxial", "--force", "500mN", "--field-amplitude", "5MV/m", "--frequency",
        "0.371kHz", "--duration", "5 ms", "--density", "1.1g/cm^3", "--parameter", "viscosity=1kPa s",
        "--initial", "stretch-rate=0.02 1/ms",
    )  # fmt: skip
    xr.testing.assert_identical(typed, bare)


def test_a_table_may_carry_units_from_its_first_line_on(tmp_path):
    table = tmp_path / "force.csv"
    table.write_text("0s,0mN\n10ms,200mN\n", encoding="utf-8")
    run = stored(tmp_path, "simulate", "equal-biaxial", "--duration", "0.01", "--force-csv", str(table))
    np.testing.assert_allclose(run["force"].values[[0, -1]], [0.0, 0.2], atol=1e-15)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (
            ["--force", "5 MV"],
            "--force = '5 MV' has a unit of dimension kg m^2 s^-3 A^-1; needed is N (kg m s^-2)",
        ),
        (["--force", "5 newton"], "--force must be in N, got '5 newton'"),
        (
            ["--held-stretch", "2 mm"],
            "--held-stretch = '2 mm' has a unit of dimension m; needed is a pure number",
        ),
        (["--field-ramp", "0:1MV:1ms"], "1MV"),
        (["--parameter", "density=1 Pa"], "--parameter density = '1 Pa' has a unit"),
    ],
)
def test_a_wrong_unit_is_one_line_and_exit_code_2(capsys, arguments, says):
    assert main(["simulate", "equal-biaxial", "--duration", "1e-3", *arguments]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert says in line
