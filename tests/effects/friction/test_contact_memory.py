"""Contact memory."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.effects import named
from pipeline.physics.friction.dry_friction import constant, tabulated
from pipeline.physics.signals.oscillation import growth_rate
from pipeline.physics.time_stepping.simulate import Hard, Penalty
from pipeline.physics.virtual_rig.force_residual import equation_residual
from pipeline.physics.virtual_rig.response import Bench, Run, respond
from pipeline.physics.virtual_rig.roots import roots
from tests.effects.benches import RATE, anchored, rubbing, slider, steady
from tests.physics.lumps import lumps


@pytest.mark.exact
@pytest.mark.parametrize("speed", [1.0, 2.0, 4.0])
def test_friction_lags_a_swinging_load(speed):
    """T / (mu N) = 1 / (1 + i w L / v) of the swing: the delay falls with the sliding speed."""
    length, angular = 0.02, 2 * np.pi * 20.0
    bench = named("contact_memory").on(anchored(constant(0.3)), "contact", {"length": length})
    run = Run("swinging", 1.0, RATE, drive=speed)
    found = respond(bench, replace(run, inputs={"input_1": -40 - 4 * np.sin(angular * run.time)}))
    late = run.time > 0.5
    turn = np.exp(-1j * angular * run.time[late])
    told = (found["t"][late] * turn).mean() / (0.3 * found["n"][late] * turn).mean()
    assert told == pytest.approx(1 / (1 + 1j * angular * length / speed), rel=1e-3)


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.05, 0.2, 1.0])
def test_growth_rates_against_speed(speed):
    """(s^2 + c s + k)(s + r) + N mu' r s = 0 with r = v / L: falling friction that is heard late drives less."""
    length, slope = 0.01, -0.1
    friction = tabulated([0.0, 4.0], [0.5, 0.5 + 4 * slope])
    bench = named("contact_memory").on(slider(friction=friction, speed=speed), "contact", {"length": length})
    rate = speed / length
    exact = np.roots(np.polyadd(np.polymul([1.0, 2.0, 400.0], [1.0, rate]), [0.0, 0.0, 40 * slope * rate, 0.0]))
    found = roots(bench, steady())
    for root in exact:
        assert abs(found - root).min() < 1e-9 * abs(root)
    assert len(found) == 6


@pytest.mark.exact
def test_flutter_with_memory_of_the_load():
    """det(M s^2 + K + mu r / (s + r) K_f) = 0 at each root that turns."""
    k11, k22, k12, contact, mu, length = 1.1e6, 1.2e6, 1e5, 4e5, 0.6, 2e-3
    model = lumps([1.0, 1.0], [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]], [k11 - k12, k22 - k12 - contact, k12],
                  normal=[[0.0, 1.0]], tangent=[[1.0, 0.0]], speed=-5.0)
    bench = named("contact_memory").on(Bench(model, Penalty(contact), constant(mu), 1e-5, ()), "contact",
                                       {"length": length})
    for root in roots(bench, Run("pressed", 1.0, 1000.0, {"input_1": -20.0})):
        if abs(root.imag) > 1.0:
            matrix = np.array([[k11, k12 - mu * contact * 2500 / (root + 2500)], [k12, k22]]) + root**2 * np.eye(2)
            assert abs(np.linalg.det(matrix)) < 1e-9 * k11 * k22


@pytest.mark.exact
def test_a_simulated_motion_grows_as_its_root_says():
    bench = named("contact_memory").on(slider(friction=tabulated([0.0, 1.0], [0.5, 0.3]), speed=0.6), "contact",
                                       {"length": 0.02})
    run = steady(duration=3.5)
    run = replace(run, inputs={**run.inputs, "input_0": 1e-3 * (run.time < 0.02)})
    root = max(roots(bench, run), key=lambda r: r.imag if r.imag < 25 else 0.0)
    swing = respond(bench, run)["x"][1000:] - 40 * 0.38 / 400
    assert root.real > 0.5
    assert growth_rate(swing, 1 / RATE, root.imag / (2 * np.pi))[0] == pytest.approx(root.real, rel=0.02)


def test_equation_residual_hears_late_as_well():
    base, run = rubbing(speed=2.0), steady(duration=0.4)
    run = replace(run, inputs={"input_1": -40 - 4 * np.sin(120 * run.time)})
    bench = named("contact_memory").on(base, "contact", {"length": 0.02})
    measured = respond(bench, run)
    left, missed = (abs(equation_residual(b, run, measured)[:, 300:-10]).max() for b in (bench, base))
    assert left < 0.02 * missed


def test_contacts_that_do_not_yield_are_refused():
    with pytest.raises(ConfigError, match="yield"):
        respond(named("contact_memory").on(slider(Hard()), "contact", {"length": 1e-3}), steady())
