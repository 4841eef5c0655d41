"""Stage matrix_modes: the flutter of two masses in closed form; the map; the public industrial brake."""

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError
from pipeline.contract.settings import fill
from stages.matrices import Settings as System
from stages.matrices import matrices
from stages.matrix_modes import Settings, matrix_modes

TWO_PI = 2.0 * np.pi
#: k1, k2 N/m on 1 kg each; friction couples them by +c and -c: flutter from c = (k2 - k1) / 2 on
SOFT, STIFF = 0.9e6, 1.1e6
DAMPED = 2.0


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    folder = tmp_path_factory.mktemp("matrices")
    for name, matrix in (("m", np.eye(4)), ("k", np.diag([SOFT, STIFF, 4e6, 5e6])), ("d", DAMPED * np.eye(4))):
        scipy.io.mmwrite(folder / f"{name}.mtx", scipy.sparse.csr_matrix(matrix))
    coupled = np.zeros((4, 4))
    coupled[0, 1], coupled[1, 0] = 2e5, -2e5
    scipy.io.mmwrite(folder / "q.mtx", scipy.sparse.csr_matrix(coupled))
    return matrices(settings=fill(System, {
        "mass": {"M": {"file": str(folder / "m.mtx")}}, "damping": {"D": {"file": str(folder / "d.mtx")}},
        "stiffness": {"K": {"file": str(folder / "k.mtx")},
                      "Q": {"file": str(folder / "q.mtx"), "times": "friction"}}}, "case"))


def solved(system, **settings):
    return matrix_modes(system, settings=fill(Settings, {"frequency_max": "300 Hz", **settings}, "case"))


@pytest.mark.exact
def test_the_flutter_of_two_masses(system):
    """s^2 + d s + (k1 + k2) / 2 = +- i sqrt(c^2 - (k2 - k1)^2 / 4)."""
    found = solved(system, speeds=["1 rad/s"], map_friction=[0, 0.4, 0.6, 1])
    middle, split = (SOFT + STIFF) / 2, np.sqrt(2e5**2 - (STIFF - SOFT)**2 / 4)
    expected = -DAMPED / 2 + np.sqrt(DAMPED**2 / 4 - middle + 1j * split)
    assert found.roots.unstable_root == pytest.approx([expected], rel=1e-9)
    assert found.roots.residual[0] < 1e-6 and len(found.roots.root) == 2
    assert found.map_unstable.tolist() == [[0, 0, 1, 1]]
    assert found.map_growth[0, :2] == pytest.approx(-DAMPED / 2, abs=1e-6)
    assert found.map_growth[0, 3] == pytest.approx(expected.real)
    slope = 1j * 2e5**2 / split / (2 * expected + DAMPED)
    assert found.roots.per_friction == pytest.approx([slope], rel=1e-5)
    assert found.roots.per_term[0, list(found.term).index("Q")] == pytest.approx(slope, rel=1e-5)
    assert found.roots.per_speed == pytest.approx([0.0])


def test_a_stable_system_has_no_unstable_modes(system):
    found = solved(system, speeds=["1 rad/s", "2 rad/s"], friction=0.3, map_friction=[0.3])
    assert not len(found.roots.unstable_root) and found.map_unstable.tolist() == [[0], [0]]
    assert found.roots.root_operating.tolist() == [0, 0, 1, 1]
    with pytest.raises(ConfigError, match="coefficients of friction from 0 on"):
        matrix_modes.check({"matrix_modes": Settings(map_friction=(-1.0,))})
