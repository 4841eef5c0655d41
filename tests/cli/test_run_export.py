"""'brakechain export': what it writes and what it says."""

import pytest
from click.testing import CliRunner

from pipeline.cli.run_export import export
from pipeline.contract.errors import BrakechainError
from tests.exports.small_runs import brake_run, flutter_run


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return flutter_run(tmp_path_factory.mktemp("run"))


def told(*words):
    done = CliRunner().invoke(export, [str(word) for word in words], standalone_mode=False)
    if done.exception:
        raise done.exception
    return done.output


def test_matrices_of_a_state_with_their_case(run, tmp_path):
    said = told("matrices", run, tmp_path / "out", "--state", 1, "--format", "mtx")
    assert "6 matrices, reduced sliding model, operating point 1 (2 Pa, 3 rad/s)" in said
    assert f"brakechain run {tmp_path / 'out' / 'out.yaml'}" in said
    assert {p.name for p in (tmp_path / "out").iterdir()} >= {"mass.mtx", "circulatory.mtx", "out.yaml"}


@pytest.mark.parametrize(("options", "expected"), [
    (("--state", 7), "--state: expected one of 0"), (("--full",), "expected the product structure, found no file")])
def test_what_cannot_be_exported_is_one_sentence(run, tmp_path, options, expected):
    with pytest.raises(BrakechainError, match=expected):
        told("matrices", run, tmp_path / "out", *options)
    assert not (tmp_path / "out").exists()


def test_modes_by_the_suffix_of_their_file(tmp_path):
    run = brake_run(tmp_path)
    for name, options in (("modes.unv", ()), ("modes.vtkhdf", ()), ("disc.uff", ("--body", "disc"))):
        assert "nodes, " in told("modes", run, tmp_path / name, *options) and (tmp_path / name).stat().st_size
    with pytest.raises(BrakechainError, match=r"expected a name that ends in .unv, .uff or .vtkhdf, found '.stl'"):
        told("modes", run, tmp_path / "modes.stl")


def test_a_unit_by_its_suffix(run, tmp_path):
    with pytest.raises(BrakechainError, match=r"expected a name that ends in .fmu, found '.zip'"):
        told("fmu", run, tmp_path / "rig.zip")
    pytest.importorskip("pythonfmu", reason="the extra 'fmu' is not installed")
    said = told("fmu", run, tmp_path / "rig.fmu", "--state", 1)
    assert "linearised about operating point 1 (2 Pa, 3 rad/s)" in said
    assert "inputs: pressure, force.press, force_at.along" in said and (tmp_path / "rig.fmu").stat().st_size


@pytest.mark.parametrize("name", ["modes.unv", "rig.fmu"])
def test_a_file_that_is_there_is_refused_before_anything_is_read(name, tmp_path):
    """The folder holds no products, which would be told next."""
    (tmp_path / name).write_text("mine")
    with pytest.raises(BrakechainError, match="expected a name that is free"):
        told("modes" if name.endswith("unv") else "fmu", tmp_path, tmp_path / name)
    assert (tmp_path / name).read_text() == "mine"
