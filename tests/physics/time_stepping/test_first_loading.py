"""Memory at the start of a motion: sliders that were loaded from where they are relaxed, in closed form."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.physics.time_stepping.elements import Dry, Element, Maxwell, Polynomial, Sliders, alone
from pipeline.physics.time_stepping.first_loading import loaded, remembers_loading
from pipeline.physics.time_stepping.simulate import Hard, Start, simulate
from tests.physics.lumps import lumps

STIFFNESS, LIMIT = np.array([40.0, 25.0, 10.0]), np.array([0.2, 1.0, 1e3])


def elements(*laws):
    return tuple(Element(f"law {k}", np.array([1.0]), law) for k, law in enumerate(laws))


@pytest.mark.exact
@pytest.mark.parametrize("relaxed", [0.0, 0.02, -0.05])
def test_sliders_hold_what_their_way_from_relaxed_gives_them(relaxed):
    kernel = alone(elements(Sliders(STIFFNESS, LIMIT)))
    memory = loaded(kernel, np.ones((1, 1)), np.array([relaxed]), np.array([0.03]))
    np.testing.assert_allclose(memory, np.clip(STIFFNESS * (0.03 - relaxed), -LIMIT, LIMIT), rtol=1e-12)


def test_laws_without_such_a_memory_start_without_a_force():
    kernel = alone(elements(Polynomial(cubic=1.0), Dry(1e3, 1.0, 1.0)))
    assert not loaded(kernel, np.ones((2, 1)), np.zeros(1), np.array([0.1]), time=2.0).any()
    assert not remembers_loading(kernel) and remembers_loading(alone(elements(Sliders(STIFFNESS, LIMIT))))
    assert not remembers_loading(alone(()))


@pytest.mark.exact
def test_relaxing_branches_are_loaded_at_once():
    """What a way of 0.08 m gives to springs of 5 and 2 N/m before their dampers move."""
    kernel = alone(elements(Maxwell([5.0, 2.0], [0.1, 3.0])))
    memory = loaded(kernel, np.ones((1, 1)), np.array([0.02]), np.array([0.1]), time=2.0)
    np.testing.assert_allclose(memory[:2], [0.4, 0.16], rtol=1e-12)
    assert memory[2] == 2.0, "the clock of the branches is that of the start"
    assert remembers_loading(kernel)


@pytest.mark.exact
def test_a_motion_goes_on_where_it_was_cut():
    """After a first loading to 0.02 m the second part of a motion is that of the whole."""
    base = lumps([1.0], [[1.0]], [400.0], [1.0])
    model = replace(base, elements=elements(Sliders(STIFFNESS, LIMIT)))
    whole = simulate(model, Hard(), step=1e-3, duration=2.0, start=Start(np.zeros(1), np.array([0.5])))
    cut = int(np.argmax(whole.displacement[0] > 0.02))
    start = Start(whole.displacement[:, cut], whole.velocity[:, cut])
    right, wrong = (simulate(model, Hard(), step=1e-3, duration=0.5, start=replace(start, relaxed=relaxed))
                    for relaxed in (np.zeros(1), None))
    np.testing.assert_allclose(right.displacement[0], whole.displacement[0, cut:cut + 501], atol=1e-9)
    assert abs(wrong.displacement[0] - whole.displacement[0, cut:cut + 501]).max() > 1e-4
