"""What a channel of a file is, and libraries that are not there."""

import pytest

from pipeline.contract import ConfigError
from pipeline.recordings.waveform import Waveform, free_name, library, plain_name, self_told


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


def test_channels_that_say_enough_and_what_the_others_lack():
    found = {"g/a": Waveform([1.0], "PA", 10.0), "g/b": Waveform([1.0], "EU", 10.0), "g/c": Waveform([1.0], "-", 10.0),
             "g/d": Waveform([1.0], "", 10.0), "g/e": Waveform([1.0], "m")}
    told = []
    assert self_told(found, {"g/d": "N"}, None, "f", told.append) == {"g_a": ("g/a", None), "g_d": ("g/d", "N")}
    assert [line.partition(" left out: ")[0] for line in told] == ["f: g/b", "f: g/c", "f: g/e"]
    assert told[1].endswith("the file states no unit; add units: {g_c: ...}") and "no sampling rate; name it" in told[2]
    assert self_told({"g/b": found["g/b"]}, {}, None, "f", told.append) == {"g_b": ("g/b", None)} and len(told) == 3
