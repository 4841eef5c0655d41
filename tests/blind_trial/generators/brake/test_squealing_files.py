"""Files of the squealing bench: a case that runs, close to its brake, that does not tell what is true."""

from functools import partial

import numpy as np
import pytest

from pipeline.blind_trial.generators.brake import brake_parts, squealing_brake, squealing_files
from pipeline.blind_trial.generators.brake.squealing_brake import DRAWN, ONE_WAY, TWO_WAY, growing, inclined
from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.scatter import family
from pipeline.contract import documents
from pipeline.diagnosis.published.line_hypotheses import on_rigid_disc
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.recordings.neutral import read_neutral
from stages.complex_modes import complex_modes
from stages.line_evidence import line_evidence
from stages.lumped import lumped
from stages.reduced_model import reduced_model
from tests.blind_trial.generators.imported import imported
from tests.studies.forced import filled

SHAPE = brake_parts.SHAPES[1]


def test_it_uses_nothing_of_the_tool():
    here = "pipeline.blind_trial.generators"
    assert not [m for m in imported(f"{here}.brake.squealing_files") if not m.startswith(here) and (
        m.startswith("pipeline") and not m.startswith("pipeline.contract.errors"))]


@pytest.fixture(scope="module")
def nominal():
    """Products of the case of a workshop that tapped its disc without error, on the brake as drawn."""
    class Exact:
        def standard_normal(self):
            return 0.0

    document = squealing_files.nominal(SHAPE, squealing_files.tapped(DRAWN, SHAPE, Exact()))
    section = partial(filled, document)
    model = reduced_model(lumped(settings=section(lumped)), settings=section(reduced_model))
    modes = complex_modes(model, None, None, None, settings=section(complex_modes, followed=0))
    return model, modes, section(line_evidence)


@pytest.mark.parametrize("rigid", [False, True])
def test_its_unstable_modes_are_those_of_the_brake_as_drawn(nominal, rigid):
    """Within the model error that the case states, at the middle load."""
    model, modes, asked = nominal
    points = StabilitySettings.of(modes)
    case = family(model, 1, None, points)
    case = on_rigid_disc(case, asked.disc) if rigid else case
    roots = sampled(case, [6.0], points.frequency_max).roots(NOMINAL, 6.0)
    found = np.sort(roots[roots.real > 5].imag) / (2 * np.pi)
    hidden = {"contact_damping": {"damping": squealing_brake.CONTACT_LOSS}}
    brake = inclined(brake_parts.built(DRAWN, SHAPE, hidden=hidden), DRAWN)
    expected = growing(squealing_brake.held(brake) if rigid else brake, 700.0, 6.0).imag / (2 * np.pi)
    expected = expected[expected < points.frequency_max]
    strong = [f for f in expected if abs(found - f).min() < 2 * asked.model_error * f]
    assert len(strong) == len(expected) >= 1


def test_the_public_folder_does_not_tell_the_kind(tmp_path):
    truths = {kind: squealing_files.write(7, kind, tmp_path / kind) for kind in (TWO_WAY, ONE_WAY)}
    documents_of = [documents.read_yaml(tmp_path / kind / "nominal.yaml") for kind in truths]
    assert documents_of[0] == documents_of[1] and truths[TWO_WAY]["values"] == truths[ONE_WAY]["values"]
    assert sorted(p.name for p in (tmp_path / TWO_WAY).iterdir()) == ["nominal.yaml", "recordings.h5"]
    runs = read_neutral(tmp_path / TWO_WAY / "recordings.h5")
    assert len(runs) == 6 and all(not str(run.description) for run in runs.values())
    assert all(set(run.conditions) == {"pressure", "speed"} and set(run.lines) == {"microphone"}
               for run in runs.values())
