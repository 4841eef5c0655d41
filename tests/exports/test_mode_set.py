"""Modes of a run on a mesh: which there are, and what is refused."""

import numpy as np
import pytest

from pipeline.contract import ConfigError, ProductError, store
from pipeline.exports.mode_set import body_modes_of, complex_modes_of
from pipeline.products import ComplexModes, Structure
from tests.exports.small_runs import changed, written


def test_unstable_modes_on_the_surface(brake):
    modes, found = store.read(ComplexModes, brake / "complex_modes.h5"), complex_modes_of(brake)
    assert found.is_complex and found.shape.shape == (len(modes.unstable_root), len(found.node), 3)
    np.testing.assert_allclose(found.frequency, modes.unstable_root.imag / (2 * np.pi))
    assert f"operating point {modes.unstable_operating[0]} (" in found.about[0]
    assert abs(found.shape).max(axis=(1, 2)) == pytest.approx(1.0)


def test_real_modes_of_a_body(brake):
    disc, found = store.read(Structure, brake / "structure.h5").disc, body_modes_of(brake, "disc")
    assert not found.is_complex and found.body_name == ("disc",) and not found.root.real.any()
    np.testing.assert_allclose(found.frequency, disc.frequency)
    np.testing.assert_array_equal(found.cells[0][1], disc.element)


def test_what_is_not_there_is_refused(brake, rig, tmp_path):
    with pytest.raises(ConfigError, match="--body: expected one of disc, pad_outer, .*, found 'rotor'"):
        body_modes_of(brake, "rotor")
    with pytest.raises(ConfigError, match="nodes on the surface of the bodies, found none, as of lumped systems"):
        complex_modes_of(rig)
    modes = store.read(ComplexModes, brake / "complex_modes.h5")
    none = {name: getattr(modes, name)[:0] for name in modes.__dict__ if name.startswith("unstable_")}
    for path in brake.glob("reduced_model.h5"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    written(tmp_path, changed(modes, **none))
    with pytest.raises(ConfigError, match="expected unstable modes, found none; export modes of a body: --body"):
        complex_modes_of(tmp_path)
    with pytest.raises(ProductError, match="expected the product structure"):
        body_modes_of(tmp_path, "disc")


def test_a_body_without_modes_is_refused(brake, tmp_path):
    structure = store.read(Structure, brake / "structure.h5")
    rigid = changed(structure.caliper, frequency=[], shape=structure.caliper.shape[:0])
    written(tmp_path, changed(structure, caliper=rigid))
    with pytest.raises(ConfigError, match="--body: expected one with modes: disc, .*, found caliper"):
        body_modes_of(tmp_path, "caliper")
