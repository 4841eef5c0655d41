"""Public scans of six instruments through the whole study of friction, each as disc and, turned round, as pad."""

import os
from pathlib import Path

import numpy as np
import pytest

from pipeline.contract.settings import fill
from pipeline.physics.rough.topography import read_scan
from stages.friction_map import Settings as MapSettings
from stages.friction_map import friction_map
from stages.micro_friction import Settings as MicroSettings
from stages.micro_friction import micro_friction
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface
from tests.commands import ROOT

SURFACES = Path(os.environ.get("BRAKECHAIN_DATA", ROOT.parent / "shared" / "data")) / "surfaces"
SCANS = ("al3d-1.al3d", "di-1.di", "metropro-1.dat", "opd-1.opd", "plu-1.plu", "x3p-2.x3p")
NODES = 64


@pytest.mark.measured
@pytest.mark.parametrize("name", SCANS)
def test_a_scan_goes_through_the_study(name):
    """From an atomic force microscope over half a micrometre to focus variation over a millimetre: slopes of 0.05, one
    pressure for all lengths."""
    path = SURFACES / name
    if not path.exists():
        pytest.skip(f"no public scans at {SURFACES}; set BRAKECHAIN_DATA")
    channel = "Height (1)" if name == "di-1.di" else None       # it also holds the heights of the way back
    scan = read_scan(path, channel)
    patch = 0.85 * min(n * d for n, d in zip(scan.heights.shape, scan.spacing, strict=True))
    body = {"kind": "scan", "file": str(path), "channel": channel, "rms_height": f"{5e-3 * patch} m",
            "longest_wavelength": f"{patch / 2} m", "reason": "heights are scaled to one slope for all scans"}
    made = surface(settings=fill(SurfaceSettings, {
        "nodes": NODES, "patch_length": f"{patch} m", "shortest_wavelength": f"{8 * patch / NODES} m",
        "disc_thickness": f"{patch} m", "pad_thickness": f"{patch} m", "disc": body,
        "pad": body | {"transposed": True}}, "surface"))
    assert made.disc_height.std() == pytest.approx(5e-3 * patch, rel=0.02)
    found = micro_friction(made, settings=fill(MicroSettings, {
        "pressures": ["1 MPa", "2 MPa", "4 MPa"], "disc_speeds": ["8.5 rad/s", "12 rad/s"], "cycles": 10,
        "stroke": f"{3 * patch / NODES} m", "recorded_distances": ["0 m", f"{patch} m", f"{10 * patch} m"],
        "realisations": 2, "refinement": [0.5, 1]}, "micro_friction"))
    law = friction_map(found, settings=MapSettings())
    assert (np.diff(found.real_area, axis=0) > 0).all() and (found.wear_depth[..., 1:] > 0).all()
    assert (law.friction > 0.05).all() and (law.friction < 5).all() and (law.friction_std >= 0).all()
    np.testing.assert_allclose(found.friction, found.limit_at_speed * found.real_area / found.pressure[:, None, None],
                               rtol=1e-3)
