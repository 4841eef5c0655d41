"""Stage sensitivities on the brake of a few elements, and on the quick case."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity.matrices import Case, polished_root, system_of, without_surface
from pipeline.case_models.sensitivity.parameters import parameters
from pipeline.contract import store
from pipeline.products import FrictionMap, ReducedModel, Structure
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.probability import Settings as Draws
from stages.probability import probability
from stages.sensitivities import Settings, sensitivities
from tests.case_models.sensitivity.curved_brake import curved_brake
from tests.commands import ROOT, brakechain
from tests.diagnosis.small_rig import effects
from tests.stages.two_processes import TwoProcesses

SOURCES = ({"kind": "joint_stiffness", "variation": 0.3}, {"kind": "friction", "variation": 0.05},
           {"kind": "damping_speed", "range": (0.5, 1.5), "distribution": "uniform"})


@pytest.fixture(scope="module")
def brake():
    structure, model, law, modes = curved_brake(2001, 401)
    drawn = probability(model, law, modes, settings=Draws(draws=1, checked=0, sources=SOURCES))
    return model, law, modes, structure, drawn


@pytest.fixture(scope="module")
def made(brake):
    return sensitivities(*brake, varied={}, settings=Settings(modes=2))


def column(product, name):
    return list(map(str, product.parameter)).index(name)


def test_the_modes_are_the_strongest_of_each_frequency(brake, made):
    modes = brake[2]
    first = np.flatnonzero(modes.unstable_first == np.arange(len(modes.unstable_first)))
    np.testing.assert_array_equal(made.mode, first[:2])
    np.testing.assert_allclose(made.root, modes.unstable_reduced[first[:2]], rtol=1e-8)
    np.testing.assert_array_equal(made.mode_root, modes.unstable_root[first[:2]])
    where = modes.unstable_operating[first[:2]]
    np.testing.assert_array_equal(made.pressure, modes.operating_pressure[where])
    np.testing.assert_array_equal(made.friction, modes.operating_friction[where])


def test_ranks_follow_what_one_standard_deviation_changes(made):
    np.testing.assert_allclose(made.change, made.derivative.real * made.scatter)
    for k in range(2):
        order = np.argsort(made.rank[k])
        assert (np.diff(abs(made.change[k][order])) <= 0).all()
        np.testing.assert_array_equal(np.sort(made.rank[k]), np.arange(1, len(made.parameter) + 1))
    assert (made.known == 1).all() and set(map(str, made.method)) == {"analytic"}


def test_the_scatter_is_the_declared_one_where_there_is_one(made):
    abutment, friction, speed, density = (column(made, name) for name in (
        "structure.joints.abutment_stiffness", "friction", "complex_modes.damping_speed", "structure.disc.density"))
    assert made.scatter[0, abutment] == pytest.approx(np.sqrt(np.log1p(0.09)) * made.value[0, abutment])
    assert made.scatter[0, friction] == pytest.approx(0.05)
    assert made.scatter[0, speed] == pytest.approx(made.value[0, speed] / np.sqrt(12))
    assert made.scatter[0, density] == pytest.approx(0.05 * 7200)
    assert [int(made.declared[k]) for k in (abutment, friction, speed, density)] == [1, 1, 1, 0]


def test_derivatives_are_those_of_the_growth_rate_that_complex_modes_compute(brake, made):
    """Of the disc's loss factor, by the stage before: with 0.001 in the model, within 1 %."""
    model, law, modes, structure, _ = brake
    disc = np.ix_(*(np.flatnonzero(model.coordinate_body == list(model.body_name).index("disc")),) * 2)
    loss = model.loss.copy()
    loss[disc] += 1e-3 * model.stiffness[disc]
    settings = Modes(friction_steps=2, speeds=("8 rad/s", "12 rad/s"), frequency_max="8 kHz", followed=0)
    damped = complex_modes(replace(model, loss=loss), law, settings=settings)
    k = int(made.mode[1])
    there = damped.unstable_reduced[damped.unstable_operating == modes.unstable_operating[k]]
    change = (there[np.argmin(abs(there - made.root[1]))] - made.root[1]) / 1e-3
    assert made.derivative[1, column(made, "structure.disc.loss_factor")] == pytest.approx(change, rel=0.01)


def test_values_that_make_the_strongest_mode_stable_are_tried(made):
    assert len(made.remedy_root) >= 1 and not made.remedy_mode.any()
    for k, root, value in zip(made.remedy_parameter, made.remedy_root, made.remedy_value, strict=True):
        assert root.real < 0.1 * made.root[0].real and abs(root.imag / made.root[0].imag - 1) < 0.05
        assert np.sign(value - made.value[0, k]) == -np.sign(made.derivative[0, k].real)


def test_the_number_of_workers_changes_no_bit(brake, made):
    again = sensitivities(*brake, varied={}, settings=Settings(modes=2), context=TwoProcesses())
    assert store.content_hash(again) == store.content_hash(made)


def test_a_case_without_map_structure_or_scatter_has_sensitivities_of_its_joints(brake):
    model, _, modes, *_ = brake
    stated = complex_modes(model, None, settings=Modes(friction=0.6, friction_steps=2, speeds=("8 rad/s",),
                                                       frequency_max="8 kHz", followed=0))
    found = sensitivities(model, None, stated, None, None, varied={}, settings=Settings(modes=1, remedies=0))
    assert not found.declared.any() and not any("disc" in str(name) for name in found.parameter)
    assert len(found.remedy_value) == 0 and (found.error <= 1e-2 * abs(found.derivative.real) + 1e-3).all()


def test_nothing_unstable_gives_nothing(brake):
    model, law, modes, structure, drawn = brake
    none = sensitivities(model, law, modes, structure, drawn, varied={}, settings=Settings(modes=0))
    assert not len(none.mode) and not len(none.parameter) and not len(none.remedy_value) and len(none.left_out)


def test_effects_act_on_derivatives_and_on_what_makes_a_mode_stable(brake):
    """Friction that falls with speed: its modes grow by other amounts, and so do those of the changed case."""
    model, law, modes, structure, drawn = brake
    added = effects({"falling_friction": {"contact": {"rise": 0.2, "decay_speed": "100 mm/s"}}})
    settings = Settings(modes=1, remedies=1)
    found = sensitivities(model, law, modes, structure, drawn, added, varied={}, settings=settings)
    bare = sensitivities(model, law, modes, structure, drawn, varied={}, settings=Settings(modes=1, remedies=0))
    assert found.root[0] != bare.root[0] and abs(found.root[0] - bare.root[0]) < 0.05 * abs(bare.root[0])
    friction = list(found.parameter).index("friction")
    assert found.derivative[0, friction] != bare.derivative[0, friction]


def test_settings_that_move_the_mesh_are_ranked_with_the_others(brake, made):
    """A thickness whose increase by 1 % adds 3 1/s to the strongest mode, and whose decrease takes the other away."""
    model, law, modes, structure, drawn = brake
    more, less = (modes.operating_root + side * 3.0 for side in (1, -1))
    gone = modes.unstable_operating[made.mode[1]]
    assert gone != modes.unstable_operating[made.mode[0]]
    less[gone] = -1.0 + 1j * np.arange(1, less.shape[1] + 1)
    name = "structure.disc.ring_thickness"
    varied = {f"{name}.{end}": SimpleNamespace(operating_root=root) for end, root in (("more", more), ("less", less))}
    found = sensitivities(model, law, modes, structure, drawn, varied=varied,
                          settings=Settings(modes=2, remedies=0, differences=({"setting": name, "variation": 0.01},)))
    assert found.method[-1] == "differences" and found.parameter[-1] == name
    assert found.change[0, -1] == pytest.approx(3.0) and found.rank[0, -1] > 0
    assert found.known[1, -1] == 0 and found.rank[1, -1] == 0


@pytest.mark.slow
def test_thirty_values_of_the_quick_brake_within_five_percent_of_differences(tmp_path):
    """Two modes of the quick case, its contact law and its map refined until their steps are no matter: growth rates of
    the whole reduced model with each value 0.5 % up and down, 1 % where it moves little, half of what is typical where
    it is 0. Roots are uncertain by 0.003 1/s, as sliding states are found to 1e-7 of a contact force."""
    brakechain("run", ROOT / "configs" / "disc_brake_quick.yaml", "--until", "complex_modes", "--run", tmp_path)
    structure, model, law = (store.read(cls, tmp_path / f"{name}.h5") for cls, name in (
        (Structure, "structure"), (ReducedModel, "reduced_model"), (FrictionMap, "friction_map")))
    model, law = _fine(model), _fine_map(law)
    modes = complex_modes(model, law, settings=Modes(friction_steps=2, speeds=("10 rad/s",), frequency_max="6 kHz",
                                                     followed=0))
    found = sensitivities(model, law, modes, structure, None, varied={}, settings=Settings(modes=2, remedies=0))
    points, checked = StabilitySettings.of(modes), 0
    assert len(found.mode) == 2
    for k in range(2):
        state = int(modes.unstable_operating[found.mode[k]])
        case = Case(without_surface(model), state, 10.0)
        for p, value in enumerate(parameters(case, structure, float(found.friction[k]), points)):
            slope = found.derivative[k, p] * value.reference
            step = 0.005 if abs(slope) > 50 else 0.01 if value.value else 0.5
            ends = [(system_of(value.changed(case, side * step), law, points), found.root[k] + side * step * slope)
                    for side in (-1, 1)]
            low, high = (polished_root(*end).root for end in ends)
            assert slope.real == pytest.approx((high - low).real / (2 * step), rel=0.05, abs=0.003 / step), value.name
            checked += 1
    assert checked >= 60


def _fine(model):
    """The ReducedModel with its contact law, which is exponential but for its first row, in rows 10 000 times finer."""
    known, pressure = model.law_closure[1:], model.law_pressure[1:]
    rows = np.interp(np.arange(10000 * len(known) - 9999) / 10000, np.arange(len(known)), known)
    return replace(model, law_closure=np.append(0.0, rows),
                   law_pressure=np.append(0.0, np.exp(CubicSpline(known, np.log(pressure))(rows))))


def _fine_map(law):
    """A FrictionMap with the friction of ``law`` as a plane over the logarithms of pressure and speed, in fine rows."""
    friction = law.friction[:, :, -1]
    p, v = np.meshgrid(np.log(law.pressure), law.speed, indexing="ij")
    plane = np.linalg.lstsq(np.column_stack((np.ones(p.size), p.ravel(), v.ravel())), friction.ravel(), rcond=None)[0]
    pressure, speed = np.geomspace(1e4, 1e7, 200001), np.linspace(0.05, 20, 11)
    mu = plane[0] + plane[1] * np.log(pressure)[:, None, None] + plane[2] * speed[:, None] + np.zeros(2)
    return replace(law, pressure=pressure, speed=speed, distance=[0.0, 1.0], friction=mu, friction_std=0 * mu,
                   normal_stiffness=np.full((len(pressure), 2), 1e12), best_pressure=[1e6, 1e6],
                   pressure_slope_std=[0.0, 0.0], speed_slope_std=[0.0, 0.0],
                   error_correlation=np.tile(np.eye(3), (2, 1, 1)))
