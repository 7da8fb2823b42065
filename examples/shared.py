"""What the examples share: from a description to a model that runs, and where the picture goes."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import xarray as xr
from matplotlib.figure import Figure

import delagrange as dl
from delagrange.common.files import prepare_folder
from delagrange.derive import Description, derive_description, read_model_file, write_together
from delagrange.figures.style import journal_style, save

HERE = Path(__file__).parent
MEGA = 1e6


def model_of_file(name: str, folder: Path) -> ModuleType:
    """The model of a TOML file beside this one, derived into a folder: as `delagrange derive` does it."""
    return model_of(read_model_file(HERE / name), folder)


def model_of(description: Description, folder: Path) -> ModuleType:
    """The model of a description in Python, derived into a folder."""
    prepare_folder(folder)
    write_together(derive_description(description), folder)
    return dl.load(folder / f"{description.name}.py")


def out_folder(title: str) -> Path:
    """The folder that a user gives by --out; it is made."""
    parser = argparse.ArgumentParser(description=title)
    parser.add_argument("--out", type=Path, metavar="DIR", default=Path("out/examples"),
                        help="folder of the derived model and of the figure (%(default)s)")  # fmt: skip
    folder = parser.parse_args().out
    prepare_folder(folder)
    return folder


def draw_into(stem: Path, draw: Callable[[xr.Dataset], Figure], found: xr.Dataset) -> None:
    """Draw what was found, in the style of all figures, as `stem`.png and `stem`.pdf."""
    with journal_style():
        png, pdf = save(draw(found), stem)
    print(f"drawn: {png}, {pdf}")
