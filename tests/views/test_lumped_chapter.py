"""The chapter of a lumped system tells every part, its place and its load."""

from dataclasses import fields

import numpy as np

from pipeline.views import lumped as pictures
from pipeline.views.chapter import Look
from pipeline.views.chapters.lumped import chapter
from tests.views import products_for_views as small


def changed(product, **values):
    return type(product)(**{**{f.name: getattr(product, f.name) for f in fields(product)}, **values})


def test_every_part_is_told():
    found = chapter(small.lumped(), Look())
    springs, contacts, inputs = found.tables
    assert [row[1] for row in springs.rows] == ["block.x", "block.x \u2212 tool.x", "tool.x"]
    assert [row[2] for row in contacts.rows] == ["block.y", "friction joint"]
    assert inputs.rows[0][1] == "\u2212 block.y" and inputs.rows[0][2] == "20\u202fN"
    assert "At rest the contacts carry 5–20\u202fN." in found.conclude and "3 coordinates" in found.see


def test_a_system_without_contacts_says_so():
    none = np.empty((0, 3))
    bare = changed(small.lumped(), contact_name=[], contact_body=[], contact_area=[], contact_lever=[], contact_gap=[],
                   contact_normal=none, contact_tangent=none, contact_lateral=none, preload=np.empty((1, 0)),
                   contact_stiffness=np.empty((1, 0)), drive_history=[0.0, 1.0])
    found = chapter(bare, Look())
    assert "Nothing touches" in found.conclude and "varies over time" in found.see and len(found.tables) == 2


def test_the_diagram_is_the_same_twice_and_changes_with_the_system():
    product = small.lumped()
    first = pictures.diagram(product)
    assert first == pictures.diagram(product) and first.startswith("<?xml")
    moved = changed(product, joint_rows=np.roll(product.joint_rows, 1, axis=1))
    assert pictures.diagram(moved) != first
