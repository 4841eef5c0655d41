"""Files of a pulled block: the stages read them, and the courses are those of the truth."""

import numpy as np
import yaml

from pipeline.blind_trial.generators.switching.pulled_block import made
from pipeline.blind_trial.generators.switching.pulled_files import hides, nominal, write
from pipeline.blind_trial.generators.systems import SYSTEMS, Draw
from pipeline.case_models.runs import recorded
from pipeline.contract.units import to_si
from pipeline.effects import CATALOGUE
from pipeline.products import Recording
from pipeline.recordings.neutral import read_neutral
from stages.bench import bench
from stages.lumped import lumped
from stages.reduced_model import reduced_model
from tests.studies.forced import filled


def test_two_files_that_the_stages_read_with_the_courses_of_the_truth(tmp_path):
    told = write(Draw(1, "pulled_block", "control", (), 0.0, 0.01), tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["nominal.yaml", "recordings.h5"] and told["effects"] == []
    document, case = yaml.safe_load((tmp_path / "nominal.yaml").read_text()), made(1, "control")
    model = reduced_model(lumped(settings=filled(document, lumped)), settings=filled(document, reduced_model))
    runs = recorded(Recording(source=[""], runs=read_neutral(tmp_path / "recordings.h5")), filled(document, bench),
                    model)
    for (name, run), course in zip(runs.items(), case.courses, strict=True):
        led = run.run.inputs["machine"]
        np.testing.assert_allclose(led, course.displacement(run.run.time), atol=1e-8 * abs(led).max(), err_msg=name)


def test_values_and_names_are_those_of_the_case():
    case = made(1, "control")
    lumps = nominal(case)["lumped"]
    assert np.isclose(to_si(lumps["springs"]["machine"]["stiffness"], "N/m", ""), case.belief.stiffness, rtol=1e-5)
    known = {effect.name for effect in CATALOGUE}
    classes = hides()
    assert all(form in known for form, in classes["effect"]) and not any(form in known for form, in classes["foreign"])
    assert SYSTEMS["pulled_block"].hides == classes
