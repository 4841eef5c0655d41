"""Files by the writers of others with planted facts: what is read has their numbers, instants and sign, or says why not."""

from tests.fuzz.semantics import channel_files, column_files, sound_files
from tests.fuzz.semantics.planted import read
from tests.fuzz.trial import Target

TARGETS = (
    Target("tdms meaning", read, channel_files.tdms, apart=True),
    Target("mdf meaning", read, channel_files.mdf, apart=True),
    Target("audio meaning", read, sound_files.audio, apart=True),
    Target("files meaning", read, sound_files.pair, apart=True),
    Target("table meaning", read, column_files.table, (column_files.plain_text,)),
    Target("matlab meaning", read, column_files.matlab, apart=True),
)
