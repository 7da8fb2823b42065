"""Each worked example against the same physics typed here by hand: closed forms, and stresses with root finding."""

from __future__ import annotations

import sys
from functools import partial
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import delagrange as dl

EXAMPLES = Path(__file__).parents[1] / "examples"
QUESTIONS = {  # the function that answers it, and the fixture that has the answer
    "gent_snap_through": ("snap_through", "snapped"),
    "charge_control": ("both_controls", "both"),
    "vhb_two_branches": ("pull_in_over_rate", "vhb"),
    "attached_mass": ("frequencies", "loaded"),
}
NAMES = tuple(QUESTIONS)


@pytest.fixture(scope="module")
def example():
    """`example("attached_mass")` -> the script as a module; its folder is on the path meanwhile, as when it is run."""
    sys.path.insert(0, str(EXAMPLES))
    yield import_module
    sys.path.remove(str(EXAMPLES))


# --- A Gent membrane under a dead load ------------------------------------------------------------


SIDE, THICKNESS, MODULUS, LOCKING, PERMITTIVITY = 20e-3, 1e-3, 20e3, 70.0, 40e-12  # of gent_snap_through.toml


def gent_field_squared(stretch: float, force: float) -> float:
    """E^2 of the balance of nominal stresses, force / section = elastic - epsilon E^2 stretch^3."""
    room = 1 - (2 * stretch**2 + stretch**-4 - 3) / LOCKING
    elastic = MODULUS * (stretch - stretch**-5) / room
    return (elastic - force / (SIDE * THICKNESS)) / (PERMITTIVITY * stretch**3)


def slope(function, at: float, *others: float) -> float:
    return (function(at * (1 + 1e-6), *others) - function(at * (1 - 1e-6), *others)) / (2e-6 * at)


@pytest.fixture(scope="module")
def snapped(example, tmp_path_factory):
    return example("gent_snap_through").snap_through(tmp_path_factory.mktemp("gent"))


def test_the_gent_membrane_snaps_where_its_curve_turns(snapped):
    limit = brentq(lambda stretch: slope(gent_field_squared, stretch, 0.5), 1.6, 3.0)
    highest = gent_field_squared(limit, 0.5)
    after = brentq(lambda stretch: gent_field_squared(stretch, 0.5) - highest, 4.0, 5.8)
    assert float(snapped["snap_field"]) == pytest.approx(np.sqrt(highest), rel=1e-9)
    assert float(snapped["stretch_before"]) == pytest.approx(limit, rel=1e-6)
    assert float(snapped["stretch_after"]) == pytest.approx(after, rel=1e-8)


def test_the_gent_membrane_is_stable_on_both_sides_of_the_jump(snapped):
    stable = snapped["curve_stability"] == "stable"
    rising = np.array([slope(gent_field_squared, one, 0.5) for one in snapped["curve_stretch"].values]) > 0
    clear = np.all(
        np.abs(snapped["curve_stretch"].values - snapped["limit_stretch"].values[:, None]) > 1e-3, 0
    )
    np.testing.assert_array_equal(stable[clear], rising[clear])
    assert list(snapped["limit_kind"].values) == ["snap-through", "snap-back"]


# --- The same membrane under voltage and under charge -----------------------------------------------


@pytest.fixture(scope="module")
def both(example, tmp_path_factory):
    return example("charge_control").both_controls(tmp_path_factory.mktemp("charge"))


def test_charge_control_has_no_pull_in(both):
    """mu (lambda - lambda^-5) = D^2 / (epsilon lambda^5): lambda^6 = 1 + D^2 / (epsilon mu), whatever the charge."""
    charge = both["nominal_charge_density"].values
    expected = (1 + charge**2 / (40e-12 * 30e3)) ** (1 / 6)
    np.testing.assert_allclose(both["stretch"], expected, rtol=1e-9)
    np.testing.assert_allclose(both["field"], charge / (40e-12 * expected**4), rtol=1e-8)
    assert set(both["stability"].values) == {"stable"}
    assert "no limit point" in both["pull_in_of_charge"].item()


def test_voltage_control_pulls_in_at_the_known_stretch(both):
    """An ideal neo-Hookean dielectric: epsilon E^2 = mu (lambda^-2 - lambda^-8), largest at 2^(1/3)."""
    limit = 2 ** (1 / 3)
    field = np.sqrt(30e3 / 40e-12 * (limit**-2 - limit**-8))
    assert float(both["pull_in_stretch"]) == pytest.approx(limit, rel=1e-6)
    assert float(both["pull_in_field"]) == pytest.approx(field, rel=1e-10)
    assert float(both["stretch"].max()) > 1.7 * limit


# --- VHB 4910 with two branches --------------------------------------------------------------------


CHAINS, LONGEST = 15.36e3, 5.99  # modulus [Pa] and locking stretch of the equilibrium spring
BRANCHES = ((26.06e3, 0.6074), (26.53e3, 6.56))  # modulus [Pa], relaxation time [s]
SIZE = {"L": 5e-3, "H": 0.5e-3, "density": 1000.0, "permittivity": 4.8 * 8.85e-12, "dashpot": 10.0}


def eight_chains(stretch: float) -> float:
    """Half the slope of the energy by the stretch [Pa]: five terms of Arruda & Boyce (1993)."""
    invariant, links = 2 * stretch**2 + stretch**-4, LONGEST**2
    coefficients = (1 / 2, 1 / 20, 11 / 1050, 19 / 7000, 519 / 673750)
    by_invariant = sum(n * c * (invariant / links) ** (n - 1) for n, c in enumerate(coefficients, 1))
    return 2 * CHAINS * by_invariant * (stretch - stretch**-5)


def vhb_field_squared(stretch: float, branches: float) -> float:
    """E^2 of the balance, 0 = elastic - epsilon E^2 stretch^3, with `branches` of the branches frozen (0 or 1)."""
    frozen = branches * sum(modulus for modulus, _ in BRANCHES) * (stretch - stretch**-5)
    return (eight_chains(stretch) + frozen) / (SIZE["permittivity"] * stretch**3)


def vhb_limit(branches: float) -> float:
    """Nominal field [V/m] at the limit point."""
    limit = brentq(lambda stretch: slope(vhb_field_squared, stretch, branches), 1.1, 1.5)
    return np.sqrt(vhb_field_squared(limit, branches))


def vhb_motion(time: float, state: np.ndarray, rate: float) -> np.ndarray:
    """The motion under E = rate t, energies per volume of the body.

    Kinetic: places X, Y, Z move to lambda X, lambda Y, Z/lambda^2, and the mean of X^2 is L^2/3. The dashpot beside
    the springs carries 2 eta d along each axis, with d = lambda'/lambda twice and -2 lambda'/lambda.
    """
    stretch, speed, *inner = state
    inertia = 2 * SIZE["density"] / 3 * (SIZE["L"] ** 2 + 2 * SIZE["H"] ** 2 * stretch**-6)
    inertia_slope = -8 * SIZE["density"] * SIZE["H"] ** 2 * stretch**-7
    resisting, flows = 2 * eight_chains(stretch) + 12 * SIZE["dashpot"] * speed / stretch**2, []
    for (modulus, relaxation_time), one in zip(BRANCHES, inner, strict=True):
        elastic = stretch / one
        resisting += 2 * modulus * (elastic - elastic**-5) / one
        flows.append(one * (elastic**2 - elastic**-4) / (6 * relaxation_time))
    driving = 2 * SIZE["permittivity"] * (rate * time) ** 2 * stretch**3
    return np.array([speed, (driving - resisting - inertia_slope * speed**2 / 2) / inertia, *flows])


@pytest.fixture(scope="module")
def vhb_folder(tmp_path_factory):
    return tmp_path_factory.mktemp("vhb")


@pytest.fixture(scope="module")
def vhb(example, vhb_folder):
    return example("vhb_two_branches").pull_in_over_rate(vhb_folder)


@pytest.fixture(scope="module")
def ramp(example, vhb, vhb_folder):
    """`ramp(rate, highest, **changes)` -> field at pull-in, of the model that is derived already."""
    return partial(example("vhb_two_branches").pull_in_of_ramp, dl.load(vhb_folder))


def test_the_limits_of_vhb_are_those_of_statics(vhb):
    assert float(vhb["relaxed_limit"]) == pytest.approx(vhb_limit(0.0), rel=1e-9)
    assert float(vhb["frozen_limit"]) == pytest.approx(vhb_limit(1.0), rel=1e-9)


def test_pull_in_of_vhb_grows_with_the_rate_between_its_limits(vhb):
    field, rate, upper = vhb["field"].values, vhb["rate"].values, float(vhb["frozen_limit"])
    assert np.all(np.diff(rate) > 0) and np.all(np.diff(field) > 0)
    assert 1.0 < field[0] / float(vhb["relaxed_limit"]) < 1.01
    assert np.all(field[upper / rate > 1.0] < upper)  # ramps of more than a second


def test_one_ramp_of_vhb_is_that_of_the_motion_by_hand(ramp):
    rate = 2e6

    def thin(time, state, rate):
        return state[0] - np.sqrt(10.0)  # the thickness is a tenth

    thin.terminal = True
    run = solve_ivp(
        vhb_motion, (0, 20), [1.0, 0.0, 1.0, 1.0], "LSODA", args=(rate,), events=thin, rtol=1e-8, atol=1e-10
    )
    assert ramp(rate, 40e6) == pytest.approx(rate * run.t_events[0][0], rel=1e-6)


def test_ramps_fast_against_relaxation_alone_tend_to_the_frozen_limit(ramp):
    """With dashpots that hardly flow: from above, since inertia delays, and the less the slower the ramp."""
    limit = vhb_limit(1.0)
    stiff = {f"viscosity_{number}": 1e12 for number in (1, 2)}  # [Pa s]
    excess = [ramp(limit / time, 2 * limit, **stiff) / limit - 1 for time in (1.0, 10.0)]
    assert 0 < excess[1] < 0.3 * excess[0] < 0.01


# --- A mass on each edge ---------------------------------------------------------------------------


@pytest.fixture(scope="module")
def loaded(example, tmp_path_factory):
    return example("attached_mass").frequencies(tmp_path_factory.mktemp("mass"))


def mass_on_a_spring(mass: np.ndarray | float, force: float = 0.0) -> np.ndarray | float:
    """sqrt(k/M)/(2 pi) [Hz] about the equilibrium under a force on each edge.

    k = V W''(lambda), W = mu/2 (2 lambda^2 + lambda^-4 - 3), V = 8 H L^2; M = 2 rho V (L^2 + 2 H^2 lambda^-6)/3 of the
    membrane and L^2 m of each of four edges, which move by L (lambda - 1). The force does work on four edges.
    """
    modulus, density, half, thin = 60e3, 1100.0, 20e-3, 0.25e-3
    volume = 8 * thin * half**2
    stretch = brentq(lambda one: 2 * volume * modulus * (one - one**-5) - 4 * half * force, 1.0, 4.0)
    stiffness = volume * modulus * (2 + 10 * stretch**-6)
    inertia = 2 * density * volume * (half**2 + 2 * thin**2 * stretch**-6) / 3 + 4 * mass * half**2
    return np.sqrt(stiffness / inertia) / (2 * np.pi)


def test_a_mass_on_the_edges_lowers_the_frequency_as_a_mass_on_a_spring(loaded):
    for force in loaded["force"].values:
        of_load = loaded.sel(force=force)
        expected = mass_on_a_spring(of_load["edge_mass"].values, force)
        np.testing.assert_allclose(of_load["frequency"], expected, rtol=1e-9)
        np.testing.assert_allclose(of_load["bare_frequency"], mass_on_a_spring(0.0, force), rtol=1e-7)
    assert loaded["frequency"].units == "Hz"


# --- All of them -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_it_runs_as_a_script_and_draws(example, request, name, monkeypatch, tmp_path, capsys):
    """With what the fixture found, so as not to compute it twice."""
    script, (question, fixture) = example(name), QUESTIONS[name]
    found = request.getfixturevalue(fixture)
    monkeypatch.setattr(script, question, lambda folder: found)
    monkeypatch.setattr(sys, "argv", [f"{name}.py", "--out", str(tmp_path / "new")])
    script.main()
    said = capsys.readouterr().out
    assert "MV/m" in said or "Hz" in said
    assert (tmp_path / "new" / f"{name}.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", NAMES)
def test_its_picture_is_kept_and_small(name):
    assert 10e3 < (EXAMPLES / "shown" / f"{name}.png").stat().st_size < 120e3
