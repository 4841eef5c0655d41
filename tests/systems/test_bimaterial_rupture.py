"""The built system: nucleation, laws, preload, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.closed_form.wave_speeds import Solid
from pipeline.systems.bimaterial_rupture import Parameters, build

PAPER = Parameters(Solid(5.3e9, 0.25, 1246.0), Solid(3.392e9, 0.25, 1246.0), 4e-3, 1e-3, 2.5e-5, 2.5e-5, 0.1, False,
                   False, 1.0, 1.0, 1e-6, 0.0, 0.0, 1.25e-4, 1e6, 0.94, False)


def test_friction_vanishes_on_the_nucleation_length():
    system = build(PAPER)
    frictionless = system.x[system.interface.static == 0.0]
    assert frictionless == pytest.approx(2e-3 + 2.5e-5 * np.arange(-2, 3)), "five nodes of 25 um: 0.125 mm"
    assert (system.interface.length[system.interface.static == 0.0]).sum() == pytest.approx(1.25e-4)


def test_the_solved_preload_meets_the_ratio_in_the_middle():
    system = build(replace(PAPER, solved_preload=True, upper_spacing=5e-5, lower_spacing=5e-5))
    law, middle = system.interface, system.x.size // 2
    assert law.shear[middle] / law.pressure[middle] == pytest.approx(0.94, rel=1e-3)
    assert (law.shear <= law.pressure * (1 + 1e-9)).all() and system.preload.shift_x > 0


def test_edges_are_free_held_or_absorbing():
    free, absorbing = build(PAPER), build(replace(PAPER, absorbing_sides=True, absorbing_far=True))
    assert free.lower.edges.tolist() == [[0, 0], [0, 0], [1, 1], [0, 0]]
    assert free.upper.edges.tolist() == [[0, 0], [0, 0], [0, 0], [1, 1]]
    assert absorbing.lower.edges.tolist() == [[2, 2], [2, 2], [2, 2], [0, 0]]


@pytest.mark.parametrize("changes, message", [
    ({"ratio": 1.0}, "stress_ratio: expected shear over pressure from 0 to below the static friction 1, found 1"),
    ({"nucleation_length": 4e-5}, "nucleation_length: expected 2 or more elements of 2.5e-05 m, found 4e-05 m"),
    ({"nucleation_length": 5e-3}, "nucleation_length: expected less than the length"),
    ({"lower": Solid(3e9, 0.5, 1e3)}, "rupture.lower.poisson_ratio: expected a value between -1 and 0.5"),
    ({"dynamic_friction": 1.1}, "friction.dynamic: expected at most the static friction"),
    ({"lower_spacing": 2e-5, "solved_preload": True}, "lower_spacing: expected matched interface nodes"),
    ({"lower_spacing": 3e-5}, "whole elements"),
])
def test_what_is_refused(changes, message):
    with pytest.raises(ConfigError, match=message):
        build(replace(PAPER, **changes))
