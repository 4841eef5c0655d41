"""Files by the writers of others with planted facts: their numbers, instants and sign come back, or it is said why."""

from tests.fuzz.semantics import channel_files, column_files, neutral_files, scans, sound_files, universal_files
from tests.fuzz.semantics.planted import read
from tests.fuzz.trial import Target

TARGETS = (
    Target("tdms meaning", read, channel_files.tdms, apart=True),
    Target("mdf meaning", read, channel_files.mdf, apart=True),
    Target("audio meaning", read, sound_files.audio, (sound_files.overloaded,), True),
    Target("files meaning", read, sound_files.pair, apart=True),
    Target("table meaning", read, column_files.table, (column_files.plain_text, column_files.grouped, column_files.lost,
                                                          column_files.labview), share=0.5),
    Target("matlab meaning", read, column_files.matlab, apart=True),
    Target("uff meaning", read, universal_files.uff, apart=True),
    Target("scan meaning", scans.read, scans.scan, apart=True),
    Target("hdf5 meaning", read, neutral_files.hdf5, apart=True),
)
