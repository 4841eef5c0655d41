"""A sound as a WAV file, beside the page and in it."""

import io
import wave


def wav(excerpt):
    """WAV bytes, mono, 16 bits, of the product Excerpt."""
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(round(float(excerpt.rate)))
        file.writeframes(excerpt.samples.astype("<i2").tobytes())
    return stream.getvalue()


def sound_files(product, case=None):
    """Companions of a product: {name.wav: bytes} of what it has to listen to."""
    return {f"{name}.wav": wav(one) for name, one in product.listen.items()}
