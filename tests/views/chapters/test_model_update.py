"""Chapter of a model updated by a modal test."""

from pipeline.views.chapters.bench import model_update
from pipeline.views.chapters.chapter import Look
from tests.views import products_for_views as small


def test_values_pairs_doubts_and_points_are_told():
    product = small.model_update()
    made = model_update.chapter(product, Look())
    assert model_update.headline(product) == (
        "2 of 4 measured modes paired beyond doubt; the model is off by 3.8\u202f% as stated, by 0.11\u202f% updated",
        "warning")
    assert "disc.young 120\u202fGPa to 128.3\u202fGPa ± 0.4\u202f%" in model_update.values(product)
    assert "hardly tells disc.poisson: what was stated decides" in model_update.values(product)
    assert model_update.doubts(product) == ("No mode of the model: 1710 Hz; one of two modes of the model: 1500 Hz.")
    assert "Point node 2 direction 3 shows other shapes than the model (correlation of 0.5" in made.conclude
    values, modes, points = made.tables
    assert modes.rows[0][4:] == ("0.99", "2 nodal diameters") and modes.rows[2][5] == "in doubt: or 1512 Hz"
    assert modes.rows[3][5] == "no mode of the model" and points.rows[1][4] == "4"
    assert values.rows[0] == ("disc.young", "120\u202fGPa", "10\u202f%", "128.3\u202fGPa", "0.4\u202f%")


def test_without_points_the_page_says_so():
    made = model_update.chapter(small.model_update(points=False), Look())
    assert "by frequency alone, as no point of the test is stated" in made.see and len(made.tables) == 2
