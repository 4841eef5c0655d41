"""Closed forms of lumped systems: the reference files hold what the formulas give for the cases as they stand."""

from pathlib import Path

import numpy as np
import pytest

from pipeline.contract.documents import read_yaml
from pipeline.contract.settings import fill
from pipeline.contract.units import to_si
from pipeline.physics.closed_form import stick_slip, two_mode_flutter, wobbling_disc
from pipeline.products import ComplexModes, Transient
from pipeline.validation.lumped import lumped_rows
from pipeline.validation.published_facts import load
from stages.complex_modes import Settings as Modes
from stages.lumped import Settings, lumped
from tests.views.products_for_views import filled

ROOT = Path(__file__).parents[2]


def case(name):
    """(Lumped, settings of complex_modes, of transient, facts by key) of a case of the project."""
    document = read_yaml(ROOT / "configs" / f"{name}.yaml")
    mass = next(iter(document["lumped"]["masses"].values()))
    mass["mass"] = mass["mass"]["value"] if isinstance(mass.get("mass"), dict) else mass.get("mass", "0 kg")
    facts = {fact.key: fact for fact in load(ROOT / "data" / "reference" / f"{name}.yaml")}
    modes = fill(Modes, document["complex_modes"], name)
    return lumped(settings=fill(Settings, document["lumped"], name)), modes, document["transient"], facts


def told(facts, **values):
    """Every fact stands in the file with six digits or more, and nothing else does."""
    assert set(facts) == set(values)
    for key, value in values.items():
        assert facts[key].role == "closed_form"
        assert facts[key].value == pytest.approx(value, rel=1e-6, abs=1e-9), key


@pytest.mark.exact
def test_belt():
    found, _, motion, facts = case("belt")
    mass, stiffness, force = found.mass[0, 0], found.joint_stiffness[0], found.preload[0, 0]
    speed, mu = to_si(motion["speeds"][0], "rad/s", "") * found.contact_lever[0], motion["friction"]
    given = stiffness, force, mu * motion["static_factor"], mu, speed
    period = stick_slip.period(mass, *given)
    told(facts, cycle_period=period, cycle_displacement=1e3 * stick_slip.amplitude(mass, *given),
         backward_speed=1e3 * stick_slip.backward_speed(mass, *given),
         stick_share=stick_slip.stick_time(*given) / period, frequency_1=np.sqrt(stiffness / mass) / (2 * np.pi))


@pytest.mark.exact
def test_two_mode_flutter():
    found, modes, _, facts = case("two_mode_flutter")
    contact = found.contact_stiffness[0, 0]
    stiffness = (found.joint_rows.T * found.joint_stiffness) @ found.joint_rows + np.diag([0.0, contact])
    given = stiffness[0, 0], stiffness[1, 1], -stiffness[0, 1], contact
    damping = found.joint_damping[0]
    growth = two_mode_flutter.growth_rate(*given, modes.friction, damping)
    still = np.sort(abs(two_mode_flutter.roots_over_friction(*given, 0.0)))[::2] / (2 * np.pi)
    told(facts, frequency_1=still[0], frequency_2=still[1], growth_rate=growth, operating_growth=growth,
         onset_friction=two_mode_flutter.onset_friction(*given, damping), amplitude_over_load=1.0,
         onset_frequency=np.sqrt((given[0] + given[1]) / 2) / (2 * np.pi))


@pytest.mark.exact
def test_wobbling_disc():
    found, modes, _, facts = case("wobbling_disc")
    radius, half = abs(found.contact_normal).max(), abs(found.contact_tangent).max()
    given = (found.mass[0, 0], abs(found.gyroscopic).max(), found.joint_stiffness[0], found.joint_damping[0],
             found.contact_stiffness[0, 0], radius, 2 * half, modes.speeds[0])
    inertia, hinge, pad = given[0], given[2], given[4]
    told(facts, frequency_1=np.sqrt(hinge / inertia) / (2 * np.pi),
         frequency_2=np.sqrt((hinge + 2 * pad * radius**2) / inertia) / (2 * np.pi),
         onset_friction=wobbling_disc.onset_friction(*given), onset_frequency=wobbling_disc.onset_frequency(*given),
         operating_growth=np.roots(wobbling_disc.polynomial(*given, modes.friction)).real.max())


@pytest.mark.exact
def test_flutter_with_damping_begins_where_growth_is_zero():
    given = 1.1e6, 1.2e6, 1e5, 4e5
    onset = two_mode_flutter.onset_friction(*given, 40.0)
    assert onset > two_mode_flutter.onset_friction(*given)
    below, at, above = (two_mode_flutter.growth_rate(*given, share * onset, 40.0) for share in (0.99, 1.0, 1.01))
    assert below < 0 < above and at == pytest.approx(0.0, abs=1e-6)


@pytest.mark.exact
def test_the_wobbling_disc_has_imaginary_roots_at_its_onset():
    given = 0.16, 0.32, 1.88e7, 0.1, 6e6, 0.13, 0.02, 100.0
    roots = np.roots(wobbling_disc.polynomial(*given, wobbling_disc.onset_friction(*given)))
    leading = roots[roots.real.argmax()]
    assert abs(leading.real) < 1e-6 and abs(leading.imag) == pytest.approx(
        2 * np.pi * wobbling_disc.onset_frequency(*given))


def test_numbers_are_read_from_the_products():
    """A sweep that grows from 0.3 on, a settled sine of 2 Hz and 3 mm that sticks a quarter of the time."""
    friction, time = np.linspace(0, 0.5, 6), np.linspace(0, 5, 50001)
    root = np.where(friction > 0.25, 1.0, -1.0)[None, :, None] + 100j
    modes = filled(ComplexModes, friction=friction, root=root, operating_root=[[2.0 + 100j]], real_frequency=[[16.0]])
    place = 3e-3 * np.sin(4 * np.pi * time)[None, None]
    motion = filled(Transient, time=time, window=4.0, displacement=place, settled=[[1]], grew=[[0]], pressure=[1.0],
                    velocity=np.gradient(place[0, 0], time)[None, None], cycle_amplitude=[[0.01]],
                    status=np.where((2 * time) % 1 < 0.25, 1, 2)[None, None])
    rows = lumped_rows({"complex_modes": modes, "transient": motion}, (), {})
    expected = {"onset_friction": 0.25, "onset_frequency": 100 / 2 / np.pi, "operating_growth": 2.0,
                "frequency_1": 16.0, "cycle_period": 0.5, "cycle_displacement": 3e-3,
                "backward_speed": 3e-3 * 4 * np.pi, "stick_share": 0.25}
    for key, value in expected.items():
        assert rows[key].value == pytest.approx(value, rel=1e-3), key
    assert rows["growth_rate"].value is None and rows["amplitude_over_load"].value is None
    restless = lumped_rows({"transient": filled(Transient, time=time, window=4.0, displacement=place)}, (), {})
    assert restless["cycle_period"].value is None and "not settled" in restless["cycle_period"].note
