"""The file of raw numbers: each part under its name, written after every part."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Store:
    """Numbers in `benchmark.json` of a folder."""

    folder: Path

    @property
    def path(self) -> Path:
        return self.folder / "benchmark.json"

    def load(self) -> dict:
        """All parts that there are.

        Raises:
            ValueError: the file is not one of this benchmark.
        """
        if not self.path.is_file():
            return {}
        try:
            return json.loads(self.path.read_text(encoding="utf-8"))
        except json.JSONDecodeError as error:
            raise ValueError(
                f"{self.path.name} is no JSON ({error}); remove it or choose another --out"
            ) from None

    def keep(self, part: str) -> Callable[[dict], None]:
        """A function that puts the numbers of a part in the place of its old ones."""
        return lambda numbers: self.keep_all(self.load() | {part: numbers})

    def keep_all(self, everything: dict) -> None:
        """Put all parts in the place of the old ones."""
        self.folder.mkdir(parents=True, exist_ok=True)
        unfinished = self.path.with_suffix(".unfinished")
        unfinished.write_text(json.dumps(everything, indent=1) + "\n", encoding="utf-8")
        unfinished.replace(self.path)
