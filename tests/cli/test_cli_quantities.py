"""Numbers and ranges as a person types them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delagrange.cli import values as v


@given(start=st.integers(-1000, 1000), count=st.integers(0, 400), step=st.decimals("0.001", "50", places=3))
def test_a_range_includes_its_stop(start, count, step):
    stop = start + count * step
    values = np.atleast_1d(v.axis("frequency", [f"{start}:{stop}:{step}"], "Hz"))
    assert len(values) == count + 1
    exact = [float(start + k * step) for k in range(count + 1)]
    np.testing.assert_allclose(values, exact, rtol=1e-12, atol=1e-9)


@given(start=st.integers(-50, 50), count=st.integers(0, 50), step=st.integers(2, 9), beyond=st.integers(1, 8))
def test_a_range_stops_before_a_stop_that_no_step_lands_on(start, count, step, beyond):
    stop = start + count * step + min(beyond, step - 1)
    values = np.atleast_1d(v.axis("force", [f"{start}:{stop}:{step}"], "N"))
    np.testing.assert_array_equal(values, start + step * np.arange(count + 1))


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=8))
def test_a_comma_list_and_a_repeated_option_say_the_same(numbers):
    listed = v.axis("force", [",".join(map(repr, numbers))], "N")
    repeated = v.axis("force", list(map(repr, numbers)), "N")
    np.testing.assert_array_equal(listed, repeated)
    np.testing.assert_array_equal(np.atleast_1d(listed), numbers)
    assert np.ndim(listed) == (len(numbers) > 1)


def test_forms_mix():
    mixed = v.axis("force", ["0.1, 0.2", "1:2:0.5"], "N")
    np.testing.assert_array_equal(mixed, [0.1, 0.2, 1.0, 1.5, 2.0])


@pytest.mark.parametrize(
    "text",
    ["", ",", "1,", "one", "1:2", "1:2:3:4", "1:2:x", "2:1:1", "1:2:0", "1:2:-1", "1:inf:1", "nan:2:1"],
)
def test_what_is_no_number_and_no_range_is_refused_with_its_unit(text):
    with pytest.raises(ValueError, match=r"^frequency .*Hz"):
        v.axis("frequency", [text], "Hz")


def test_window_and_ramp():
    assert v.window("window", "0.05:0.1") == (0.05, 0.1)
    assert v.ramp("force-ramp", "0:1:2", "N") == [0.0, 1.0, 2.0]
    for text, says in (
        ("nan:1:1", "start .* nan N"),
        ("0:inf:1", "stop .* inf N"),
        ("0:1:-1", "duration .* -1 s"),
    ):
        with pytest.raises(ValueError, match=f"^force-ramp {says}"):
            v.ramp("force-ramp", text, "N")
    assert v.ramp("force-ramp", "0:1:2:3", "N") == [0.0, 1.0, 2.0, 3.0]
