"""Stage effects: the block of a case as a product."""

from pipeline.case_models.effect_block import terms
from pipeline.contract.settings import fill
from stages.effects import Settings, effects
from tests.diagnosis.small_rig import HIDDEN


def test_terms_of_the_block():
    found = effects(settings=fill(Settings, HIDDEN, "effects"))
    assert list(found.effect) == ["cubic_stiffness"] and list(found.unit) == ["N/m^3"]
    assert terms(found)[0].values == {"coefficient": 1.5e4}


def test_no_block_no_terms():
    assert terms(effects(settings=Settings())) == ()
