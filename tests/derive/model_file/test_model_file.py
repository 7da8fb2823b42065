"""Model files: what they say comes out in SI units, and what does not make a membrane is refused with its line."""

from __future__ import annotations

import importlib.util
import re
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from delagrange.cli import main
from delagrange.common.roles import Role, Sign
from delagrange.derive.emit import write_together as writing
from delagrange.derive.emit.write_together import write_together
from delagrange.derive.equations.described import description_equations
from delagrange.derive.model_file import formulas
from delagrange.derive.model_file.expression import read_expression as reading
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.model_file.toml_table import ModelError, lines_of
from delagrange.derive.pipeline import derive_description

EXAMPLE = Path(__file__).parents[2] / "models" / "gent_three_branches.toml"

SMALL = """name = "small"
title = "Gent membrane with one branch"
[body]
half_length = "5 mm"
half_thickness = "1 mm"
density = 1200
[equilibrium_spring]
material = "Gent"
shear_modulus = "18 kPa"
locking = 110
[[branch]]
material = "neo-Hookean"
shear_modulus = "42 kPa"
relaxation_time = "400 s"
[dielectric]
permittivity = "61.98 pF/m"
[load]
kind = "equal_biaxial"
"""
OWN = """energy = "mu/2*(I_1 - 3) + a*(lambda_1*lambda_2*lambda_3 - 1)^2"
parameters = { mu = "18 kPa", a = "1 kPa" }
"""
GENT = 'material = "Gent"\nshear_modulus = "18 kPa"\nlocking = 110\n'
LOAD = '[load]\nkind = "equal_biaxial"\n'
ATTACHED = SMALL + '[[attachment]]\nmass = "0 g"\nstiffness = -2\n'
RELATION = """[load]
kind = "relation"
coordinate = "q"
lambda_1 = "q"
lambda_2 = "q^-a"
[load.parameters]
a = 0.3
"""


@pytest.fixture
def read(tmp_path):
    """`read(text)` -> Description of the membrane of a file that holds it."""

    def reading(text: str):
        path = tmp_path / "my.toml"
        path.write_text(text, encoding="utf-8")
        return read_model_file(path)

    return reading


def changed(old: str, new: str, text: str = SMALL) -> str:
    assert text.count(old) == 1, old
    return text.replace(old, new)


def test_the_example_says_what_it_says():
    model = read_model_file(EXAMPLE)
    assert model.name == EXAMPLE.stem and model.load.kind == "uniaxial"
    values, names = model.defaults, ("half_length", "density", "shear_modulus_alpha", "locking_alpha")
    assert [values[name] for name in names] == [5e-3, 1200.0, 1.8e4, 110.0]
    assert not model.body.unlike and model.equilibrium_spring.name == "Gent"
    viscosities = [values[branch.viscosity.name] for branch in model.branches]
    assert viscosities == pytest.approx([20.0, 600.0, 4000.0], rel=1e-14)
    assert model.branches[2].energy.name == "own"


def test_the_example_has_a_value_for_every_parameter():
    description = read_model_file(EXAMPLE)
    names = {
        "half_length", "half_thickness", "density", "permittivity", "shear_modulus_alpha", "locking_alpha",
        "shear_modulus_beta_1", "locking_beta_1", "viscosity_1", "shear_modulus_beta_2", "viscosity_2", "mu_beta_3",
        "k_beta_3", "viscosity_3",
    }  # fmt: skip
    assert set(description.defaults) == names
    assert description.defaults["k_beta_3"] == 2e3 and description.defaults["viscosity_1"] == pytest.approx(
        20.0
    )


def test_a_relaxation_time_stands_for_a_viscosity_by_the_modulus_at_rest(read):
    """eta = tau mu with the shear modulus of small strains, which is mu + k for the energy below."""
    own = 'energy = "mu/2*(I_1 - 3) + k/2*(I_2 - 3)"\nparameters = { mu = "30 kPa", k = "12 kPa" }\n'
    text = changed('material = "neo-Hookean"\nshear_modulus = "42 kPa"\n', own)
    assert read(text).defaults["viscosity"] == pytest.approx(400.0 * 4.2e4, rel=1e-12)
    assert read(SMALL).defaults["viscosity"] == pytest.approx(400.0 * 4.2e4, rel=1e-12)


def test_an_own_energy_is_the_energy(read):
    description = read(changed(GENT, OWN))
    stretches = sp.symbols("a b c", positive=True)
    energy = description.equilibrium_spring
    mu, a = (quantity.symbol for quantity in energy.parameters)
    expected = mu / 2 * (sum(s**2 for s in stretches) - 3) + a * (sp.prod(stretches) - 1) ** 2
    assert sp.expand(energy.density(stretches) - expected) == 0
    assert [quantity.name for quantity in energy.parameters] == ["mu_alpha", "a_alpha"]


def test_rectangles_attachments_damping_and_permittivity(read):
    text = changed('half_length = "5 mm"', 'half_length_1 = "5 mm"\nhalf_length_2 = 0.01')
    text = changed(LOAD, '[load]\nkind = "pure_shear"\nheld_stretch = 2\nlateral_dashpots = "held"\n', text)
    text = changed('permittivity = "61.98 pF/m"', 'control = "charge"\npermittivity_formula = "e*(1 - c*(I_1 - 3))"\n'
                   'parameters = { e = "62 pF/m", c = 0.01 }', text)  # fmt: skip
    text += '[damping]\nparallel_viscosity = "2 Pa s"\nmedium = 3.0\n'
    text += '[[attachment]]\naxis = 1\nmass = "2 g"\nstiffness = "3 N/m"\n'
    description = read(text)
    assert description.body.unlike and not description.load.lateral_dashpots_free
    assert description.dielectric.control == "charge"
    law = description.dielectric.permittivity
    assert law.of_stretches((1, 1, 1)) == law.parameters[0].symbol
    expected = {
        "half_length_1": 5e-3, "half_length_2": 0.01, "permittivity_e": 6.2e-11, "permittivity_c": 0.01,
        "parallel_viscosity": 2.0, "medium_damping": 3.0, "edge_mass_1": 2e-3, "edge_stiffness_1": 3.0,
        "held_stretch": 2.0,
    }  # fmt: skip
    assert expected.items() <= dict(description.defaults).items()


def test_a_relation_has_one_coordinate(read):
    relation = read(changed(LOAD, RELATION)).load.relation
    q, (a,) = relation.coordinate.value.symbol, relation.parameters
    assert relation.stretches == (q, q**-a.symbol) and relation.forces == (True, False)
    assert a.name == "relation_a"


@pytest.mark.parametrize(
    ("lambda_1", "lambda_2", "start", "positive"),
    [
        ("q", "q^-a", "1", True),
        ("1 + q", "2*a*sqrt(q)", "0.5", True),
        ("1 + q", "1 + q", "0", False),
        ("1 - q", "1 + a*q", "-0.25", False),
        ("q^2", "q^-2", "1", False),  # a negative one gives stretches as well
        ("q^2", "q^-2", "-1", False),
        ("q^a", "1 + q", "1", False),  # a may be set to 2
        ("-a*q", "1", "-3", False),
    ],
)
def test_a_coordinate_is_taken_for_positive_where_a_stretch_says_so(
    read, lambda_1, lambda_2, start, positive
):
    text = RELATION.replace('lambda_1 = "q"', f'lambda_1 = "{lambda_1}"').replace('"q^-a"', f'"{lambda_2}"')
    relation = read(changed(LOAD, changed("[load.", f"start = {start}\n[load.", text))).load.relation
    assert bool(relation.coordinate.value.symbol.is_positive) is positive
    assert relation.coordinate.value.unit == "1" and relation.coordinate.rate.unit == "1/s"
    assert relation.start == sp.Rational(start)


def test_a_root_of_the_square_of_a_positive_coordinate_is_the_coordinate(read):
    relation = read(changed(LOAD, changed("q^-a", "q/sqrt(q^2)^a", RELATION))).load.relation
    q, (a,) = relation.coordinate.value.symbol, relation.parameters
    assert sp.simplify(relation.stretches[1] - q ** (1 - a.symbol)) == 0


def test_no_name_makes_a_coordinate_a_stretch_or_positive(read):
    text = RELATION.replace('"q"\nlambda_1 = "q"', '"stretch"\nlambda_1 = "1 + stretch"')
    text = text.replace("q^-a", "1 + stretch").replace("[load.", "start = 0\n[load.")
    coordinate = read(changed(LOAD, text)).load.relation.coordinate
    assert (coordinate.value.role, coordinate.value.sign) == (Role.COORDINATE, Sign.ANY)


def test_what_may_be_absent_or_negative_may_be_given_so(read):
    """A mass may be zero, a spring may push, and a term of an energy may soften it."""
    softening = 'material = "Mooney-Rivlin"\nshear_modulus = "18 kPa"\nsecond_modulus = "-3 kPa"\n'
    found = read(changed(GENT, softening, ATTACHED)).defaults
    assert (found["edge_mass"], found["edge_stiffness"]) == (0.0, -2.0)
    assert found["second_modulus_alpha"] == -3e3
    with pytest.raises(ModelError, match=r"at rest must be positive and finite, its energy has -2000 Pa"):
        read(changed(GENT, softening.replace("-3 kPa", "-20 kPa")))


def test_a_frame_may_have_its_force_put_into_the_potential(read):
    """The formulation of the paper's Eq. (20), for anybody: its motion is not that of mechanics."""
    load = '[load]\nkind = "pure_shear"\nheld_stretch = 2\n'
    consistent, inserted = (
        read(changed(LOAD, f'{load}formulation = "{formulation}"\n'))
        for formulation in ("consistent", "as_printed")
    )
    assert inserted.load.formulation == "as_printed"
    assert consistent == replace(read(changed(LOAD, load)), equilibrium_spring=consistent.equilibrium_spring,
                                 branches=consistent.branches, dielectric=consistent.dielectric)  # fmt: skip
    terms = {each.name: each.vector[0] for each in description_equations(inserted).force_terms}
    own = {each.name: each.vector[0] for each in description_equations(consistent).force_terms}
    assert sp.expand(terms["electric_force"] + own["electric_force"]) == 0
    assert terms["applied_force"] == own["applied_force"]


@pytest.mark.parametrize(
    ("load", "line", "reason"),
    [
        ('kind = "uniaxial"\nformulation = "as_printed"\n', 19, "formulation belongs to a load of the kind pure_shear"),
        ('kind = "pure_shear"\nheld_stretch = 2\nformulation = "printed"\n', 20,
         "formulation must be one of consistent, as_printed; got 'printed'"),
    ],
)  # fmt: skip
def test_a_formulation_that_does_not_fit_is_refused(read, load, line, reason):
    with pytest.raises(ModelError, match=f"line {line}: {reason}"):
        read(changed(LOAD, f"[load]\n{load}"))


def test_a_formula_is_read_once(read, monkeypatch):
    """Energies, a limit, a permittivity and a relation: from the file straight into the description."""
    texts = []
    monkeypatch.setattr(
        formulas, "read_expression", lambda text, names: texts.append(text) or reading(text, names)
    )
    text = changed(LOAD, RELATION, changed(GENT, OWN + 'validity = "9 + mu/a - I_1"\n'))
    law = 'permittivity_formula = "e*(1 - c*(I_1 - 3))"\nparameters = { e = "62 pF/m", c = 0.01 }'
    read(changed('permittivity = "61.98 pF/m"', law, text))
    assert sorted(texts) == sorted(
        [
            "mu/2*(I_1 - 3) + a*(lambda_1*lambda_2*lambda_3 - 1)^2",
            "9 + mu/a - I_1",
            "e*(1 - c*(I_1 - 3))",
            "q",
            "q^-a",
        ]
    )


def test_ogden_terms_are_counted(read):
    terms = 'material = "ogden"\n' + "".join(
        f'ogden_modulus_{k} = "{m} kPa"\nogden_exponent_{k} = {a}\n'
        for k, m, a in ((1, 10, 1.3), (2, -1, -2))
    )
    energy = read(changed(GENT, terms)).equilibrium_spring
    assert len(energy.parameters) == 4


FAULTS = [
    ("unknown table", changed("[load]", "[laod]"), 17, "unknown key 'laod' in the file (did you mean 'load'?)"),
    ("unknown key", changed("locking", "lockin"), 10, "(did you mean 'locking'?)"),
    ("unknown material", changed('"Gent"', '"Gint"'), 8, "got 'Gint' (did you mean 'Gent'?)"),
    ("missing value", changed("locking = 110\n", ""), 7, "[equilibrium_spring] needs a value of locking"),
    ("missing table", changed('[dielectric]\npermittivity = "61.98 pF/m"\n', ""), 1, "needs a table [dielectric]"),
    ("wrong unit", changed('"18 kPa"', '"18 kg"'), 9, "has a unit of dimension kg; needed is Pa"),
    ("unknown unit", changed('"18 kPa"', '"18 kilo"'), 9, "'kilo' is none of"),
    ("no unit", changed('"18 kPa"', '"18"'), 9, "must carry a unit"),
    ("not positive", changed('"18 kPa"', '"-18 kPa"'), 8, "the shear modulus of [equilibrium_spring] at rest must be "
     "positive and finite, its energy has -18000 Pa"),
    ("negative mass", ATTACHED.replace("0 g", "-1 g"), 20, "mass must be zero or positive, got '-1 g'"),
    ("negative size", changed('"1 mm"', '"-1 mm"'), 5, "half_thickness must be positive, got '-1 mm'"),
    ("not finite", changed("density = 1200", "density = inf"), 6, "density must be finite"),
    ("a date", changed("density = 1200", "density = 1979-05-27"), 6, "density must be a number"),
    ("both times", changed('"400 s"', '"400 s"\nviscosity = 1'), 15, "has relaxation_time and viscosity"),
    ("no time", changed('relaxation_time = "400 s"\n', ""), 11, "[[branch]] 1 must have one of viscosity"),
    ("misplaced dashpot", changed("locking = 110\n", "locking = 110\nviscosity = 3\n"), 11, "belongs in a [[branch]]"),
    ("unknown load", changed('"equal_biaxial"', '"biaxal"'), 18, "did you mean 'biaxial'?"),
    ("extra hold", SMALL + "held_stretch = 2\n", 19, "over-determines one of the kind equal_biaxial"),
    ("thickness", SMALL + "lambda_3 = 2\n", 19, "it follows from lambda_1 lambda_2 lambda_3 = 1"),
    ("name", changed('"small"', '"class"'), 1, "no word of Python"),
    ("stdlib name", changed('"small"', '"random"'), 1, "that of another module"),
    ("built-in name", changed('"small"', '"uniaxial"'), 1, "that of another module"),
    ("title that ends a docstring", changed("Gent membrane", "'''\\\"\\\"\\\"import os"), 2, "title must be a text of"),
    ("two lines", changed("Gent membrane", "Gent\\nmembrane"), 2, "in one line"),
    ("rectangle", changed('half_length = "5 mm"', "half_length_1 = 1\nhalf_length_2 = 2"), 4, "sides of a membrane"),
    ("both lengths", changed('half_length = "5 mm"', "half_length = 1\nhalf_length_1 = 2"), 5, "has half_length and"),
    ("attachment", SMALL + "[[attachment]]\n", 19, "[[attachment]] 1 needs a mass"),
    ("twice", SMALL + "[[attachment]]\nmass=1\n[[attachment]]\nmass = 2\n", 21, "over-determines edges"),
    ("axis", SMALL + "[[attachment]]\naxis = 3\n", 20, "axis must be 1 or 2, got 3"),
    ("control", changed("[dielectric]", '[dielectric]\ncontrol = "current"'), 16, "control must be one of voltage"),
    ("damping", SMALL + "[damping]\nmedum = 3\n", 20, "did you mean 'medium'?"),
    ("not tables", changed("[[branch]]", "[branch]"), 11, "branch must be tables, each written [[branch]]"),
    ("not a table", "load = 3\n" + changed(LOAD, ""), 1, "load must be a table, written [load]"),
    ("TOML", SMALL + "kind = \n", None, "not understood as TOML"),
    ("twice a key", SMALL + 'kind = "uniaxial"\n', None, "not understood as TOML"),
]  # fmt: skip
OWN_FAULTS = [
    ("unknown symbol", changed("mu/2", "nu/2", OWN), 8, "column 1 of the formula: unknown symbol 'nu'"),
    ("code", changed("mu/2", "__import__('os')", OWN), 8, "column 1 of the formula: found '_'"),
    ("attribute", changed("mu/2", "mu.real", OWN), 8, "column 3 of the formula: found '.'"),
    ("power", changed("^2", "^9^9^9^9", OWN), 8, "a power too large"),
    ("dimension", changed("mu/2", "mu^2", OWN), 8, "dimension"),
    ("no energy", changed('"1 kPa"', '"1 mm"', OWN), 8, "has dimension"),
    ("stressed at rest", changed("mu/2*(I_1 - 3)", "mu*lambda_1", OWN), 8, "is not stress-free at rest"),
    ("no stiffness", changed("mu/2*(I_1 - 3)", "0*mu", OWN), 9, "parameter 'mu' does not occur"),
    ("negative", changed("mu/2", "-mu/2", OWN), 8, "shear modulus of [equilibrium_spring] at rest must be positive"),
    ("deep", changed("mu/2", "mu*" + "exp(lambda_1*" * 30 + "1" + ")" * 30, OWN), 8, "deep in each other"),
    ("surds", changed("mu/2", "mu" + "".join(f"/(lambda_1 + {k}*sqrt(lambda_2 + {k}))" for k in range(1, 40)), OWN), 8,
     "operations"),
    ("no value", changed("mu/2", "mu*log(lambda_1 - 1)", OWN), 8, "no finite real stresses"),
    ("reserved", changed("{ mu", '{ lambda_1 = 1, mu', OWN), 9, "it has a meaning of its own"),
    ("function's name", changed("{ mu", '{ exp = 1, mu', OWN), 9, "it has a meaning of its own"),
    ("no name", changed("{ mu", '{ "a b" = 1, mu', OWN), 9, "the name of a parameter must be"),
    ("unit of a parameter", changed('"1 kPa"', '"1 kPo"', OWN), 9, "a has no unit that is known"),
    ("two energies", OWN + 'material = "Gent"\n', 10, "has energy and material"),
    ("no text", changed('"mu/2*(I_1 - 3) + a*(lambda_1*lambda_2*lambda_3 - 1)^2"', "3", OWN), 8, "must be a text"),
]  # fmt: skip
RELATION_FAULTS = [
    ("no freedom", RELATION.replace('"q"\nlambda_2 = "q^-a"', '"2"\nlambda_2 = "1 + a"'), 20, "leaves no freedom"),
    ("no freedom at rest", changed('"q"\nlambda_2 = "q^-a"', '"1+(q-1)^2"\nlambda_2 = "a/a"', RELATION), 17,
     "leaves no freedom at the start"),
    ("collapsed", changed('"q^-a"', '"q - 1"', RELATION), 21, "must be positive and finite at the start"),
    ("unknown symbol", changed('"q^-a"', '"q^-b"', RELATION), 21, "column 4 of the formula: unknown symbol 'b'"),
    ("a third equation", changed('"q^-a"\n', '"q^-a"\nlambda_3 = "q"\n', RELATION), 22, "over-determines"),
    ("force on what is held", changed('"q^-a"\n', '"1 + a"\nforces = [1, 2]\n', RELATION), 22, "moves nothing"),
    ("axes", changed('"q^-a"\n', '"q^-a"\nforces = [3]\n', RELATION), 22, "forces must be a list of the axes"),
    ("unit", changed("a = 0.3", 'a = "0.3 m"', RELATION), 21, "pure number"),
    ("kink", changed('"q"\nlambda_2 = "q^-a"', '"1 + a*sqrt(q^2)"\nlambda_2 = "1 + q"\nstart = 0', RELATION), 20,
     "lambda_1 has no finite slope at the start, q = 0"),
    ("steep", changed('"q"\nlambda_2 = "q^-a"', '"1 + q"\nlambda_2 = "1 + sqrt(q)"\nstart = 0', RELATION), 21,
     "lambda_2 has no finite slope at the start, q = 0"),
    ("start", changed('"q^-a"\n', '"q^-a"\nstart = nan\n', RELATION), 22, "start must be finite"),
    ("start with a unit", changed('"q^-a"\n', '"q^-a"\nstart = "1 m"\n', RELATION), 22, "needed is"),
    ("none at the start", changed('"q^-a"\n', '"q^-a"\nstart = 0\n', RELATION), 20, "positive and finite at the start"),
    ("none real", changed('"q"\nlambda_2 = "q^-a"\n', '"-q"\nlambda_2 = "a + log(q)"\nstart = -1\n', RELATION), 21,
     "positive and finite at the start"),
    ("name", changed('"q"\nlambda_1', '"Q!"\nlambda_1', RELATION), 19, "must be a name of the form"),
]  # fmt: skip
CASES = (
    *FAULTS,
    *((name, changed(GENT, text), line, reason) for name, text, line, reason in OWN_FAULTS),
    *((name, changed(LOAD, text), line, reason) for name, text, line, reason in RELATION_FAULTS),
)


@pytest.mark.parametrize(
    ("text", "line", "reason"), [case[1:] for case in CASES], ids=[case[0] for case in CASES]
)
def test_what_makes_no_membrane_is_refused_with_its_line(read, tmp_path, text, line, reason):
    start = time.perf_counter()
    with pytest.raises(ModelError, match=re.escape(reason)) as caught:
        read(text)
    assert time.perf_counter() - start < 5.0
    message = str(caught.value)
    assert message.startswith(f"{tmp_path / 'my.toml'}{'' if line is None else f', line {line}'}:")
    assert "\n" not in message and message.isprintable()


@pytest.mark.parametrize(
    "content",
    [
        b"\xff\xfe",
        b"a = [" * 20_000,
        b"#" * 300_000,
        b"a = " + b"9" * 5000,
        b"\x00",
        b'a = """',
        b"[[branch]",
    ],
    ids=["bytes", "deep", "long", "large number", "NUL", "open text", "open heading"],
)
def test_what_is_no_toml_is_refused(tmp_path, content):
    (tmp_path / "my.toml").write_bytes(content)
    with pytest.raises(ModelError, match=r"my\.toml") as caught:
        read_model_file(tmp_path / "my.toml")
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(ModelError, match="cannot be read: No such file"):
        read_model_file(tmp_path / "none.toml")
    with pytest.raises(ModelError, match="cannot be read: Is a directory"):
        read_model_file(tmp_path)


def test_lines_are_found_under_headings_and_in_arrays():
    text = 'a = 1\n[b]\nc = """\nd = 2\n"""\n[[e]]\nf = 1\n[[e]]\nf = 2\n[e.g]\n"h" = 3\ni.j = 4\n'
    lines = lines_of(text)
    assert lines["a",] == 1 and lines["b", "c"] == 3 and ("b", "d") not in lines
    assert lines["e", 0, "f"] == 7 and lines["e", 1, "f"] == 9
    assert lines["e", 1, "g", "h"] == 11 and lines["e", 1, "g", "i", "j"] == 12


@pytest.fixture(scope="module")
def emitted(tmp_path_factory):
    """The small membrane through `delagrange derive FILE --out DIR`: file and folder."""
    folder = tmp_path_factory.mktemp("model")
    (folder / "small.toml").write_text(SMALL, encoding="utf-8")
    assert (
        main(["derive", str(folder / "small.toml"), "--out", str(folder / "deep" / "models"), "--quiet"]) == 0
    )
    return folder / "small.toml", folder / "deep" / "models"


def _imported(path: Path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_file_goes_the_whole_road(emitted):
    """Emitted, imported, integrated: at rest it stays; small vibrations have the frequency of the closed form."""
    from scipy.integrate import solve_ivp

    _, folder = emitted
    assert sorted(path.name for path in folder.iterdir()) == [
        "small.h",
        "small.py",
        "small_lanes.py",
        "small_variational.py",
    ]
    module = _imported(folder / "small.py")
    values = [module.DEFAULTS[parameter.name] for parameter in module.PARAMETERS]
    state, still = np.asarray(module.reference_state(values)), [0.0] * len(module.INPUTS)
    assert np.all(np.abs(module.rhs(state, still, values)) < 1e-9)
    length, thickness, density = 5e-3, 1e-3, 1200.0
    omega = np.sqrt(18 * (1.8e4 + 4.2e4) / (density * thickness**2 * (2 + (length / thickness) ** 2)))
    state[0] += 1e-5
    run = solve_ivp(
        lambda _, y: module.rhs(y, still, values), (0.0, 2 * np.pi / omega), state, rtol=1e-10, atol=1e-14
    )
    assert run.success and run.y[0, -1] - 1 == pytest.approx(1e-5, rel=1e-3)


def test_the_same_file_gives_the_same_modules(emitted):
    path, folder = emitted
    for name, text in derive_description(read_model_file(path)):
        assert (folder / name).read_text(encoding="utf-8") == text


def test_a_stale_module_is_named(emitted, tmp_path, capsys):
    path, folder = emitted
    for each in folder.glob("small*"):
        (tmp_path / each.name).write_bytes(each.read_bytes())
    (tmp_path / "small_lanes.py").write_text("", encoding="utf-8")
    assert main(["derive", str(path), "--out", str(tmp_path), "--check", "--quiet"]) == 1
    assert "small_lanes.py is not what" in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.parametrize(
    ("text", "arguments", "reason"),
    [
        (changed('"18 kPa"', '"18 kg"'), ["--out", "{}/models"], "line 9: shear_modulus = '18 kg'"),
        (SMALL, [], "need a folder of their own: give it with --out DIR"),
    ],
    ids=["bad file", "no folder"],
)
def test_the_command_refuses_in_one_line_and_leaves_nothing(tmp_path, capsys, text, arguments, reason):
    (tmp_path / "my.toml").write_text(text, encoding="utf-8")
    given = [argument.format(tmp_path) for argument in arguments]
    assert main(["derive", str(tmp_path / "my.toml"), *given, "--quiet"]) == 2
    error = capsys.readouterr().err
    assert reason in error and error.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["my.toml"]


@pytest.mark.parametrize("fault", [OSError(28, "No space left on device"), KeyboardInterrupt()])
@pytest.mark.parametrize("last_good", [0, 1, 2])
def test_all_files_are_written_or_none(tmp_path, monkeypatch, fault, last_good):
    """What stood in the folder before stands there again, whichever file fails."""
    folder = tmp_path / "models"
    write_together((("a.py", "old a"), ("b.py", "old b")), folder)
    replace, calls = Path.replace, []

    def failing(self, target):
        calls.append(target)
        if len(calls) > last_good:
            raise fault
        return replace(self, target)

    monkeypatch.setattr(writing.Path, "replace", failing)
    with pytest.raises((ValueError, KeyboardInterrupt)):
        write_together((("a.py", "new a"), ("b.py", "new b"), ("c.py", "new c")), folder)
    assert {path.name: path.read_text() for path in folder.iterdir()} == {"a.py": "old a", "b.py": "old b"}


def test_no_folder_is_left_where_nothing_was_written(tmp_path, monkeypatch):
    monkeypatch.setattr(writing, "_write", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left")))
    with pytest.raises(ValueError, match="cannot be written: No space left"):
        write_together((("a.py", "a"),), tmp_path / "deep" / "models")
    assert not list(tmp_path.iterdir())
