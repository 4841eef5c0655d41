"""Chapters of the beam on beam: coalescences, scatter, geometry, and why a mode is not heard."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.products import BeamGeometry, BeamOnBeam, Comparison, ComplexModes, MotionScatter
from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models import beam_on_beam as chapters
from tests.views.products_for_views import filled

LOOK = Look(dpi=50)
FREQUENCY = np.linspace(100, 1e4, 500)


def beams(**given):
    values = {"element": "plane", "curve_frequency": FREQUENCY, "curve_friction": 0.3 * np.sin(FREQUENCY / 900),
              "closed_frequency": [200.0, 2500.0, 3100.0], "onset_frequency": [400.0, 2800.0],
              "onset_friction": [0.16, 0.12], "check_onset_frequency": [402.0], "check_onset_friction": [0.15]}
    return filled(BeamOnBeam, **{**values, **given})


def modes():
    friction = np.linspace(0, 0.5, 20)
    root = np.zeros((1, 20, 2), complex)
    root[0, :, 0] = 2j * np.pi * (2500 + 600 * friction)
    root[0, :, 1] = 300 * (friction - 0.12) + 2j * np.pi * (3100 - 600 * friction)
    return filled(ComplexModes, friction=friction, root=root)


def scatter(runs=4):
    return filled(MotionScatter, formulation=["hard", "hard", "forward", "forward"][:runs], step=[1e-6, 2e-6] * 2,
                  seed=[1, 1, 2, 2], fundamental=[2680.0, 2700.0, 2690.0, 2700.0], peak_force=[40.0] * 4,
                  peak_slip=[0.05] * 4, status_share=[[0.2, 0.5, 0.3]] * 4, vibrating_share=[0.4, 0.5, 0.5, 0.6],
                  harmonic_level=[[0.0, -20.0, -40.0]] * 4, harmonic_height=[[25.0, 20.0, 10.0]] * 4,
                  low_level=[-30.0] * 4, imbalance=[1e-5, 1e-5, 1e-3, 2e-3])


def geometry(level):
    names = [f"p{k}" for k in range(13)]
    return filled(BeamGeometry, parameter=names, best=np.arange(1.0, 14.0), samples=np.ones((20, 10)),
                  sampled_parameter=names[:10], lower_bound=np.zeros(10),
                  upper_bound=np.full(10, 20.0), quantity_name=["peak_force", "share_open"], lower=[33.0, 0.1],
                  upper=[52.0, 1e9], motion=[[40.0, 0.2], [30.0, 0.2]], damping=[0.0, 400.0], low_growth=[900.0, 700.0],
                  middle_growth=[1500.0, 1300.0], damping_low_level=level, onset_frequency=[400.0],
                  onset_friction=[0.16], rigid_parameter=names[:6])


def test_coalescences_are_told_by_both_kinds_of_elements():
    told = chapters.beams(beams(), modes(), None, LOOK)
    assert len(told.figures) == 2 and "400\u202fHz (friction 0.16)" in told.conclude
    assert "Timoshenko beams: 402\u202fHz (0.15)" in told.conclude
    calm = beams(onset_frequency=[], onset_friction=[], check_onset_frequency=[], check_onset_friction=[])
    alone = chapters.beams(calm, None, None, LOOK)
    assert len(alone.figures) == 1 and "no friction" in alone.conclude and "none" in alone.conclude


def test_scatter_is_told_as_ranges():
    told = chapters.scatter(scatter(), None, LOOK)
    assert "The energy balance closes within 0.2\u202f%" in told.see
    assert "2.68\u20132.7\u202fkHz" in told.conclude and "40\u202f% to 60\u202f%" in told.conclude
    assert len(told.tables[0].rows) == 4 and "20\u202f% / 50\u202f% / 30\u202f%" in told.tables[0].rows[0]


def test_numbers_of_the_text_are_marks():
    """And only they: rows without a printed value leave no mark."""
    keys = ["coalescence_low", "coalescence_low_friction", "mode_5", "force_named", "slip_named", "share_stick"]
    facts = filled(Comparison, key=keys, published=[400.0, 0.16, 2500.0, 40.0, 50.0, 0.0],
                   published_known=[1, 1, 1, 1, 1, 0])
    bare, told = chapters.beams(beams(), modes(), None, LOOK), chapters.beams(beams(), modes(), facts, LOOK)
    for figure, plain in zip(told.figures, bare.figures, strict=True):
        assert "stars: numbers in the text" in figure.caption and figure.image != plain.image
        assert "stars" not in plain.caption
    assert "dotted: numbers in the text" in chapters.scatter(scatter(), facts, LOOK).figures[0].caption


@pytest.mark.parametrize("level, said", [
    ([0.0, -30.0], "unstable but not observed from a damping per mass of 400"),
    ([0.0, -2.0], "observed at every damping")])
def test_geometry_tells_why_a_mode_is_unheard(level, said):
    told = chapters.geometry(geometry(level), LOOK)
    assert said in told.conclude and "75\u202f%" in told.conclude
    assert told.tables[0].rows[0][3] == "50\u202f%"


def test_a_mode_that_damping_makes_stable():
    product = geometry([0.0, -30.0])
    told = chapters.geometry(replace(product, low_growth=np.array([900.0, -10.0])), LOOK)
    assert "only where damping stabilises it" in told.conclude
