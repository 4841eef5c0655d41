"""Motion of an unstable system from onset to limit cycle."""

import numpy as np

from pipeline.contract import Array, count, parts, product, quantity, text
from pipeline.products.sound import Excerpt


@product(version=2)
class LimitCycle:
    """What unstable modes grow into: motion about steady sliding with opening, stiffening and sticking contacts.

    Operating points are those with unstable modes; all other motion decays.
    """

    pressure: Array = quantity("Pa", "operating", "nominal pressure")
    speed: Array = quantity("rad/s", "operating", "speed of the drive")
    onset_operating: Array = count("onset", "row of the operating point of an unstable mode")
    onset_root: Array = quantity("1/s", "onset", "root of the mode in complex modes", complex)
    onset_simulated: Array = quantity("1/s", "onset", "growth rate and angular frequency of the mode while the simulated motion is small", complex)
    sensor_name: Array = text("sensor", "sensor names")
    window: Array = quantity("s", "", "length of the windows of the levels")
    level: Array = quantity("m/s", "operating sensor stretch", "root mean square velocity in successive windows")
    open_share: Array = quantity("1", "operating stretch", "share of the contacts that are open, mean over the window")
    stick_share: Array = quantity("1", "operating stretch", "share of the contact patches that stick, mean over the window")
    settled: Array = count("operating", "1 where the level changes by less than settled_within over the last two windows")
    settled_within: Array = quantity("1", "", "largest change of the level, in dB")
    imbalance: Array = quantity("1", "operating", "largest error of the energy balance in the last window over the energy exchanged")
    added_loss: Array = quantity("1", "operating", "share of the energy lost that goes to the damping added above the modes of interest")
    time: Array = quantity("s", "time", "time in the recorded end of the motion")
    velocity: Array = quantity("m/s", "operating sensor time", "velocity at the sensors at the end of the motion", np.float32)
    frequency: Array = quantity("Hz", "frequency", "frequency axis of the spectra")
    spectrum: Array = quantity("m/s", "operating sensor frequency", "amplitude spectrum of the end of the motion, Hann window")
    cycle_frequency: Array = quantity("Hz", "operating", "frequency of the strongest line over the sensors")
    harmonic_amplitude: Array = quantity("m/s", "operating sensor harmonic", "amplitude at 1, 2, ... times that frequency")
    patches: Array = count("", "contact patches")
    modes: Array = count("", "modes that move, damped ones above the modes of interest included")
    step: Array = quantity("s", "", "time step")
    check: Array = text("check", "what was changed to see how far the result holds, at the strongest operating point")
    check_level: Array = quantity("1", "check", "change of the level by it in dB, all sensors together")
    check_frequency: Array = quantity("1", "check", "change of the frequency of the strongest line by it, as a share of it")
    listen: dict[str, Excerpt] = parts("squeal: the loudest limit cycle, to listen to; nothing where all motion decays", empty=True)
