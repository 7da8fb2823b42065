"""Described membranes emitted once for all workers, and kept for the next run with what is compiled of them."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from kept import kept, placed

import delagrange as dl
from delagrange.derive.emit.numpy_module import emit
from delagrange.derive.membrane.description import Description
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.pipeline import derive_description, description_spec


def described_in(folder: Path, name: str, text: str) -> Description:
    """What a model file describes, which is written to a folder."""
    file = folder / f"{name}.toml"
    file.write_text(text, encoding="utf-8")
    return read_model_file(file)


def loaded(description: Description, kernels: bool = True) -> ModuleType:
    """The model of a description, from a file; with its compiled kernels or without."""
    if kernels:
        modules = kept("modules", description, lambda: derive_description(description))
    else:
        modules = ((f"{description.name}.py", _numpy_text(description)),)
    return dl.load(placed(modules) / f"{description.name}.py")


def numpy_module(description: Description) -> ModuleType:
    """The NumPy module of a description."""
    return executed(_numpy_text(description), description.title)


def executed(text: str, title: str) -> ModuleType:
    """The module of a text that is in no file."""
    module = ModuleType(title)
    exec(compile(text, f"<{title}>", "exec"), module.__dict__)
    return module


def _numpy_text(description: Description) -> str:
    return kept("numpy", description, lambda: emit(description_spec(description)))
