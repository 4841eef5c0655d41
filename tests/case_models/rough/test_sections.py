"""The section ``surface`` as it is written in a case."""

import pytest

from pipeline.case_models.rough.sections import BODIES, PlateauPad, Settings, TurnedDisc
from pipeline.contract import ConfigError
from pipeline.contract.settings import fill


def test_both_bodies_are_generated_by_default():
    given = Settings()
    assert BODIES == ("disc", "pad")
    assert isinstance(given.disc, TurnedDisc) and isinstance(given.pad, PlateauPad)


def test_a_kind_decides_what_a_body_states():
    with pytest.raises(ConfigError, match="pad.*feed"):
        fill(Settings, {"pad": {"kind": "generated", "feed": "1 mm"}}, "case: surface")
    with pytest.raises(ConfigError, match="disc.*none"):
        fill(Settings, {"disc": {"kind": "none"}}, "case: surface")
