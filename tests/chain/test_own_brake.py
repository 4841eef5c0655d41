"""A brake of one's own, from 'new' to its report."""

import pytest

from tests.chain.conftest import brakechain


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
    assert "<h2>Measure these</h2>" in page and page.index("Measure these") < page.index("1. ")
    shown = page.partition("</style>")[2]
    assert not any(word in shown for word in ("paper", "published", "Tuned", ">tuned<", "Table 1", "multi-scale"))
