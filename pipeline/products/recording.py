"""Recordings: measured data, run by run, and the modes of a measured structure."""

import numpy as np

from pipeline.contract import Array, count, parts, product, quantity, text
from pipeline.contract.mapped import blocks

#: conditions that channels tell: what these measure, and its unit
CONDITIONS = {"pressure": (("pressure",), "Pa"), "speed": (("angular_velocity", "speed"), "rad/s"),
              "temperature": (("temperature",), "K")}
#: largest pressure of sound, Pa, but for one sample in so many
_SOUND, _LOUDER = 2e3, 1000


@product(version=1)
class Channel:
    """One sampled signal of a run."""

    samples: Array = quantity("1", "sample", "samples in the unit that `unit` names; 0 where missing", narrow=True)
    missing: Array = count("sample_gap bound", "first sample of each gap in the data, and the first after it")
    unit: Array = text("", "coherent SI unit of the samples")
    measures: Array = text("", "what is measured: displacement, velocity, acceleration, force, pressure, voltage, ...")
    rate: Array = quantity("Hz", "", "sampling rate")
    begin: Array = quantity("s", "", "time of the first sample")
    place: Array = text("", "named point or joint; empty if not given")
    position: Array = quantity("m", "xyz", "position of the point; size 0 if not given")
    direction: Array = quantity("1", "axis", "direction, unit vector; size 0 if not given")
    role: Array = text("", "response or excitation")

    def heard(self):
        """Whether a pressure is that of sound: about 0, and of its size but for one sample in a thousand."""
        if str(self.measures) not in ("pressure", "value"):
            return False
        moments = np.array([(np.sum(x, dtype=float), np.sum(np.square(x, dtype=float)), np.sum(np.abs(x) >= _SOUND))
                            for x in blocks(self.samples)])
        mean, square, large = moments.sum(axis=0) / len(self.samples)
        return bool(large * _LOUDER <= 1 and mean**2 <= square - mean**2)


@product(version=1)
class Condition:
    """A condition of a run: one value, or a series over time."""

    value: Array = quantity("1", "moment", "value in the unit that `unit` names")
    time: Array = quantity("s", "moment", "time of each value; 0 for a condition that does not change")
    unit: Array = text("", "coherent SI unit of the values")


@product(version=1)
class FrequencyResponse:
    """A measured frequency response function."""

    frequency: Array = quantity("Hz", "frequency", "frequency axis")
    response: Array = quantity("1", "frequency", "response per reference, in the unit that `unit` names", complex)
    unit: Array = text("", "unit of the function, e.g. m/s^2/N")
    place: Array = text("", "location and direction of the response")
    reference: Array = text("", "location and direction of the reference")


@product(version=1)
class MeasuredModes:
    """Identified modes with their standard deviations."""

    frequency: Array = quantity("Hz", "mode", "natural frequencies")
    frequency_std: Array = quantity("Hz", "mode", "their standard deviations")
    damping_ratio: Array = quantity("1", "mode", "damping ratios; 0 where not measured")
    damping_ratio_std: Array = quantity("1", "mode", "their standard deviations; 0 where not measured")
    place: Array = text("place", "locations and directions of the shapes")
    shape: Array = quantity("1", "mode place", "mode shapes", complex)


@product(version=2)
class Lines:
    """A published list of peaks, where no raw signal exists."""

    label: Array = text("line", "names of the lines, empty where they have none")
    frequency: Array = quantity("Hz", "line", "frequencies")
    frequency_tolerance: Array = quantity("Hz", "line", "reading uncertainty of the frequencies")
    level: Array = quantity("1", "line", "levels in dB re the strongest line; 0 where none is given")
    level_known: Array = count("line", "1 where a level is given")
    partners: Array = count("line", "1: mode without a partner, 2: one of a pair; 0 if not given")
    diameters: Array = count("line", "nodal diameters of its mode; -1 if not given")
    place: Array = text("", "where the spectrum was measured")


@product(version=1)
class Topography:
    """A measured height map."""

    y: Array = quantity("m", "y", "lateral position across sliding")
    x: Array = quantity("m", "x", "lateral position along sliding")
    height: Array = quantity("m", "y x", "heights, positive out of the solid")
    body: Array = text("", "body, e.g. disc or pad")
    state: Array = text("", "new or worn")


@product(version=1)
class MeasuredFriction:
    """Measured coefficients of friction with their conditions."""

    friction: Array = quantity("1", "sample", "coefficient of friction")
    friction_std: Array = quantity("1", "sample", "its standard error")
    pressure: Array = quantity("Pa", "sample", "nominal contact pressure")
    speed: Array = quantity("m/s", "sample", "sliding speed")
    distance: Array = quantity("m", "sample", "sliding distance")
    temperature: Array = quantity("K", "sample", "temperature")


@product(version=1)
class FileClock:
    """Where the times of a file lie on the clock of a run."""

    offset: Array = quantity("s", "", "what was added to the times of the file")
    offset_std: Array = quantity("s", "", "its standard deviation; 0 where none is stated")
    origin: Array = text("", "how it is known: stated, by time stamps, or by channels that both files hold")


@product(version=3)
class Run:
    """One run on a test bench, or a declared stretch of a long record."""

    description: Array = text("", "what was done")
    repeat_of: Array = text("", "name of the run that this one repeats; empty for none")
    conditions: dict[str, Condition] = parts("conditions by name: pressure, speed, normal_load, temperature, ...",
                                             empty=True)
    channels: dict[str, Channel] = parts("sampled signals by name", empty=True)
    frf: dict[str, FrequencyResponse] = parts("frequency response functions by name", empty=True)
    modes: dict[str, MeasuredModes] = parts("identified modes by name", empty=True)
    lines: dict[str, Lines] = parts("published peak lists by name", empty=True)
    topography: dict[str, Topography] = parts("height maps by name", empty=True)
    friction: dict[str, MeasuredFriction] = parts("measured friction by name", empty=True)
    clocks: dict[str, FileClock] = parts("offsets of the files that it is made of, by file", empty=True)

    def telling(self, condition, unit=None):
        """{name: Channel} of those that tell one of CONDITIONS, in its ``unit`` if not another; no pressure of sound.
        """
        measures, usual = CONDITIONS[condition]
        return {name: channel for name, channel in self.channels.items() if str(channel.unit) == (unit or usual)
                and str(channel.measures) in measures and not (condition == "pressure" and channel.heard())}


@product(version=3)
class Recording:
    """Measured data in one format; simulations embed the same runs in their products."""

    source: Array = text("source", "files that it was read from, with SHA-256")
    remarks: Array = text("remark", "what was left out, taken for granted or made of what the files hold", empty=True)
    runs: dict[str, Run] = parts("runs by name")


@product(version=2)
class TestResponses:
    """Frequency responses of one test, given or estimated from records, on one frequency axis."""

    line: Array = quantity("Hz", "line", "frequency axis")
    response: Array = quantity("1", "function line", "responses per reference, each in its own unit", complex)
    coherence: Array = quantity("1", "known line", "multiple coherence of each response; none where it is not known")
    label: Array = text("function", "channel of each response, or name of the function in the file")
    unit: Array = text("function", "its unit, e.g. m/s^2/N")
    place: Array = text("function", "location and direction of the response")
    reference: Array = text("function", "location and direction of the reference")
    method: Array = text("", "given, blows, lasting force, motions alone, or several of these")
    averages: Array = count("record", "segments or blows of each record, 0 where given")
    left_out: Array = text("blow", "blows that were left out, when and why")
    decay: Array = quantity("1/s", "", "what windows add to every decay rate")
    remark: Array = text("remark", "what was changed of responses as given, or cannot be told of them, in sentences")


@product(version=2)
class ResponseFunctions:
    """Frequency responses of every test of a recording."""

    tests: dict[str, TestResponses] = parts("by run, or of all runs together", empty=True)


@product(version=2)
class TestModes:
    """Modes that the frequency responses of one run hold."""

    frequency: Array = quantity("Hz", "mode", "natural frequencies, absolute values of the poles")
    frequency_std: Array = quantity("Hz", "mode", "their standard deviations")
    damping_ratio: Array = quantity("1", "mode", "damping ratios")
    damping_ratio_std: Array = quantity("1", "mode", "their standard deviations")
    narrow: Array = count("mode", "1 where its peak is too narrow for the lines of a lasting force: damping comes out too large")
    partner: Array = count("mode", "mode that makes a pair with it, close in frequency and of another shape; itself without one")
    place: Array = text("response", "location and direction of each response")
    reference: Array = text("response", "location and direction of its reference")
    shape: Array = quantity("1", "mode response", "residue of each response, in its unit times rad/s", complex)
    shape_std: Array = quantity("1", "mode response", "standard deviation of its size")
    likeness: Array = quantity("1", "mode other", "modal assurance criterion of the shapes among themselves")
    noise: Array = quantity("1", "response", "effective value of what the modes leave, over that of the response")
    line: Array = quantity("Hz", "line", "frequency axis")
    measured: Array = quantity("1", "line", "root mean square over the responses, each over its own effective value")
    fitted: Array = quantity("1", "line", "the same of the modes")
    order: Array = count("pole", "order of the denominator that a pole belongs to")
    pole_frequency: Array = quantity("Hz", "pole", "its frequency")
    pole_damping: Array = quantity("1", "pole", "its damping ratio")
    stable: Array = count("pole", "1 where it came back from the order before")
    chosen: Array = count("pole", "mode that it became, -1 for none")


@product(version=1)
class ModalTest:
    """Modal test: poles and shapes of the runs with frequency responses."""

    runs: dict[str, TestModes] = parts("by run", empty=True)
