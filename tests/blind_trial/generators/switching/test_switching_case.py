"""Cases: what is hidden can be seen, noise and samples are as drawn, the same seed draws the same case."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.switching import switching_case
from pipeline.blind_trial.generators.switching.hidden import PIECES
from pipeline.blind_trial.generators.switching.instruments import Sensor, written
from pipeline.blind_trial.generators.switching.rig import drawn
from pipeline.blind_trial.generators.switching.switching_case import LEAST, _Bench, _beside_a_moved_wall, _index, made
from pipeline.contract import ConfigError


def test_a_control_shows_its_rig_in_noise_of_its_level():
    case = made(3, "control", level=0.05)
    assert (case.kind, case.form, case.left, case.change) == ("control", "", 0.0, 0.0)
    assert len(case.runs) == len(case.shown) == 4 and 14.9 < case.rate / case.truth.frequencies[-1] < 60.1
    for sensor, std in zip(case.sensors, case.noise, strict=True):
        rows = [run[case.sensors.index(sensor)] * sensor.per_unit for run in case.shown]
        assert np.sqrt(np.mean([np.nanmean(row**2) for row in rows])) == pytest.approx(std / 0.05, rel=0.05)


def test_hidden_friction_leaves_what_can_be_seen():
    case = made(1, "effect", "coulomb")
    assert case.left >= LEAST and case.change > 0 and case.reach < 5 and case.name == "coulomb"


def test_each_law_of_a_pair_is_seen_beside_the_other_one(monkeypatch):
    """Quadratic stiffness of a body that a soft pad brakes is none, however much of it there is without the pad."""
    pair = "effect", "cubic_stiffness", 0.01, "quadratic_damping", False
    case = made(7, *pair)
    assert case.second.left >= LEAST
    beside = switching_case._Hiding.beside
    monkeypatch.setattr(switching_case._Hiding, "beside", lambda self, seen, known, _: beside(self, known, known))
    with pytest.raises(ConfigError, match="two laws that are both seen"):
        made(7, *pair)


def test_a_seed_repeats_itself():
    case, again = (made(3, "control") for _ in range(2))
    for first, second in zip(case.shown, again.shown, strict=True):
        np.testing.assert_array_equal(first, second)


def test_nothing_is_hidden_at_the_spring_whose_wall_is_moved():
    """There a law would act on the motion relative to the wall."""
    for form, layout, possible in (("coulomb", "single", False), ("coulomb", "row", True), ("base_shake", "row", False),
                                   ("attached_mass", "single", True)):
        assert _beside_a_moved_wall(PIECES[form], layout) == possible
    random, truth = np.random.default_rng(1), drawn(np.random.default_rng(1), "bridge")
    bench = _Bench(truth, (), (Sensor("ch2", 1, "displacement", "mm", 1e-4),))
    assert {_index(random, PIECES["coulomb"], bench, 0) for _ in range(40)} == {1, 2}
    assert {_index(random, PIECES["attached_mass"], bench, 0) for _ in range(40)} == {1}


@pytest.mark.slow
@pytest.mark.study
def test_a_wrong_value_is_far_off_and_a_faulty_sensor_is_one_of_the_channels():
    wrong = made(2, "wrong_value")
    assert wrong.far in wrong.truth.names
    assert abs(np.log(wrong.belief.value(wrong.far) / wrong.truth.value(wrong.far))) > np.log(1.59)
    faulty = made(4, "sensor", "reversed")
    assert faulty.name == "reversed_channel" and faulty.left > LEAST and faulty.index < len(faulty.sensors)
    assert written(np.ones(3), 1.0, np.zeros(3, bool)).shape == (3,)
