"""Doubts about recorded channels, without a model."""

import numpy as np

from pipeline.diagnosis.experiment_design.record_doubts import doubts
from pipeline.products import Channel, Recording, Run

TIME = np.arange(2000) / 200


def told(held_out=("c",), free=True, **channels):
    made = {n: Channel(samples=v, missing=np.empty((0, 2), int), unit="m", measures="displacement", rate=200.0,
                       begin=0.0, place="", position=(), direction=(), role="response") for n, v in channels.items()}
    runs = {name: Run(description="", repeat_of="", channels=made) for name in "abcd"}
    return " ".join(doubts(Recording(source=[], runs=runs), list(channels), held_out, free))


def wave(noise=1e-3, frequency=2.0):
    return 0.01 * np.sin(2 * np.pi * frequency * TIME) + noise * 0.01 * np.random.default_rng(0).standard_normal(2000)


def test_a_sound_record_raises_no_doubt():
    assert told(x=wave()) == ""


def test_each_fault_has_its_sentence():
    assert "x never changes" in told(x=np.ones(2000))
    assert "it clips" in told(x=np.clip(wave(), -0.008, 0.008))
    assert "it rests there" in told(x=np.append(wave()[:-300], np.full(300, 0.02)))
    assert "has steps of" in told(x=np.round(wave(), 2) + 0.0)
    assert "x and y are one another's copy" in told(x=wave(), y=wave())
    assert "channels.x.offset: -0.11 m" in told(x=wave() / 10 - 0.11)
    assert "offset" not in told(x=wave() + 0.05)
    assert "is its unit right" in told(x=1e5 * wave())
    assert "periods of x" in told(x=wave(frequency=0.15))
    assert "periods of x" not in told(x=wave(frequency=0.15), free=False)
    assert "samples in a period of x" in told(x=wave(frequency=40.0))
    assert "no run is held out" in told(held_out=(), x=wave())
    assert "2 fitted runs" in told(held_out=("c", "d"), x=wave())
