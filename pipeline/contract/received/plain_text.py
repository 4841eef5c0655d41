"""Text as instruments write it: its encoding, what separates its columns, its decimal mark, its time stamps."""

import csv
import re
from datetime import date

import numpy as np

from pipeline.contract.errors import ConfigError

#: texts that stand for a missing number, in lower case
MISSING = frozenset({"", "nan", "-nan", "na", "n/a", "#n/a", "#na", "none", "null", "-", "--", "---", "1.#qnan",
                     "-1.#ind", "1.#ind", "1.#inf", "-1.#inf"})
#: marks that separate columns, the most certain first; a blank stands for any white space
DELIMITERS = ("\t", ";", ",", "|", " ")
_WORDS = {"tab": "\t", "semicolon": ";", "comma": ",", "blank": " ", "space": " ", "whitespace": " "}

_NUMBER = re.compile(r"[-+]?((\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|inf|Inf|INF)")
_GROUPED = {".": re.compile(r"[-+]?\d{1,3}(,\d{3})+\.\d*"), ",": re.compile(r"[-+]?\d{1,3}(\.\d{3})+,\d*")}
_THOUSANDS = re.compile("(?<=\\d)['\N{RIGHT SINGLE QUOTATION MARK}\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}]"
                        "(?=\\d{3}(\\D|$))")
_FORTRAN = re.compile(r"[dD](?=[-+]?\d+$)")
_INFINITE = {"\N{INFINITY}": np.inf, "+\N{INFINITY}": np.inf, "-\N{INFINITY}": -np.inf}
_STAMP = re.compile(
    r"(?:(?P<date>\d{4}([-/.])\d{1,2}\2\d{1,2}|\d{1,2}([-/.])\d{1,2}\3(?:\d{4}|\d{2})))?[T ]*"
    r"(?:(?P<hour>\d{1,3}):(?P<minute>\d{2}):(?P<second>\d{2})(?:[.,:](?P<part>\d+))?"
    r"(?: *(?P<half>[AaPp])\.?[Mm]\.?)?)?"
    r"(?:Z| *[-+]\d{2}:?\d{2})?")
_MARKED = ((b"\xff\xfe\x00\x00", "utf-32"), (b"\x00\x00\xfe\xff", "utf-32"), (b"\xff\xfe", "utf-16"),
           (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig"))
#: bytes in which the zeros of UTF-16 are sought, and their least share of every second one
_BEGINNING, _ZEROS = 4096, 0.4
#: seconds of a day, and their decimals that a number holds
DAY, _PLACES = 86400.0, 10


def decoded(path, encoding=None):
    """(text, its encoding) of a file; ``encoding`` None: by its mark, UTF-16 by its zeros, UTF-8, else Windows-1252.

    Raises ConfigError for a file that cannot be read or is none of text.
    """
    try:
        content = path.read_bytes()
        if encoding is None:
            encoding = next((name for mark, name in _MARKED if content.startswith(mark)), None) or _unmarked(content)
        return content.decode(encoding), encoding
    except (OSError, UnicodeDecodeError, LookupError) as error:
        raise ConfigError(path, "a readable text table", str(error),
                          "state the encoding of the file, such as encoding: cp1252 or encoding: shift_jis") from None


def _unmarked(content):
    """Encoding of bytes without a mark; UnicodeDecodeError where none fits."""
    start = content[:_BEGINNING]
    for first, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        half = start[first::2]
        if half and half.count(0) > _ZEROS * len(half) and start[1 - first::2].count(0) == 0:
            return name
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        if re.search(rb"[\x00-\x08\x0e-\x1f]", content):
            raise
        return "cp1252"
    return "utf-8"


def lines_of(text):
    """Lines of a text, whatever ends them."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def delimiter_of(stated):
    """A delimiter that a case states, by its character or its name; None where it states none."""
    return _WORDS.get(stated.lower(), " " if not stated.strip(" ") else stated) if stated else None


def cells(line, delimiter):
    """Texts of a line that ``delimiter`` separates (a blank: any white space), quotation marks taken off."""
    if delimiter == " ":
        line = " ".join(line.split())
    if '"' not in line or len(delimiter) > 1:
        return [text.strip() for text in line.split(delimiter)]
    try:
        return [text.strip() for text in next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [""])]
    except csv.Error:
        return [text.strip() for text in line.split(delimiter)]


def number(text, decimal="."):
    """The number that a text is with this ``decimal`` mark, NaN of a missing one, None of any other text.

    Thousands may be set apart by no-break spaces, apostrophes or, before decimals, by the other mark.
    """
    text = text.strip()
    if _NUMBER.fullmatch(text):
        return float(text) if decimal == "." or "." not in text else None
    if text.lower() in MISSING:
        return np.nan
    if text in _INFINITE:
        return _INFINITE[text]
    text = _THOUSANDS.sub("", text.replace("\N{MINUS SIGN}", "-"))
    if _GROUPED[decimal].fullmatch(text):
        text = text.replace("," if decimal == "." else ".", "")
    if decimal == ",":
        text = text.replace(",", ".") if "." not in text else ""
    text = _FORTRAN.sub("e", text)
    return float(text) if _NUMBER.fullmatch(text) else None


def stamp(text):
    """(date as numbers in the order written or None, seconds of the day or None) of a time stamp; None of no stamp."""
    match = _STAMP.fullmatch(text.strip())
    if not match or not (match["date"] or match["hour"]):
        return None
    day = tuple(int(part) for part in re.split("[-/.]", match["date"])) if match["date"] else None
    if not match["hour"]:
        return day, None
    hour = int(match["hour"])
    if match["half"]:
        hour = hour % 12 + 12 * (match["half"].lower() == "p")
    return day, 3600 * hour + 60 * int(match["minute"]) + int(match["second"]) + float(f"0.{match['part'] or 0}")


def seconds_of(stamps):
    """Seconds (n,) from the first of ``stamps`` [(date, seconds of the day)], NaN where one is None.

    Where the order of day and month is open, the one is taken that makes the record shorter; clocks without a date go
    on behind midnight. Returns None for dates that are none.
    """
    clock = np.array([np.nan if s is None else s[1] or 0.0 for s in stamps], float)
    there = [k for k, s in enumerate(stamps) if s is not None]
    if all(stamps[k][0] is None for k in there):
        steps = np.zeros(len(clock))
        steps[there[1:]] = np.cumsum(np.diff(clock[there]) < -DAY / 2)
        return np.round(clock - clock[there[0]] + DAY * steps, _PLACES)
    spans = [days for order in ("dmy", "mdy") if (days := _days([stamps[k][0] for k in there], order)) is not None]
    if not spans:
        return None
    days = np.full(len(clock), np.nan)
    days[there] = min(spans, key=np.ptp)
    return np.round(DAY * (days - days[there[0]]) + (clock - clock[there[0]]), _PLACES)


def _days(dates, order):
    """Days (n,) of dates written year first, else in this ``order``; None where one is no date."""
    known, numbers = {}, []
    for written in dates:
        if written is None:
            return None
        if written not in known:
            year, month, day = written if written[0] > 31 else (written[2], *(written[1::-1] if order == "dmy" else
                                                                              written[:2]))
            try:
                known[written] = date(year + 2000 * (year < 100), month, day).toordinal()
            except ValueError:
                return None
        numbers.append(known[written])
    return np.array(numbers, float)


def is_datum(text, decimal):
    """Whether a text is a number, a missing one or a time stamp."""
    return number(text, decimal) is not None or stamp(text) is not None


def marks(heads, rows, delimiter=None, decimal=None):
    """(delimiter, decimal mark) with which most of the lines ``rows`` are numbers and a line of ``heads`` names them.

    What is stated stays.
    """
    best = None
    for mark in (delimiter,) if delimiter else DELIMITERS:
        for point in (decimal,) if decimal else (".", ","):
            if point == mark and not any('"' in row for row in rows):
                continue
            split = [_without_end(cells(row, mark)) for row in rows]
            whole = sum(all(is_datum(text, point) for text in row) and any(map(len, row)) for row in split)
            numbers = sum(np.isfinite(value) for row in split for text in row
                          if (value := number(text, point)) is not None)
            widths = {len(row) for row in split}
            named = any(len(names) in widths and not all(is_datum(text, point) for text in names)
                        for names in (_without_end(cells(head, mark)) for head in heads))
            score = (whole, named, numbers)
            if best is None or score > best[0]:
                best = (score, (mark, point))
    return best[1] if best else (delimiter or ",", decimal or ".")


def _without_end(texts):
    while len(texts) > 1 and not texts[-1]:
        texts = texts[:-1]
    return texts
