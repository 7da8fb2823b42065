"""What a file or a description may not smuggle into emitted code, or keep the derivation busy with for hours."""

from __future__ import annotations

import ast
import math
import time
from dataclasses import replace

import pytest
import sympy as sp
from described import plain
from test_model_file import GENT, LOAD, RELATION, SMALL, changed

from delagrange.derive.membrane.description import UNIAXIAL, Permittivity
from delagrange.derive.membrane.own_energy import own_energy
from delagrange.derive.membrane.strain_energy import neo_hookean
from delagrange.derive.model_file.expression import read_expression
from delagrange.derive.model_file.file import read_model_file
from delagrange.derive.model_file.number_at import number_at
from delagrange.derive.model_file.toml_table import ModelError
from delagrange.derive.notation import symbols as s
from delagrange.derive.notation.symbols import quantity
from delagrange.derive.pipeline import derive_description, description_spec

MANY = [f"a{k}" for k in range(20)]
MANY_VALUES = ", ".join(f"{name} = 0.1" for name in MANY)
TOWER = "exp(exp(exp(exp(9*{}))))"


def own(energy: str, parameters: str = 'mu = "18 kPa"', more: str = "") -> str:
    """The small model with an own energy."""
    return changed(GENT, f'energy = "{energy}"\nparameters = {{ {parameters} }}\n{more}')


def polarised(formula: str, parameters: str = 'e = "62 pF/m"') -> str:
    """The small model with a permittivity of its own."""
    return changed(
        'permittivity = "61.98 pF/m"', f'permittivity_formula = "{formula}"\nparameters = {{ {parameters} }}'
    )


def related(stretch: str) -> str:
    """The small model with a relation: its first stretch over the coordinate."""
    return changed(LOAD, RELATION.replace('"q"\nlambda_2', f'"{stretch}"\nlambda_2'))


REFUSED = {
    "viscosity without bound": (changed('"400 s"', "1e308"), "relaxation_time", "makes a viscosity of inf Pa s"),
    "viscosity of nothing": (
        changed('"400 s"', '"1e-200 s"').replace('"42 kPa"', '"1e-200 Pa"'),
        "relaxation_time",
        "makes a viscosity of 0 Pa s",
    ),
    "beyond the limit at rest": (own("mu/2*(I_1 - 3)", more='validity = "2 - I_1"\n'), "validity", "got -1"),
    "no limit at rest": (own("mu/2*(I_1 - 3)", more='validity = "sqrt(I_1 - 4)"\n'), "validity", "got nan"),
    "deep limit": (
        own("mu/2*(I_1 - 3)", more=f'validity = "{"exp(" * 9}I_1{")" * 9}"\n'), "validity", "deep in each other"),
    "absolute value of a parameter": (
        own("mu/2*(I_1 - 3)*sqrt(x^2)", 'mu = "18 kPa", x = -1'), "energy", "has Abs(own_x_alpha)"),
    "absolute value of a stretch": (
        own("mu/2*(I_1 - 3) + mu*sqrt((lambda_1 - 1)^2)^3"), "energy", "(the root of a square); allowed are sqrt"),
    "many terms": (
        own("mu/2*(I_1 - 3)*" + "*".join(f"(1 + {name})" for name in MANY), f'mu = "18 kPa", {MANY_VALUES}'),
        "energy", "terms; allowed are 300"),
    "tower": (own(f"mu/2*(I_1 - 3)*{TOWER.format('I_1')}"), "energy", "no finite real stresses at rest"),
    "tower that vanishes": (
        own(f"mu/2*(I_1 - 3)*exp(-{TOWER.format('I_1')[4:-1]})"), "energy", "no finite real stresses at rest"),
    "permittivity like a tower": (polarised(f"e*{TOWER.format('I_1')}"), "permittivity_formula", "got nan F/m"),
    "permittivity too large": (polarised("e*exp(exp(exp(exp(I_1 - 3))))^64"), "permittivity_formula", "got nan F/m"),
    "permittivity with a kink": (
        polarised("e*(1 + sqrt(c^2))", 'e = "62 pF/m", c = -0.1'), "permittivity_formula", "has Abs(c)"),
    "deep relation": (
        related(f"{'exp(' * 9}q{')' * 9}"), "lambda_1", "deep in each other"),
    "relation of many factors": (
        related("*".join(f"(q + {k})^63" for k in range(99))), "lambda_1", "operations"),
    "relation like a tower": (related(TOWER.format("q")), "lambda_1", "got nan at q"),
    "relation without a slope but for round-off": (
        related("2 + cos(q)").replace('"q^-a"', f'"1 + a*0"\nstart = {math.pi}'), "start", "no freedom at the start"),
    "name of the package": (changed('name = "small"', 'name = "delagrange"'), "name", "that of another module"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "key", "reason"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_derived_is_refused_at_once(tmp_path, text, key, reason):
    path = tmp_path / "my.toml"
    path.write_text(text, encoding="utf-8")
    start = time.perf_counter()
    with pytest.raises(ModelError) as caught:
        read_model_file(path)
    assert time.perf_counter() - start < 30.0  # and not for ever
    line = next(number for number, row in enumerate(text.split("\n"), 1) if row.startswith(f"{key} ="))
    message = str(caught.value)
    assert message.startswith(f"{path}, line {line}:") and reason in message and "\n" not in message


def test_a_key_of_very_many_parts_is_refused(tmp_path):
    path = tmp_path / "my.toml"
    path.write_text(SMALL + "a" + ".a" * 20_000 + " = 1\n", encoding="utf-8")
    with pytest.raises(ModelError, match="more than 2000 dots"):
        read_model_file(path)


def test_the_base_of_the_natural_logarithm_is_emitted(tmp_path):
    path = tmp_path / "my.toml"
    path.write_text(own("mu*exp(1)/2*(I_1 - 3)"), encoding="utf-8")
    name, text = derive_description(read_model_file(path))[0]
    ast.parse(text, name)
    assert "np.exp(1)" in text


TEXTS = ('a """', "a \\mu", "two\nlines", 'say "so"')


@pytest.mark.parametrize("text", TEXTS)
def test_no_text_ends_what_it_stands_in(text):
    membrane = plain(UNIAXIAL)
    mean = quantity("z", "stiffness_of_mine", "z", "z", "Pa", text)
    for hostile in (
        replace(membrane, title=text),
        replace(membrane, sources=(text,)),
        replace(membrane, equilibrium_spring=replace(membrane.equilibrium_spring, source=text)),
        replace(membrane, equilibrium_spring=neo_hookean(mean)),
    ):
        with pytest.raises(ValueError, match="printable characters in one line") as caught:
            description_spec(hostile)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "name", ["state", "np", "volume", "rhs", "net_force_1", "constant_2", "applied_force_1"]
)
def test_no_parameter_takes_a_name_of_emitted_code(name):
    """Else the code would compute with a wrong number, without a word."""
    mine = quantity("zeta", name, "ζ", r"\zeta", "Pa", "a stiffness of mine")
    with pytest.raises(ValueError, match="the name of something else in emitted code"):
        derive_description(replace(plain(UNIAXIAL), equilibrium_spring=neo_hookean(mine)))


def test_a_constant_of_a_user_may_be_called_spring(tmp_path):
    """Nothing in emitted code is: `spring_alpha` is free beside `spring_alpha_force`."""
    path = tmp_path / "my.toml"
    path.write_text(own("spring/2*(I_1 - 3)", 'spring = "18 kPa"'), encoding="utf-8")
    assert "spring_alpha" in dict(derive_description(read_model_file(path)))["small.py"]


def test_a_function_without_a_name_in_code_is_refused():
    stretches = sp.symbols("a b c", positive=True)
    excess = sum(stretch**2 for stretch in stretches) - 3
    mu = s.SHEAR_MODULUS_ALPHA
    with pytest.raises(ValueError, match=r"energy 'mine' has erf\(.*allowed are sqrt, cos"):
        own_energy("mine", mu.symbol * sp.erf(excess), stretches, (mu,))
    membrane = plain(UNIAXIAL)
    bent = Permittivity((s.PERMITTIVITY,), lambda at: s.PERMITTIVITY.symbol * (1 + sp.Abs(at[0] - 1)))
    with pytest.raises(ValueError, match=r"has Abs\("):
        description_spec(replace(membrane, dielectric=replace(membrane.dielectric, permittivity=bent)))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2*x^2 - 1/3", 2 * 0.7**2 - 1 / 3),
        ("sqrt(x)*exp(-x)/cosh(x)", math.sqrt(0.7) * math.exp(-0.7) / math.cosh(0.7)),
        ("tanh(log(x)) + sin(x)*cos(x)", math.tanh(math.log(0.7)) + math.sin(0.7) * math.cos(0.7)),
        ("exp(-exp(exp(exp(9*x))))", math.nan), ("log(x - 1)", math.nan),
        ("(x - 1)^0.5", math.nan), ("1/(x - 0.7)", math.nan),
    ],
)  # fmt: skip
def test_number_at_is_the_value_or_nan(text, value):
    x = sp.Symbol("x")
    assert number_at(read_expression(text, {"x": x}), {x: 0.7}) == pytest.approx(
        value, rel=1e-14, nan_ok=True
    )


def test_the_small_model_is_still_taken(tmp_path):
    path = tmp_path / "my.toml"
    path.write_text(SMALL, encoding="utf-8")
    assert read_model_file(path).defaults["viscosity"] == pytest.approx(400.0 * 42e3)
