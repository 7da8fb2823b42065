"""From equations to the description of a module.

Each function below says how one function of a model module is computed from named intermediate values.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from delagrange.derive.check.verdict import Verdict
from delagrange.derive.equations.euler_lagrange import EquationsOfMotion
from delagrange.derive.kernel.electrode_functions import charge_assignments, charge_powers, electrodes
from delagrange.derive.kernel.energy_functions import dashpot_power, potential, validity
from delagrange.derive.kernel.formulas import digest, governing_equations
from delagrange.derive.kernel.function import kernel_function
from delagrange.derive.kernel.reference_state import reference_state, springs_at_rest, start_text
from delagrange.derive.kernel.spec import Assignment, KernelFunction, KernelSpec, Origin


def _entry(name: str, *indices: int, size: int) -> str:
    """`mass` for one coordinate, `mass_12` for several."""
    return name if size == 1 else f"{name}_{''.join(str(index + 1) for index in indices)}"


def _mass_assignments(eom: EquationsOfMotion) -> tuple[Assignment, ...]:
    n = eom.mass_matrix.rows
    return tuple(
        Assignment(
            _entry("mass", row, column, size=n),
            eom.mass_matrix[row, column],
            "mass matrix [kg m^2]" if row == column == 0 else "",
        )
        for row in range(n)
        for column in range(row, n)
    )


def _mass_symbols(n: int) -> sp.Matrix:
    return sp.Matrix(n, n, lambda row, column: sp.Symbol(_entry("mass", *sorted((row, column)), size=n)))


def _solved(n: int, right_side: sp.Matrix) -> sp.Matrix:
    """M^-1 times a matrix, M by name; its determinant is the intermediate `mass_determinant`."""
    mass = _mass_symbols(n)
    if n == 1:
        return right_side / mass[0, 0]
    return mass.adjugate() * right_side / sp.Symbol("mass_determinant")


def _determinant_assignment(n: int) -> tuple[Assignment, ...]:
    return () if n == 1 else (Assignment("mass_determinant", _mass_symbols(n).det()),)


def _force_assignments(eom: EquationsOfMotion) -> tuple[Assignment, ...]:
    n = eom.mass_matrix.rows
    return tuple(
        Assignment(
            _entry(term.name, row, size=n),
            term.vector[row],
            f"generalised force of {term.meaning} [J]" if row == 0 else "",
        )
        for term in eom.force_terms
        for row in range(n)
        if term.vector[row] != 0
    )


def _net_force(eom: EquationsOfMotion) -> sp.Matrix:
    n = eom.mass_matrix.rows
    return sp.Matrix(
        [
            sp.Add(*(sp.Symbol(_entry(t.name, row, size=n)) for t in eom.force_terms if t.vector[row] != 0))
            for row in range(n)
        ]
    )


def _rhs(eom: EquationsOfMotion) -> KernelFunction:
    load_case, n = eom.load_case, eom.mass_matrix.rows
    forces = tuple(Assignment(_entry("net_force", row, size=n), f) for row, f in enumerate(_net_force(eom)))
    acceleration = _solved(n, sp.Matrix([sp.Symbol(a.name) for a in forces]))
    solved = tuple(
        Assignment(
            c.acceleration.name,
            acceleration[row],
            "mass matrix times acceleration = net force" if row == 0 else "",
        )
        for row, c in enumerate(load_case.coordinates)
    )
    rates = tuple(
        Assignment(i.rate.name, rate, "flow of the dashpot [1/s]" if row == 0 else "")
        for row, (i, rate) in enumerate(zip(load_case.internals, eom.internal_rates, strict=True))
    )
    moving = [*(c.rate for c in load_case.coordinates), *(c.acceleration for c in load_case.coordinates)]
    moving += [i.rate for i in load_case.internals]
    moving += [] if eom.charge_balance is None else [eom.charge_balance.rate]
    return kernel_function(
        eom,
        "rhs",
        "Time derivative of the state.",
        "the unit of each state per second",
        (len(moving),),
        (
            *_mass_assignments(eom),
            *_determinant_assignment(n),
            *_force_assignments(eom),
            *forces,
            *solved,
            *rates,
            *charge_assignments(eom),
        ),
        [quantity.symbol for quantity in moving],
    )


def _slopes(stem: str, matrix: sp.MatrixBase, comment: str) -> tuple[tuple[Assignment, ...], sp.Matrix]:
    """A name for every entry of a matrix that is not zero, and the matrix in those names."""
    names = sp.Matrix(
        matrix.rows,
        matrix.cols,
        lambda row, column: (
            sp.Symbol(f"{stem}_{row + 1}_{column + 1}") if matrix[row, column] != 0 else sp.S.Zero
        ),
    )
    entries = [(name.name, value) for name, value in zip(names, matrix, strict=True) if value != 0]
    assignments = tuple(
        Assignment(name, value, comment if number == 0 else "")
        for number, (name, value) in enumerate(entries)
    )
    return assignments, names


def _jacobian(eom: EquationsOfMotion) -> KernelFunction:
    """Rows of the accelerations through the mass matrix by name; those of dashpots and charge as derived."""
    n, size = eom.mass_matrix.rows, len(eom.state)
    end = 2 * n + len(eom.internal_rates)
    forces, force_slopes = _slopes(
        "force_slope",
        eom.unbalanced_jacobian,
        "slope of (net force - mass matrix times acceleration), [J] per unit of the state",
    )
    dashpots, dashpot_slopes = _slopes(
        "dashpot_slope",
        eom.jacobian[2 * n : end, :],
        "slope of the dashpot rates, [1/s] per unit of the state",
    )
    charge, charge_slopes = _slopes(
        "charge_slope",
        eom.jacobian[end:, :],
        "slope of the rate of the charge density, [A/m^2] per unit of the state",
    )
    elementary = sp.Matrix(eom.jacobian[:n, :])
    rows = sp.Matrix.vstack(elementary, _solved(n, force_slopes), dashpot_slopes, charge_slopes)
    return kernel_function(
        eom,
        "jacobian",
        "Derivative of `rhs` with respect to the state; entry [i, j] is d rhs_i / d state_j.",
        "per second, times the unit of state i over that of state j",
        (size, size),
        (*_mass_assignments(eom), *_determinant_assignment(n), *forces, *dashpots, *charge),
        list(rows),
        accelerations=tuple(c.acceleration.name for c in eom.load_case.coordinates),
    )


def _input_jacobian(eom: EquationsOfMotion) -> KernelFunction:
    """Rows of the accelerations through the mass matrix by name."""
    n = eom.mass_matrix.rows
    forces, force_slopes = _slopes(
        "input_slope",
        eom.unbalanced_input_jacobian,
        "slope of (net force - mass matrix times acceleration), [J] per unit of the input",
    )
    outer = eom.input_jacobian
    rows = sp.Matrix.vstack(sp.Matrix(outer[:n, :]), _solved(n, force_slopes), sp.Matrix(outer[2 * n :, :]))
    return kernel_function(
        eom,
        "input_jacobian",
        "Derivative of `rhs` with respect to the inputs; entry [i, j] is d rhs_i / d input_j.",
        "per second, times the unit of state i over that of input j",
        outer.shape,
        (*_mass_assignments(eom), *_determinant_assignment(n), *forces),
        list(rows),
    )


def _edge_forces(eom: EquationsOfMotion) -> KernelFunction:
    names = tuple(f"edge_force_{axis}" for axis in range(1, len(eom.edge_forces) + 1))
    body = eom.membrane.body
    return kernel_function(
        eom,
        "edge_forces",
        f"Force on {body.on_edges} that balances springs and field at rest, pulling if positive.",
        ", ".join(dict.fromkeys(force.unit for force in body.forces)),
        (len(names),),
        [Assignment(name, force) for name, force in zip(names, eom.edge_forces, strict=True)],
        [sp.Symbol(name) for name in names],
    )


def _reactions(eom: EquationsOfMotion) -> tuple[KernelFunction, ...]:
    reactions = eom.load_case.reactions
    if not reactions:
        return ()
    needed = {symbol for force in eom.reaction_forces for symbol in force.free_symbols}
    moving = any(c.acceleration.symbol in needed for c in eom.load_case.coordinates)
    assignments = tuple(
        Assignment(reaction.name, force)
        for reaction, force in zip(reactions, eom.reaction_forces, strict=True)
    )
    return (
        kernel_function(
            eom,
            "reaction_forces",
            "Forces that hold the constrained axes" + ("." if moving else ", without inertia."),
            ", ".join(dict.fromkeys(reaction.unit for reaction in reactions)),
            (len(reactions),),
            assignments,
            [reaction.symbol for reaction in reactions],
            accelerations=tuple(c.acceleration.name for c in eom.load_case.coordinates) if moving else (),
        ),
    )


def _scalar(
    eom: EquationsOfMotion, name: str, summary: str, unit: str, expression: sp.Expr
) -> KernelFunction:
    return kernel_function(eom, name, summary, unit, (), (), [expression])


def _mass(eom: EquationsOfMotion) -> KernelFunction:
    shape, entries = eom.mass_matrix.shape, list(eom.mass_matrix)
    return kernel_function(
        eom, "mass_matrix", "Mass matrix of the coordinates.", "kg m^2", shape, (), entries
    )


def kernel(
    eom: EquationsOfMotion,
    verdicts: tuple[Verdict, ...] = (),
    origin: Origin | None = None,
    defaults: Mapping[str, float] | None = None,
) -> KernelSpec:
    """Describe the module of one model, with the verdicts on the printed equations it was checked against."""
    load_case, n = eom.load_case, eom.mass_matrix.rows
    formulas = governing_equations(eom)
    functions = (
        _rhs(eom),
        _jacobian(eom),
        _input_jacobian(eom),
        _mass(eom),
        _scalar(eom, "kinetic_energy", "Kinetic energy.", "J", eom.kinetic_energy),
        potential(eom),
        _scalar(eom, "force_power", "Power that the applied forces put in.", "W", eom.force_power),
        dashpot_power(eom),
        *charge_powers(eom),
        electrodes(eom),
        *_reactions(eom),
        _edge_forces(eom),
        kernel_function(
            eom,
            "principal_stretches", "Stretches along axes 1, 2 and through the thickness.", "1", (3,), (),
            eom.principal_stretches,
        ),
        *validity(eom),
    )  # fmt: skip
    return KernelSpec(
        name=load_case.name,
        title=load_case.title,
        load_case=load_case.family,
        formulation=load_case.formulation,
        remark=load_case.remark,
        coordinate_count=n,
        state=eom.state,
        inputs=load_case.inputs,
        parameters=eom.parameters,
        reactions=load_case.reactions,
        functions=functions,
        reference_state=reference_state(eom),
        formulas=formulas,
        verdicts=verdicts,
        digest=digest(formulas),
        quantities=eom.quantities,
        body=eom.membrane.body.text,
        start=start_text(eom),
        origin=origin or Origin(),
        defaults=defaults,
        springs=springs_at_rest(eom),
    )
