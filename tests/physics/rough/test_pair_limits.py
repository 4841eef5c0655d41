"""Operating points beyond a rough pair end in one error before anything is computed."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract.errors import ConfigError
from pipeline.physics.rough.contact.normal_contact import full_contact_pressure
from pipeline.physics.rough.flash_temperature import ThermalSolid
from pipeline.physics.rough.generator import self_affine
from pipeline.physics.rough.layered_solid import graded_depth, layered_compliance
from pipeline.physics.rough.pair_limits import refuse_beyond_limits, refuse_large_grid
from pipeline.physics.rough.sliding_pair import RoughPair, Rubbing, Shearing, Solving, Wearing

NODES = 32
SOLID = ThermalSolid(50.0, 7200.0, 500.0)


def rubbing(rate=0.0):
    pad, disc = (3e-6 * self_affine(np.random.default_rng(s), NODES, 1e-3, 125e-6, 3e-4, 0.8) for s in (1, 2))
    spacing = (1e-3 / NODES,) * 2
    block = layered_compliance((NODES, NODES), spacing, graded_depth(spacing[0], 1e-3, 1.5), 0.2e9, 0.25)
    return Rubbing(RoughPair(pad, disc, spacing, block), Wearing(1, 1e-3, 1, 1e-12, 1e-12),
                   Shearing(13e6, 1.3, rate, 0.0, SOLID, SOLID), Solving(1e-4, 2000))


@pytest.mark.exact
def test_loads_up_to_full_contact_are_computed():
    pair = rubbing().pair
    flat = full_contact_pressure(-pair.pad_height - pair.disc_height, pair.compliance.normal)
    refuse_beyond_limits(rubbing(), [1e6, 0.999 * flat], [1.0])
    with pytest.raises(ConfigError, match=r"rough pair: pressures: expected below .*, which flattens the surfaces"):
        refuse_beyond_limits(rubbing(), [1e6, 1.001 * flat], [1.0])


def test_a_load_on_one_node_shows_the_grid():
    with pytest.raises(ConfigError, match="rough pair: pressures: expected a load on at least 2 .* 1 of 1024"):
        refuse_beyond_limits(rubbing(), [1.0], [1.0])


@pytest.mark.exact
def test_a_rate_term_that_takes_the_whole_limit_is_refused():
    """1 + C ln(v / v0) vanishes at v0 exp(-1 / C)."""
    refuse_beyond_limits(rubbing(2.0), [1e6], [1.3 * np.exp(-0.499)])
    with pytest.raises(ConfigError, match="rough pair: rate_coefficient: expected a shear limit above 0"):
        refuse_beyond_limits(rubbing(2.0), [1e6], [1.3 * np.exp(-0.501), 1.3])


def test_grids_beyond_memory_are_refused():
    refuse_large_grid(64, "test")
    with pytest.raises(ConfigError, match="test: expected .* GB for a block of 3200000 x 3200000 surface nodes"):
        refuse_large_grid(3_200_000, "test")


def test_a_body_softer_than_the_highest_pressure_is_refused():
    soft = rubbing()
    soft = replace(soft, pair=replace(soft.pair, hardness=2e6, yielding="disc"))
    refuse_beyond_limits(soft, [1e6, 1.9e6], [1.0])
    with pytest.raises(ConfigError, match=r"rough pair: disc.hardness: expected above the highest pressure, 3e\+06 Pa"):
        refuse_beyond_limits(soft, [1e6, 3e6], [1.0])
