"""Verdicts on the paper: what is found, how it is explained, and that the record guards it."""

from __future__ import annotations

import copy
from dataclasses import replace

import mpmath
import pytest
import sympy as sp

from delagrange.derive.check import explain
from delagrange.derive.check.compare import Comparison, agrees_numerically, compare, may_agree, witness
from delagrange.derive.check.record import departures, recorded
from delagrange.derive.check.report import as_text, detail, rows, summary
from delagrange.derive.check.verdict import Outcome
from delagrange.derive.check.verify import verdict_on
from delagrange.derive.equations.derived_equations import (
    check_dimensions,
    check_model_dimensions,
    derived_equations,
)
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.dimensions import DimensionError
from delagrange.derive.papers.sheng_2015 import symbols as paper
from delagrange.derive.papers.sheng_2015.paper import PAPER as SHENG_2015
from delagrange.derive.printed.latex import read_equation
from delagrange.derive.printed.tree import Number, walk

KNOWN = tuple(SHENG_2015.table.entries.values())
MODELS = (
    "biaxial", "equal_biaxial", "uniaxial", "pure_shear_as_printed", "pure_shear_consistent",
    "pure_shear_consistent_free",
)  # fmt: skip


@pytest.fixture(scope="module")
def verdicts(walked):
    return {(verdict.number, verdict.model): verdict for verdict in walked.verdicts}


@pytest.fixture
def subject(equations):
    def make(model, quantity):
        return witness(derived_equations(equations(model))[quantity], KNOWN)

    return make


@pytest.mark.parametrize(
    ("number", "model", "outcome"),
    [
        *((str(n), "biaxial", Outcome.EQUAL) for n in (4, 5, 6)),
        *((str(n), "equal_biaxial", Outcome.EQUAL) for n in (7, 8, 10)),
        ("9", "equal_biaxial", Outcome.SCALED),
        *((str(n), "uniaxial", Outcome.EQUAL) for n in (11, 12, 13, 14)),
        *((str(n), "uniaxial", Outcome.DIFFERS) for n in (15, 16)),
        *((str(n), "pure_shear_as_printed", Outcome.EQUAL) for n in (17, 18, 20)),
        ("19", "pure_shear_as_printed", Outcome.SCALED),
        ("21", "pure_shear_as_printed", Outcome.DIFFERS),
        ("22", "pure_shear_as_printed", Outcome.MISSING),
        *((str(n), "pure_shear_consistent", Outcome.EQUAL) for n in (17, 18)),
        *((str(n), "pure_shear_consistent", Outcome.DIFFERS) for n in (19, 20, 21)),
        ("17", "pure_shear_consistent_free", Outcome.EQUAL),
        *((str(n), "pure_shear_consistent_free", Outcome.DIFFERS) for n in (18, 19, 20, 21)),
        ("22", "pure_shear_consistent_free", Outcome.MISSING),
    ],
)
def test_outcome(number, model, outcome, verdicts):
    assert verdicts[number, model].outcome is outcome


def test_the_scaling_of_eq_9_is_stated_and_has_no_zero(verdicts):
    factor = verdicts["9", "equal_biaxial"].factor
    mass = s.DENSITY.symbol * s.HALF_LENGTH.symbol**2 * s.HALF_THICKNESS.symbol
    stretch, L, H = paper.STRETCH_EB.value.symbol, s.HALF_LENGTH.symbol, s.HALF_THICKNESS.symbol
    assert sp.simplify(factor - 3 * stretch**6 / (16 * mass * (2 * H**2 + L**2 * stretch**6))) == 0
    assert factor.is_positive


def test_eq_15_names_the_terms_without_partner(verdicts):
    verdict = verdicts["15", "uniaxial"]
    assert verdict.derived_unmatched == ("μ^β ξ_UA1³ ξ_UA2² / (6 η λ_UA1² λ_UA2²)",)
    assert len(verdict.printed_unmatched) == 2
    assert all(
        r"\lambda_{\mathrm{UA2}}^{-2} \xi_{\mathrm{UA1}}^{3}" in term for term in verdict.printed_unmatched
    )
    assert verdict.corrections == ()  # no single edit mends two terms


def test_eq_16_is_mended_by_its_prefactor(verdicts):
    first, *others = verdicts["16", "uniaxial"].corrections
    assert first == r"coefficient: \frac{\mu^{\beta}}{3 \eta} -> \frac{\mu^{\beta}}{6 \eta}"
    rate = r"\frac{\mathrm{d} \xi_{UA2}}{\mathrm{d}t}"
    assert others == [f"coefficient: {rate} -> 2 {rate}"]


EQ_10_WITH_ANOTHER_PREFACTOR = (
    r"\frac{d\xi_{EB}}{dt} = \frac{\mu^{\beta}}{PREFACTOR \eta}"
    r" (\lambda_{EB}^2 \xi_{EB}^{-1} - \lambda_{EB}^{-4} \xi_{EB}^5)"
)


def test_a_correction_of_what_is_printed_comes_before_an_inserted_number(subject):
    tree = read_equation(
        EQ_10_WITH_ANOTHER_PREFACTOR.replace("PREFACTOR", r"3 \times 2^{2}"), SHENG_2015.table, number="x"
    )
    found = verdict_on(tree, subject("equal_biaxial", "dashpot_rate_1")).corrections
    rate = r"\frac{\mathrm{d} \xi_{EB}}{\mathrm{d}t}"
    assert [correction.partition(":")[0] for correction in found] == [
        "coefficient",
        "exponent",
        "coefficient",
    ]
    assert r"2^{2}" in found[0].partition("->")[2] and r"2^{2}" in found[1].partition("->")[0]
    assert found[2] == rf"coefficient: {rate} -> \frac{{1}}{{2}} {rate}"


def test_a_candidate_without_proof_is_no_correction(subject, monkeypatch):
    """It is dropped alone: the others are still found."""
    tree = read_equation(EQ_10_WITH_ANOTHER_PREFACTOR.replace("PREFACTOR", "3"), SHENG_2015.table, number="x")
    rate = subject("equal_biaxial", "dashpot_rate_1")
    first, *others = explain.corrections(tree, rate)

    def prove_all_but_the_first(edited, witness):
        if 6 in edited_numbers(edited):
            return Comparison(False, sp.S.One, "in numbers only")
        return compare(edited, witness)

    monkeypatch.setattr(explain, "compare", prove_all_but_the_first)
    assert r"6 \eta" in first and others
    assert explain.corrections(tree, rate) == tuple(others)


def edited_numbers(tree):
    return [part.value for _, part in walk(tree) if isinstance(part, Number)]


def test_eq_21_is_mended_by_its_bracket_and_breaks_the_unit(verdicts):
    verdict = verdicts["21", "pure_shear_as_printed"]
    assert [correction.partition(":")[0] for correction in verdict.corrections] == ["bracket"]
    assert len(verdict.unit_faults) == 2
    assert (
        r"\frac{P}{4HL}\lambda_{PS}^{4} has dimension kg m^-1 s^-2, where s^-2 is expected"
        in verdict.unit_faults[0]
    )
    assert r"\varepsilon E^{2}" in verdict.unit_faults[1]
    assert [fault for v in verdicts.values() if v.number != "21" for fault in v.unit_faults] == []


def test_eq_19_lacks_the_thickness_inertia(verdicts):
    verdict = verdicts["19", "pure_shear_consistent"]
    assert verdict.printed_unmatched == ()
    assert any("λ̈_PS" in term for term in verdict.derived_unmatched)
    assert any("λ̇_PS²" in term for term in verdict.derived_unmatched)


def test_eq_22_is_derived_where_the_text_lost_it(verdicts):
    derived = verdicts["22", "pure_shear_as_printed"].derived
    assert derived == "ξ̇_PS = μ^β (2 λ_PS² / ξ_PS - ξ_PS - ξ_PS³ / λ_PS²) / (6 η)"


def test_every_derived_term_has_its_unit(equations):
    for name in MODELS:
        for equation in derived_equations(equations(name)).values():
            terms = check_dimensions(equation)
            assert terms and all(term.ok for term in terms)


def test_a_derived_term_with_another_unit_is_named(equations):
    good = derived_equations(equations("uniaxial"))["equation_of_motion_1"]
    bad = replace(good, residual=good.residual + s.FORCE.symbol)
    with pytest.raises(DimensionError, match="term P has dimension kg m s\\^-2"):
        check_dimensions(bad)
    bracket = sp.Mul(good.residual, sp.Add(1, s.FORCE.symbol), evaluate=False)
    with pytest.raises(DimensionError, match="P has dimension kg m s\\^-2"):
        check_dimensions(replace(good, residual=bracket))


def test_the_parts_of_every_model_have_their_units(equations):
    for name in MODELS:
        assert check_model_dimensions(equations(name)) >= 20


FORCE_N, ENERGY_J = s.FORCE.symbol, s.KINETIC_ENERGY.symbol
ENTRY = sp.ImmutableMatrix([[FORCE_N]])


@pytest.mark.parametrize(
    ("part", "spoil"),
    [
        ("kinetic_energy", lambda eom: {"kinetic_energy": eom.kinetic_energy + FORCE_N}),
        (
            "potential_energy, electrostatic",
            lambda eom: {
                "energies": eom.energies.with_part("electrostatic", eom.energies["electrostatic"] + FORCE_N)
            },
        ),
        ("mass_matrix[0, 0]", lambda eom: {"mass_matrix": eom.mass_matrix + ENTRY}),
        (
            "inertia_force[0, 0]",
            lambda eom: {
                "force_terms": (
                    replace(eom.force_terms[0], vector=eom.force_terms[0].vector + ENTRY),
                    *eom.force_terms[1:],
                )
            },
        ),
        ("internal_rate_1", lambda eom: {"internal_rates": (eom.internal_rates[0] + FORCE_N,)}),
        ("reaction_force_1", lambda eom: {"reaction_forces": (eom.reaction_forces[0] + ENERGY_J,)}),
        (
            "static_reaction_force_1",
            lambda eom: {"static_reaction_forces": (eom.static_reaction_forces[0] + ENERGY_J,)},
        ),
        ("force_power", lambda eom: {"force_power": eom.force_power + FORCE_N}),
        ("deviatoric_stress_2", lambda eom: {"dissipation": spoiled_stress(eom.dissipation)}),
        ("jacobian[0, 1]", lambda eom: {"jacobian": spoiled_entry(eom.jacobian, 0, 1)}),
        ("jacobian[1, 0]", lambda eom: {"jacobian": spoiled_entry(eom.jacobian, 1, 0)}),
        ("jacobian[2, 1]", lambda eom: {"jacobian": spoiled_entry(eom.jacobian, 2, 1)}),
    ],
)
def test_a_part_with_another_unit_is_named(part, spoil, equations):
    eom = equations("pure_shear_consistent")
    with pytest.raises(DimensionError) as caught:
        check_model_dimensions(replace(eom, **spoil(eom)))
    assert str(caught.value).startswith(f"pure_shear_consistent, {part}: ")
    assert set(caught.value.terms) & {FORCE_N, ENERGY_J}
    assert "\n" not in str(caught.value)


def spoiled_entry(matrix, i, j):
    changed = matrix.as_mutable()
    changed[i, j] += FORCE_N
    return changed.as_immutable()


def spoiled_stress(dissipation):
    dashpot = dissipation.dashpots[0]
    first, second, third = dashpot.deviators
    spoiled = replace(dashpot, deviators=(first, second + FORCE_N, third))
    return replace(dissipation, dashpots=(spoiled,))


def test_a_dashpot_power_with_another_unit_is_named(equations, monkeypatch):
    eom = equations("pure_shear_consistent")
    monkeypatch.setattr(type(eom.dissipation), "power", lambda dissipation, volume: ENERGY_J)
    with pytest.raises(DimensionError, match=r"pure_shear_consistent, dashpot_power: term T has dimension"):
        check_model_dimensions(eom)


def test_a_potential_with_reactions_is_stated_only_where_there_are_reactions(equations):
    for name in MODELS:
        stated = "potential_with_reactions" in derived_equations(equations(name))
        assert stated == bool(equations(name).load_case.reactions)


# --- the comparison itself --------------------------------------------------------------------------


def test_scaling_both_sides_is_seen_as_scaling(subject):
    tree = read_equation(
        r"3 \frac{d\xi_{EB}}{dt} = \frac{\mu^{\beta}}{2\eta} (\lambda_{EB}^2 \xi_{EB}^{-1} - \lambda_{EB}^{-4} \xi_{EB}^5)",
        SHENG_2015.table,
        number="x",
    )
    verdict = verdict_on(tree, subject("equal_biaxial", "dashpot_rate_1"))
    assert (verdict.outcome, verdict.factor) == (Outcome.SCALED, 3)


def test_terms_may_stand_on_either_side(subject):
    tree = read_equation(
        r"\frac{d\xi_{EB}}{dt} - \frac{\mu^{\beta}}{6\eta} \lambda_{EB}^2 \xi_{EB}^{-1} = - \frac{\mu^{\beta}}{6\eta} \lambda_{EB}^{-4} \xi_{EB}^5",
        SHENG_2015.table,
        number="x",
    )
    assert verdict_on(tree, subject("equal_biaxial", "dashpot_rate_1")).outcome is Outcome.EQUAL


@pytest.mark.parametrize("latex", [r"\mu^{\beta} = \mu^{\beta}", r"0 = 0", r"\lambda_{EB} = \xi_{EB}"])
def test_an_equation_without_the_unknown_differs(latex, subject):
    tree = read_equation(latex, SHENG_2015.table, number="x")
    assert (
        verdict_on(tree, subject("equal_biaxial", "dashpot_rate_1"), explained=False).outcome
        is Outcome.DIFFERS
    )


NOT_LINEAR = "it is not linear in {}, as the derived one is: compared as differing"


def test_an_equation_that_bends_in_the_unknown_differs(subject):
    """At 0 and 1 the square of the unknown looks like the unknown."""
    tree = read_equation(
        r"(\frac{d\xi_{EB}}{dt})^2 = \frac{\mu^{\beta}}{6\eta} (\lambda_{EB}^2 \xi_{EB}^{-1} - \lambda_{EB}^{-4} \xi_{EB}^5)",
        SHENG_2015.table,
        number="x",
    )
    rate = subject("equal_biaxial", "dashpot_rate_1")
    assert not compare(tree, rate).equal
    assert verdict_on(tree, rate, explained=False).note == NOT_LINEAR.format("ξ̇_EB")


def test_the_right_equation_in_another_form_is_said_not_to_be_compared_term_by_term(subject):
    tree = read_equation(
        r"\frac{1}{T} = \frac{1}{\frac{8}{3}\rho L^4 H \dot{\lambda}_{EB}^2 + \frac{16}{3}\rho L^2 H^3 \dot{\lambda}_{EB}^2 \lambda_{EB}^{-6}}",
        SHENG_2015.table,
        number="x",
    )
    verdict = verdict_on(tree, subject("equal_biaxial", "kinetic_energy"), explained=False)
    assert (verdict.outcome, verdict.note) == (Outcome.DIFFERS, NOT_LINEAR.format("T"))
    assert "not linear in T" in detail(verdict)


def test_a_difference_in_the_thirtieth_digit_is_seen(subject):
    """Double precision calls this possible."""
    tiny = "1" + "0" * 29 + "1"
    tree = read_equation(
        rf"T = \frac{{{tiny}}}{{1{'0' * 30}}} \frac{{8}}{{3}}\rho L^4 H \dot{{\lambda}}_{{EB}}^2 + \frac{{16}}{{3}}\rho L^2 H^3 \dot{{\lambda}}_{{EB}}^2 \lambda_{{EB}}^{{-6}}",
        SHENG_2015.table, number="x",
    )  # fmt: skip
    energy = subject("equal_biaxial", "kinetic_energy")
    assert may_agree(tree, energy)
    assert not agrees_numerically(tree, energy)


def test_the_printed_side_is_evaluated_in_high_precision(subject):
    assert mpmath.mp.dps == 15  # the comparison does not leave its precision behind
    compare(SHENG_2015.read("7"), subject("equal_biaxial", "kinetic_energy"))
    assert mpmath.mp.dps == 15


@pytest.mark.parametrize(
    ("latex", "reason"),
    [
        (r"E D = E R", "which can vanish"),
        (r"(\lambda_{EB} - 1) D = (\lambda_{EB} - 1) R", "which can vanish"),
        (r"(D - R)^2 = 0", "not linear in"),
        (r"\frac{1}{D} = \frac{1}{R}", "not linear in"),
        (r"\lambda_{EB} = \xi_{EB}", "does not stand in it"),
    ],
)
def test_a_difference_that_terms_do_not_show_has_a_reason(latex, reason, subject):
    rate = r"\frac{d\xi_{EB}}{dt}"
    right = r"(\frac{\mu^{\beta}}{6\eta} (\lambda_{EB}^2 \xi_{EB}^{-1} - \lambda_{EB}^{-4} \xi_{EB}^5))"
    text = latex.replace("D", rate).replace("R", right) if "D" in latex else latex
    verdict = verdict_on(
        read_equation(text, SHENG_2015.table, number="x"),
        subject("equal_biaxial", "dashpot_rate_1"),
        explained=False,
    )
    assert verdict.outcome is Outcome.DIFFERS and reason in verdict.note


# --- the record --------------------------------------------------------------------------------------


def test_verdicts_are_as_recorded(verdicts):
    record = [entry for entry in recorded(SHENG_2015) if entry["model"] in MODELS]
    assert departures(tuple(verdicts.values()), record) == ()


@pytest.mark.parametrize(
    "field",
    ["outcome", "factor", "printed_unmatched", "derived_unmatched", "corrections", "unit_faults", "derived"],
)
def test_a_departure_from_the_record_is_reported(field, verdicts):
    record = copy.deepcopy([entry for entry in recorded(SHENG_2015) if entry["model"] in MODELS])
    changed = next(entry for entry in record if field in entry)
    changed[field] = "something else"
    lines = departures(tuple(verdicts.values()), record)
    assert len(lines) == 1 and lines[0].startswith(f"Eq. ({changed['number']}) against {changed['model']}")


def test_what_is_found_or_recorded_twice_is_reported(verdicts):
    record = [entry for entry in recorded(SHENG_2015) if entry["model"] in MODELS]
    found = tuple(verdicts.values())
    name = f"Eq. ({record[3]['number']}) against {record[3]['model']}"
    assert departures(found, [*record, record[3]]) == (f"{name}: recorded 2 times, allowed is once",)
    assert departures((*found, found[3], found[3]), record) == (f"{name}: found 3 times, allowed is once",)


def test_an_unrecorded_or_vanished_verdict_is_reported(verdicts):
    record = [entry for entry in recorded(SHENG_2015) if entry["model"] in MODELS]
    found = tuple(verdicts.values())
    assert "recorded nothing" in departures(found, record[1:])[0]
    assert "found nothing" in departures(found[1:], record)[0]


def test_nothing_is_recorded_as_equal_that_is_not(verdicts):
    for entry in recorded(SHENG_2015):
        if entry["outcome"] in (Outcome.EQUAL, Outcome.SCALED) and entry["model"] in MODELS:
            assert verdicts[entry["number"], entry["model"]].agrees


def test_the_table_shows_each_verdict(verdicts):
    found = tuple(verdicts.values())
    text = as_text(found)
    assert len(rows(found)) == len(found)
    for verdict in found:
        assert f"({verdict.number})" in text
        assert str(verdict.outcome) in summary(found)
    assert "one edit mends it" in detail(verdicts["16", "uniaxial"])
