"""Files of models as a user may have them: written without this package's emission, with names of their own.

A square membrane pulled by a force along each axis, neo-Hookean or stiffening (Gent 1996), with any number of
Maxwell branches. Its numbers are the paper's, so that it can be compared with the built-in models.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import sympy as sp

_HEAD = '''"""A membrane of a user."""
from typing import NamedTuple
import numpy as np


class Variable(NamedTuple):
    name: str
    symbol: str
    unit: str
    meaning: str


def _stacked(shape, *entries):
    return np.array(np.broadcast_arrays(*entries)).reshape((*shape, *np.broadcast_shapes(*map(np.shape, entries))))


REACTIONS = ()
MODEL, FORMULATION, LOAD_CASE = "{name}", "by_hand", "biaxial"
COORDINATE_COUNT = 2
'''


def write_membrane(
    folder: Path, name: str, branches: int = 2, gent: bool = False, defaults: bool = True
) -> Path:
    """The file of a membrane in a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.py"
    path.write_text(_text(name, branches, gent, defaults), encoding="utf-8")
    return path


@cache
def _text(name: str, branches: int, gent: bool, defaults: bool) -> str:
    lambdas, rates, forces = (sp.symbols(names) for names in ("stretch_1:3", "stretch_rate_1:3", "force_1:3"))
    field, length, thickness, density, permittivity, alpha, locking = sp.symbols(
        "nominal_electric_field half_length half_thickness density permittivity modulus_alpha locking_alpha"
    )
    betas, etas = sp.symbols(f"modulus_beta_1:{branches + 1}"), sp.symbols(f"viscosity_1:{branches + 1}")
    inner = [sp.symbols(f"inelastic_stretch_{k}_1:3") for k in range(1, branches + 1)]
    state = (*lambdas, *rates, *(entry for pair in inner for entry in pair))
    inputs = (*forces, field)
    parameters = (
        length,
        thickness,
        density,
        permittivity,
        alpha,
        *betas,
        *etas,
        *((locking,) if gent else ()),
    )
    volume, third = 8 * thickness * length**2, 1 / (lambdas[0] * lambdas[1])

    def elastic(modulus, ones):
        return modulus / 2 * (sum(one**2 for one in ones) + 1 / (ones[0] * ones[1]) ** 2 - 3)

    equilibrium = elastic(alpha, lambdas)
    room = locking - 2 * equilibrium / alpha
    if gent:
        equilibrium = -alpha * locking / 2 * sp.log(1 - 2 * equilibrium / alpha / locking)
    overstress = sum(
        elastic(beta, [a / b for a, b in zip(lambdas, pair)]) for beta, pair in zip(betas, inner)
    )
    internal = volume * (
        equilibrium + overstress - permittivity * field**2 * (lambdas[0] * lambdas[1]) ** 2 / 2
    )
    potential = internal - 2 * length * sum(force * one for force, one in zip(forces, lambdas))
    third_rate = sum(sp.diff(third, one) * rate for one, rate in zip(lambdas, rates))
    speeds = length**2 * sum(rate**2 for rate in rates) + thickness**2 * third_rate**2
    kinetic = sp.Rational(4, 3) * density * thickness * length**2 * speeds
    mass = sp.hessian(kinetic, rates)
    momentum_change = sp.Matrix(
        [sum(sp.diff(kinetic, r, one) * v for one, v in zip(lambdas, rates)) for r in rates]
    )
    net = sp.Matrix([sp.diff(kinetic - potential, one) for one in lambdas]) - momentum_change
    flows = []
    for beta, eta, pair in zip(betas, etas, inner):
        stress = [beta * (a / b) ** 2 for a, b in zip(lambdas, pair)]
        stress.append(beta * (third * pair[0] * pair[1]) ** 2)
        flows += [one / (6 * eta) * (3 * s - sum(stress)) for one, s in zip(pair, stress)]
    motion = sp.Matrix([*rates, *(mass.inv() * net), *flows])
    dashpot = -sum(sp.diff(internal, one) * flow for one, flow in zip(state[4:], flows))
    functions = {
        "rhs": ((len(state),), motion),
        "jacobian": ((len(state),) * 2, motion.jacobian(state)),
        "input_jacobian": ((len(state), 3), motion.jacobian(inputs)),
        "mass_matrix": ((2, 2), mass),
        "kinetic_energy": ((), [kinetic]),
        "potential_energy": ((), [potential]),
        "force_power": ((), [2 * length * sum(f * v for f, v in zip(forces, rates))]),
        "dashpot_power": ((), [dashpot]),
        "principal_stretches": ((3,), [*lambdas, third]),
        "edge_forces": ((2,), [sp.diff(internal, one) / (2 * length) for one in lambdas]),
    }
    if gent:
        functions["validity"] = (), [room]
    units = {"half_length": "m", "half_thickness": "m", "density": "kg/m^3", "permittivity": "F/m"}
    units |= {entry.name: "Pa" for entry in (alpha, *betas)} | {entry.name: "Pa s" for entry in etas}
    units |= (
        {entry.name: "1/s" for entry in rates} | {entry.name: "N" for entry in forces} | {field.name: "V/m"}
    )
    lines = [_HEAD.format(name=name)]
    for title, entries in (("STATE", state), ("INPUTS", inputs), ("PARAMETERS", parameters)):
        rows = "".join(_row(entry.name, units) for entry in entries)
        lines.append(f"{title} = (\n{rows})\n")
    lines += [
        _function(called, shape, entries, (state, inputs, parameters))
        for called, (shape, entries) in functions.items()
    ]
    start = ", ".join(["1.0, 1.0, 0.0, 0.0", *["1.0"] * (2 * branches)])
    lines.append(f"def reference_state(parameters):\n    return np.array([{start}])\n")
    if defaults:
        lines.append(f"DEFAULTS = {_defaults(branches, gent)}\n")
    return "\n\n".join(lines)


def _row(name: str, units: dict[str, str]) -> str:
    return f"    Variable({name!r}, {name!r}, {units.get(name, '1')!r}, {name.replace('_', ' ')!r}),\n"


def _function(called: str, shape: tuple, entries, arguments: tuple) -> str:
    shared, results = sp.cse(list(entries))
    lines = [f"def {called}(state, inputs, parameters):"]
    for of, symbols in zip(("state", "inputs", "parameters"), arguments):
        lines.append(f"    {', '.join(symbol.name for symbol in symbols)} = {of}")
    code = [f"    {symbol} = {sp.pycode(value)}" for symbol, value in shared]
    returned = ", ".join(sp.pycode(value) for value in results)
    lines += [*code, f"    return _stacked({shape}, {returned})"]
    return "\n".join(lines).replace("math.", "np.")


def _defaults(branches: int, gent: bool) -> dict[str, float]:
    """The paper's numbers, spring β and its viscosity shared out to the branches evenly."""
    values = {"half_length": 5e-3, "half_thickness": 1e-3, "density": 1.2e3, "permittivity": 6.198e-11}
    values |= {"modulus_alpha": 1.8e4}
    values |= {f"modulus_beta_{k}": 4.2e4 / branches for k in range(1, branches + 1)}
    values |= {f"viscosity_{k}": 400.0 * 4.2e4 / branches for k in range(1, branches + 1)}
    return values | ({"locking_alpha": 5.0} if gent else {})
