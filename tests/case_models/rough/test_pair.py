"""From a product Surface and the section micro_friction to the physics of the rough pair."""

import numpy as np
import pytest

from pipeline.case_models.rough.pair import Settings, cycle_distance, offsets, rough_pair, rubbing, shifted
from pipeline.contract.settings import fill
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface


@pytest.fixture(scope="module")
def rough():
    return surface(settings=SurfaceSettings(nodes=32, shortest_wavelength="125 um"))


def test_values_of_the_section_arrive(rough):
    settings = Settings(third_body_factor=0.5, disc_strength="200 MPa", cycles=50, stroke="94 um")
    found = rubbing(rough, settings)
    assert found.shearing.limit == pytest.approx(0.5 * 200e6 / np.sqrt(3), rel=1e-14)
    assert found.shearing.reference_speed == pytest.approx(10.25 * 0.128)
    assert (found.wearing.cycles, found.wearing.stroke) == (50, 3)
    assert found.wearing.distance == cycle_distance(settings) == pytest.approx(10e-3 / 50)
    assert found.wearing.pad_coefficient == pytest.approx(4e-12)
    np.testing.assert_array_equal(found.pair.pad_height, rough.pad_height[0])


def test_positions_of_the_patches(rough):
    settings = Settings(realisations=3)
    places = offsets(rough, settings)
    assert places.shape == (3, 2) and not places[0].any() and places[1:].any()
    moved = shifted(rubbing(rough, settings), places[1]).pair
    np.testing.assert_array_equal(moved.pad_height, np.roll(rough.pad_height[0], places[1], (0, 1)))
    np.testing.assert_array_equal(moved.disc_height, rough.disc_height[0])


def test_a_finer_grid_holds_the_same_surface(rough):
    fine = rough_pair(rough, Settings(), 2.0)
    assert fine.pad_height.shape == (64, 64) and fine.spacing[0] == pytest.approx(1e-3 / 64)
    np.testing.assert_allclose(fine.pad_height[::2, ::2], rough.pad_height[0], atol=1e-12)


def test_the_softer_body_yields(rough):
    hard = {name: {"hardness": value} for name, value in (("pad", "400 MPa"), ("disc", "2 GPa"))}

    def found(given):
        return rough_pair(rough, fill(Settings, given, "micro_friction"))

    assert (found({}).hardness, found(hard).hardness, found(hard).yielding) == (np.inf, 4e8, "pad")
    assert found({"disc": hard["disc"]}).yielding == "disc"
