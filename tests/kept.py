"""What takes long to derive or to compile: made once for all workers, and kept for the next run.

It is kept in `.pytest_cache`, by a digest of all that it is made from: the sources of the derivation, the packages that
it runs on, and what it is asked about. Whoever needs what another worker is making waits for it.
`pytest --cache-clear` forgets it all.
"""

from __future__ import annotations

import fcntl
import io
import marshal
import os
import pickle
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from hashlib import sha256
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from types import CellType, CodeType, FunctionType, MappingProxyType
from typing import TypeVar

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / ".pytest_cache" / "d" / "kept"
SOURCES = (ROOT / "derive", ROOT / "src" / "delagrange" / "common")  # of what is derived
PACKAGES = ("sympy", "mpmath", "jinja2")
MOST_DERIVATIONS, MOST_MODELS = 4, 200  # states of the sources, folders of modules: the latest used
T = TypeVar("T")


def kept(name: str, subject: object, make: Callable[[], T]) -> T:
    """What is derived about a subject, made by `make` where it has not been.

    name: tells apart what is derived about the same subject
    """
    path = FOLDER / "derived" / _digest_of_sources() / f"{name}_{digest(subject)}.pickle"
    with locked(path):
        if not path.is_file():
            _write(path, pickled(make()))
        return pickle.loads(path.read_bytes())


def placed(modules: tuple[tuple[str, str], ...]) -> Path:
    """A folder that holds modules, file name and text, and beside them what Numba has compiled of them."""
    folder = FOLDER / "models" / digest(modules)
    with locked(folder / "modules"):
        for name, text in modules:
            if not (folder / name).is_file():  # one that is written anew is compiled anew
                _write(folder / name, text.encode())
    os.utime(folder)
    return folder


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Of all processes that ask for the same path, one at a time; the end of a process frees it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.with_name(f"{path.name}.lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def forget_old() -> None:
    """Remove what has not been used for long."""
    for folder, most in ((FOLDER / "derived", MOST_DERIVATIONS), (FOLDER / "models", MOST_MODELS)):
        places = [place for place in folder.glob("*") if place.is_dir()]
        for place in sorted(places, key=lambda place: place.stat().st_mtime)[:-most]:
            shutil.rmtree(place, ignore_errors=True)


def digest(subject: object) -> str:
    """Of a value: equal for equal ones that are made alike, in whatever process."""
    return sha256(pickled(subject, _Told)).hexdigest()[:20]


class _Whole(pickle.Pickler):
    """A function that stands in another goes with what it holds; strain energies are such functions."""

    def reducer_override(self, thing):
        if isinstance(thing, FunctionType) and "<" in thing.__qualname__:
            code = marshal.dumps(thing.__code__)
            return _function, (code, thing.__module__, thing.__qualname__, thing.__defaults__, _held(thing))
        if isinstance(thing, MappingProxyType):
            return _read_only, (dict(thing),)
        return NotImplemented


class _Told(_Whole):
    """A function is told by the file that it stands in, its code, and what it holds."""

    def reducer_override(self, thing):
        if isinstance(thing, FunctionType):
            file = _digest_of_file(thing.__code__.co_filename)
            return tuple, ((file, thing.__qualname__, thing.__code__, thing.__defaults__, _held(thing)),)
        if isinstance(thing, CodeType):
            return tuple, ((thing.co_firstlineno, thing.co_code, thing.co_names, thing.co_consts),)
        return super().reducer_override(thing)


def pickled(value: object, pickler: type[pickle.Pickler] = _Whole) -> bytes:
    written = io.BytesIO()
    pickler(written).dump(value)
    return written.getvalue()


def _read_only(entries: dict) -> MappingProxyType:
    return MappingProxyType(entries)


def _held(function: FunctionType) -> tuple:
    return tuple(cell.cell_contents for cell in function.__closure__ or ())


def _function(code: bytes, module: str, name: str, defaults: tuple | None, held: tuple) -> FunctionType:
    """As `_Whole` writes it; the file and the Python are the same, or it would have another digest."""
    cells = tuple(map(CellType, held))
    made = FunctionType(marshal.loads(code), vars(import_module(module)), name, defaults, cells)
    made.__qualname__ = name
    return made


@cache
def _digest_of_file(name: str) -> str:
    return sha256(Path(name).read_bytes()).hexdigest()


@cache
def _digest_of_sources() -> str:
    parts = [sys.version, *(f"{package} {version(package)}" for package in PACKAGES)]
    for path in sorted(path for folder in SOURCES for path in folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            parts += [str(path.relative_to(ROOT)), _digest_of_file(str(path))]
    found = digest(parts)
    place = FOLDER / "derived" / found
    place.mkdir(parents=True, exist_ok=True)
    os.utime(place)
    return found


def _write(path: Path, held: bytes) -> None:
    """As a whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f"{path.name}.unfinished")
    unfinished.write_bytes(held)
    unfinished.replace(path)
