"""The main job: derive, check, emit, integrate, draw, and the tables of verdicts, numbers and statements."""

from __future__ import annotations

import time
from pathlib import Path

from rich.console import Console

from delagrange.common.files import prepare_folder
from delagrange.reproduction import record
from delagrange.reproduction.claims.numbers import compare_peaks
from delagrange.reproduction.claims.statements import judge
from delagrange.reproduction.figures.gallery import draw_figures
from delagrange.reproduction.runs.all_runs import all_runs
from delagrange.reproduction.tables import Table, numbers_table, statements_table


def reproduce(out: Path, progress: bool = True) -> int:
    """Walk the whole road and write what it gives under `out`.

    Returns:
        0, or 1 where a verdict, a number or an answer departs from its record or a generated module is stale.

    Raises:
        ValueError: `out` cannot be written.
    """
    console = Console(stderr=True, quiet=not progress)
    began = time.monotonic()
    prepare_folder(out)

    console.rule("derive, check, emit")
    verdicts, status = _derive(console)

    console.rule("integrate")
    runs = all_runs(out / "data", progress=progress, kinds=True)

    console.rule("draw")
    figures = draw_figures(runs, out / "figures", progress=progress)

    console.rule("compare")
    with console.status("integrating the witnesses of the peaks ..."):
        comparisons, judgements = compare_peaks(runs), judge(runs)
    found = record.as_record(comparisons, judgements)
    record.write(found, out)
    departed = record.departures(found, record.recorded())
    tables = (verdicts, numbers_table(comparisons), statements_table(judgements))
    report = _write(tables, out)
    screen = Console()
    for table in tables:
        screen.print(table.rich())
    screen.print(
        f"{len(figures)} files of figures in {out / 'figures'}; tables in {report} and beside it as CSV"
    )
    screen.print(f"{time.monotonic() - began:.0f} s")
    for line in departed:
        console.print(f"[red]not as recorded:[/red] {line}")
    return 1 if departed else status


def _derive(console: Console) -> tuple[Table, int]:
    """Verdicts, and whether all is as recorded and checked in."""
    from importlib import resources

    from delagrange.derive import pipeline
    from delagrange.derive.check.report import HEADINGS, rows
    from delagrange.derive.emit.folder import stale

    with console.status("deriving ..."):
        walked = pipeline.walk()
    old = stale(walked.modules, Path(str(resources.files("delagrange.generated"))))
    for line in (*walked.departures, *(f"generated module {name} is stale" for name in old)):
        console.print(f"[red]not as recorded:[/red] {line}")
    caption = "Every printed equation against the derivation from Eqs. (1)-(6)."
    table = Table(
        "verdicts", "Printed equations against the derivation", HEADINGS, rows(walked.verdicts), caption
    )
    return table, 1 if walked.departures or old else 0


def _write(tables: tuple[Table, ...], out: Path) -> Path:
    report = out / "report.md"
    report.write_text("\n".join(table.markdown() for table in tables), encoding="utf-8")
    for table in tables:
        (out / f"{table.name}.csv").write_text(table.csv(), encoding="utf-8")
    return report
