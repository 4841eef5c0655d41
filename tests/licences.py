"""'make licences': the licence of every installed package, of what kind it is, and which lock asks for it.

A user's environment may hold no package under a strong copyleft licence; ends with 1 where it does, or where a licence
is not known.
"""

import re
import sys
from dataclasses import dataclass
from importlib.metadata import distributions
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: kinds in the order in which they are looked for, and what a statement of a licence holds of each
KINDS = {"strong copyleft": r"AGPL|Affero|(?<!L)GPL|(?<!Lesser )General Public License",
         "weak copyleft": r"LGPL|Lesser General Public|MPL|Mozilla",
         "of its maker": r"Proprietary|Intel|EXUDYN",
         "permissive": r"MIT|BSD|Apache|PSF|Python Software Foundation|ISC|Zlib|HPND|CC0|0BSD|matplotlib"}
#: statements that say less than the licence file beside them, which was read
READ = {"fmpy": "BSD-2-Clause", "umf": "Apache-2.0 WITH LLVM-exception"}
_SHOWN = 60


@dataclass(frozen=True)
class Package:
    """An installed package: its ``name`` as a lock writes it, version and what it states as its ``licence``."""

    name: str
    version: str
    licence: str

    @property
    def kind(self):
        """One of KINDS, or 'unknown'."""
        return next((kind for kind, wanted in KINDS.items() if re.search(wanted, self.licence)), "unknown")


def locked(name):
    """Packages that the lock file ``name`` pins."""
    pins = re.findall(r"^([\w.\-]+)(?:\[[^\]]*\])?==", (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)
    return {_written(pin) for pin in pins}


def installed():
    """[Package] of this environment but brakechain itself, by name."""
    found = {_written(each.name): Package(_written(each.name), each.version, stated(each.name, each.metadata))
             for each in distributions()}
    return [found[name] for name in sorted(found) if name != "brakechain"]


def stated(name, metadata):
    """The licence that the metadata of a distribution state: as an expression, by classifiers, or in words."""
    if name in READ:
        return READ[name]
    classifiers = [line.split("::")[-1].strip() for line in metadata.get_all("Classifier") or ()
                   if line.startswith("License ::")]
    words = next((line.strip(" #") for line in (metadata.get("License") or "").splitlines() if line.strip()), "")
    return metadata.get("License-Expression") or ", ".join(classifiers) or words


def _written(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def main():
    """Print the table; 1 where a user's package is under a licence that it may not be under."""
    users, developers = locked("requirements.lock"), locked("requirements-dev.lock")
    refused = 0
    for package in installed():
        of = "user" if package.name in users else "developer" if package.name in developers else "neither lock"
        wrong = package.kind == "unknown" or (of == "user" and package.kind == "strong copyleft")
        refused += wrong
        print(f"{package.name:<24} {package.version:<14} {of:<13} {package.kind:<16} {package.licence[:_SHOWN]}"
              f"{'   REFUSED' if wrong else ''}")
    return int(refused > 0)


if __name__ == "__main__":
    sys.exit(main())
