"""What inputs do between samples, against SciPy's integration of the same force."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from pipeline.contract.errors import ConfigError
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.simulate import Hard
from pipeline.physics.virtual_rig.half_sine import HalfSine
from pipeline.physics.virtual_rig.inputs import holding, input_unit, resolved, run_inputs, stated_inputs
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.sensor import ACCELERATION, DISPLACEMENT, VELOCITY, Sensor
from tests.physics.lumps import lumps

#: 1 kg on 100 N/m, and samples a second
STIFFNESS, DAMPING, RATE, DURATION = 100.0, 0.4, 40.0, 6.0
TONES = ((1.1, 0.3), (1.9, 2.0), (3.3, 1.1))


def bench(step):
    return Bench(lumps([1.0], [[1.0]], [STIFFNESS], [DAMPING]), Hard(), constant(0.0), step,
                 tuple(Sensor(q.name, q, "sensor_0") for q in (DISPLACEMENT, VELOCITY, ACCELERATION)))


def force(time):
    """Tones (N) that come and go."""
    return np.sin(np.pi * time / DURATION) ** 2 * sum(np.cos(2 * np.pi * f * time + phase) for f, phase in TONES)


def shaken(rate=RATE):
    time = np.arange(round(DURATION * rate) + 1) / rate
    return Run("shaken", DURATION, rate, {"input_0": force(time)}, band_limited=("input_0",))


def exact(time):
    """{quantity: (n,)} of the motion from rest."""
    def slope(t, state):
        return state[1], force(t) - DAMPING * state[1] - STIFFNESS * state[0]

    x, v = solve_ivp(slope, (0, DURATION), [0.0, 0.0], "DOP853", time, rtol=1e-10, atol=1e-12).y
    return {"displacement": x, "velocity": v, "acceleration": slope(time, (x, v))[1]}


def errors(run, step):
    """Relative errors {quantity: worst over the root mean square} of a Run."""
    found, true = respond(bench(step), run), exact(run.time)
    return {name: abs(found[name] - values).max() / values.std() for name, values in true.items()}


@pytest.mark.exact
def test_a_force_of_few_samples_moves_and_accelerates_as_it_did():
    """Twelve samples a period of the highest tone; straight lines through them are 2 % too weak, and the force at the
    samples of lines that make up for it 2 % too strong."""
    coarse, fine = (errors(shaken(), step) for step in (1 / 400, 1 / 1600))
    assert max(coarse.values()) < 6e-3 and max(fine.values()) < 5e-4, (coarse, fine)
    straight = errors(replace(shaken(), band_limited=()), 1 / 1600)
    assert min(straight.values()) > 5e-3, straight


def test_inputs_that_are_not_named_are_straight_between_samples_beside_one_that_is():
    two = Bench(lumps([1.0, 1.0], np.eye(2), [100.0, 100.0], [0.4, 0.4]), Hard(), constant(0.0), 1e-2, ())
    run = Run("two", 1.0, 10.0, dict.fromkeys(("input_0", "input_1"), np.arange(11.0) ** 2), band_limited=("input_0",))
    finer, (smooth, straight) = resolved(two, run, 10)
    assert finer.samples == 101 and len(smooth) == len(straight) == 101
    np.testing.assert_allclose(straight, np.interp(finer.time, run.time, np.arange(11.0) ** 2))
    assert abs(smooth - straight)[20:-20].max() > 0.1


def test_a_blow_lands_on_top_of_a_band_limited_force():
    still = shaken()
    struck = replace(still, pulses={"input_0": HalfSine(1.0, 0.01, 5.0)})
    (finer, (before,)), (_, (after,)) = (resolved(bench(1 / 400), run, 10) for run in (still, struck))
    np.testing.assert_allclose(after - before, struck.pulses["input_0"].force(finer.samples, finer.sample_rate),
                               atol=1e-12)


def test_inputs_by_name():
    run = replace(shaken(), held=("input_0",), band_limited=())
    assert holding(bench(0.01), run).tolist() == [True] and input_unit(bench(0.01), "input_0") == "N"
    np.testing.assert_array_equal(run_inputs(bench(0.01), run)[0], stated_inputs(bench(0.01), run)[0])
    with pytest.raises(ConfigError, match="one of input_0"):
        stated_inputs(bench(0.01), replace(run, inputs={"hammer": 1.0}))
