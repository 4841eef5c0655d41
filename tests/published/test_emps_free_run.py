"""The carriage drive simulated open loop over 25 s: raw, recalibrated and completed by Coulomb friction.

Estimator: least squares on positions (output error); hold: the voltage stays for 1 ms (step); start: measured place and
speed. Least squares on positions tell dry from viscous friction less well than inverse dynamics: without dry friction
the carriage gets twice the viscous friction and a quarter more mass, and drifts by 7 mm where dry friction leaves 3.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares

from pipeline.case_models.force_balance import measured_start
from pipeline.case_models.runs import Recorded
from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.elements import Element, Wave
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import DISPLACEMENT, Sensor
from tests.effects.test_emps import RATE, recorded
from tests.physics.lumps import lumps


def bench(mass, damping, offset, friction):
    plain = Bench(lumps([mass], [[1.0]], [0.0], [damping]), Hard(), constant(0.0), 1 / RATE,
                  (Sensor("q", DISPLACEMENT, "sensor_0"),))
    row = plain.model.input_rows[0]
    pushed = plain.with_elements(Element("offset", row, Wave(1.0, amplitude=offset)))
    return named("coulomb").on(pushed, "joint_0", {"force": friction})


@pytest.mark.measured
@pytest.mark.published
@pytest.mark.slow
@pytest.mark.study
def test_the_completed_model_follows_25_s_within_5_mm():
    force, place = recorded("DATA_EMPS")
    run = Run("record", (len(force) - 1) / RATE, RATE, {"input_0": force}, held=("input_0",))
    seen = Recorded(run, ("q",), ("m",), place[None], np.ones((1, len(place)), bool), "")
    run = replace(run, start=measured_start(bench(95.0, 200.0, 0.0, 0.0), seen))

    def error(values):
        mass, damping, offset, friction = (*values * [95.0, 200.0, 3.0, 20.0][:len(values)], 0.0)[:4]
        return 1e3 * (respond(bench(mass, damping, offset, friction), run)["q"] - place)

    def refitted(start):
        return least_squares(error, start, x_scale=0.01, max_nfev=8)

    size = {"raw nominal": np.sqrt(np.mean(error(np.array([1.0, 1.0, 1.0])) ** 2))}
    nominal, complete = refitted(np.array([1.0, 2.0, 1.0])), refitted(np.ones(4))
    size |= {n: np.sqrt(np.mean(f.fun**2)) for n, f in (("recalibrated", nominal), ("completed", complete))}
    assert size["completed"] < 5.0 < size["recalibrated"] < 7.5 < 20.0 < size["raw nominal"], size
    assert nominal.x[1] * 200 > 400 and nominal.x[0] * 95 > 110, "what took the place of dry friction"
    assert complete.x[3] * 20 == pytest.approx(22.5, abs=2.0)
