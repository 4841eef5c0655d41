"""Derivatives of a growing mode of a small brake to its values, beside central differences of its root."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.sensitivity.matrices import Case, mean_friction, polished_root, system_of
from pipeline.case_models.sensitivity.parameters import parameters
from pipeline.physics.sliding.model import lining_part
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.small_structure import small_friction_map, small_structure

STEP = 1e-3


def test_every_value_within_five_percent_of_differences():
    """Growth rate and frequency, about the sliding state that each value leads to, of the two strongest modes."""
    structure, law = small_structure(), small_friction_map(0.6)
    model = reduced_model(structure, settings=Reduction(fixed_below="20 kHz"))
    modes = complex_modes(model, law, settings=Modes(friction_steps=2, speeds=("8 rad/s", "12 rad/s"),
                                                     frequency_max="8 kHz", followed=0))
    points = StabilitySettings.of(modes)
    for start, operating in zip(modes.unstable_reduced[:2], modes.unstable_operating[:2], strict=True):
        state, speed = divmod(int(operating), len(points.speeds))
        case = Case(model, state, points.speeds[speed])
        found = parameters(case, structure, mean_friction(case, law, points), points)
        assert len(found) >= 30 and len({p.name for p in found}) == len(found)
        mode = polished_root(system_of(case, law, points), start)
        assert mode.root == pytest.approx(start, rel=1e-8)
        for each in found:
            compared(each, case, mode, law, points)


def compared(value, case, mode, law, points):
    """Derivative of a RootWithVectors to a Parameter, which central differences must confirm."""
    ends = [system_of(value.changed(case, side * STEP), law, points) for side in (-1, 1)]
    change = -(mode.left.conj() @ ends[1].beyond(ends[0], mode.root, mode.right)) / (2 * STEP)
    roots = [polished_root(m, mode.root + s * STEP * change).root for m, s in zip(ends, (-1, 1), strict=True)]
    expected = (roots[1] - roots[0]) / (2 * STEP)
    for part in (np.real, np.imag):
        assert part(change) == pytest.approx(part(expected), rel=0.05, abs=1e-6), value.name
    return change


def test_pressure_acts_through_linings_that_it_stiffens():
    """Half the stiffness of the pads is that of linings: the change is the one of the load and that of their moduli."""
    structure, law = small_structure(), small_friction_map(0.6)
    model = reduced_model(structure, settings=Reduction(fixed_below="20 kHz"))
    lined = np.flatnonzero(np.isin(model.coordinate_body, (1, 2)))
    model = replace(model, lining_coordinate=lined, lining_stiffness=0.5 * model.stiffness[np.ix_(lined, lined)])
    modes = complex_modes(model, law, settings=Modes(friction_steps=2, speeds=("8 rad/s",), frequency_max="8 kHz",
                                                     followed=0))
    points = StabilitySettings.of(modes)
    state = int(modes.unstable_operating[0])
    changes = []
    for exponent in (0.0, 0.5):
        stiffening = replace(model, lining_exponent=exponent, lining_pressure=model.pressure[state])
        case = Case(stiffening, state, points.speeds[0])
        mode = polished_root(system_of(case, law, points), modes.unstable_reduced[0])
        named = {each.name: each for each in parameters(case, structure, mean_friction(case, law, points), points)}
        changes.append(compared(named["structure.pressures"], case, mode, law, points))
    lining = replace(case, model=replace(model, stiffness=model.stiffness + STEP * lining_part(model)))
    moved = polished_root(system_of(lining, law, points), mode.root).root - mode.root
    assert changes[1] - changes[0] == pytest.approx(0.5 * moved / STEP, rel=0.05)
