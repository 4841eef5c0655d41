"""Memory that is available, and a refusal of work that would need more, before it begins."""

from pathlib import Path

from pipeline.contract.errors import ConfigError

_MEMINFO = Path("/proc/meminfo")


def available_memory():
    """Bytes that a process may use without pushing others out, as Linux states them; None on other systems."""
    try:
        lines = _MEMINFO.read_text().splitlines()
    except OSError:
        return None
    stated = next((line.split()[1] for line in lines if line.startswith("MemAvailable:")), None)
    return None if stated is None else 1024 * int(stated)


def refuse_beyond_memory(needed, what, where="memory", remedy="use fewer workers or a coarser mesh"):
    """ConfigError at ``where`` if ``what`` needs more than the bytes that are available."""
    available = available_memory()
    if available is not None and needed > available:
        raise ConfigError(where, f"{needed / 1e9:.2g} GB for {what}", f"{available / 1e9:.2g} GB available", remedy)
