"""Every file of a run folder hashed: products by the checksum behind them, companions by their product's record."""

import json
from dataclasses import dataclass
from pathlib import Path

from pipeline.contract import store
from pipeline.contract.errors import ConfigError, ProductError
from pipeline.contract.integrity import checksum, examined, seen
from pipeline.contract.received import files, names


@dataclass(frozen=True)
class Checked:
    """A file of a run folder by its path in there, and what is wrong with it: '' for nothing."""

    name: str
    flaw: str


def verify(folder):
    """[Checked] of all products of a run folder and its variants, each followed by its companions.

    ProductError for a folder without products.
    """
    folder = Path(folder)
    products = sorted(folder.glob("*.h5")) + sorted(folder.glob("variants/*/*.h5"))
    if not products:
        raise ProductError(folder, "a run folder with products", "none", "name the folder that 'brakechain run' wrote")
    flaws = {path: _flaw(folder, path) for path in products}
    examined.examine([path for path, told in flaws.items() if not told])
    return [checked for path, told in flaws.items()
            for checked in _of_product(folder, path, told or examined.flaw(path))]


def _flaw(folder, path):
    try:
        names.within(folder, path.relative_to(folder))
        return checksum.flaw(path)
    except (OSError, ConfigError) as error:
        return str(error)


def _of_product(folder, path, told):
    name = str(path.relative_to(folder))
    try:
        companions = {} if told else recorded(store.provenance(path))
    except (OSError, ValueError) as error:
        yield Checked(name, str(error))
        return
    except Exception as error:      # whatever HDF5 makes of a file with a right checksum
        yield Checked(name, f"{type(error).__name__}: {error}")
        return
    yield Checked(name, told)
    for companion, digest in companions.items():
        beside = path.with_name(companion)
        yield Checked(str(beside.relative_to(folder)), _of_companion(beside, digest))


def _of_companion(path, digest):
    try:
        return "" if checksum.digest_of_file(path) == digest else checksum.WRONG
    except OSError as error:
        return error.strerror or str(error)


def recorded(provenance):
    """{name: digest} of the companions that the provenance of a product lists; ValueError of no such list."""
    companions = json.loads(provenance["companions"])
    if not isinstance(companions, dict) or not all(names.is_name(name) for name in companions):
        raise ValueError("a list of companions that is none")
    return companions


def of_companions(folder, companions):
    """What is wrong with ``companions`` {name: digest} of a product in a folder; one phrase each."""
    missing = [name for name in companions if not files.is_plain(folder / name)]
    changed = [name for name in companions if name not in missing and seen.differs(folder / name, companions[name])]
    return ["a companion file is missing"] * bool(missing) + [f"{name} is not as it was written" for name in changed]
