"""Files: written whole, read back equal, refused before work is done for them."""

from __future__ import annotations

import csv
import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from delagrange.common.files import check_file, check_folder, check_writable, prepare_folder, write_dataset


def grid(values: np.ndarray) -> xr.Dataset:
    """A Dataset over two dimensions, one of them without a coordinate, with a scalar and texts."""
    kinds = np.where(np.isfinite(values), "completed", "diverged").astype(object)
    return xr.Dataset(
        {
            "amplitude": (("force", "lane"), values, {"units": "1"}),
            "kind": (("force", "lane"), kinds, {"long_name": "how the run ended"}),
        },
        coords={
            "force": ("force", np.arange(len(values)) / 3, {"units": "N"}),
            "field": ((), 1e6, {"units": "V/m"}),
        },
        attrs={"source": "a test"},
    )


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@given(arrays(float, st.tuples(st.integers(1, 4), st.integers(1, 4)), elements=st.floats()))
def test_numbers_in_csv_read_back_equal(tmp_path_factory, values):
    path = write_dataset(grid(values), tmp_path_factory.mktemp("csv") / "grid.csv")
    rows = rows_of(path)
    assert list(rows[0]) == ["force [N]", "lane", "field [V/m]", "amplitude [1]", "kind"]
    places = list(np.ndindex(values.shape))
    assert len(rows) == len(places)
    for row, place in zip(rows, places, strict=True):
        np.testing.assert_equal(float(row["amplitude [1]"]), values[place])
        assert (float(row["force [N]"]), int(row["lane"])) == (place[0] / 3, place[1])
        assert float(row["field [V/m]"]) == 1e6
        assert row["kind"] == ("completed" if np.isfinite(values[place]) else "diverged")


def test_the_order_of_dimensions_of_a_variable_does_not_matter(tmp_path):
    dataset = grid(np.arange(6.0).reshape(2, 3))
    turned = dataset.assign(amplitude=dataset["amplitude"].transpose("lane", "force"))
    rows = rows_of(write_dataset(turned, tmp_path / "turned.csv"))
    found = {(float(row["force [N]"]), int(row["lane"])): float(row["amplitude [1]"]) for row in rows}
    assert found == {(k / 3, lane): 3.0 * k + lane for k in range(2) for lane in range(3)}


def test_netcdf_reads_back_identical(tmp_path):
    dataset = grid(np.array([[1.0, np.nan], [np.pi, -0.0]]))
    write_dataset(dataset, tmp_path / "grid.nc")
    xr.testing.assert_identical(xr.load_dataset(tmp_path / "grid.nc"), dataset)


@pytest.mark.parametrize("suffix", [".nc", ".csv"])
def test_a_failed_write_leaves_the_old_file_and_no_rest(tmp_path, monkeypatch, suffix):
    path = tmp_path / f"grid{suffix}"
    write_dataset(grid(np.ones((1, 1))), path)
    before = path.read_bytes()

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("xarray.Dataset.to_netcdf", full)
    monkeypatch.setattr("delagrange.common.files._write_csv", full)
    with pytest.raises(ValueError, match=f"grid{suffix} cannot be written: No space left on device"):
        write_dataset(grid(np.zeros((1, 1))), path)
    assert path.read_bytes() == before
    assert os.listdir(tmp_path) == [path.name]


@pytest.mark.parametrize("name", ["run", "run.txt", "run.nc.gz", ".nc"])
def test_other_suffixes_are_refused(tmp_path, name):
    with pytest.raises(ValueError, match=r"must end in \.nc \(NetCDF\) or \.csv \(CSV\)"):
        check_writable(tmp_path / name)


def test_a_folder_is_no_file_and_a_file_no_folder(tmp_path):
    (tmp_path / "folder.nc").mkdir()
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(ValueError, match="is a folder"):
        check_writable(tmp_path / "folder.nc")
    with pytest.raises(ValueError, match="missing: No such file or directory"):
        check_file(tmp_path / "missing" / "table.md")
    for folder in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(ValueError, match=f"output folder {folder} cannot be written"):
            prepare_folder(folder)


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="needs a folder that takes files from nobody")
def test_a_folder_that_takes_no_file_is_refused_even_for_root():
    with pytest.raises(ValueError, match="output folder /proc/self cannot be written"):
        prepare_folder(Path("/proc/self"))
    with pytest.raises(ValueError, match=r"output file /proc/self/run\.nc cannot be written"):
        check_writable(Path("/proc/self/run.nc"))


def test_looking_leaves_nothing_behind(tmp_path):
    check_writable(tmp_path / "run.nc")
    prepare_folder(tmp_path / "a" / "b")
    assert os.listdir(tmp_path) == ["a"]
    assert os.listdir(tmp_path / "a" / "b") == []


def test_a_folder_to_read_from_must_be_there(tmp_path):
    assert check_folder(tmp_path) == tmp_path
    (tmp_path / "file").write_text("", encoding="utf-8")
    for name, reason in (("none", "No such file or directory"), ("file", "Not a directory")):
        with pytest.raises(ValueError, match=f"folder {tmp_path / name} cannot be read: {reason}"):
            check_folder(tmp_path / name)
