"""The tables of the README, from what `delagrange reproduce` found in a folder.

`python -m delagrange.reproduction.readme out` writes them into README.md.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

_VERDICT_COLUMNS = {"Eq.": "Eq.", "states": "states", "derivation": "derivation", "verdict": "verdict"}
_NUMBER_COLUMNS = {
    "Fig.": "Fig.",
    "model": "model",
    "load": "load",
    "printed peak": "printed peak",
    "accurate": "accurate",
    "verdict (accurate)": "verdict",
    "paper's numerics": "paper's numerics",
    "verdict (paper's numerics)": "verdict",
}


def compact(table: list[dict[str, str]], columns: dict[str, str]) -> str:
    """Some columns of a table as Markdown; keys are what is read, values the headings."""
    lines = [
        list(columns.values()),
        ["---"] * len(columns),
        *([row[name] for name in columns] for row in table),
    ]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def with_block(text: str, name: str, block: str) -> str:
    """The text with what stands between the marks of `name` replaced.

    Raises:
        ValueError: the marks are not there.
    """
    begin, end = f"<!-- {name} -->", f"<!-- /{name} -->"
    if begin not in text or end not in text:
        raise ValueError(f"the marks {begin} and {end} must stand in the README")
    head, rest = text.split(begin, 1)
    return f"{head}{begin}\n\n{block}\n\n{end}{rest.split(end, 1)[1]}"


def _read(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def verdict_block(table: list[dict[str, str]]) -> str:
    """The verdicts without the variant of pure shear in which both dashpots flow."""
    return compact([row for row in table if not row["derivation"].endswith("_free")], _VERDICT_COLUMNS)


def update(readme: str, out: Path) -> str:
    """The README with its tables from the CSV files in `out`."""
    readme = with_block(readme, "verdicts", verdict_block(_read(out / "verdicts.csv")))
    return with_block(readme, "numbers", compact(_read(out / "numbers.csv"), _NUMBER_COLUMNS))


if __name__ == "__main__":
    path = Path("README.md")
    path.write_text(update(path.read_text(encoding="utf-8"), Path(sys.argv[1])), encoding="utf-8")
