"""Names of the groups that say where joints act, as the joints of a brake with all bodies are called."""

import numpy as np
import pytest

from pipeline.physics.fem.mesh import Mesh
from pipeline.systems.disc_brake import build
from pipeline.systems.mesh_files.places import PLACES, named_mean
from stages.structure import Settings
from tests.systems.test_disc_brake_bracket import BODIES

pytestmark = pytest.mark.exact


def test_every_joint_has_its_places():
    for name in build(Settings(**BODIES)).joints.name:
        words = [w for w in name.upper().split("_") if w not in ("AXIAL", "TANGENTIAL", "RADIAL", "NORMAL")]
        if words[0] == "PISTON" and words[-1].isdigit():
            words.insert(1, "RIM")
        assert "_".join(words) in PLACES


def test_the_longer_name_goes_first():
    mesh = Mesh(np.eye(3), np.empty((0, 20), int), "hexahedron20", np.empty((0, 3), int),
                {"SEAL_INNER": np.array([[0]]), "SEAL": np.array([[1], [2]])})
    assert list(named_mean(mesh, "seal_inner").toarray()[0]) == [1, 0, 0]
    assert list(named_mean(mesh, "seal_outer").toarray()[0]) == [0, 0.5, 0.5]
    assert named_mean(mesh, "pressed") is None
