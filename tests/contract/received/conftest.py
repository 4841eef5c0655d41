"""A limit of the clock for tests of texts that would compute for ever: what does not end fails."""

import signal

import pytest

SECONDS = 20


@pytest.fixture
def in_time():
    """Fails a test that takes longer than SECONDS."""
    before = signal.signal(signal.SIGALRM, lambda *_: pytest.fail(f"not done after {SECONDS} s"))
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)
