"""Section of a matrix: its file must be there."""

import pytest

from pipeline.case_models.matrices.sections import Term
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill


def test_a_term_names_a_file_that_is_there(tmp_path):
    (tmp_path / "k.mtx").write_text("")
    found = fill(Term, {"file": str(tmp_path / "k.mtx"), "at_frequency": "1.6 kHz"}, "case")
    assert found.at_frequency == 1600.0 and found.times == "1" and found.symmetry is None
    with pytest.raises(ConfigError, match="expected a file"):
        fill(Term, {"file": str(tmp_path / "m.mtx")}, "case")
    assert fill(Term, {"file": str(tmp_path / "k.mtx"), "symmetry": "skew-symmetric"}, "case").symmetry
    with pytest.raises(ConfigError, match="case.symmetry: .*'symmetric', 'skew-symmetric' or 'general'"):
        fill(Term, {"file": str(tmp_path / "k.mtx"), "symmetry": "upper"}, "case")
