"""The plan of the house: no circle among files or among rooms, and nothing too large to be read.

Every import counts: a late one, and one that only types need. `pytest -s tests/test_rooms.py` shows the plan.
"""

from __future__ import annotations

from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import grimp
import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("delagrange", "benchmarks")
MOST_LINES, MOST_FILES = 400, 22
HOUSE = (ROOT / "derive", ROOT / "src" / "delagrange")
REASONS: dict[str, str] = {}  # of what is larger, by its place

Arrows = dict[str, set[str]]  # what each file or room imports


@pytest.fixture(scope="module")
def files() -> Arrows:
    graph = grimp.build_graph(*PACKAGES, cache_dir=None)
    return {name: graph.find_modules_directly_imported_by(name) for name in sorted(graph.modules)}


def corridors(files: Arrows) -> dict[str, Arrows]:
    """The rooms of each package, and what they import of each other; a file beside the rooms is a room."""
    found = {name: {} for name in files if any(other.startswith(f"{name}.") for other in files)}
    for package, rooms in found.items():
        for importer, imported in files.items():
            if room := _room(importer, package):
                others = {other for name in imported if (other := _room(name, package))}
                rooms.setdefault(room, set()).update(others - {room})
    return found


def _room(name: str, package: str) -> str | None:
    """The part of a package in which a file stands; None outside of it."""
    depth = package.count(".") + 2
    return ".".join(name.split(".")[:depth]) if name.startswith(f"{package}.") else None


def circle(arrows: Arrows) -> list[str]:
    """Names that import each other in turn, the first once more at the end; empty where there are none."""
    try:
        TopologicalSorter(arrows).prepare()
    except CycleError as error:
        return error.args[1][::-1]
    return []


def test_the_files_are_those_of_the_tree(files):
    """An empty graph has no circle either."""
    for package, folder in (("delagrange", ROOT / "src" / "delagrange"), ("benchmarks", ROOT / "benchmarks")):
        here = {name for name in files if name.split(".")[0] == package}
        places = {".".join((package, *path.relative_to(folder).with_suffix("").parts)) for path in _modules(folder)}
        assert here == {name.removesuffix(".__init__") for name in places}
    assert "delagrange.derive.pipeline" in files["delagrange.derive.__main__"]
    assert "delagrange.derive.pipeline" in files["delagrange.cli.derive"]  # a late import


def _modules(folder: Path) -> list[Path]:
    """Those of the rooms that are linked into it, too."""
    linked = [path for path in folder.iterdir() if path.is_symlink()]
    return [path for place in (folder, *linked) for path in place.rglob("*.py")]


def test_no_circle_among_files(files):
    assert circle(files) == []


def test_no_circle_among_rooms(files):
    for package, rooms in corridors(files).items():
        print(f"\n{package}")
        for room, others in rooms.items():
            print(f"  {_last(room)} -> {', '.join(map(_last, sorted(others))) or 'nothing'}")
        assert circle(rooms) == [], package


def _last(name: str) -> str:
    return name.rpartition(".")[2]


def test_one_more_arrow_makes_a_circle(files):
    start, initial = "delagrange.equilibrium.start", "delagrange.problem.initial"
    assert initial in files[start]
    found = circle(files | {initial: files[initial] | {start}})
    assert found[0] == found[-1] and {start, initial} <= set(found)


def test_rooms_may_be_in_a_circle_where_files_are_not():
    files = {
        "house": set(), "house.a": set(), "house.b": set(),
        "house.a.one": {"house.b.one"}, "house.b.one": set(), "house.b.two": {"house.a.two"}, "house.a.two": set(),
    }  # fmt: skip
    assert circle(files) == []
    assert set(circle(corridors(files)["house"])) == {"house.a", "house.b"}
    assert circle(corridors(files)["house.a"]) == []


@pytest.mark.parametrize("folder", HOUSE, ids=lambda folder: folder.name)
def test_no_file_is_too_long_and_no_folder_too_full(folder):
    assert set(too_large(folder)) == REASONS.keys() & {str(path.relative_to(ROOT)) for path in folder.rglob("*")}


def too_large(folder: Path) -> dict[str, str]:
    """Files with too many lines, and folders with too many files: how many."""
    found, held = {}, {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            held.setdefault(path.parent, []).append(path)
            if path.suffix == ".py" and (lines := path.read_bytes().count(b"\n")) > MOST_LINES:
                found[_place(path)] = f"{lines} lines"
    return found | {_place(room): f"{len(paths)} files" for room, paths in held.items() if len(paths) > MOST_FILES}


def _place(path: Path) -> str:
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT) else path.name


def test_what_is_too_large_is_named(tmp_path):
    for name in range(MOST_FILES):
        (tmp_path / f"{name}.py").write_text("x = 1\n" * MOST_LINES)
    assert too_large(tmp_path) == {}
    (tmp_path / "long.py").write_text("x = 1\n" * (MOST_LINES + 1))
    assert too_large(tmp_path) == {"long.py": "401 lines", tmp_path.name: "23 files"}
