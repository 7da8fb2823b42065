"""A membrane that stiffens (Gent 1996), equal-biaxial, written by hand with the interface of a generated module."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from delagrange.generated import equal_biaxial

STIFFENING = 100.0  # J_m


def gent_membrane() -> ModuleType:
    module = ModuleType("gent_membrane")
    module.MODEL, module.FORMULATION, module.COORDINATE_COUNT = "gent_membrane", "by_hand", 1
    module.STATE, module.INPUTS = equal_biaxial.STATE[:2], equal_biaxial.INPUTS
    module.PARAMETERS = equal_biaxial.PARAMETERS[:5]
    module.rhs, module.jacobian, module.input_jacobian = _rhs, _jacobian, _input_jacobian
    module.mass_matrix, module.edge_forces = _mass_matrix, _edge_forces
    module.potential_energy = _potential_energy
    module.principal_stretches = lambda state, inputs, parameters: np.array(
        [state[0], state[0], 1 / np.asarray(state[0]) ** 2]
    )
    module.reference_state = lambda parameters: np.array([1.0, 0.0])
    return module


def _room(stretch):
    room = 1 - (2 * stretch**2 + stretch**-4.0 - 3) / STIFFENING
    return np.where(room > 0, room, np.nan)


def _mass(parameters):
    half_length, half_thickness, density, _, _ = parameters
    return 16 * half_thickness * half_length**4 * density / 3


def _stress(stretch, inputs, parameters):
    """Generalised force of the springs and the field [J], per volume and factor 2."""
    _, field = inputs
    _, _, _, permittivity, modulus = parameters
    return modulus * (stretch - stretch**-5.0) / _room(stretch) - permittivity * field**2 * stretch**3


def _rhs(state, inputs, parameters):
    half_length, half_thickness = parameters[:2]
    stretch = np.asarray(state[0], dtype=float)
    volume = 8 * half_thickness * half_length**2
    total = 4 * inputs[0] * half_length - 2 * volume * _stress(stretch, inputs, parameters)
    return np.array(np.broadcast_arrays(state[1], total / _mass(parameters)))


def _jacobian(state, inputs, parameters):
    half_length, half_thickness, _, permittivity, modulus = parameters
    stretch = np.asarray(state[0], dtype=float)
    room, volume = _room(stretch), 8 * half_thickness * half_length**2
    slope = modulus * (1 + 5 * stretch**-6.0) / room
    slope = slope + modulus * (stretch - stretch**-5.0) ** 2 * 4 / STIFFENING / room**2
    slope = slope - 3 * permittivity * inputs[1] ** 2 * stretch**2
    zero = np.zeros_like(slope)
    return np.array([[zero, zero + 1], [-2 * volume * slope / _mass(parameters), zero]])


def _input_jacobian(state, inputs, parameters):
    half_length, half_thickness, _, permittivity, _ = parameters
    volume, mass = 8 * half_thickness * half_length**2, _mass(parameters)
    by_field = 4 * volume * permittivity * inputs[1] * state[0] ** 3 / mass
    return np.array([[0.0, 0.0], [4 * half_length / mass, by_field]])


def _mass_matrix(state, inputs, parameters):
    return np.array([[_mass(parameters)]])


def _edge_forces(state, inputs, parameters):
    force = 4 * parameters[0] * parameters[1] * _stress(state[0], inputs, parameters)
    return np.array([force, force])


def _potential_energy(state, inputs, parameters):
    half_length, half_thickness, _, permittivity, modulus = parameters
    stretch, volume = state[0], 8 * half_thickness * half_length**2
    elastic = -modulus * STIFFENING / 2 * np.log(_room(stretch))
    electric = -permittivity * inputs[1] ** 2 * stretch**4 / 2
    return (elastic + electric) * volume - 4 * half_length * inputs[0] * stretch
