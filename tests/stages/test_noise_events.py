"""Stage noise_events on runs of microphones, accelerometers and slow channels."""

import io
from types import SimpleNamespace

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError, mapped, store
from pipeline.products import Condition, Recording, Run
from pipeline.recordings.samples import channel
from stages.noise_events import Settings, companions, noise_events
from tests.stages.two_processes import TwoProcesses

RATE = 48000.0
T = np.arange(round(4 * RATE)) / RATE
TONE = np.sqrt(2) * 20e-6 * 10 ** (85 / 20) * np.sin(2 * np.pi * 3150 * T) * ((T > 1) & (T < 2.5))
NOISE = 1e-3 * np.random.default_rng(1).standard_normal(len(T))


def run(channels, **conditions):
    return Run(description="", repeat_of="", channels=channels,
               conditions={k: Condition(value=[v], time=[0.0], unit=u) for k, (v, u) in conditions.items()})


def recorded(**more):
    channels = {"mic": channel(TONE + NOISE, "Pa", "sound_pressure", RATE, 0.5, "mic"),
                "pad": channel(2e5 * TONE + NOISE, "m/s^2", "acceleration", RATE, 0.5, "pad"),
                "line": channel(1e6 * T[::100], "Pa", "pressure", RATE / 100, 0.5, "line"),
                "shaft": channel(30 - 5 * T[::100], "rad/s", "angular_velocity", RATE / 100, 0.5, "shaft")}
    return Recording(source=[], runs={"loud": run(channels, temperature=(400.0, "K")), "quiet": run(
        {"mic": channel(NOISE, "Pa", "sound_pressure", RATE, 0.0, "mic")}), **more})


@pytest.fixture(scope="module")
def result():
    return noise_events(recorded(), settings=Settings())


def test_events_have_frequency_level_begin_and_conditions(result):
    assert list(result.record_run) == ["loud", "loud", "quiet"] and list(result.record_kind) == ["sound", "vibration",
                                                                                                 "sound"]
    assert list(result.event_kind) == ["squeal", "squeal"] and result.event_record.tolist() == [0, 1]
    weighted = 85 + 1.2
    assert result.event_frequency == pytest.approx([3150, 3150], abs=1)
    assert result.event_level[0] == pytest.approx(weighted, abs=0.2)
    assert result.event_level[1] == pytest.approx(85 + 20 * np.log10(2e5 * 20e-6 / 1e-6), abs=0.2)
    assert result.event_start == pytest.approx([1.5, 1.5], abs=0.01)
    assert result.event_duration == pytest.approx([1.5, 1.5], abs=0.01)
    assert list(result.condition) == ["pressure", "speed", "temperature"] and result.event_condition_known.all()
    np.testing.assert_allclose(result.event_condition[0], [1.75e6, 30 - 5 * 1.75, 400], rtol=0.01)


def test_records_tell_peak_background_and_a_spectrogram(result):
    assert result.record_peak[0] == pytest.approx(86.2, abs=0.3) and result.record_peak[2] < 40
    assert result.record_peak_frequency[0] == pytest.approx(3150, abs=1)
    whole = 20 * np.log10(1e-3 / 20e-6) + 10 * np.log10(14 / 24)
    assert result.record_background[2] == pytest.approx(whole, abs=1.5)
    shown = result.spectrogram["loud.mic"]
    time, line = np.unravel_index(shown.level.argmax(), shown.level.shape)
    assert 1.5 < shown.time[time] < 3 and shown.frequency[line] == pytest.approx(3150, abs=60)
    assert max(shown.level.shape) <= 600


def test_channels_may_be_chosen_and_must_exist():
    found = noise_events(recorded(), settings=Settings(channels=["pad"]))
    assert list(found.record_channel) == ["pad"]
    with pytest.raises(ConfigError, match="noise_events.channels: expected channels of the recording, found mike"):
        noise_events(recorded(), settings=Settings(channels=["mike"]))


def test_a_quiet_pressure_is_a_microphone_and_a_line_pressure_is_none():
    quiet = run({"p": channel(TONE + NOISE, "Pa", "pressure", RATE, 0.0, "p")})
    line = run({"p": channel(1e6 + TONE, "Pa", "pressure", RATE, 0.0, "p")})
    found = noise_events(Recording(source=[], runs={"a": quiet, "b": line}), settings=Settings())
    assert list(found.record_run) == ["a"] and list(found.event_kind) == ["squeal"]


def test_what_is_too_slow_or_too_short_is_told():
    told = []
    slow = run({"mic": channel(NOISE, "Pa", "sound_pressure", 3000.0, 0.0, "mic")})
    brief = run({"mic": channel(NOISE[:4000], "Pa", "sound_pressure", RATE, 0.0, "mic")})
    context = SimpleNamespace(remark=told.append, map=lambda f, items, _: [f(item) for item in items])
    found = noise_events(Recording(source=[], runs={"slow": slow, "brief": brief}), settings=Settings(),
                         context=context)
    assert not len(found.record_run) and not len(found.event_kind)
    assert "does not reach the squeal band" in told[0] and "shorter than three frames" in told[1]
    assert list(found.remarks) == told


def test_without_channels_of_sound_nothing_is_found():
    drive = run({"x": channel(T, "m", "displacement", RATE, 0.0, "x")})
    found = noise_events(Recording(source=[], runs={"a": drive}), settings=Settings())
    assert not len(found.record_run) and found.band.tolist() == [2000, 16000]


def test_a_band_that_ends_before_it_begins_is_refused():
    with pytest.raises(ConfigError, match="lowest_frequency: expected less than highest_frequency, 1000 Hz"):
        noise_events.check({"noise_events": Settings(highest_frequency="1 kHz")})


def test_the_table_of_events(result):
    head, first, *_ = companions(result)["noise_events.csv"].splitlines()
    assert head.startswith("run,channel,kind,frequency / Hz") and head.endswith("temperature / K")
    assert first.startswith("loud,mic,squeal,31") and first.split(",")[6].startswith("86.") and first.endswith(",400")


def test_conditions_come_from_what_was_measured_meanwhile():
    """Missing samples do not count, and a channel that ended before the event tells nothing."""
    gapped = np.full(400, 2e6)
    gapped[100:180] = np.nan
    early = channel(np.full(100, 2e6), "Pa", "pressure", 200.0, 0.0, "line")
    mic = channel(TONE + NOISE, "Pa", "sound_pressure", RATE, 0.0, "mic")
    for line, value in ((channel(gapped, "Pa", "pressure", 100.0, 0.0, "line"), 2e6), (early, None)):
        found = noise_events(Recording(source=[], runs={"a": run({"mic": mic, "line": line})}), settings=Settings())
        assert found.event_condition_known[0].tolist() == [int(value is not None), 0, 0]
        assert found.event_condition[0, 0] == (value or 0.0)


def test_what_is_no_sound_is_not_taken_for_it_and_what_is_named_is_searched():
    resting = channel(500.0 + TONE, "Pa", "pressure", RATE, 0.0, "line")
    glitch = np.array(TONE + NOISE)
    glitch[7] = 1e5
    runs = {"a": run({"line": resting}), "b": run({"mic": channel(glitch, "Pa", "pressure", RATE, 0.0, "mic")})}
    assert list(noise_events(Recording(source=[], runs=runs), settings=Settings()).record_run) == ["b"]
    named = noise_events(Recording(source=[], runs=runs), settings=Settings(channels=["line"]))
    assert list(named.record_run) == ["a"]
    force = run({"f": channel(T, "N", "force", RATE, 0.0, "f")})
    with pytest.raises(ConfigError, match="channels of sound pressure or acceleration, found f in N"):
        noise_events(Recording(source=[], runs={"a": force}), settings=Settings(channels=["f"]))


def test_a_tone_of_a_narrow_band_is_not_noise_as_well():
    tone = np.sqrt(2) * 20e-6 * 10 ** (85 / 20) * np.sin(2 * np.pi * 2500 * T)
    mic = run({"mic": channel(tone + NOISE, "Pa", "sound_pressure", RATE, 0.0, "mic")})
    found = noise_events(Recording(source=[], runs={"a": mic}), settings=Settings(highest_frequency="3 kHz"))
    assert list(found.event_kind) == ["squeal"]


def test_events_are_compared_with_modes():
    """The tone lies 1.6 % below a mode, which names it; within 1 % of none."""
    modes = {"bell": "3.2 kHz", "ring": "5 kHz"}
    found = noise_events(recorded(), settings=Settings(modes=modes))
    assert list(found.mode_name) == ["bell", "ring"] and found.event_mode.tolist() == [0, 0]
    np.testing.assert_allclose(found.event_chance, [[np.log2(1.03 / 0.97), 0.0]] * 2, rtol=1e-9)
    assert found.mode_unstable.tolist() == [-1, -1]
    head, first, *_ = companions(found)["noise_events.csv"].splitlines()
    assert head.endswith("mode,mode / Hz") and first.endswith("bell,3200")
    far = noise_events(recorded(), settings=Settings(modes=modes, near=0.01))
    assert far.event_mode.tolist() == [-1, -1] and companions(far)["noise_events.csv"].splitlines()[1].endswith(",400")


@pytest.mark.exact
def test_maps_tell_the_share_of_time_with_squeal_in_every_bin(result):
    """The line pressure rises by 1 MPa a second from 0.5 s on while it squeals from 1.5 s to 3 s; 400 K are stated."""
    assert set(result.maps) == {"pressure.speed", "pressure.temperature", "speed.temperature"}
    one = result.maps["pressure.temperature"]
    assert one.first_edge.tolist() == [0.0, 5e5, 1e6, 1.5e6, 2e6, 2.5e6, 3e6, 3.5e6, 4e6] and one.time.shape == (8, 1)
    np.testing.assert_allclose(one.time[:, 0], 0.5)
    np.testing.assert_allclose(one.squealing[:, 0], [0, 0, 0.5, 0.5, 0.5, 0, 0, 0], atol=0.051)
    assert one.runs[:, 0].tolist() == [1] * 8 and one.squealing_runs[:, 0].tolist() == [0, 0, 1, 1, 1, 0, 0, 0]
    assert one.level[3, 0] == pytest.approx(86.2, abs=0.3) and one.level[0, 0] == 0
    assert not noise_events(recorded(), settings=Settings(channels=["pad"])).maps["pressure.speed"].level.max() < 100


@pytest.mark.exact
def test_the_loudest_squeal_is_written_to_listen_to(result):
    """The microphone is heard, from 0.2 s before the event to 0.2 s after it, frequency within 1 Hz."""
    rate, samples = scipy.io.wavfile.read(io.BytesIO(companions(result)["squeal.wav"]))
    told = result.listen["squeal"]
    assert len(samples) / rate == pytest.approx(1.9, abs=0.03) and told.begin == pytest.approx(1.3, abs=0.02)
    line = np.abs(np.fft.rfft(samples * np.hanning(len(samples)), 2**20)).argmax() * rate / 2**20
    assert line == pytest.approx(result.event_frequency[0], abs=1.0) and str(told.content) == "run loud, mic"
    pascal = samples[rate // 2:rate] * told.full_scale / 32767
    assert 20 * np.log10(pascal.std() / 20e-6) == pytest.approx(85.0, abs=0.2) and str(told.unit) == "Pa"
    quiet = noise_events(Recording(source=[], runs={"a": run({"mic": channel(
        NOISE, "Pa", "sound_pressure", RATE, 0.0, "mic")})}), settings=Settings())
    assert list(companions(quiet)) == ["noise_events.csv"]


def test_a_product_in_its_file_gives_the_events_of_one_in_memory(tmp_path, monkeypatch):
    store.write(recorded(), tmp_path / "recording.h5", {})
    outside, inside = (store.read(Recording, tmp_path / "recording.h5", whole) for whole in (False, True))
    maps = [mapped.map_of(one.runs["loud"].channels["mic"].samples) for one in (outside, inside)]
    assert maps[0] is not None and maps[1] is None
    expected = store.content_hash(noise_events(inside, settings=Settings()))
    assert store.content_hash(noise_events(outside, settings=Settings())) == expected
    again = noise_events(outside, settings=Settings(), context=TwoProcesses())
    assert store.content_hash(again) == expected


def test_a_condition_is_averaged_in_parts(monkeypatch):
    whole = noise_events(recorded(), settings=Settings()).event_condition
    monkeypatch.setattr("stages.noise_events._AT_ONCE", 10)
    np.testing.assert_allclose(noise_events(recorded(), settings=Settings()).event_condition, whole, rtol=1e-12)


@pytest.mark.parametrize("ends, level", [((-1.0, 1.0), 2.5), ((-9.0, 1.0), 2.5), ((-1.0, 1.0), 8.0)])
def test_harmonics_of_an_overloaded_tone_are_clipping(ends, level):
    """Cut at one end and at both, a little and nearly to a square, whose multiples fold down; uncut: a squeal."""
    free = level * np.sin(2 * np.pi * 3137.3 * T) + 10 * NOISE
    runs = {name: run({"mic": channel(samples, "Pa", "sound_pressure", RATE, 0.0, "mic")}) for name, samples in (
        ("cut", np.clip(free, *ends)), ("free", free))}
    result = noise_events(Recording(source=[], runs=runs), settings=Settings())
    kinds = [result.event_kind[result.event_record == k].tolist() for k in (0, 1)]
    assert kinds[1] == ["squeal"] and kinds[0].count("squeal") == 1 and set(kinds[0]) == {"squeal", "clipping"}
    assert result.record_overload[0] > 0.3 > result.record_overload[1] == 0.0
    assert result.record_range.tolist() == [1.0, 0.0]
    rows = companions(result)["noise_events.csv"].splitlines()
    assert rows[0].endswith("level is a lower bound") and rows[1].endswith("yes") and rows[-1].endswith("no")


def test_a_squeal_beside_an_overloaded_tone_stays_one():
    loud = np.clip(3.0 * np.sin(2 * np.pi * 2900.0 * T) + 0.3 * np.sin(2 * np.pi * 7350.0 * T) + 10 * NOISE, -2, 2)
    result = noise_events(Recording(source=[], runs={"a": run({"mic": channel(
        loud, "Pa", "sound_pressure", RATE, 0.0, "mic")})}), settings=Settings())
    squeal = result.event_frequency[result.event_kind == "squeal"]
    assert np.any(abs(squeal - 7350) < 2) and np.any(abs(squeal - 2900) < 2)
