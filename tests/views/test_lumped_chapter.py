"""The chapter of a lumped system tells every part, its place and its load."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.views.chapters.chapter import Look
from pipeline.views.chapters.models import lumped as lumped_chapter
from pipeline.views.chapters.models.lumped import chapter
from pipeline.views.figures.models import lumped as pictures
from tests.views import products_for_views as small


def changed(product, **values):
    return type(product)(**{**{f.name: getattr(product, f.name) for f in fields(product)}, **values})


def test_every_part_is_told():
    found = chapter(small.lumped(), None, Look())
    springs, contacts, inputs, sensors = found.tables
    assert sensors.rows[0][-1] == "\u2014"
    assert [row[1] for row in springs.rows] == ["block.x", "block.x \u2212 tool.x", "tool.x"]
    assert [row[2] for row in contacts.rows] == ["block.y", "friction joint"]
    assert inputs.rows[0][1] == "\u2212 block.y" and inputs.rows[0][2] == "20\u202fN"
    assert "At rest the contacts carry 5–20\u202fN." in found.conclude and "3 coordinates" in found.see


def test_a_system_too_large_to_survey_has_no_diagram_and_folded_tables(monkeypatch, words_only):
    assert chapter(small.lumped(), None, Look()).figures
    monkeypatch.setattr(lumped_chapter, "_SURVEYED", 3)
    large = chapter(small.lumped(), None, Look())
    assert not large.figures and large.tables[0].folded and large.tables[1].folded


def test_a_system_without_contacts_says_so():
    none = np.empty((0, 3))
    bare = changed(small.lumped(), contact_name=[], contact_body=[], contact_position=none, contact_area=[],
                   contact_lever=[], contact_gap=[], contact_normal=none, contact_tangent=none, contact_lateral=none,
                   preload=np.empty((1, 0)), contact_stiffness=np.empty((1, 0)), drive_history=[0.0, 1.0])
    found = chapter(bare, None, Look())
    assert "There are no contacts" in found.conclude and "varies over time" in found.see and len(found.tables) == 3


@pytest.mark.parametrize("kind, reads, largest", [
    ("displacement", "10 mV per m", 5e-3), ("velocity", "10 mV per m/s", 0.5),
    ("acceleration", "10 mV per m/s²", 50.0)])
def test_a_sensor_tells_its_reading_in_its_unit(kind, reads, largest):
    """x = 5 mm sin(100 t): 0.5 m/s and 50 m/s^2, at 10 mV per SI unit."""
    time = np.linspace(0, 0.2, 20001)
    place, count = 5e-3 * np.sin(100 * time), len(small.lumped().sensor_name)
    motion = SimpleNamespace(time=time, displacement=np.tile(place, (1, count, 1)),
                             velocity=np.tile(0.5 * np.cos(100 * time), (1, count, 1)))
    product = changed(small.lumped(), sensor_quantity=[kind] * count, sensor_unit=["mV"] * count,
                      sensor_gain=[10.0] * count)
    row = chapter(product, motion, Look()).tables[-1].rows[0]
    assert row[2] == kind and row[3] == reads
    assert float(row[4].split()[0]) == pytest.approx(10 * largest, rel=0.01) and row[4].endswith("mV")


def test_the_diagram_is_the_same_twice_and_changes_with_the_system():
    product = small.lumped()
    first = pictures.diagram(product)
    assert first == pictures.diagram(product) and first.image.startswith("<?xml")
    moved = changed(product, joint_rows=np.roll(product.joint_rows, 1, axis=1))
    assert pictures.diagram(moved) != first
