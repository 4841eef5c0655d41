"""WAV files that other programs read."""

import io

import numpy as np
import pytest
import scipy

from pipeline.products import Excerpt
from pipeline.views.pages.sound_file import wav


@pytest.mark.exact
def test_a_wav_file_holds_the_samples_at_their_rate():
    samples = np.array([0, 1, -2, 32767, -32768], np.int16)
    excerpt = Excerpt(samples=samples, rate=48000.0, full_scale=0.5, unit="Pa", content="a test", begin=0.0)
    rate, read = scipy.io.wavfile.read(io.BytesIO(wav(excerpt)))
    assert rate == 48000 and read.dtype == np.int16
    np.testing.assert_array_equal(read, samples)
