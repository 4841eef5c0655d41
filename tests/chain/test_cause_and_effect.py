"""Nothing is decoration: what goes in at the micro scale comes out as another squeal."""

import numpy as np
import pytest

from pipeline.contract import store
from pipeline.products import Squeal
from tests.chain.conftest import QUICK
from tests.commands import brakechain

#: change of a level that a user would see, dB
VISIBLE = 0.01
#: what squeal stands on: neither complex modes nor what is told of them
TO_SQUEAL = ("surface", "effects", "micro-friction", "friction-map", "structure", "reduced-model", "multibody",
             "response", "squeal")


def scan(path, seed):
    """A scan of a rough surface, 1.2 mm wide, as the text format of an instrument."""
    heights = 1e-6 * np.random.default_rng(seed).standard_normal((96, 96)).cumsum(axis=0)
    head = "# Channel: Topography\n# Width: 1200 um\n# Height: 1200 um\n# Value units: m\n"
    path.write_text(head + "\n".join(" ".join(f"{v:.6e}" for v in row) for row in heights))
    return f"surface.pad={{kind: scan, file: {path}, rms_height: 4 um, reason: made for a test}}"


def levels(folder, *changes):
    """Peak levels (dB) after a run with ``changes``."""
    settings = [part for change in changes for part in ("--set", change)]
    for stage in TO_SQUEAL:
        brakechain(stage, QUICK, "--run", folder, *settings)
    return store.read(Squeal, folder / "squeal.h5").peak_level


@pytest.mark.parametrize("change", [
    pytest.param("structure.pad.lining_young_normal=1.4 GPa", id="pad modulus"),
    pytest.param("structure.joints.guide_pin_stiffness=30 MN/m", id="caliper", marks=pytest.mark.slow)])
def test_a_changed_stiffness_changes_the_squeal(copy, finished, change):
    before = store.read(Squeal, finished / "squeal.h5").peak_level
    assert np.abs(levels(copy, change) - before).max() > VISIBLE


@pytest.mark.slow
def test_another_scan_changes_the_squeal(copy, tmp_path):
    first = levels(copy, scan(tmp_path / "first.txt", 1))
    assert np.abs(levels(copy, scan(tmp_path / "second.txt", 2)) - first).max() > VISIBLE
