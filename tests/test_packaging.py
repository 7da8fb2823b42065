"""The wheel holds what the tree holds, and the links that make the three rooms one package are there."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
ROOMS = {
    "delagrange/derive": ROOT / "derive",
    "delagrange/generated": ROOT / "generated",
    "delagrange": ROOT / "src/delagrange",
}
SUFFIXES = {".py", ".jinja", ".json", ".typed", ".c", ".h"}


def _tree() -> set[str]:
    """Every file that belongs to the package, by its place in the wheel."""
    found = set()
    for place, folder in ROOMS.items():
        for path in folder.rglob("*"):
            inside = path.relative_to(folder)
            linked = folder.name == "delagrange" and inside.parts[0] in ("derive", "generated")
            if (
                path.is_file()
                and path.suffix in SUFFIXES
                and not linked
                and "__pycache__" not in inside.parts
            ):
                found.add(f"{place}/{inside.as_posix()}")
    return found


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> zipfile.ZipFile:
    folder = tmp_path_factory.mktemp("wheel")
    # From a copy of what git would clone, so that neither build folders nor links of this tree matter
    source = folder / "source"
    files = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.splitlines()
    for name in files:
        target = source / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_symlink():
            target.symlink_to((ROOT / name).readlink())
        else:
            target.write_bytes((ROOT / name).read_bytes())
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "--wheel-dir",
        str(folder),
        str(source),
    ]
    subprocess.run(command, check=True)
    (built,) = folder.glob("*.whl")
    return zipfile.ZipFile(built)


def test_the_wheel_holds_what_the_tree_holds(wheel):
    inside = {name for name in wheel.namelist() if not name.startswith("delagrange-")}
    assert inside == _tree()


def test_the_rooms_are_linked_into_the_package():
    for room in ("derive", "generated"):
        link = ROOT / "src/delagrange" / room
        assert link.is_symlink() and link.resolve() == ROOT / room
