"""Tables of the command line show what they are given as it stands."""

from __future__ import annotations

import pytest
from charge_membranes import VOLTAGE, derived
from rich.text import Text

from delagrange.cli import console
from delagrange.cli.app import main


@pytest.mark.parametrize("text", ["edge_mass [kg]", "[bold]", "half_length [m]", "[/]", "a \\[s]"])
def test_brackets_are_no_markup(capsys, text):
    table = console.table(text, "other")
    table.add_row(f"cell {text}", Text("styled", style="bold red"))
    console.show(f"title {text}", table)
    title, heading, _, row = capsys.readouterr().out.splitlines()
    assert (title, heading.split("  ")[0].rstrip()) == (f"title {text}", text)
    assert row.rstrip().startswith(f"cell {text}") and row.rstrip().endswith("styled")


def test_a_table_over_a_parameter_has_its_unit(tmp_path, capsys):
    weighted = derived(tmp_path, "weighted", control=VOLTAGE, more='[[attachment]]\nmass = "0.1 g"\nstiffness = 2.0\n')
    assert main(["modes", weighted.__file__, "--force", "0.1", "--parameter", "edge_mass=1e-4,2e-4"]) == 0
    assert "edge_mass [kg]" in capsys.readouterr().out
