"""A first look is the case on coarse grids and meshes: it can be built, and nothing in it is finer than the case."""

from pathlib import Path

import pytest

import stages
from pipeline.case_models.early.first_look import coarse
from pipeline.contract import case, settings

CONFIGS = Path(__file__).parents[3] / "configs"


def loaded(name, *overrides):
    return case.load(CONFIGS / f"{name}.yaml", stages.CHAINS, stages.load, overrides)


@pytest.fixture(scope="module")
def brake():
    return loaded("disc_brake")


def test_nothing_is_finer_than_in_the_case_and_all_of_it_is_understood(brake):
    changes = coarse(brake.sections)
    looked = brake.varied(changes).sections
    for stage in brake.stages:
        stage.check(looked)
    given, taken = ({f"{stage}.{leaf.key}": leaf.value for stage, section in sections.items()
                     for leaf in settings.leaves(section)} for sections in (brake.sections, looked))
    differing = {key for key in {**given, **taken} if given.get(key) != taken.get(key)}
    assert set(changes) - differing == {"reduced_model.fixed_below"} and differing < set(changes)
    cells = {key for key in changes if "cells" in key or "nodes" in key}
    assert len(cells) > 8 and all(taken[key] < given[key] for key in cells)
    assert all(taken[key] == 2 * given[key] for key in changes if "element_size" in key)
    assert taken["structure.pressures"] == (3e6,) and taken["complex_modes.speeds"] == (10.25,)
    assert taken["structure.frequency_max"] == taken["complex_modes.frequency_max"] == 20e3


def test_counts_that_a_mesh_needs_stay(brake):
    changed = brake.varied({"structure.disc.web_cells": 2, "structure.disc.ring_cells": 9,
                            "structure.pad.lining_layers": 1, "structure.piston.angular_cells": 8,
                            "surface.nodes": 80})
    few = coarse(changed.sections)
    assert changed.varied(few).sections["structure"].disc.web_cells == 2
    assert few["structure.disc.ring_cells"] == 5 and few["structure.pad.lining_layers"] == 1
    assert few["structure.piston.angular_cells"] == 8 and few["surface.nodes"] == 80


@pytest.mark.parametrize("changes", [{"structure.disc.angular_cells": 40},
                                     {"micro_friction.pad.inclusions": {"modulus_factor": 3}},
                                     {"structure.caliper.mesh_file": str(CONFIGS / "disc_brake.yaml")}])
def test_a_coarse_case_particles_and_mesh_files_have_no_first_look(brake, changes):
    assert coarse(brake.varied(changes).sections) == {}


def test_other_systems_have_none():
    assert coarse(loaded("belt").sections) == {}
