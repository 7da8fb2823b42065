"""The table of quantities: what it says is what a command takes, and gets."""

from __future__ import annotations

from collections import Counter
from dataclasses import FrozenInstanceError

import pytest

from delagrange.cli.app import application
from delagrange.cli.options import Given, flag_of
from delagrange.cli.quantities import TABLE

COMMANDS = [each.callback.__name__ for each in application().registered_commands]


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_has_each_row_of_the_table_that_names_it_once(command):
    (function,) = [c.callback for c in application().registered_commands if c.callback.__name__ == command]
    rows = [row.name for row in TABLE if row.kind(command) is not None]
    assert list(function.__annotations__) == rows
    assert max(Counter(rows).values()) == 1


def test_the_table_names_commands_that_there_are():
    named = {name for row in TABLE for names in row.commands.values() for name in names.split()}
    assert named == set(COMMANDS)


def test_what_is_given_is_frozen_and_knows_its_names():
    given = Given({"force": 0.5, "frequency": None})
    assert (given.force, given.frequency, given.get("field")) == (0.5, None, None)
    assert given.some("force", "frequency", "field") == {"force": 0.5}
    with pytest.raises(FrozenInstanceError):
        given.force = 1.0
    with pytest.raises(AttributeError, match="no option field"):
        _ = given.field


def test_a_quantity_says_its_unit_in_its_meaning():
    """Besides the column of units: a help is read line by line."""
    for row in TABLE:
        if row.takes in (
            "N",
            "V/m",
            "Pa",
            "Hz",
            "C/m^2",
            "A/m^2",
            "rad",
            "s",
            "V",
            "kg/m^3",
            "F/m",
            "m",
            "Pa s",
        ):
            assert f" in {row.takes}" in row.meaning or row.name == "sample_interval", row


def test_flags():
    assert flag_of("field_bias") == "--field-bias"
