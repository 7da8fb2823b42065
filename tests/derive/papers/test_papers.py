"""A paper is a folder: it is found, walked and held to its record, and nobody else has to know of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import pytest
from more_papers.second_paper.paper import PAPER as SECOND

import delagrange.derive
from delagrange.derive import __main__ as driver
from delagrange.derive import pipeline
from delagrange.derive.check.record import record_path, to_json
from delagrange.derive.check.verdict import Outcome
from delagrange.derive.equations.described import description_equations
from delagrange.derive.papers.paper import papers
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015


@pytest.fixture(scope="module")
def walked():
    return pipeline.walk((SECOND,))


def test_papers_are_found_by_their_folders():
    assert papers() == (SHENG_2015,)
    assert papers("more_papers") == (SECOND,)


def test_no_other_file_of_the_derivation_names_a_paper():
    rooms = Path(delagrange.derive.__file__).parent
    others = [path for path in sorted(rooms.rglob("*.py")) if path.parent.name != "sheng_2015"]
    assert len(others) > 80
    assert [path.name for path in others if "sheng_2015" in path.read_text(encoding="utf-8").lower()] == []


def test_what_it_printed_is_right_or_wrong(walked):
    right, wrong = walked.verdicts
    assert (right.number, right.model, right.outcome) == ("1", "letter_2020", Outcome.EQUAL)
    assert (wrong.number, wrong.outcome) == ("2", Outcome.DIFFERS)
    assert wrong.printed_unmatched == (r"+ \epsilon E^2 x^3",)
    assert wrong.corrections == (r"sign: + \epsilon E^{2} x^{3} -> - \epsilon E^{2} x^{3}",)


def test_it_is_held_to_its_own_record(walked):
    assert walked.departures == ()
    assert record_path(SECOND).read_text(encoding="utf-8") == to_json(walked.verdicts)
    (checked,) = walked.checked
    turned = replace(checked.verdicts[0], outcome=Outcome.DIFFERS)
    departed = replace(checked, verdicts=(turned, *checked.verdicts[1:])).departures
    assert departed == ("Eq. (1) against letter_2020: found differs, recorded equal",)


def test_its_membrane_is_emitted_in_its_notation(walked):
    names = [name for name, _ in walked.modules]
    assert names == ["letter_2020.py", "letter_2020.h", "letter_2020_lanes.py", "letter_2020_variational.py"]
    text = walked.modules[0][1]
    assert f"Checked against the equations printed in {SECOND.citation}:" in text
    assert "    Eq. (2): differs\n" in text
    module = ModuleType("letter_2020")
    exec(compile(text, "letter_2020", "exec"), module.__dict__)
    assert [each.symbol for each in module.STATE] == ["x", "x\u0307"]
    values = {
        "half_length": 0.05,
        "half_thickness": 5e-4,
        "density": 1e3,
        "permittivity": 4e-11,
    } | module.DEFAULTS
    parameters = [values[each.name] for each in module.PARAMETERS]
    stretch, force, field = 1.4, 0.3, 2e6
    length, thickness, density = 0.05, 5e-4, 1e3
    stress = 2e4 * 80 * (stretch - stretch**-5) / (80 + 3 - 2 * stretch**2 - stretch**-4)
    pull = force / (4 * thickness * length) + 4e-11 * field**2 * stretch**3 - stress
    inertia = density / 3 * (length**2 + 2 * thickness**2 * stretch**-6)
    _, found = module.rhs((stretch, 0.0), (force, field), parameters)
    assert found == pytest.approx(pull / inertia, rel=1e-12)


def test_the_driver_walks_every_paper_that_it_finds(monkeypatch, tmp_path, capsys):
    """With the second paper in the folder of papers, `python -m delagrange.derive` emits and checks it."""
    monkeypatch.setattr(pipeline, "papers", lambda: papers("more_papers"))
    assert driver.main(["--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "letter_2020.h", "letter_2020.py", "letter_2020_lanes.py", "letter_2020_variational.py",
    ]  # fmt: skip
    assert "1 equal, 1 differs" in capsys.readouterr().out
    assert driver.main(["--check", "--out", str(tmp_path)]) == 0


def test_an_equation_that_states_what_no_model_gives_is_refused():
    odd = replace(SECOND, equations=(replace(SECOND["1"], quantity="kinetic_enery"),))
    with pytest.raises(ValueError, match=r"Eq. \(1\) of A made-up letter .* states 'kinetic_enery', which"):
        pipeline.check((odd,))


def test_a_membrane_is_named(equations):
    assert description_equations(SECOND.description("letter_2020")).load_case.name == "letter_2020"
    with pytest.raises(
        ValueError, match=r"model 'letter' is none of A made-up letter .*; there are letter_2020"
    ):
        SECOND.description("letter")
