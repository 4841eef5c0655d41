"""A brake of one's own, from 'new' to its report."""

import numpy as np
import pytest

from pipeline.contract import store
from pipeline.products import Sensitivities
from tests.commands import brakechain


@pytest.fixture
def quick(tmp_path):
    """A new case on coarse grids."""
    brakechain("new", tmp_path / "my_brake", "--quick")
    return tmp_path / "my_brake_quick.yaml"


def test_a_new_case_is_ready_to_run(quick, tmp_path):
    """Both files, in both commands that compute nothing."""
    for file in (quick, quick.with_name("my_brake.yaml")):
        for command in (["chain"], ["run", "--dry-run"]):
            done = brakechain(*command, file, "--run", tmp_path / "run")
            assert "structure        would run" in done.stdout


@pytest.mark.slow
def test_its_report_is_of_no_paper(quick, tmp_path):
    brakechain("run", quick, "--run", tmp_path / "run", "--workers", "1")
    page = (tmp_path / "run" / "report.html").read_text()
    assert "What matters most for the mode at" in page
    assert "<h2>Measure these</h2>" in page and page.index("Measure these") < page.index("1. ")
    shown = page.partition("</style>")[2]
    assert not any(word in shown for word in ("paper", "published", "Tuned", ">tuned<", "Table 1", "multi-scale"))


@pytest.mark.slow
def test_derivatives_by_vectors_are_those_of_the_case_computed_again(quick, tmp_path):
    """Of the strongest mode to the density of the disc, which both ways can give, within 3 %."""
    quick.write_text(quick.read_text() + "sensitivities: {modes: 1, remedies: 0, differences: [{setting:"
                                         " structure.disc.density, variation: 0.01}]}\n")
    brakechain("run", quick, "--run", tmp_path / "run", "--until", "sensitivities", "--workers", "1")
    made = store.read(Sensitivities, tmp_path / "run" / "sensitivities.h5")
    vectors, again = made.derivative[0, np.array(made.parameter, str) == "structure.disc.density"]
    assert made.method[-1] == "differences" and again == pytest.approx(vectors, rel=0.03)
