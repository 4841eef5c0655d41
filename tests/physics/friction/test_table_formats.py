"""Tables of other programs hold every point: each text is read back by its own rules."""

from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.physics.friction import table_formats

PRESSURE, SPEED, DISTANCE = np.array([5e5, 1e6, 3e6]), np.array([0.8, 1.3]), np.array([0.0, 1e-2])
FRICTION = 0.4 + 1e-8 * PRESSURE[:, None, None] + 0.01 * SPEED[:, None] + DISTANCE
AXES = PRESSURE, SPEED, DISTANCE


@pytest.mark.exact
def test_csv():
    rows = np.array([line.split(",") for line in
                     table_formats.as_csv(*AXES, FRICTION, FRICTION / 10).splitlines()[1:]], float)
    assert rows.shape == (12, 5)
    np.testing.assert_allclose(rows[:, 3].reshape(FRICTION.shape), FRICTION, rtol=1e-9)
    np.testing.assert_allclose(rows[:, 4], rows[:, 3] / 10, rtol=1e-9)


@pytest.mark.exact
def test_abaqus():
    lines = [line for line in table_formats.as_abaqus(*AXES, FRICTION).splitlines() if not line.startswith("**")]
    assert lines[0] == "*FRICTION, DEPENDENCIES=1"
    rows = np.array([[float(v.strip() or "nan") for v in line.split(",")] for line in lines[1:]])
    assert np.isnan(rows[:, 3]).all() and len(rows) == FRICTION.size
    for mu, speed, pressure, _, distance in rows:
        at = tuple(int(np.flatnonzero(axis == v)[0]) for axis, v in zip(AXES, (pressure, speed, distance), strict=True))
        assert mu == pytest.approx(FRICTION[at], rel=1e-9)
    order = [tuple(row) for row in rows[:, [4, 1, 2]]]
    assert order == sorted(order)


@pytest.mark.exact
def test_adams():
    text = "\n".join(line for line in table_formats.as_adams(*AXES, FRICTION).splitlines() if not line.startswith("!"))
    splines = text.replace("\n", " ").split("SPLINE/")[1:]
    assert [s.split()[0] for s in splines] == ["1", "2"]
    for s, spline in enumerate(splines):
        x, *curves = [[float(v) for v in part.strip(" ,").split(",")] for part in
                      spline.split(",", 1)[1].replace("X =", "").split("Y =")]
        assert x == list(SPEED) and [c[0] for c in curves] == list(PRESSURE)
        np.testing.assert_allclose([c[1:] for c in curves], FRICTION[:, :, s], rtol=1e-9)


def test_long_axes_go_on_in_the_next_line():
    text = table_formats.as_adams(PRESSURE, np.arange(1.0, 13.0), DISTANCE, np.ones((3, 12, 2)))
    assert max(len(line) for line in text.splitlines()) < 120
    assert ", X = 1, 2, 3, 4, 5\n, 6, 7, 8, 9, 10\n, 11, 12\n" in text


@pytest.mark.exact
def test_modelica():
    lines = [line for line in table_formats.as_modelica(*AXES, FRICTION).splitlines() if not line.startswith("# ")]
    assert lines[0] == "#1" and lines[1] == "double mu_1(4,3)" and lines[6] == "double mu_2(4,3)"
    table = np.array([line.split() for line in lines[7:11]], float)
    np.testing.assert_allclose(table[0], [0, *SPEED])
    np.testing.assert_allclose(table[1:, 0], PRESSURE)
    np.testing.assert_allclose(table[1:, 1:], FRICTION[:, :, 1], rtol=1e-9)


def test_abaqus_reads_the_temperatures_of_the_bodies():
    warm = SimpleNamespace(temperature=np.array([0.0, 200.0]), friction=np.array([FRICTION, 0.9 * FRICTION]))
    lines = [line for line in table_formats.as_abaqus(*AXES, FRICTION, warm).splitlines() if line[0] not in "*"]
    assert len(lines) == 2 * FRICTION.size
    rows = np.array([[float(part) for part in line.split(",")] for line in lines])
    assert set(rows[:, 3]) == {0.0, 200.0}
    np.testing.assert_allclose(rows[rows[:, 3] == 200.0][:, 0], 0.9 * rows[rows[:, 3] == 0.0][:, 0])
