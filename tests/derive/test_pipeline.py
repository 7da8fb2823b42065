"""`python -m delagrange.derive`: what it writes, what it refuses to write, and what it reports."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from delagrange.derive import __main__ as driver
from delagrange.derive import pipeline
from delagrange.derive.check import record
from delagrange.derive.check.verdict import Outcome
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015
from delagrange.derive.printed.latex import read_equation


@pytest.fixture
def prepared(walked, tmp_path, monkeypatch):
    """The driver with the walk made once, and a record of its own: what was just found."""
    path = tmp_path / "record.json"
    path.write_text(record.to_json(walked.verdicts), encoding="utf-8")
    monkeypatch.setattr(record, "record_path", lambda _: path)
    monkeypatch.setattr(pipeline, "walk", lambda: walked)
    return path


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "modules"


def derive(*arguments, out):
    return driver.main([*arguments, "--out", str(out)])


def depart(path):
    """Change one verdict of the record."""
    entries = json.loads(path.read_text(encoding="utf-8"))
    entries[2]["outcome"] = str(Outcome.DIFFERS)
    path.write_text(json.dumps(entries), encoding="utf-8")
    return f"Eq. ({entries[2]['number']}) against {entries[2]['model']}: found equal, recorded differs"


def only_line(text):
    (line,) = text.splitlines()
    return line


def test_the_walk_covers_every_model_once(walked):
    models = [eom for each in walked.checked for eom in each.models]
    names = [
        f"{eom.load_case.name}{kind}"
        for eom in models
        if eom.load_case.name != "biaxial"
        for kind in (".py", ".h", "_lanes.py", "_variational.py")
    ]
    assert names == [name for name, _ in walked.modules]
    assert {verdict.model for verdict in walked.verdicts} == {eom.load_case.name for eom in models}


def test_the_check_finds_the_verdicts_of_the_walk(walked, monkeypatch):
    models = {eom.load_case.name: eom for each in walked.checked for eom in each.models}
    monkeypatch.setattr(pipeline, "description_equations", lambda description: models[description.name])
    assert pipeline.check().verdicts == walked.verdicts


def test_what_is_checked_in_is_what_the_walk_gives(walked, monkeypatch, capsys):
    """All modules byte for byte, and all verdicts, as `make check-generated` compares them."""
    monkeypatch.setattr(pipeline, "walk", lambda: walked)
    assert driver.main(["--check"]) == 0
    assert capsys.readouterr().err == ""


def test_what_is_written_passes_the_check(prepared, folder, walked, capsys):
    assert derive(out=folder) == 0
    assert derive("--check", out=folder) == 0
    assert sorted(path.name for path in folder.iterdir()) == sorted(name for name, _ in walked.modules)
    assert capsys.readouterr().err == ""


def test_a_stale_module_is_reported_and_left_as_it_is(prepared, folder, capsys):
    derive(out=folder)
    (folder / "uniaxial.py").write_text("edited by hand")
    assert derive("--check", out=folder) == 1
    assert str(folder / "uniaxial.py") in only_line(capsys.readouterr().err)
    assert (folder / "uniaxial.py").read_text() == "edited by hand"


@pytest.mark.parametrize("name", ["old_model.py", "uniaxial.py.unfinished", "notes.txt", "__init__.py"])
def test_what_nothing_emits_is_reported(name, prepared, folder, capsys):
    derive(out=folder)
    (folder / name).write_text("x = 1\n")
    assert derive("--check", out=folder) == 1
    line = only_line(capsys.readouterr().err)
    assert line == f"surplus: {folder / name} holds what the derivation does not emit"


def test_an_empty_init_and_the_cache_are_no_surplus(prepared, folder):
    derive(out=folder)
    (folder / "__init__.py").touch()
    (folder / "__pycache__").mkdir()
    assert derive("--check", out=folder) == 0


def test_nothing_is_written_where_a_verdict_departs_from_the_record(prepared, folder, capsys):
    departed = depart(prepared)
    assert derive(out=folder) == 1
    assert not folder.exists()
    first, last = capsys.readouterr().err.splitlines()
    assert first == f"not as recorded: {departed}"
    assert last.startswith("no module is written")


def test_a_departure_fails_the_check(prepared, folder, capsys):
    derive(out=folder)
    departed = depart(prepared)
    assert derive("--check", out=folder) == 1
    assert only_line(capsys.readouterr().err) == f"not as recorded: {departed}"


def test_recording_says_what_it_changes(prepared, folder, walked, capsys):
    departed = depart(prepared)
    assert derive("--record", out=folder) == 0
    printed = capsys.readouterr().out
    assert f"changed in the record: {departed}" in printed
    assert printed.endswith(f"{len(walked.verdicts)} verdicts recorded, changes: 1\n")
    assert prepared.read_text(encoding="utf-8") == record.to_json(walked.verdicts)
    assert derive("--check", out=folder) == 0
    assert derive("--record", out=folder) == 0
    assert capsys.readouterr().out.endswith("changes: 0\n")


def test_check_and_record_exclude_each_other(capsys):
    with pytest.raises(SystemExit) as caught:
        driver.main(["--check", "--record"])
    assert caught.value.code == 2
    assert "not allowed with argument" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("[{", "Expecting property name"),
        ("", "Expecting value"),
        ('{"number": "4"}', "it holds a dict"),
        ('[{"number": "4"}]', "entry 1 is no verdict with a number and a model"),
        ("[1]", "entry 1 is no verdict"),
    ],
)
@pytest.mark.parametrize("option", [(), ("--check",), ("--record",)])
def test_a_broken_record_is_one_line(text, reason, option, prepared, folder, capsys):
    prepared.write_text(text, encoding="utf-8")
    assert derive(*option, out=folder) == 2
    line = only_line(capsys.readouterr().err)
    assert line.startswith(f"record {prepared} cannot be read: ") and reason in line
    assert not folder.exists() and prepared.read_text(encoding="utf-8") == text


def test_where_nothing_is_recorded_every_verdict_departs(prepared, folder, capsys):
    """As those of a new paper, until they are looked at and recorded."""
    prepared.unlink()
    assert derive(out=folder) == 1
    *departed, last = capsys.readouterr().err.splitlines()
    assert len(departed) == len(pipeline.walk().verdicts) and "--record" in last
    assert all(line.endswith("recorded nothing") for line in departed)
    assert not folder.exists() and not prepared.exists()


def test_an_unreadable_equation_is_one_line(prepared, folder, capsys, monkeypatch):
    """The real walk would stop at such an equation; here it is the first that is read."""
    broken = replace(SHENG_2015["7"], latex=r"T = \int L")

    def walk():
        return read_equation(broken.reading, SHENG_2015.table, number=broken.number)

    monkeypatch.setattr(pipeline, "walk", walk)
    assert derive(out=folder) == 2
    assert only_line(capsys.readouterr().err).startswith(r"Eq. (7), line 1, column 5: found '\int'")


def test_an_output_folder_that_cannot_be_written_is_one_line(prepared, folder, capsys):
    folder.write_text("a file")
    assert derive("--record", out=folder) == 2
    assert only_line(capsys.readouterr().err).startswith(f"output folder {folder} cannot be written")
