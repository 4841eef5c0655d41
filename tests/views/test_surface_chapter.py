"""The chapter of the surfaces calls the bodies as the product does."""

from dataclasses import replace

import pytest

from pipeline.views.chapters import surface
from pipeline.views.chapters.chapter import Look
from tests.views import products_for_views as small


@pytest.mark.parametrize("bodies", [("disc", "pad"), ("disc", "pin")])
def test_bodies_keep_the_names_of_the_product(bodies):
    told = surface.chapter(replace(small.surface(), body=list(bodies)), Look(dpi=40, shapes=0))
    words = " ".join([told.see, *(f.caption for f in told.figures), *told.tables[0].head])
    assert f"of {bodies[0]} and {bodies[1]}" in words and f"{bodies[1]} above {bodies[0]}" in words
    assert ("pad" in words.replace("plateau pad", "")) == ("pad" in bodies)
