"""Sealing: the commitment binds, the key opens, and it never lies with the set."""

import hashlib

import pytest

from pipeline.blind_trial.protocol import sealing
from pipeline.contract.errors import BrakechainError

TRUTH = {"001": {"class": "control", "effects": []}}


@pytest.mark.exact
def test_the_commitment_is_the_salted_sha256_of_the_truth_and_binds_it():
    salt = "00" * 32
    assert sealing.commitment(salt, TRUTH) == hashlib.sha256(
        bytes(32) + b'{"001":{"class":"control","effects":[]}}').hexdigest()
    assert sealing.commitment("01" * 32, TRUTH) != sealing.commitment(salt, TRUTH)
    assert sealing.commitment(salt, {"002": TRUTH["001"]}) != sealing.commitment(salt, TRUTH)


def test_what_is_sealed_opens_with_its_key_alone_and_tells_nothing(tmp_path):
    key = sealing.new_key(tmp_path / "a.key")
    content, told = sealing.sealed(TRUTH, key)
    assert b"control" not in content
    opened = sealing.unlocked(content, sealing.read_key(tmp_path / "a.key"), "here")
    assert opened["truth"] == TRUTH and sealing.commitment(opened["salt"], TRUTH) == told
    assert sealing.sealed(TRUTH, key)[1] != told, "a fresh salt every time"
    for wrong in (sealing.new_key(tmp_path / "b.key"), key):
        spoilt = content if wrong != key else content[:-3] + b"xxx"
        with pytest.raises(BrakechainError, match="what this key opens"):
            sealing.unlocked(spoilt, wrong, "here")


def test_a_key_is_read_by_its_owner_alone_and_never_overwritten(tmp_path):
    key = sealing.new_key(tmp_path / "deep" / "a.key")
    assert (tmp_path / "deep" / "a.key").stat().st_mode & 0o777 == 0o600
    with pytest.raises(BrakechainError, match="a file that is not there yet"):
        sealing.new_key(tmp_path / "deep" / "a.key")
    assert sealing.read_key(tmp_path / "deep" / "a.key") == key
    with pytest.raises(BrakechainError, match="the key of the set"):
        sealing.read_key(tmp_path / "none.key")
    with pytest.raises(BrakechainError, match="32 bytes"):
        sealing.locked({}, b"short")


def test_a_key_lies_outside_the_set_and_outside_every_repository(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "home"))
    assert sealing.key_path(tmp_path / "winter") == tmp_path / "home" / "brakechain" / "keys" / "winter.key"
    with pytest.raises(BrakechainError, match="outside the set"):
        sealing.key_path(tmp_path / "winter", tmp_path / "winter" / "deep" / "a.key")
    (tmp_path / "work" / ".git").mkdir(parents=True)
    with pytest.raises(BrakechainError, match="outside every Git repository"):
        sealing.key_path(tmp_path / "winter", tmp_path / "work" / "keys" / "a.key")
