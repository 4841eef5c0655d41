"""From a product Surface and the section micro_friction to the physics of the rough pair."""

import numpy as np
import pytest
from PIL import Image

from pipeline.case_models.rough.pair import Settings, cycle_distance, of_pair, offsets, rough_pair, rubbing, shifted
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


def test_particles_go_with_the_pad(rough):
    """Stiffer ones that wear and shear less: their nodes are those of the block, also where the pad is shifted."""
    given = {"pad": {"inclusions": {"modulus_factor": 8, "size": "150 um", "wear_factor": 0.2, "shear_factor": 0.6}}}
    pair = rubbing(rough, fill(Settings, given, "micro_friction")).pair
    particles = pair.compliance.normal.block.factor[0] == 8
    assert 0.05 < particles.mean() < 0.4
    np.testing.assert_array_equal(pair.wear_factor, np.where(particles, 0.2, 1.0))
    np.testing.assert_array_equal(pair.shear_factor, np.where(particles, 0.6, 1.0))
    moved = pair.with_pad_at((3, 5))
    for of, was in ((moved.compliance.normal.block.factor[0] == 8, particles), (moved.wear_factor, pair.wear_factor)):
        np.testing.assert_array_equal(of, np.roll(was, (3, 5), (0, 1)))


def test_particles_of_each_pair_lie_elsewhere():
    several = surface(settings=SurfaceSettings(nodes=32, shortest_wavelength="125 um", pairs=3))
    given = {"pad": {"inclusions": {"modulus_factor": 8, "size": "150 um"}}}
    rubbed = rubbing(several, fill(Settings, given, "micro_friction"))
    blocks = [of_pair(rubbed, several, number).pair.compliance.normal.block.factor for number in range(3)]
    assert blocks[0].mean() == pytest.approx(blocks[1].mean()) == pytest.approx(blocks[2].mean())
    assert not any((blocks[a] == blocks[b]).all() for a, b in ((0, 1), (1, 2), (0, 2)))
    np.testing.assert_array_equal(blocks[0], rubbed.pair.compliance.normal.block.factor)


def test_particles_of_a_picture(rough, tmp_path):
    picture = np.zeros((2, 2), np.uint8)
    picture[0, 1] = 255
    Image.fromarray(picture).save(tmp_path / "lining.png")
    asked = {"pad": {"inclusions": {"modulus_factor": 4, "image": str(tmp_path / "lining.png"), "size": "90 um"}}}
    factor = rubbing(rough, fill(Settings, asked, "micro_friction")).pair.compliance.normal.block.factor
    assert (factor[0, :16, 16:] == 4).all() and (factor[0, 16:] == 1).all() and (factor[-1] == 1).all()
