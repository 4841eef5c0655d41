"""Mutations of bytes and text, drawn from one seeded generator, so that a number names an input."""

import struct

#: numbers that readers stumble over, as text and as bytes
EXTREMES = (
    "0",
    "-0",
    "-1",
    "1",
    "2147483647",
    "-2147483648",
    "4294967296",
    "9223372036854775808",
    "1e308",
    "1e-320",
    "1e400",
    "-1e308",
    "nan",
    "inf",
    "-inf",
    "1e",
    "0x10",
    "1_000",
    "1,5",
    "１２",
    "",
    "-",
    ".",
    "1e3",
    "1d3",
    "00",
    "99999999999999999999999999",
    "0.1.2",
    "+",
    "true",
    "null",
)
_WORDS = tuple(
    struct.pack(form, value)
    for form, values in (
        ("<i", (0, 1, -1, 2**31 - 1, -(2**31), 2, 3, 255, 65535)),
        (">i", (1, -1, 2**31 - 1, -(2**31), 2)),
        ("<q", (0, -1, 2**63 - 1, 1, 2**40)),
        (">q", (2**63 - 1, 1)),
        ("<h", (0, -1, 2**15 - 1, 1)),
        (">h", (1, -(2**15))),
        ("<d", (float("nan"), float("inf"), 1e308, -1.0, 0.0, 1e-310)),
    )
    for value in values
)
_MARKS = (
    b"\0",
    b"\xff",
    b"\xef\xbb\xbf",
    b"\xc3",
    b"\x80",
    b"\r",
    b"\t",
    b"\x1b[2J",
    b'"',
    b"'",
    b"%",
    b"#",
    b"*",
    b"\x85",
    b"\xe2\x80\xa8",
    b"/",
    b"\\",
    b"${x}",
    b"../",
    b"%s%n",
    b"{",
    b"}",
    b"[",
    b"&a",
    b"*a",
    b"!!python/x",
)


def draw(rng, options):
    """One of the ``options``."""
    return options[int(rng.integers(len(options)))]


def damaged(rng, content):
    """``content`` with one to four changes of its bytes."""
    for _ in range(int(rng.integers(1, 5))):
        content = draw(rng, _OF_BYTES)(rng, content)
    return content


def garbled(rng, content):
    """``content``, the bytes of a text, with one to four changes of its lines, fields and characters."""
    for _ in range(int(rng.integers(1, 5))):
        content = draw(rng, _OF_TEXT)(rng, content)
    return content


def _position(rng, content):
    """Mostly near the head, where what steers a reader is."""
    most = len(content) if rng.random() < 0.5 else min(len(content), 600)
    return int(rng.integers(max(most, 1)))


def _span(rng, content):
    begin = _position(rng, content)
    return begin, min(len(content), begin + int(draw(rng, (1, 2, 4, 8, 40, 512, 4000))))


def _flipped(rng, content):
    changed = bytearray(content)
    for _ in range(int(rng.integers(1, 9)) if content else 0):
        changed[_position(rng, content)] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def _cut(rng, content):
    return content[: int(rng.integers(len(content) + 1))]


def _beheaded(rng, content):
    return content[int(rng.integers(min(len(content), 64) + 1)) :]


def _filled(rng, content):
    begin, end = _span(rng, content)
    return content[:begin] + draw(rng, (b"\0", b"\xff", rng.bytes(1), b" ")) * (end - begin) + content[end:]


def _random(rng, content):
    begin, end = _span(rng, content)
    return content[:begin] + rng.bytes(end - begin) + content[end:]


def _lost(rng, content):
    begin, end = _span(rng, content)
    return content[:begin] + content[end:]


def _doubled(rng, content):
    begin, end = _span(rng, content)
    return content[:end] + content[begin:end] * int(draw(rng, (1, 1, 3))) + content[end:]


def _exchanged(rng, content):
    (a, b), (c, d) = sorted((_span(rng, content), _span(rng, content)))
    return content if b > c else content[:a] + content[c:d] + content[b:c] + content[a:b] + content[d:]


def _reworded(rng, content):
    """A number of 2 to 8 bytes becomes an extreme one, mostly where numbers are aligned."""
    word, begin = draw(rng, _WORDS), _position(rng, content)
    begin -= begin % (len(word) if rng.random() < 0.7 else 1)
    return content[:begin] + word + content[begin + len(word) :]


def _marked(rng, content):
    begin = _position(rng, content)
    return content[:begin] + draw(rng, _MARKS) + content[begin:]


_OF_BYTES = (
    _flipped,
    _flipped,
    _flipped,
    _cut,
    _beheaded,
    _filled,
    _random,
    _lost,
    _doubled,
    _exchanged,
    _reworded,
    _reworded,
    _reworded,
    _marked,
)


def _lines(content):
    return content.split(b"\n")


def _line_lost(rng, content):
    lines = _lines(content)
    del lines[int(rng.integers(len(lines)))]
    return b"\n".join(lines)


def _line_again(rng, content):
    lines = _lines(content)
    lines.insert(int(rng.integers(len(lines))), draw(rng, lines))
    return b"\n".join(lines)


def _lines_exchanged(rng, content):
    lines = _lines(content)
    a, b = rng.integers(len(lines), size=2)
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def _in_line(rng, content, change):
    """``change(fields, k)`` of the fields of a line; they are split where it has most separators."""
    lines = _lines(content)
    k = int(rng.integers(len(lines)))
    mark = max((b",", b";", b"\t", b" ", b":"), key=lines[k].count)
    fields = lines[k].split(mark)
    change(fields, int(rng.integers(len(fields))))
    lines[k] = mark.join(fields)
    return b"\n".join(lines)


def _extreme(rng, content):
    return _in_line(rng, content, lambda fields, k: fields.__setitem__(k, draw(rng, EXTREMES).encode()))


def _field_lost(rng, content):
    return _in_line(rng, content, lambda fields, k: fields.pop(k))


def _field_again(rng, content):
    return _in_line(rng, content, lambda fields, k: fields.insert(k, fields[k] * int(draw(rng, (1, 1, 50)))))


def _recoded(rng, content):
    text = content.decode("latin-1")
    return draw(
        rng,
        (
            lambda: text.encode("utf-16"),
            lambda: text.replace("m", "µ").encode("latin-1"),
            lambda: content.replace(b"\n", b"\r"),
            lambda: content.upper(),
            lambda: content.replace(b".", b","),
            lambda: content.replace(b"\n", b""),
            lambda: b"\n" * 1000 + content,
            lambda: content.replace(b" ", b"\t"),
            lambda: content + b"x" * 3000,
        ),
    )()


_OF_TEXT = (
    *_OF_BYTES,
    _line_lost,
    _line_again,
    _lines_exchanged,
    _extreme,
    _extreme,
    _extreme,
    _field_lost,
    _field_again,
    _recoded,
)
