"""The template of every page, with the scripts that it runs: no other text of a page can run."""

import base64
import hashlib
from dataclasses import dataclass
from importlib.resources import files

#: scripts of the templates folder, in the order in which they run
_SCRIPTS = ("reading.js", "pointer.js", "turning.js")


@dataclass(frozen=True)
class Script:
    """Text of a script, and the digest (SHA-256, base64) by which the page allows it."""

    text: str

    @property
    def digest(self):
        """As browsers take it: of the text between the tags."""
        return base64.b64encode(hashlib.sha256(self.text.encode()).digest()).decode()


def template():
    """The template of every page."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(loader=PackageLoader("pipeline.views"), autoescape=True, undefined=StrictUndefined,
                              trim_blocks=True, lstrip_blocks=True)
    folder = files("pipeline.views") / "templates"
    environment.globals["scripts"] = [Script((folder / name).read_text(encoding="utf-8")) for name in _SCRIPTS]
    return environment.get_template("report.html.j2")
