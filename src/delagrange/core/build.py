"""From the header of a model to machine code, on its first use."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path

from delagrange.common.header_digest import belongs
from delagrange.core.compiler import Compiler, NoCompiler, compile_shared, find_compiler
from delagrange.core.levels import processor_level
from delagrange.core.machine_code import kept_or_made, key_of, made_aside

PARTS = ("lanes", "trajectory", "tangents")  # each a source and a library of its own
_HEADER = "header_of_model.h"  # the name under which a model's header is compiled


@dataclass(frozen=True)
class Header:
    """The header of a model, read and checked."""

    model: str
    text: bytes


def read_header(module: Path) -> Header | None:
    """The header beside the file of a module; None where there is none.

    Raises:
        ValueError: it cannot be read, or is not the header of that module.
    """
    path = module.with_suffix(".h")
    if not path.is_file():
        return None
    try:
        text, of_module = path.read_bytes(), module.read_bytes()
    except OSError as error:
        raise ValueError(f"{path} cannot be read: {error.strerror or error}") from error
    if not belongs(of_module, text):
        raise ValueError(
            f"{path} is not the header of {module}: one of the two has been changed since they were derived together; "
            "derive both anew, or take the header away"
        )
    return Header(module.stem, text)


def load_library(part: str, header: Header) -> ctypes.CDLL:
    """The library of one of PARTS for a model, compiled if that has not been done before.

    Raises:
        NoCompiler: it is not there yet, and cannot be compiled.
    """
    compiler, level = find_compiler(), processor_level()
    try:
        return _load(part, header, compiler, level)
    except NoCompiler:
        if level is None:
            raise
        try:
            return _load(part, header, compiler, None)  # a compiler that does not know this processor
        except NoCompiler:
            pass
        raise


def _load(part: str, header: Header, compiler: Compiler, level: str | None) -> ctypes.CDLL:
    flags = compiler.flags(level)
    sources = _sources()
    told = "\0".join([part, compiler.identity, *compiler.command, *flags]).encode()
    key = key_of(told, header.text, *(text for _, text in sources))
    name = f"{header.model}-{part}"

    def make(folder: Path) -> Path:
        for source, text in (*sources, (_HEADER, header.text)):
            (folder / source).write_bytes(text)
        made = folder / "made"
        arguments = (*flags, f'-DDELAGRANGE_MODEL="{_HEADER}"', f"{part}.c", "-o", made.name, "-lm")
        compile_shared(compiler, arguments, folder)
        return made

    path = kept_or_made(name, key, make)
    try:
        return ctypes.CDLL(str(path))
    except OSError:  # a disk whose files may not be executed
        path = made_aside(name, key, make)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise NoCompiler(
            f"what {compiler.command[0]} makes cannot be loaded: {' '.join(str(error).split())}"
        ) from error


@cache
def _sources() -> tuple[tuple[str, bytes], ...]:
    """Name and text of every file of the core."""
    folder = resources.files("delagrange.core") / "c"
    names = sorted(file.name for file in folder.iterdir() if file.name.endswith((".c", ".h")))
    return tuple((name, folder.joinpath(name).read_bytes()) for name in names)
