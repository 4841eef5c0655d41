"""Products of a run that an export needs, and the operating point that it is about."""

from pipeline.contract import ConfigError, store
from pipeline.products import ComplexModes, Effects, FrictionMap, ReducedModel

#: pressures below it are told in Pa
_SMALL = 1e3


def product_of(cls, folder, optional=False):
    """The product ``cls`` in a run ``folder``; None where it is ``optional`` and there is none.

    Raises ProductError where it is missing or cannot be read.
    """
    path = folder / f"{cls.name}.h5"
    return None if optional and not path.exists() else store.read(cls, path)


def sliding_products(folder):
    """(ComplexModes, ReducedModel, FrictionMap or None, Effects or None) of a run ``folder``; errors as above."""
    modes, model = product_of(ComplexModes, folder), product_of(ReducedModel, folder)
    return modes, model, product_of(FrictionMap, folder, True), product_of(Effects, folder, True)


def operating_point(modes, wanted=None):
    """Index of an operating point of the product ComplexModes: ``wanted``, or that of its most unstable mode.

    Raises ConfigError for one that does not exist, with those that do.
    """
    count = len(modes.operating_speed)
    if wanted is None:
        return int(modes.unstable_operating[0]) if len(modes.unstable_operating) else 0
    if not 0 <= wanted < count:
        raise ConfigError("--state", f"one of {'; '.join(described(modes, k) for k in range(count))}", str(wanted))
    return int(wanted)


def described(modes, operating):
    """The operating point in words, such as '3 (1 MPa, 8.5 rad/s)'."""
    pressure = modes.operating_pressure[operating]
    size = f"{pressure / 1e6:.4g} MPa" if pressure >= _SMALL else f"{pressure:.4g} Pa"
    return f"{operating} ({size}, {modes.operating_speed[operating]:.4g} rad/s)"


def refuse_existing(path):
    """ConfigError where something is at ``path`` already, or no folder that it can be made in."""
    if path.exists() or path.is_symlink():
        raise ConfigError(path, "a name that is free", "a folder" if path.is_dir() else "a file",
                          "choose another name, or delete it")
    if not path.absolute().parent.is_dir():
        raise ConfigError(path.absolute().parent, "a folder", "none", "make it first")


def safe_names(names):
    """``names`` with letters, digits, - and _ alone, each once: as names of files and keys."""
    plain, used = [], set()
    for name in names:
        base = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in str(name)) or "_"
        number, chosen = 2, base
        while chosen in used:
            chosen, number = f"{base}_{number}", number + 1
        used.add(chosen)
        plain.append(chosen)
    return plain

