"""Peak memory of a command and its children, as Linux counts it.

Not getrusage: what a child inherits of its parent counts there as its own.
"""

import subprocess
import time
from pathlib import Path

#: seconds between two looks
_INTERVAL = 0.02


def peaks(command, **options):
    """(largest peak of one process, largest sum over all at one time) in MB of a command that ends with 0.

    The peak is VmHWM; in the sum pages that processes share count once (Pss).
    """
    child, largest, together = subprocess.Popen(list(map(str, command)), **options), 0.0, 0.0
    while child.poll() is None:
        family = _family(child.pid)
        largest = max([largest, *(_told(one, "status", "VmHWM") for one in family)])
        together = max(together, sum(_told(one, "smaps_rollup", "Pss") for one in family))
        time.sleep(_INTERVAL)
    assert child.returncode == 0
    return largest, together


def _family(process):
    """A process and all that descend from it."""
    found = [process]
    for one in found:
        try:
            tasks = [task.read_text() for task in Path(f"/proc/{one}/task").glob("*/children")]
        except OSError:
            continue        # it ended meanwhile
        found += [int(number) for text in tasks for number in text.split()]
    return found


def _told(process, file, name):
    """MB that a file of /proc tells of a process under this name; 0 where it ended."""
    try:
        lines = Path(f"/proc/{process}/{file}").read_text().splitlines()
    except OSError:
        return 0.0
    return next((float(line.split()[1]) / 1e3 for line in lines if line.startswith(f"{name}:")), 0.0)
