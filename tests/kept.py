"""What takes long to derive or to compile: made once for all workers, and kept for the next run.

It is kept in `.pytest_cache`, by a digest of all that it is made from: the sources of the derivation, the packages that
it runs on, and what it is asked about. Whoever needs what another worker is making waits for it.
`pytest --cache-clear` forgets it all.
"""

from __future__ import annotations

import fcntl
import io
import os
import pickle
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from types import FunctionType, MappingProxyType
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
            _write(path, pickle.dumps(make()))
        return pickle.loads(path.read_bytes())


def placed(modules: tuple[tuple[str, str], ...]) -> Path:
    """A folder that holds modules, file name and text, and beside them what Numba has compiled of them."""
    folder = FOLDER / "models" / digest(modules)
    with locked(folder):
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
    written = io.BytesIO()
    _Written(written).dump(subject)
    return sha256(written.getvalue()).hexdigest()[:20]


class _Written(pickle.Pickler):
    """A function is what its file says where it stands, with what it holds."""

    def reducer_override(self, thing):
        if isinstance(thing, FunctionType):
            code = thing.__code__
            held = tuple(cell.cell_contents for cell in thing.__closure__ or ())
            place = _digest_of_file(code.co_filename), code.co_firstlineno, thing.__qualname__, code.co_code
            return tuple, ((*place, held, thing.__defaults__),)
        if isinstance(thing, MappingProxyType):
            return dict, (dict(thing),)
        return NotImplemented


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
