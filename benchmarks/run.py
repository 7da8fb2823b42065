"""The driver: part after part, then the report and the figure."""

from __future__ import annotations

import sys
from pathlib import Path

from benchmarks.engines import chosen_engine
from benchmarks.figure import save_figure
from benchmarks.parts import PARTS, Plan, checked_parts
from benchmarks.report import report
from benchmarks.store import Store


def run(folder: Path, only: list[str] | None, quick: bool, engine: str | None) -> int:
    """Run the parts asked for; an interruption from the keyboard keeps what is finished.

    Returns:
        The exit status: 130 after an interruption, else 0.

    Raises:
        ValueError: no such part, no such engine, or a folder with another program's numbers.
    """
    names = checked_parts(only)
    store, plan = Store(folder), Plan(folder, quick, chosen_engine(engine))
    store.load()
    status = 0
    try:
        for name in names:
            print(f"part {name}", file=sys.stderr)
            PARTS[name](plan, store.keep(name))
    except KeyboardInterrupt:
        print("interrupted: what is finished is kept", file=sys.stderr)
        status = 130
    write_report(store)
    return status


def write_report(store: Store) -> None:
    """The tables and the figure of what is in the store."""
    numbers = store.load()
    store.folder.mkdir(parents=True, exist_ok=True)
    (store.folder / "benchmark.md").write_text(report(numbers), encoding="utf-8")
    save_figure(numbers, store.folder)
