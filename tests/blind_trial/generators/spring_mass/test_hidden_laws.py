"""Hidden physics: forces that take energy out, that the catalogue has or lacks, apart from what solves the trial."""

import subprocess
import sys

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN, Spot
from pipeline.blind_trial.generators.spring_mass.motion import World
from pipeline.blind_trial.generators.spring_mass.placement import places
from pipeline.blind_trial.generators.spring_mass.rig import drawn
from pipeline.effects import CATALOGUE

RIG = drawn(np.random.default_rng(2), 3)
#: forces in proportion to their size; sliders, play and an arm vanish in other ways
SIZED = [name for name, piece in HIDDEN.items() if piece.place in ("link", "shaker")
         and name not in ("hysteretic_joint", "backlash", "compliant_arm")]
FORBIDDEN = ("pipeline.effects", "pipeline.physics", "pipeline.diagnosis", "pipeline.inference", "pipeline.case_models")


def law_of(name, size):
    spot = Spot(RIG, 1, 0.01, 0.2, 3.0, 5.0, (0.3, 0.6, 0.9))
    return HIDDEN[name].build(spot, size).laws[0]


def work(law, seconds=20.0, interval=1e-4):
    """Energy in J that a law takes out of e = 0.012 sin 20 t, states by Euler steps."""
    time = np.arange(0, seconds, interval)
    e, v, z, total = 0.012 * np.sin(20 * time), 0.24 * np.cos(20 * time), np.zeros(law.states), 0.0
    for t, place, speed in zip(time, e, v, strict=True):
        total += law.force(t, place, speed, z) * speed * interval
        if law.states:
            z = z + interval * law.rates(t, place, speed, z)
    return total


@pytest.mark.parametrize("name", ["coulomb", "asymmetric_friction", "joint_damping", "quadratic_damping", "film_drag",
                                  "hysteretic_joint", "viscoelastic_pad", "shim_damping", "fractional_damping",
                                  "rough_friction", "dithered_friction", "dwell_friction", "hydraulic_compliance"])
def test_what_resists_takes_energy_out(name):
    assert work(law_of(name, 0.5), seconds=3.0) > 0


@pytest.mark.exact
def test_coulomb_takes_four_times_force_and_amplitude_a_cycle():
    cycles = 20 * 2.0 * np.pi / (2 * np.pi)
    assert work(law_of("coulomb", 0.5), 2.0 * np.pi) == pytest.approx(cycles * 4 * 1.5 * 0.012, rel=5e-3)


@pytest.mark.parametrize("name", SIZED)
def test_a_law_grows_from_nothing(name):
    for place, speed in ((0.01, 0.2), (-0.005, 0.1)):
        args = (1.3, place, speed, np.full(law_of(name, 1.0).states, 0.0))
        assert abs(law_of(name, 1e-6).force(*args)) <= 1e-5 * max(abs(law_of(name, 1.0).force(*args)), 1e-9)


def test_at_least_eight_pieces_are_not_in_the_catalogue_and_the_others_are():
    catalogue = {e.name for e in CATALOGUE}
    assert {n for n, p in HIDDEN.items() if p.known} <= catalogue
    foreign = {n for n, p in HIDDEN.items() if not p.known}
    assert len(foreign) >= 8 and not foreign & catalogue


def test_places_are_those_of_the_rig():
    assert places(HIDDEN["coulomb"], 2) == [(0, "link_0"), (1, "link_1")]
    assert places(HIDDEN["moving_base"], 3) == [(0, "link_0"), (3, "link_3")]
    assert places(HIDDEN["pressure_ripple"], 2) == [(0, "shaker")]


def test_nothing_that_solves_a_trial_is_loaded_by_what_makes_it():
    code = ("import sys, pipeline.blind_trial.generators.case_files; "
            f"print([m for m in sys.modules if m.startswith({FORBIDDEN!r})])")
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"


def test_a_mass_and_a_wall_change_the_rig_alone():
    spot = Spot(RIG, 0, 0.01, 0.2, 3.0, 5.0, (0.3, 0.6, 0.9))
    carried, base = HIDDEN["attached_mass"].build(spot, 0.2), HIDDEN["moving_base"].build(spot, 0.1)
    assert carried.rig.mass[0] == pytest.approx(1.2 * RIG.mass[0]) and not carried.laws
    assert isinstance(base, World) and len(base.rig.mass) == 4 and base.rig.links[0].far == 3
