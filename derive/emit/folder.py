"""What stands in a folder of modules, beside what is emitted."""

from __future__ import annotations

from pathlib import Path

from delagrange.derive.emit.targets import Modules

_PACKAGE_MARKER = "__init__.py"  # makes the folder a package; it is empty


def stale(modules: Modules, folder: Path) -> tuple[str, ...]:
    """Names of the modules in `folder` that are not, byte for byte, what the derivation emits."""
    return tuple(name for name, text in modules if not _holds(folder / name, text))


def surplus(modules: Modules, folder: Path) -> tuple[str, ...]:
    """Names of what stands in `folder` and nothing emits, an `__init__.py` that is not empty among them."""
    known = {name for name, _ in modules}
    found = sorted(path.name for path in folder.iterdir()) if folder.is_dir() else []
    marker = folder / _PACKAGE_MARKER
    allowed = {_PACKAGE_MARKER, "__pycache__"} if _holds(marker, "") else {"__pycache__"}
    return tuple(name for name in found if name not in known | allowed)


def _holds(path: Path, text: str) -> bool:
    return path.is_file() and path.read_bytes() == text.encode("utf-8")
