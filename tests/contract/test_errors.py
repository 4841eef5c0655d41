"""Messages: bounded, and nothing in them steers a terminal."""

from pipeline.contract.errors import ConfigError, shortened


def test_a_message_has_at_most_2000_characters():
    for error in (ConfigError("a" * 600_000), ConfigError("a", "b" * 9999, "c" * 9999, "d" * 9999)):
        assert len(str(error)) <= 2000
    assert "remedy" in str(ConfigError("a", "b" * 9999, "c" * 9999, "remedy"))


def test_what_steers_a_terminal_is_written_out():
    assert str(ConfigError("a", "b", "\x1b[2J\u202e")) == "a: expected b, found \\x1b[2J\\u202e"
    assert shortened("one\ntwo\t3 µm") == "one\ntwo\t3 µm"
