"""The energy account of whole runs, and their pictures."""

import numpy as np
import pytest

from pipeline.physics.rupture.dynamics import Record, advance, at_rest, stable_step
from pipeline.physics.rupture.history import energies, run
from pipeline.physics.rupture.plate_grid import edge_impedance, elastic_force
from tests.physics.small_ruptures import interface, plates


@pytest.mark.exact
def test_without_damping_and_absorbing_edges_no_energy_is_lost():
    """Released = heat + kinetic + strain to 1 %, edges reflecting, waves back from them."""
    lower, upper = plates(damping=0.0, length=4e-3, height=1.5e-3)
    law, _ = interface(lower, upper, ratio=0.9, half_width=5e-4, memory_time=2e-8)
    energy = run(lower, upper, law, 4e-6).energy
    assert energy.released > 0 and energy.kinetic > 0.02 * energy.released and energy.heat > 0
    assert abs(energy.taken) < 0.01 * energy.released


@pytest.mark.exact
def test_the_account_closes_with_the_step():
    """What is missing falls with the time step, and damping only takes."""
    lower, upper = plates(damping=0.0, length=4e-3, height=1.5e-3)
    law, _ = interface(lower, upper, friction=0.0, ratio=0.0)
    x = 5e-5 * np.arange(lower.columns)
    law = law._replace(shear=1e6 * np.exp(-(((x - 2e-3) / 3e-4) ** 2)))
    missing = []
    for share in (0.9, 0.45):
        energy = run(lower, upper, law, 2e-6, share).energy
        missing.append(abs(energy.taken) / energy.released)
    assert missing[1] < 0.6 * missing[0] < 0.006
    damped = run(*plates(length=4e-3, height=1.5e-3), law, 2e-6).energy
    assert damped.taken > 2 * missing[0] * damped.released


@pytest.mark.exact
@pytest.mark.parametrize("damping, absorbing, share", [(0.1, False, 0.025), (0.0, True, 0.225), (0.1, True, 0.225)])
def test_what_is_missing_is_what_damping_and_absorbing_edges_took(damping, absorbing, share):
    """The work of both, v C v summed step by step, closes the account to 0.1 % of the energy released."""
    lower, upper = plates(damping=damping, length=4e-3, height=1.5e-3, absorbing=absorbing)
    law, _ = interface(lower, upper, ratio=0.9, half_width=5e-4, memory_time=2e-8)
    motion, step = at_rest(lower, upper, law), 0.9 * stable_step(lower, upper)
    records, work = [], 0.0
    for _ in range(int(4e-6 / step)):
        before = [part[1].copy() for part in (motion.lower, motion.upper)]
        records.append(advance(lower, upper, law, motion, step, 1))
        for grid, old, part in zip((lower, upper), before, (motion.lower, motion.upper), strict=True):
            middle = 0.5 * (old + part[1])
            work += step * (edge_impedance(grid) * middle**2).sum()
            work += step * grid.stiffness_damping * np.vdot(middle, elastic_force(grid, old))
    record = Record(*(np.concatenate(parts) for parts in zip(*records, strict=True)))
    energy = energies(lower, upper, law, motion, record, step)
    assert energy.taken == pytest.approx(share * energy.released, rel=0.02)
    assert energy.taken == pytest.approx(work, abs=1e-3 * energy.released)


def test_pictures_are_taken_at_equal_times():
    lower, upper = plates(length=2e-3, height=1e-3)
    law, _ = interface(lower, upper)
    history = run(lower, upper, law, 3e-7, frames=3, stride=(2, 4), strip=(3, 5))
    assert history.frame_time == pytest.approx([1e-7, 2e-7, 3e-7])
    assert history.record.time[-1] == pytest.approx(3e-7)
    assert [v.shape for v in history.frames[-1]] == [(2, 11, 21), (2, 6, 11)]
    assert [v.shape for v in history.strips[-1]] == [(2, 3, 41), (2, 5, 41)]
    np.testing.assert_allclose(history.strips[-1][0][:, -1], history.motion.lower[1][:, -1], rtol=1e-6)
    np.testing.assert_allclose(history.frames[-1][0], history.motion.lower[1][:, ::2, ::2], rtol=1e-6)
    assert np.isclose(history.record.slip_rate.sum(axis=0) * history.step, history.motion.slip, rtol=1e-4).all()
