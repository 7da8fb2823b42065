"""Modules of users whose shapes, kernels or values do not fit: refused in one line."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from user_membranes import write_membrane

import delagrange as dl
from delagrange import generated
from delagrange.model.kernels import LANES, VARIATIONAL
from delagrange.model.parameters import material_of
from delagrange.model.variables import role_of, sign_of
from delagrange.problem.dashpots import dashpot_count, frozen
from delagrange.problem.problem import make_problem

BUILT_IN = Path(generated.__path__[0])
_OWN = """import numpy as np
from typing import NamedTuple
class Variable(NamedTuple):
    name: str
    symbol: str
    unit: str
    meaning: str
MODEL, FORMULATION, COORDINATE_COUNT = "own", "by hand", 1
STATE = (Variable("stretch", "x", "1", "stretch"), Variable("stretch_rate", "v", "1/s", "rate"))
INPUTS = (Variable("force", "P", "N", "force"),)
PARAMETERS = (Variable("stiffness", "k", "1/s^2", "stiffness"),)
def rhs(state, inputs, parameters):
    return np.array([state[1], -parameters[0] * (state[0] - 1)])
def principal_stretches(state, inputs, parameters):
    return np.array([state[0], state[0], state[0] ** -2.0])
def reference_state(parameters):
    return np.array([1.0, 0.0])
"""
_RATES = "np.array([state[1], -parameters[0] * (state[0] - 1)])"
MISSHAPEN = {
    "rhs is short": (_RATES, "np.array([state[1]])", r"rhs returns .*\(1,\), needed is \(2,\)"),
    "rhs raises": ("state[1], -", "state[7], -", "rhs raises IndexError"),
    "rhs is text": (_RATES, "'fast'", "rhs raises ValueError"),
    "two stretches": ("state[0], state[0], ", "state[0], ", r"principal_stretches returns .*\(2,\), needed is \(3,\)"),
    "start": ("[1.0, 0.0]", "[[1.0, 0.0]]", r"reference_state returns .*\(1, 2\)"),
    "coordinates": ('"by hand", 1', '"by hand", 2', "COORDINATE_COUNT must be an integer from 1 to half the 2"),
    "name": ('"own", "by hand"', '7, "by hand"', "MODEL must be text, got 7"),
    "no variables": ('(Variable("force", "P", "N", "force"),)', '("force",)', "each of INPUTS must have a name"),
    "exit": ("import numpy as np", "import numpy as np\nraise SystemExit('bye')", "imported: SystemExit: bye"),
}  # fmt: skip


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("case", MISSHAPEN)
def test_a_module_that_does_not_fit_itself_is_refused_in_one_line(tmp_path, case):
    old, new, says = MISSHAPEN[case]
    dl.load(written(tmp_path / "good.py", _OWN))
    assert _OWN.count(old) == 1
    with pytest.raises(ValueError, match=says) as refusal:
        dl.load(written(tmp_path / "own.py", _OWN.replace(old, new)))
    assert "\n" not in str(refusal.value) and "own.py" in str(refusal.value)


@pytest.mark.parametrize("kind", [LANES, VARIATIONAL])
def test_a_kernel_of_other_equations_is_refused(tmp_path, kind):
    path = Path(shutil.copy(BUILT_IN / "equal_biaxial.py", tmp_path / "my_membrane.py"))
    shutil.copy(BUILT_IN / f"uniaxial_{kind}.py", tmp_path / f"my_membrane_{kind}.py")
    says = rf"my_membrane_{kind}\.py is not a kernel of .*my_membrane\.py: it has the digest \w+ of its equations"
    with pytest.raises(ValueError, match=says) as refusal:
        dl.load(path)
    assert "\n" not in str(refusal.value)
    written(tmp_path / f"my_membrane_{kind}.py", "x = (")
    with pytest.raises(ValueError, match=r"it has no digest of its equations, the model [0-9a-f]{16}"):
        dl.load(path)
    (tmp_path / f"my_membrane_{kind}.py").unlink()
    assert dl.load(path).MODEL == "equal_biaxial"


def test_a_model_that_states_no_digest_takes_no_kernel(tmp_path):
    path = write_membrane(tmp_path, "mine", branches=1)
    shutil.copy(BUILT_IN / "uniaxial_lanes.py", tmp_path / "mine_lanes.py")
    with pytest.raises(ValueError, match="of its equations, the model none; derive both anew"):
        dl.load(path)


# --- values that a parameter cannot take -----------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "unit", "zero"),
    [
        ("conductivity", "S/m", True), ("parallel_viscosity", "Pa s", True), ("edge_mass", "kg", True),
        ("medium_damping", "Pa s/m", True), ("viscosity_2", "Pa s", False), ("locking_alpha", "1", False),
        ("half_length_2", "m", False), ("density", "kg/m^3", False), ("permittivity", "F/m", False),
    ],
)  # fmt: skip
def test_what_cannot_be_negative_is_refused(tmp_path, name, unit, zero):
    text = _OWN.replace('"stiffness", "k", "1/s^2", "stiffness"', f'"{name}", "k", "{unit}", "{name}"')
    model = dl.load(written(tmp_path / "own.py", text + f'DEFAULTS = {{"{name}": 2.0}}\n'))
    material = material_of(model, dl.SHENG_2015)
    allowed = "zero or positive and finite" if zero else "positive and finite"
    told = f"{name} must be {allowed}, got -1{'' if unit == '1' else f' {unit}'}"
    for value in (-1.0, np.array([1.0, -1.0])):
        with pytest.raises(ValueError, match=f"{name} must be {allowed}, got"):
            material.checked(name, value)
    with pytest.raises(ValueError, match=re.escape(told)):
        dl.simulate(model, duration=1e-4, **{name: -1.0})
    if zero:
        assert material.checked(name, 0.0) == 0.0
    else:
        with pytest.raises(ValueError, match=f"{name} must be {allowed}"):
            material.checked(name, 0.0)
    bad = dl.load(written(tmp_path / "bad.py", text + f'DEFAULTS = {{"{name}": -1.0}}\n'))
    with pytest.raises(ValueError, match=re.escape(f"DEFAULTS of the model own: {told}")):
        dl.simulate(bad, duration=1e-4)


def test_what_may_be_negative_is_not_refused(tmp_path):
    """A modulus among several, a spring that pushes, a coefficient in a law of the permittivity."""
    for name, unit in (("shear_modulus_alpha_2", "Pa"), ("edge_stiffness", "N/m"), ("softening", "F/m")):
        text = _OWN.replace('"stiffness", "k", "1/s^2", "stiffness"', f'"{name}", "k", "{unit}", "{name}"')
        model = dl.load(written(tmp_path / f"{name}.py", text + f'DEFAULTS = {{"{name}": -2.0}}\n'))
        assert material_of(model, dl.SHENG_2015).values == {name: -2.0}


# --- roles ----------------------------------------------------------------------------------------


_ROLES = _OWN.replace("    meaning: str\n", "    meaning: str\n    role: str = None\n    sign: str = None\n")


def test_a_variable_that_says_its_role_is_asked_and_its_name_is_not(tmp_path):
    rows = """(Variable("k", "k", "1/s^2", "k"), Variable("eta", "η", "Pa s", "", "viscosity"),
              Variable("viscosity", "", "1", "", "exponent"))"""
    text = _ROLES.replace('(Variable("stiffness", "k", "1/s^2", "stiffness"),)', rows)
    text += 'DEFAULTS = {"k": 1.0, "eta": 2.0, "viscosity": -3.0}\n'
    model = dl.load(written(tmp_path / "own.py", text))
    assert dashpot_count(model) == 1
    assert frozen(make_problem(model, None, {}, None, 0.0, 0.0)).parameters == (1.0, np.inf, -3.0)
    with pytest.raises(ValueError, match="eta must be positive and finite, got -1 Pa s"):
        dl.simulate(model, duration=1e-4, eta=-1.0)


def test_a_variable_without_a_role_has_that_of_the_emitted_one_of_its_name(tmp_path):
    model = dl.load(write_membrane(tmp_path, "mine", branches=2))
    assert dashpot_count(model) == 2
    assert [str(role_of(entry)) for entry in model.STATE] == (
        ["stretch"] * 2 + ["constant"] * 2 + ["inelastic_stretch"] * 4
    )
    assert [str(sign_of(entry)) for entry in model.PARAMETERS][:4] == ["positive"] * 4


@pytest.mark.parametrize(("facts", "says"), [
    ('"viscocity"', r"PARAMETERS: role of stiffness must be one of stretch, .*; got 'viscocity' \(did you mean"),
    ('"stiffness", "negative"', r"sign of stiffness must be one of positive, not_negative, any; got 'negative'"),
    ("7", "role of stiffness must be one of .*; got 7"),
])  # fmt: skip
def test_a_role_or_a_sign_that_there_is_not_is_refused(tmp_path, facts, says):
    text = _ROLES.replace(
        '"stiffness", "k", "1/s^2", "stiffness"', f'"stiffness", "k", "1/s^2", "stiffness", {facts}'
    )
    with pytest.raises(ValueError, match=says):
        dl.load(written(tmp_path / "own.py", text))
