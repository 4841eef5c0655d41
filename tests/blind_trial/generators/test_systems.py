"""Systems of a trial: each writes its cases neutrally, repeatably, and tells a truth that can be scored."""

import numpy as np
import pytest

from pipeline.blind_trial.generators.spring_mass.hidden_laws import HIDDEN
from pipeline.blind_trial.generators.spring_mass.placement import places
from pipeline.blind_trial.generators.systems import CLASSES, SYSTEMS, Draw, _apart
from pipeline.recordings.neutral import read_neutral
from tests.blind_trial.generators.imported import imported

#: cases whose draws are refitted until what they hide can be seen
LONG = (pytest.mark.slow, pytest.mark.study)


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=lambda s: s.name)
def test_what_a_system_hides_is_sorted_into_known_classes(system):
    assert set(system.hides) <= set(CLASSES) and system.sizes and system.noises and system.weight > 0
    assert system.name == next(name for name, one in SYSTEMS.items() if one is system)
    for kind, groups in system.hides.items():
        assert groups and all(isinstance(group, tuple) for group in groups), kind
        assert all(len(g) == 2 for g in groups) or kind != "pair"


def test_no_generator_is_made_of_the_models_of_the_diagnosis():
    assert not [m for m in imported("pipeline.blind_trial.generators.systems") if m.startswith((
        "pipeline.effects", "pipeline.case_models", "pipeline.diagnosis", "pipeline.inference", "pipeline.physics",
        "pipeline.systems", "stages"))]


@pytest.mark.parametrize("kind, hidden", [
    ("control", ()), pytest.param("effect", ("coulomb",), marks=LONG), ("sensor", ("clipping",)),
    pytest.param("pair", ("coulomb", "attached_mass"), marks=LONG)])
def test_a_forced_rig_leaves_two_files_and_tells_its_truth(tmp_path, kind, hidden):
    draw = Draw(3, "forced_rig", kind, hidden, 0.3, 0.01)
    truth = SYSTEMS["forced_rig"].write(draw, tmp_path / "case")
    assert sorted(p.name for p in (tmp_path / "case").iterdir()) == ["nominal.yaml", "recordings.h5"]
    assert (truth["class"], tuple(e["name"] for e in truth["effects"])) == (kind, hidden)
    assert truth["noise"] == 0.01 and (0.2 < truth["size"] < 0.45 if hidden else truth["size"] == 0)
    first = read_neutral(tmp_path / "case" / "recordings.h5")["run_0"].channels["x_0"].samples
    assert np.std(first) > 0


@pytest.mark.parametrize("kind, hidden", [("control", ()), pytest.param("sensor", ("clipping",), marks=LONG)])
def test_a_seed_draws_the_same_forced_rig_again_and_another_seed_another(tmp_path, kind, hidden):
    draw = Draw(3, "forced_rig", kind, hidden, 0.3, 0.01)
    truth = SYSTEMS["forced_rig"].write(draw, tmp_path / "case")
    again = SYSTEMS["forced_rig"].write(draw, tmp_path / "again")
    assert again == truth
    for name in ("nominal.yaml", "recordings.h5"):
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "case" / name).read_bytes()
    other = SYSTEMS["forced_rig"].write(Draw(4, "forced_rig", kind, hidden, 0.3, 0.01), tmp_path / "other")
    assert other != truth


def test_a_pair_sits_at_two_links():
    pieces = HIDDEN["quadratic_damping"], HIDDEN["moving_base"]
    for seed in range(30):
        masses, at = _apart(np.random.default_rng(seed), pieces)
        first, second = (places(piece, masses)[number][1] for piece, number in zip(pieces, at, strict=True))
        assert first != second and second in ("link_0", "link_3")


def test_below_the_threshold_little_is_left_and_a_coarse_model_hides_nothing(tmp_path):
    below = SYSTEMS["forced_rig"].write(Draw(1, "forced_rig", "below", ("coulomb",), 0.3, 0.1), tmp_path / "below")
    coarse = SYSTEMS["coarse_rig"].write(Draw(1, "coarse_rig", "solver", (), 0.0, 0.01), tmp_path / "coarse")
    assert below["class"] == "below" and 0 < below["left"] < 2.2
    assert (coarse["class"], coarse["effects"], coarse["system"]) == ("solver", [], "coarse_rig")
