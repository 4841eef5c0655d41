"""Chapter of noise events: how many, where, how loud, under which conditions; and what is said where there are none."""

from dataclasses import replace

import numpy as np

from pipeline.products import Recording, Run
from pipeline.views.chapters.bench.noise_events import chapter, conclusion, headline, key_figure, runs
from pipeline.views.chapters.chapter import Look
from pipeline.views.pages.summary import verdict
from tests.views import products_for_views as small

LOOK = Look(dpi=50)
RECORDING = Recording(source=["stop.wav 0"], runs={"stop_1": Run(description="", repeat_of="")})


def plain(text):
    return text.replace("\N{NARROW NO-BREAK SPACE}", " ")


def test_squeal_counts_runs_of_microphones():
    product = small.noise_events()
    assert runs(product) == (["stop_1", "stop_2"], ["stop_1", "stop_2"])
    told = plain(conclusion(product))
    assert told.startswith("2 squeal events in 2 of 2 runs (100 %). The loudest: 89 dB(A) at 2.78 kHz for 2.4 s,"
                           " run stop_1 (pressure 1.7 MPa, speed 20 rad/s).")
    assert "2.78 kHz (1), 7.34 kHz (1)" in told and told.endswith("Told beside: 1 harmonic, 1 groan.")
    assert plain(headline(product)[0]) == "Squeal in 2 of 2 runs, loudest at 2.78 kHz"


def test_accelerometers_count_where_nothing_listens_and_a_squeal_in_two_channels_counts_once():
    product = small.noise_events()
    deaf = replace(product, record_kind=np.array(["vibration"] * 3, dtype=object))
    told = plain(conclusion(deaf))
    assert told.startswith("2 squeal events in 2 of 2 runs (100 %), each counted once among 2 channels.")
    assert "149 dB re 1 µm/s²" in told


def test_no_squeal_and_no_channel_are_told():
    quiet = small.noise_events(quiet=True)
    assert headline(quiet) == ("No squeal in 2 runs", "quiet") and key_figure(quiet, LOOK) is None
    assert plain(conclusion(quiet)).startswith("No steady tone reaches the threshold. The loudest tone in the band has")
    none = replace(quiet, spectrogram={}, **{name: getattr(quiet, name)[:0] for name in vars(quiet)
                                             if name.startswith("record_")})
    assert headline(none) is None and "No channel of the recordings" in conclusion(none)
    assert not chapter(none, LOOK).figures and not chapter(none, LOOK).tables


def test_the_page_has_spectrograms_levels_and_tables():
    product = small.noise_events()
    made = chapter(product, LOOK)
    assert [t.title for t in made.tables] == ["Events", "Records"] and len(made.tables[0].rows) == 5
    assert [row[2] for row in made.tables[0].rows][:3] == ["squeal"] * 3
    captions = [figure.caption for figure in made.figures]
    assert len(captions) == 7 and "Run stop_1, mic" in captions[0] and "over pressure and speed" in captions[4]
    assert captions[5].startswith("Share of the time with squeal over pressure and speed; runs that squealed there /")
    assert "loudest squeal: run stop_1, mic" in key_figure(product, LOOK).caption


def test_the_first_screen_answers():
    told = verdict({"recording": RECORDING, "noise_events": small.noise_events()}, ())
    assert told.tone == "squeal" and plain(told.headline).startswith("Squeal in 2 of 2 runs")
    assert plain(dict(told.answers)["Where"]).startswith("2 squeal events")
    quiet = verdict({"recording": RECORDING, "noise_events": small.noise_events(quiet=True)}, ())
    assert quiet.headline == "No squeal in 2 runs"


def test_a_run_without_a_microphone_counts_by_its_accelerometer():
    """Beside a quiet run with a microphone; a peak of vibration is not compared with one of sound."""
    product = small.noise_events()
    mixed = replace(product, record_run=np.array(["a", "b", "a"], dtype=object),
                    event_kind=np.array(["sweep", "harmonic", "sweep", "groan", "squeal"], dtype=object))
    assert runs(mixed)[0] == ["b"] and headline(mixed)[0].startswith("Squeal in 1 of 2 runs")
    silent = replace(mixed, event_kind=np.array(["sweep"] * 5, dtype=object))
    assert "89 dB(A)" in plain(conclusion(silent))


def test_events_are_told_beside_modes_and_what_chance_would_do():
    product = small.noise_events()
    told = plain(conclusion(product))
    assert "Squeal frequencies within 3 % of one of 2 modes: 1 of 2; by chance 4 % would be, as dense as" in told
    assert "there. Of one that is predicted to be unstable: 1; by chance 2 %." in told
    together = replace(product, event_frequency=product.event_frequency * 0 + 2790.0)
    assert "of one of 2 modes: 1 of 1;" in plain(conclusion(together))
    rows = [plain(row[-1]) for row in chapter(product, LOOK).tables[0].rows]
    assert rows[0] == "umbrella, −0.71 %, unstable" and rows.count("none within 3 %") == 2 and rows.count("") == 1
    bare = replace(product, event_mode=-1 + 0 * product.event_mode, mode_name=np.array([], dtype=object),
                   mode_frequency=np.array([]), mode_unstable=np.array([], int))
    assert "modes" not in conclusion(bare) and len(chapter(bare, LOOK).tables[0].head) == 8
    assert key_figure(bare, LOOK).image != key_figure(product, LOOK).image


def test_the_loudest_squeal_can_be_heard(words_only):
    (sound,) = chapter(small.noise_events(), LOOK).sounds
    told = plain(sound.caption)
    assert sound.data[:4] == b"RIFF" and "as recorded (squeal.wav): run stop_1, mic, from 1.25 s on" in told
    assert told.endswith("full scale is 0.02 Pa.")
    assert not chapter(small.noise_events(quiet=True), LOOK).sounds


def test_overload_is_told_on_the_first_screen_and_levels_are_lower_bounds():
    product = small.noise_events()
    cut = replace(product, record_overload=np.array([0.12, 0.0, 0.0]), record_range=np.array([20.0, 0.0, 0.0]),
                  event_kind=np.where(product.event_kind == "harmonic", "clipping", product.event_kind))
    assert plain(headline(cut)[0]).endswith("loudest at 2.78 kHz; overloaded, levels are lower bounds")
    told = plain(conclusion(cut))
    assert "The loudest: at least 89 dB(A)" in told and "1 of clipping" in told
    assert "lower bounds: run stop_1, mic: 12 % of the samples stand at 20 Pa. Multiples of its tones" in told
    events, records = chapter(cut, LOOK).tables
    assert [row[4] for row in events.rows if row[1] == "mic"][0] == "≥ 89" and records.rows[0][2] == "≥ 89"
    quiet = replace(small.noise_events(quiet=True), record_overload=np.array([0.0, 0.0, 0.2]))
    assert headline(quiet) == ("No squeal in 2 runs; overloaded, levels are lower bounds", "warning")
