"""Planted facts in scans: pixel sizes, units of heights and of lengths, channels, gaps, order of rows and points."""

import hashlib
import io
import struct
import zipfile

import numpy as np

from pipeline.case_models.rough.scans import levelled
from pipeline.case_models.rough.sections import ScanFile
from pipeline.contract.settings import fill
from pipeline.physics.rough.topography import level
from tests.fuzz.mutation import draw
from tests.fuzz.trial import Trial, difference

_LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "µm": 1e-6, "": 1.0}
_ASCII = ("m", "mm", "um", "nm")


def read(path, **stated):
    """Heights, spacing and what is told of a scan as a section of a case has it, levelled."""
    found = levelled(fill(ScanFile, {"file": str(path), "outlier_threshold": 1e6} | stated, "case.yaml: surface.pad"),
                     "surface.pad")
    return {"heights": found.heights, "spacing": found.spacing, "told": found.told}


def surface(rng):
    """(heights (row, column) in m with gaps, (dy, dx) in m): no row or column looks like another."""
    rows, columns = int(rng.integers(14, 30)), int(rng.integers(14, 30))
    x, y = np.meshgrid(np.arange(columns), np.arange(rows))
    heights = np.sin(0.7 * x + rng.random()) + 0.5 * np.cos(0.5 * y) + 0.2 * rng.normal(size=(rows, columns))
    heights = 10.0 ** rng.uniform(-7, -5) * heights
    if rng.random() < 0.3:
        heights[int(rng.integers(rows)), int(rng.integers(1, columns - 3)):][:2] = np.nan
    dx = float(f"{10.0 ** rng.uniform(-7, -5):.3g}")
    return heights, (dx if rng.random() < 0.5 else float(f"{dx * rng.uniform(0.4, 2.5):.3g}"), dx)


def _meant(heights, spacing, exact):
    """The check of a scan by its true heights and pixels."""
    def check(value):
        wanted = level(heights, spacing)[0]
        return difference(np.array(value["spacing"]), np.array(spacing), 1e-4, "pixels") or difference(
            value["heights"], wanted, exact, "heights")

    return check


def scan(rng):
    """A file of one of several kinds."""
    return draw(rng, (_gwyddion, _gwyddion, _points, _points, _matrix, _headed, _array, _surfer, _x3p))(rng)


def _gwyddion(rng):
    """A file of Gwyddion with one to three channels, of which one is heights or several are."""
    heights, spacing = surface(rng)
    lateral, height = draw(rng, ("m", "m", "um", "nm", "mm", "µm", "")), draw(rng, ("m", "m", "um", "nm", "µm", ""))
    heights = np.nan_to_num(heights)
    channels = [("Topography", heights / _LENGTHS[height], height)]
    others = [("Phase", "deg"), ("Amplitude error", "m"), ("Error", "V"), ("Height", height)]
    for title, unit in [others[k] for k in rng.permutation(4)[:int(rng.integers(0, 3))]]:
        channels.insert(int(rng.integers(len(channels) + 1)), (title, rng.normal(size=heights.shape), unit))
    several = sum(unit in _LENGTHS for _, _, unit in channels) > 1
    named = {"channel": "Topography"} if several and rng.random() < 0.6 else {}
    content = gwyddion(channels, spacing, lateral)
    asked = (several and not named) or "" in (lateral, height)
    must = "refuse" if asked else "either" if "µm" in (lateral, height) else "read"
    return Trial("a.gwy", content, f"Gwyddion, {len(channels)} channels in {lateral}, {height}", named,
                 _meant(heights, spacing, 1e-6), must)


def gwyddion(channels, spacing, lateral="m"):
    """Bytes of a file of Gwyddion (its documented format, GWYP) with channels [(title, numbers, unit)]."""
    def component(name, kind, content):
        return name.encode() + b"\0" + kind + content

    def held(name, content):
        return name.encode() + b"\0" + struct.pack("<I", len(content)) + content

    inside = b""
    for k, (title, numbers, unit) in enumerate(channels):
        rows, columns = numbers.shape
        sizes = (("xreal", columns * spacing[1]), ("yreal", rows * spacing[0]))
        field = component("xres", b"i", struct.pack("<i", columns)) + component("yres", b"i", struct.pack("<i", rows))
        field += b"".join(component(n, b"d", struct.pack("<d", s / _LENGTHS[lateral])) for n, s in sizes)
        field += b"".join(component(n, b"o", held("GwySIUnit", component("unitstr", b"s", u.encode() + b"\0")))
                          for n, u in (("si_unit_xy", lateral), ("si_unit_z", unit)))
        field += component("data", b"D", struct.pack("<I", numbers.size) + numbers.astype("<f8").tobytes())
        inside += component(f"/{k}/data", b"o", held("GwyDataField", field))
        inside += component(f"/{k}/data/title", b"s", title.encode() + b"\0")
    return b"GWYP" + held("GwyContainer", inside)


def _points(rng):
    """Points x y z in any order, from anywhere, with units in the head or stated in the case."""
    heights, spacing = surface(rng)
    lateral, height = draw(rng, _ASCII), draw(rng, ("um", "nm", "mm"))
    rows, columns = np.indices(heights.shape)
    begin = np.array([draw(rng, (0.0, 5.0, -3.0)), draw(rng, (0.0, -7.0))])
    x = (begin[0] + columns) * spacing[1] / _LENGTHS[lateral]
    y = (begin[1] + rows) * spacing[0] / _LENGTHS[lateral]
    table = np.column_stack([x.ravel(), y.ravel(), heights.ravel() / _LENGTHS[height]])
    table = table[np.isfinite(table[:, 2])]
    table = table[rng.permutation(len(table))] if rng.random() < 0.5 else table
    mark, how = draw(rng, (" ", ",", "\t", ";")), draw(rng, ("head", "case", "case", "nothing"))
    head = mark.join(f"{n}[{u}]" for n, u in zip("XYZ", (lateral, lateral, height), strict=True)) + "\n"
    stated = {} if how != "case" else {"height_unit": f"1 {height}"} | (
        {} if lateral == height and rng.random() < 0.5 else {"lateral_unit": f"1 {lateral}"})
    text = "".join(mark.join(f"{v:.9g}" for v in row) + "\n" for row in table)
    text = text.replace(".", ",") if mark in ";\t" and rng.random() < 0.4 else text
    return Trial("a.xyz", ((head if how == "head" else "") + text).encode(), f"points, units by {how}", stated,
                 _meant(heights, spacing, 1e-5), "refuse" if how == "nothing" else "read")


def _matrix(rng):
    """A matrix of heights alone; the case states pixels and unit."""
    heights, spacing = surface(rng)
    height, mark = draw(rng, ("um", "nm", "mm")), draw(rng, (" ", ",", "\t", ";"))
    stated = _stated(spacing, height) if rng.random() < 0.8 else draw(
        rng, ({}, {"height_unit": f"1 {height}"}, {"pixel_size": f"{spacing[1]!r} m"}))
    gone = draw(rng, ("nan", "NaN", "bad", "***"))
    text = "".join(mark.join(gone if np.isnan(v) else f"{v / _LENGTHS[height]:.9g}" for v in row) + "\n"
                   for row in heights)
    text = text.replace(".", ",") if mark in ";\t" and rng.random() < 0.4 else text
    whole = len(stated) > 1
    turned = {"transposed": True} if whole and rng.random() < 0.2 else {}
    return Trial("a.txt", text.encode(), "matrix of heights", stated | turned, _meant(
        *((heights.T, spacing[::-1]) if turned else (heights, spacing)), 1e-5), "read" if whole else "refuse")


def _stated(spacing, height):
    return {"pixel_size": f"{spacing[1]!r} m", "height_unit": f"1 {height}"} | (
        {} if spacing[0] == spacing[1] else {"pixel_size_y": f"{spacing[0]!r} m"})


def _headed(rng):
    """The text that Gwyddion exports, with width, height and unit in its head."""
    heights, spacing = surface(rng)
    heights = np.nan_to_num(heights)
    lateral, height = draw(rng, ("um", "mm", "nm", "µm")), draw(rng, ("m", "um", "nm"))
    size = [count * step / _LENGTHS[lateral] for count, step in zip(heights.shape, spacing, strict=True)]
    head = (f"# Channel: Topography\n# Width: {size[1]:.9g} {lateral}\n# Height: {size[0]:.9g} {lateral}\n"
            f"# Value units: {height}\n")
    rows = "\n".join("\t".join(f"{v / _LENGTHS[height]:.9e}" for v in row) for row in heights)
    return Trial("a.txt", (head + rows + "\n").encode(), f"matrix with a head in {lateral}, {height}", {},
                 _meant(heights, spacing, 1e-5), "either" if lateral == "µm" else "read")


def _array(rng):
    """An array of numpy, or a variable of a MATLAB file; the case states pixels and unit."""
    from scipy.io import savemat

    heights, spacing = surface(rng)
    heights, height = np.nan_to_num(heights), draw(rng, ("um", "nm", "m"))
    numbers, form, stream = heights / _LENGTHS[height], draw(rng, ("npy", "mat")), io.BytesIO()
    if form == "npy":
        np.save(stream, numbers)
    else:
        savemat(stream, {"heights": numbers})
    return Trial(f"a.{form}", stream.getvalue(), f"array in {form}", _stated(spacing, height),
                 _meant(heights, spacing, 1e-5), "either" if form == "mat" else "read")


def _surfer(rng):
    """A surface data file of ISO 25178-71, text form, with its three scales; a negative one turns the heights."""
    heights, spacing = surface(rng)
    heights = np.nan_to_num(heights)
    scale = float(f"{np.ptp(heights) / 30000:.4g}")
    raw = np.rint(heights / scale).astype(int)
    head = {"ManufacID": "test", "CreateDate": "271120260800", "ModDate": "271120260800", "NumPoints": heights.shape[1],
            "NumProfiles": heights.shape[0], "Xscale": spacing[1], "Yscale": spacing[0], "Zscale": scale,
            "Zresolution": -1, "Compression": 0, "DataType": 5, "CheckType": 0}
    rows = "\n".join(" ".join(map(str, row)) for row in raw)
    content = "aISO-1.0\n" + "".join(f"{k}={v}\n" for k, v in head.items()) + "*\n" + rows + "\n*\n"
    return Trial("a.sdf", content.encode(), "ISO 25178-71", {}, _meant(scale * raw, spacing, 1e-5), "read")


def _x3p(rng):
    """A file of ISO 25178-72, heights as doubles or as whole numbers of an increment, with an offset of its axes."""
    heights, spacing = surface(rng)
    heights = np.nan_to_num(heights)
    scale, kind = float(f"{np.ptp(heights) / 30000:.4g}"), draw(rng, ("D", "L", "I"))
    numbers = heights if kind == "D" else np.rint(heights / scale)
    true = heights if kind == "D" else scale * numbers
    data = numbers.astype({"D": "<f8", "L": "<i4", "I": "<i2"}[kind]).tobytes()

    def axis(name, how, form, step, offset):
        return (f"<C{name}><AxisType>{how}</AxisType><DataType>{form}</DataType><Increment>{step!r}</Increment>"
                f"<Offset>{offset!r}</Offset></C{name}>")

    axes = axis("X", "I", "D", spacing[1], 0.0) + axis("Y", "I", "D", spacing[0], 0.0) + axis(
        "Z", "A", kind, 1.0 if kind == "D" else scale, float(draw(rng, (0.0, 1e-6))))
    head = ('<?xml version="1.0" encoding="UTF-8"?><p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1>'
            f"<Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>{axes}</Axes></Record1><Record2>"
            "<Date>2026-11-27T08:00:00</Date><Creator>test</Creator></Record2><Record3><MatrixDimension><SizeX>"
            f"{heights.shape[1]}</SizeX><SizeY>{heights.shape[0]}</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink>"
            "<PointDataLink>bindata/data.bin</PointDataLink><MD5ChecksumPointData>"
            f"{hashlib.md5(data, usedforsecurity=False).hexdigest()}</MD5ChecksumPointData></DataLink></Record3>"
            "<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as file:
        file.writestr("main.xml", head)
        file.writestr("bindata/data.bin", data)
        file.writestr("md5checksum.hex", hashlib.md5(head.encode(), usedforsecurity=False).hexdigest() + " *main.xml")
    return Trial("a.x3p", stream.getvalue(), f"ISO 25178-72, {kind}", {}, _meant(true, spacing, 1e-5), "read")
