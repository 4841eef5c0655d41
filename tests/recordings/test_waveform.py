"""What a channel of a file is, and libraries that are not there."""

import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.waveform import Waveform, free_name, library, plain_name


def test_a_file_need_not_tell_unit_nor_rate():
    assert Waveform([1.0]).unit == "" and Waveform([1.0]).rate is None


def test_a_library_that_is_not_installed_is_asked_for():
    assert library("json", "json", "a.wav").loads("1") == 1
    with pytest.raises(ConfigError, match=r"a.xyz: expected the package nolib, .* pip install 'brakechain\[bench\]'"):
        library("no_such_module", "nolib", "a.xyz")


def test_names_are_plain_and_free():
    assert plain_name("Gerät 1/Körperschall-Süd") == "Geraet_1_Koerperschall_Sued"
    assert plain_name("°µ", "run") == "u" or plain_name("°", "run") == "run"
    assert free_name("a", {"a": 1, "a_2": 1}) == "a_3" and free_name("b", {"a": 1}) == "b"
