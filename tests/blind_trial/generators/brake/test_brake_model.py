"""The workshop's model of the practice brake: an ordinary case, near the brake that it was drawn from."""

from functools import partial

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake import brake, brake_model, brake_parts
from pipeline.blind_trial.generators.brake.annulus import thick, thin
from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.corrections import corrected
from pipeline.physics.virtual_rig.modes import modes
from pipeline.physics.virtual_rig.response import Run
from stages.bench import bench
from stages.diagnosis import diagnosis
from stages.lumped import lumped
from stages.reduced_model import reduced_model
from tests.blind_trial.generators.imported import imported
from tests.studies.forced import filled

SHAPE = brake_parts.SHAPES[1]


@pytest.fixture(scope="module")
def reduced():
    """The Bench of the case, and its section diagnosis."""
    section = partial(filled, brake_model.nominal(SHAPE))
    model = reduced_model(lumped(settings=section(lumped)), settings=section(reduced_model))
    return benches.built(model, section(bench)), section(diagnosis)


def test_it_uses_nothing_of_the_diagnosis():
    here = "pipeline.blind_trial.generators"
    assert not [m for m in imported(f"{here}.brake.brake_model") if not m.startswith(here) and (
        m.startswith("pipeline") and not m.startswith("pipeline.contract.errors"))]


def test_every_name_in_the_case_means_something(reduced):
    """Parameters are numbers of the bench, hidden physics has its place, and pairs of waves are doublets."""
    whole, asked = reduced
    corrected(whole, dict.fromkeys(asked.parameters, 1.0))
    assert {f"{brake_model.WORDS[order]} 1" for order in brake_model.SPLIT} <= set(whole.doublets)
    assert set(brake_model.POINTS) == set(whole.model.sensor_name)
    assert set(brake_model.JOINTS) <= set(whole.model.joints.name)
    assert set(asked.effects) == {*brake.HIDDEN, *brake.DECOYS}


@pytest.mark.exact
def test_points_of_a_lining_carry_what_the_whole_does(reduced):
    """Their springs add up to it, and hold its pitch as evenly spread ones do: k r^2 sin^2 t over the face."""
    whole, _ = reduced
    rows = whole.model.contacts.normal[:12]
    pitch = whole.model.coordinate_body == whole.model.body_name.index("pad_outer")
    own = rows[:, pitch]
    full = brake_parts.built(brake_parts.NOMINAL, SHAPE)
    half = len(full.share) // 2
    wanted = full.share[:half] @ full.normal[:half, full.disc + 2] ** 2
    np.testing.assert_allclose(np.sum(own**2, axis=0)[1:] / 12, (1.0, wanted), rtol=1e-5)
    assert 12 * np.mean(whole.law.stiffness) == pytest.approx(brake_parts.NOMINAL["contact"])


@pytest.mark.exact
@pytest.mark.parametrize("run", [brake.Run("rest", 700.0, 0.0, 0.0), brake.Run("sliding", 700.0, 0.5, 0.0)],
                         ids=lambda r: r.name)
def test_with_the_waves_of_the_thick_disc_it_has_the_roots_of_the_brake(reduced, run):
    """What is left are modes that it leaves out, of some compliance: a share of 3e-3, before any value is fitted."""
    told, plate = {}, brake_model.drawn(SHAPE)
    radius = np.array([SHAPE[2] - brake_parts.INSET - brake_parts.WIDTH / 2])
    for order, word in enumerate(brake_model.WORDS):
        true, coarse = thick(plate, order), thin(plate, order)
        for k, name in enumerate((word, f"{word}_circle")[:1 + (word in brake_model.CIRCLES)]):
            told[f"bodies.{name}.frequency"] = true.frequency[k] / coarse.frequency[k]
            told[f"bodies.{name}.modal_mass"] = (coarse.at(radius)[0][0, k] / true.at(radius)[0][0, k]) ** 2
    conditions = {"press": run.load, "speed": run.speed}
    found, _ = modes(corrected(reduced[0], told), Run("", 1.0, 100.0, conditions=conditions))
    wanted = np.linalg.eigvals(brake.small_motion(brake_parts.built(brake_parts.NOMINAL, SHAPE), run))
    low, high = brake_model.BAND
    wanted = wanted[(wanted.imag > 2 * np.pi * low) & (wanted.imag < 2 * np.pi * high)]
    assert len(wanted) >= 15
    for root in wanted:
        assert np.min(abs(found - root)) < 3e-3 * abs(root)
