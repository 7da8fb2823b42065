"""Modules from files anywhere on disk: a model, and the compiled kernels beside it.

Each is imported under a package whose name is a digest. That of a kernel is of what it holds: compiled code that is
kept on disk remembers the name of its module, and so is found again wherever the folder is moved. That of a model is
of its place, too, and of its kernels: a file that has changed is another module.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable
from functools import cache
from hashlib import sha256
from importlib import import_module, invalidate_caches
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import CodeType, ModuleType

_PACKAGE = "delagrange_user_"
_DIGITS = 16
_DIGEST_STATED = "digest of the governing equations "  # before it in the docstring of an emitted module


def import_model(path: Path, endings: tuple[str, ...]) -> ModuleType:
    """The module of a model's file, which is run as any import does; kernels have its name and one of the endings.

    Raises:
        ValueError: it cannot be read, or what it holds raises an error; a kernel is not of the same equations.
    """
    try:
        path = path.resolve()
        kernels = [kernel for ending in endings if (kernel := _sibling(path, ending)).is_file()]
        _check_kernels(path, kernels)
        held = [str(path).encode(), *(file.read_bytes() for file in (path, *kernels))]
        module = _run(_registered(_package(*held), path), path)
        for ending in endings:
            beside(module, ending)  # those that are there now belong to it
        return module
    except _ForeignKernel as error:
        raise ValueError(str(error)) from None
    except (Exception, SystemExit) as error:  # whatever a user's file may do
        text = " ".join(str(error).split())
        raise ValueError(f"{path} cannot be imported: {type(error).__name__}: {text}") from error


class _ForeignKernel(Exception):
    """A kernel beside a model that is not of its equations."""


def _check_kernels(path: Path, kernels: list[Path]) -> None:
    """Compare the digest of the equations that a model states with that of each of its kernels; none is run.

    Raises:
        _ForeignKernel: a kernel has another, or none.
        OSError: one of the files cannot be read.
    """
    if _parsed(path) is None:
        return  # as importing it will tell
    for kernel in kernels:
        own, others = _stated_digest(path), _digest(kernel)
        if others is None or own != others:
            told = "no digest" if others is None else f"the digest {others}"
            raise _ForeignKernel(
                f"{kernel} is not a kernel of {path}: it has {told} of its equations, the model {own or 'none'}; "
                "derive both anew, or take the kernel away"
            )


def _stated_digest(path: Path) -> str | None:
    """The digest of its equations that a module states in its docstring."""
    tree = _parsed(path)
    text = " ".join((ast.get_docstring(tree) or "").split()) if tree else ""
    _, found, rest = text.partition(_DIGEST_STATED)
    return rest.partition(",")[0] if found else None


def _digest(kernel: Path) -> str | None:
    """What a kernel's file defines as DIGEST."""
    tree = _parsed(kernel)
    for node in tree.body if tree else ():
        if (
            isinstance(node, ast.Assign)
            and _names(node) == ["DIGEST"]
            and isinstance(node.value, ast.Constant)
        ):
            return str(node.value.value)
    return None


def _parsed(path: Path) -> ast.Module | None:
    """The file as Python, or None where it is none."""
    try:
        return ast.parse(path.read_bytes())
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


def _registered(package: str, path: Path) -> str:
    """The name by which a file can be imported from now on; nothing of it is run."""
    folder = str(path.parent)
    if package not in sys.modules:
        module = ModuleType(package, "A file of a user.")
        module.__path__ = [folder]
        sys.modules[package] = module
        invalidate_caches()  # of what is in the folder: the file may be a moment old
    sys.modules[package].__path__ = [folder]
    return f"{package}.{path.stem}"


def import_named(name: str) -> ModuleType:
    """The module of a name; that of a user's kernel only while the file is what the name says.

    Raises:
        ImportError: the file has changed since it got the name, or as any import.
    """
    package, _, stem = name.rpartition(".")
    if not package.startswith(_PACKAGE) or name in sys.modules:
        return import_module(name)
    path = Path(sys.modules[package].__path__[0]) / f"{stem}.py"
    if not path.is_file() or _package(path.read_bytes()) != package:
        raise ImportError(f"{path} has changed since its model was loaded; load the model anew")
    return _run(name, path)


class _AsItStands(SourceFileLoader):
    """Runs the text that a file holds now: bytecode on disk knows it by size and second alone."""

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return self.source_to_code(self.get_data(path), path)


def _run(name: str, path: Path) -> ModuleType:
    """The module of a file, run once for each name."""
    if name not in sys.modules:
        spec = spec_from_file_location(name, path, loader=_AsItStands(name, str(path)))
        module = sys.modules[name] = module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except BaseException:
            del sys.modules[name]
            raise
    return sys.modules[name]


def _package(*held: bytes) -> str:
    return _PACKAGE + sha256(b"".join(sha256(part).digest() for part in held)).hexdigest()[:_DIGITS]


def _sibling(path: Path, ending: str) -> Path:
    return path.with_name(f"{path.stem}_{ending}.py")


def beside(module: ModuleType, ending: str) -> str | None:
    """Name of the module `<file>_<ending>.py` beside the file of a user's model; None where there is none.

    Looked for once: what is put there later belongs to another model.
    """
    return _beside(module.__name__, module.__file__, ending)


@cache
def _beside(name: str, file: str, ending: str) -> str | None:
    kernel = _sibling(Path(file), ending)
    return _registered(_package(kernel.read_bytes()), kernel) if kernel.is_file() else None


def is_users(module: ModuleType) -> bool:
    """Whether the module is from a user's file."""
    return module.__name__.startswith(_PACKAGE)


def missing_names(path: Path, needed: Iterable[str]) -> list[str]:
    """Which names a file does not define at its top; it is read and not run.

    None where that cannot be seen: all names of another module are imported, or it is no Python.
    """
    try:
        tree = _parsed(path)
    except OSError:
        return []
    if tree is None:
        return []
    defined = {name for node in tree.body for name in _names(node)}
    return [] if "*" in defined else [name for name in needed if name not in defined]


def _names(node: ast.stmt) -> list[str]:
    """What a statement defines."""
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.AnnAssign(target=ast.Name(id=name)):
            return [name]
        case ast.Assign(targets=targets):
            parts = (part for target in targets for part in ast.walk(target))
            return [part.id for part in parts if isinstance(part, ast.Name)]
        case ast.Import(names=aliases) | ast.ImportFrom(names=aliases):
            return [alias.asname or alias.name for alias in aliases]
    return []
