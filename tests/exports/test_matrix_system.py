"""Systems of matrices of a run: which can be had, and what is refused."""

from dataclasses import fields

import numpy as np
import pytest

from pipeline.contract import ConfigError, ProductError, store
from pipeline.exports.matrix_system import full_system, is_given_as_matrices, reduced_system
from pipeline.products import ComplexModes, ReducedModel, Structure
from tests.exports.small_runs import changed, written


def test_the_most_unstable_operating_point_is_the_default(brake):
    modes = store.read(ComplexModes, brake / "complex_modes.h5")
    system = reduced_system(brake)
    assert f"operating point {modes.unstable_operating[0]} (" in system.about
    assert system.speed == modes.operating_speed[modes.unstable_operating[0]] and system.highest == 8e3
    assert not is_given_as_matrices(brake)


def test_an_operating_point_that_does_not_exist_is_refused_with_those_that_do(brake):
    with pytest.raises(ConfigError, match=r"--state: expected one of 0 \(1 MPa, 8 rad/s\); .*3 \(2 MPa, 12 rad/s\), "
                                          "found 4"):
        reduced_system(brake, 4)


def test_a_missing_product_is_named(brake, rig, tmp_path):
    with pytest.raises(ProductError, match="structure.h5: expected the product structure, found no file"):
        full_system(rig)
    written(tmp_path, store.read(ComplexModes, brake / "complex_modes.h5"))
    with pytest.raises(ProductError, match="expected the product reduced_model"):
        reduced_system(tmp_path)


def with_another(product, run, folder):
    """Copy the products of a ``run`` to a ``folder``, ``product`` in place of its own."""
    for path in run.glob("*.h5"):
        if path.stem != product.name:
            (folder / path.name).write_bytes(path.read_bytes())
    written(folder, product)


def test_products_of_different_runs_are_refused(brake, tmp_path):
    model = store.read(ReducedModel, brake / "reduced_model.h5")
    with_another(changed(model, input_area=1.01 * model.input_area), brake, tmp_path)
    with pytest.raises(ProductError, match="export: contact forces: expected those of complex_modes.h5"):
        reduced_system(tmp_path)


def test_damping_ratios_are_not_in_full_matrices(brake, tmp_path):
    structure = store.read(Structure, brake / "structure.h5")
    with_another(changed(structure, disc=changed(structure.disc, damping_ratio=0.01)), brake, tmp_path)
    with pytest.raises(ConfigError, match="--full: .* found damping ratios of bodies"):
        full_system(tmp_path)


def test_full_and_reduced_systems_have_the_same_terms_and_sensors(brake):
    full, reduced = full_system(brake, 2), reduced_system(brake, 2)
    assert {t.name for t in full.terms} == {t.name for t in reduced.terms}
    assert {f.name for f in fields(full)} >= {"terms", "rows"}
    assert full.rows["sensors"].shape[0] == reduced.rows["sensors"].shape[0]
    loss = next(t.matrix for t in full.terms if t.name == "hysteretic_loss")
    assert np.isrealobj(loss.toarray())
