"""TDMS files of LabVIEW and its relatives. The door of npTDMS."""

from pipeline.contract.errors import BrakechainError, ConfigError
from pipeline.contract.mapped import Growing
from pipeline.recordings.waveform import Waveform, held_as, library


def read_tdms(path, folder=None):
    """{'group/channel': Waveform} of the channels with numbers in a TDMS file, scaled as it says.

    ``folder``: for long channels, see ``Growing``. Raises ConfigError for a file that is none, is cut off or damaged,
    or holds no numbers.
    """
    tdms = library("nptdms", "npTDMS", path)
    try:
        with tdms.TdmsFile.open(str(path)) as file:
            if file.file_status.incomplete_final_segment:
                raise ConfigError(path, "a whole TDMS file", "one whose last segment is cut off", "copy it again")
            found = {f"{group.name}/{channel.name}": _waveform(channel, folder)
                     for group in file.groups() for channel in group.channels()
                     if len(channel) and channel.dtype.kind in "fiu"}
    except BrakechainError:
        raise
    except Exception as error:  # npTDMS passes on whatever its parser stumbles over
        raise ConfigError(path, "an undamaged TDMS file", str(error) or type(error).__name__) from None
    if not found:
        raise ConfigError(path, "a channel of numbers", "none")
    return found


def _waveform(channel, folder):
    step, values = float(channel.properties.get("wf_increment", 0.0)), Growing(held_as(channel.dtype), folder)
    for chunk in channel.data_chunks():
        values.append(chunk[:])
    return Waveform(values.array(), str(channel.properties.get("unit_string", "")).strip(),
                    1.0 / step if step > 0.0 else None, float(channel.properties.get("wf_start_offset", 0.0)))
