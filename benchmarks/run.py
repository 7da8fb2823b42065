"""The driver: part after part, then the report and the figure."""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.engines import chosen_engine
from benchmarks.figure import save_figure
from benchmarks.parts import PARTS, Keep, Plan, checked_parts
from benchmarks.report import report
from benchmarks.store import Store
from benchmarks.vector_width import failures


def run(
    folder: Path, only: list[str] | None, quick: bool, engine: str | None, results: Path | None = None
) -> int:
    """Run the parts asked for; an interruption from the keyboard keeps what is finished.

    results: folder that report, numbers and figure are put into as well

    Returns:
        The exit status: 130 after an interruption, 1 where the compiled kernel is found not to use the machine's
        vectors, else 0.

    Raises:
        ValueError: no such part, no such engine, a folder with another program's numbers, or a record of a
            quick run.
    """
    names = checked_parts(only)
    store, plan = Store(folder), Plan(folder, quick, chosen_engine(engine))
    _check_record(store.load(), names, quick, results)
    try:
        for name in names:
            print(f"part {name}", file=sys.stderr)
            PARTS[name](plan, _marked(store.keep(name), quick))
    except KeyboardInterrupt:
        print("interrupted: what is finished is kept", file=sys.stderr)
        write_report(store.load(), folder)
        return 130
    numbers = store.load()
    write_report(numbers, folder)
    if results is not None:
        Store(results).keep_all(numbers)
        write_report(numbers, results)
    return _status(numbers, names)


def _marked(keep: Keep, quick: bool) -> Keep:
    """Quick numbers say that they are."""
    return (lambda numbers: keep(numbers | {"quick": True})) if quick else keep


def _check_record(numbers: dict, names: tuple[str, ...], quick: bool, results: Path | None) -> None:
    old = [name for name, part in numbers.items() if part.get("quick") and name not in names]
    if results is not None and (quick or old):
        parts = ", ".join(old) or "all"
        raise ValueError(
            f"--record is for a full run, got one with quick parts ({parts}); run them without --quick"
        )


def _status(numbers: dict, names: tuple[str, ...]) -> int:
    lines = failures(numbers["vectors"]) if "vectors" in names and "models" in numbers["vectors"] else []
    for line in lines:
        print(line, file=sys.stderr)
    return 1 if lines else 0


def write_report(numbers: dict, folder: Path) -> None:
    """The tables and the figure of the numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "benchmark.md").write_text(report(numbers), encoding="utf-8")
    save_figure(numbers, folder)
