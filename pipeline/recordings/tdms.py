"""TDMS files of LabVIEW and its relatives. The door of npTDMS."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.recordings.waveform import Waveform, library


def read_tdms(path):
    """{'group/channel': Waveform} of the channels with numbers in a TDMS file, scaled as it says.

    Raises ConfigError for a file that is none, is cut off or damaged, or holds no numbers.
    """
    tdms = library("nptdms", "npTDMS", path)
    try:
        with tdms.TdmsFile.open(str(path)) as file:
            if file.file_status.incomplete_final_segment:
                raise ConfigError(path, "a whole TDMS file", "one whose last segment is cut off", "copy it again")
            found = {f"{group.name}/{channel.name}": _waveform(channel)
                     for group in file.groups() for channel in group.channels()
                     if len(channel) and channel.dtype.kind in "fiu"}
    except ConfigError:
        raise
    except Exception as error:  # npTDMS passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged TDMS file", str(error) or type(error).__name__) from None
    if not found:
        raise ConfigError(path, "a channel of numbers", "none")
    return found


def _waveform(channel):
    step = float(channel.properties.get("wf_increment", 0.0))
    return Waveform(np.asarray(channel[:], float), str(channel.properties.get("unit_string", "")).strip(),
                    1.0 / step if step > 0.0 else None, float(channel.properties.get("wf_start_offset", 0.0)))
