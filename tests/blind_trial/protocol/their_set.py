"""A set that was written as docs/trial_sets.md says, without any of this program."""

import contextlib
import re
from pathlib import Path

DOCUMENT = (Path(__file__).parents[3] / "docs" / "trial_sets.md").read_text()


def block(language):
    """The first block of code of a language in the document."""
    return re.search(rf"```{language}\n(.*?)```", DOCUMENT, re.DOTALL)[1]


def their_set(folder):
    """Folder of the two cases of the document and their truth; few effects, to keep it short."""
    for number in ("001", "002"):
        (folder / "cases" / number).mkdir(parents=True)
        (folder / "cases" / number / "nominal.yaml").write_text(f"{block('yaml')}  effects: [coulomb, backlash]\n")
    with contextlib.chdir(folder):
        exec(block("python"), {})
    return folder
