"""Bad input: one sentence with where, expected, found and remedy; the exit code tells the kind; no traceback."""

import os

import h5py
import numpy as np
import pytest

from pipeline.contract import store
from pipeline.contract.integrity import checksum
from pipeline.products import Transient
from tests.chain.conftest import QUICK
from tests.commands import ROOT, brakechain


def refused(code, *args):
    """Message of a command that must end with ``code`` and without a traceback."""
    told = brakechain(*args, code=code).stderr
    assert "error: " in told and "Traceback" not in told
    return told


def scan(tmp_path, name, heights):
    """A matrix of heights (um) as the text format of an instrument, and the case that reads it as the pad."""
    file = tmp_path / name
    if heights is not None:
        np.savetxt(file, heights)
    case = tmp_path / "own.yaml"
    pad = f"{{kind: scan, file: {name}, rms_height: 4 um, reason: none}}"
    case.write_text(f"based_on: {QUICK}\nsurface: {{pad: {pad}}}\n")
    return case


@pytest.mark.parametrize("name, heights, message", [
    ("missing.txt", None, "surface.pad.file: expected a file, found none at"),
    ("empty.txt", np.zeros((0, 0)), "empty.txt"),
    ("constant.txt", np.ones((64, 64)), "constant.txt"),
    ("nan.txt", np.full((64, 64), np.nan), "nan.txt"),
])
def test_a_scan_that_is_none(tmp_path, name, heights, message):
    told = refused(2, "surface", scan(tmp_path, name, heights), "--run", tmp_path / "run")
    assert message in told and "expected" in told


def test_an_unreadable_scan(tmp_path):
    case = scan(tmp_path, "noise.x3p", None)
    (tmp_path / "noise.x3p").write_bytes(bytes(range(256)) * 10)
    assert "noise.x3p" in refused(2, "surface", case, "--run", tmp_path / "run")


@pytest.mark.parametrize("override, message", [
    ("structure.disc.ring_thickness=-1 mm", "disc.ring_thickness: input should be greater than 0, found '-1 mm'"),
    ("structure.disc.ring_thickness=7 kg", "disc.ring_thickness: expected a quantity in m, such as \"12 mm\""),
    ("structure.disc.ring_thicknes=7 mm", "did you mean 'ring_thickness'?"),
    ("complex_modes.frequency_max=7 kHz", "expected at most 6000 Hz, where structure.frequency_max ends the modes of"
     " the bodies, found 7000 Hz; raise structure.frequency_max"),
])
def test_a_disc_that_is_none(tmp_path, override, message):
    assert message in refused(2, "run", QUICK, "--run", tmp_path / "run", "--set", override)
    assert not (tmp_path / "run").exists(), "the whole case is checked before anything is made"


def test_a_disc_that_its_pads_do_not_touch(copy):
    told = refused(2, "structure", QUICK, "--run", copy, "--set", "structure.pad.outer_radius=190 mm", "--set",
                   "structure.pad.inner_radius=170 mm")
    assert "expected" in told and "pad" in told


def test_a_product_of_another_version_or_in_pieces(copy):
    with h5py.File(copy / "response.h5", "a") as h5:
        h5.attrs["version"] = 99
    checksum.seal(copy / "response.h5")
    told = refused(4, "squeal", QUICK, "--run", copy, "--force")
    assert "response.h5: expected response version 1, found response version 99; rerun the stage that writes it" in told
    (copy / "response.h5").write_bytes((copy / "response.h5").read_bytes()[:2000])
    assert "truncated or damaged" in refused(4, "squeal", QUICK, "--run", copy, "--force")


def test_a_run_folder_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    assert "expected a run folder that can be written" in refused(4, "run", QUICK, "--run", tmp_path / "file" / "run")


def test_a_run_folder_without_permission(tmp_path):
    """Neither a new folder in one that is write-protected, nor one that became so after a run: nothing is computed."""
    run = tmp_path / "closed" / "run"
    run.mkdir(parents=True)
    (run / ".lock").touch()
    for folder, asked in ((run.parent, run.parent / "new"), (run, run)):
        folder.chmod(0o555)
        try:
            if os.access(folder, os.W_OK):
                pytest.skip("permissions do not stop this user, most often root")
            told = refused(4, "surface", QUICK, "--run", asked)
        finally:
            folder.chmod(0o755)
        assert "expected a run folder that can be written, found Permission denied" in told
    assert [p.name for p in run.iterdir()] == [".lock"]


def test_a_computation_that_does_not_converge(copy):
    told = refused(3, "micro-friction", QUICK, "--run", copy, "--set", "micro_friction.max_iterations=2")
    assert "expected" in told and "found" in told


@pytest.mark.parametrize("override, message", [
    ("lumped.springs.tie.between=[blok.x, ground]", "lumped.springs.tie.between: expected a coordinate, one of block.x,"
     " ground, found 'blok.x'; did you mean 'block.x'?"),
    ("lumped.springs.tie.between=[ground, ground]", "lumped.springs.tie.between: expected two different ends"),
    ("lumped.springs.tie.betwen=[block.x, ground]", "did you mean 'between'?"),
    ("lumped.masses.block.mass=-1 kg", "lumped.masses.block.mass: expected above 0 kg"),
    ("lumped.contacts.belt.normal_force=-1 N", "normal_force: input should be greater than or equal to 0"),
    ("complex_modes.friction=-0.1", "complex_modes.friction: input should be greater than or equal to 0"),
    ("complex_modes.friction=null", "complex_modes.friction: expected friction from one source"),
])
def test_a_lumped_model_that_does_not_hold_together(tmp_path, override, message):
    case = ROOT / "configs" / "belt.yaml"
    assert message in refused(2, "run", case, "--run", tmp_path / "run", "--set", override)
    assert not (tmp_path / "run").exists(), "the whole case is checked before anything is made"


BEAM = ROOT / "configs" / "beam_on_beam.yaml"


@pytest.mark.parametrize("override, message", [
    ("beam_on_beam.contact.force=0 N", "beam_on_beam.contact.force: input should be greater than 0"),
    ("transient.friction=-0.1", "transient.friction: input should be greater than or equal to 0"),
    ("motion_scatter.friction=-0.1", "motion_scatter.friction: input should be greater than or equal to 0"),
])
def test_beams_whose_settings_cannot_be(tmp_path, override, message):
    assert message in refused(2, "run", BEAM, "--run", tmp_path / "run", "--set", override)
    assert not (tmp_path / "run").exists(), "the whole case is checked before anything is made"


@pytest.mark.parametrize("case, settings, longest", [
    (BEAM, ("beam_on_beam.element=timoshenko", "transient.step=20 us"), "8.64e-06 s"),
    (ROOT / "configs" / "belt.yaml", ("transient.step=0.15 s", "transient.record_every=1"), "0.126 s"),
])
def test_a_step_too_long_for_the_highest_mode(tmp_path, case, settings, longest):
    told = refused(2, "run", case, "--run", tmp_path / "run", *(a for s in settings for a in ("--set", s)))
    assert f"transient.step (time stepping): expected at most {longest}, 2.5 steps in a period of" in told


def test_a_cycle_that_has_not_settled_is_told_and_not_judged_as_one(tmp_path):
    """A damped block that still slows down: the run ends well, product and page say that it is on its way."""
    settings = ("lumped.contacts.belt.normal_force=0 N", "lumped.springs.tie.damping=1 N s/m",
                "transient.kick=100 mm/s", "transient.duration=3 s", "transient.window=2 s")
    brakechain("run", ROOT / "configs" / "belt.yaml", "--run", tmp_path, *(a for s in settings for a in ("--set", s)))
    assert not store.read(Transient, tmp_path / "transient.h5").settled.any()
    assert "1 of 1 signals have NOT settled" in (tmp_path / "report.html").read_text(encoding="utf-8")


PIN = ROOT / "configs" / "pin_on_disc.yaml"


@pytest.mark.parametrize("override, message", [
    ("pin_on_disc.loads=[0 kg]", "pin_on_disc.loads.0: input should be greater than 0"),
    ("complex_modes.friction=-0.1", "complex_modes.friction: input should be greater than or equal to 0"),
    ("transient.friction=-0.1", "transient.friction: input should be greater than or equal to 0"),
    ("lock_in.friction=-0.1", "lock_in.friction: input should be greater than or equal to 0"),
    ("lock_in.step=4 us", "lock_in.step: expected a whole part of 1e-05 s"),
    ("transient.window=1 s", "transient.window: expected at most the duration"),
    ("lock_in.window=1 s", "lock_in.window: expected at most the duration"),
])
def test_a_pin_whose_settings_cannot_be(tmp_path, override, message):
    assert message in refused(2, "run", PIN, "--run", tmp_path / "run", "--set", override)
    assert not (tmp_path / "run").exists(), "the whole case is checked before anything is made"


@pytest.fixture(scope="module")
def pins(tmp_path_factory):
    """Run folder that the pins share, so that only the stages from the wrong setting on are computed anew."""
    return tmp_path_factory.mktemp("pins") / "run"


def coarse(folder, *overrides):
    """Arguments of a run of the pin with coarse meshes."""
    meshes = ("surface.nodes=128", "surface.patch_length=128 um", "pin_on_disc.frequency_max=3 kHz",
              "pin_on_disc.disc.radial_cells=3", "pin_on_disc.disc.angular_cells=12", "pin_on_disc.disc.axial_cells=1",
              "reduced_model.fixed_below=6 kHz", "interface_law.pressure_steps=8",
              "friction_descriptions.steps=10")
    return "run", PIN, "--run", folder, *(part for each in (*meshes, *overrides) for part in ("--set", each))


def test_a_drive_that_turns_backwards_under_a_heavy_clamp(pins):
    """Backwards the tilt leans against the motion; forwards with the other tilt the stage sees that the pin locks."""
    heavy = "pin_on_disc.pin.base_mass=1 kg"
    told = refused(2, *coarse(pins, heavy, "transient.speeds=[-0.25 rad/s]"))
    assert "transient.speeds: expected speeds above 0" in told and "change the signs of pin.tilt" in told
    assert "it locks" in refused(2, *coarse(pins, heavy, "pin_on_disc.pin.tilt=-4 deg"))


@pytest.mark.parametrize("override, message", [
    ("pin_on_disc.pin.length=15 mm", "pin.length: expected a pin longer than its clamp (0.02 m), found 0.015 m"),
    ("pin_on_disc.contact.radius=178 mm", "it never touches; move the pin over the face of the disc"),
    ("transient.step=3 us", "for the stiffness of contact 0, found 3e-06 s; shorten the step"),
])
def test_a_pin_that_cannot_be_built_or_stepped(pins, override, message):
    """The stages before the one that refuses are as they were."""
    assert message in refused(2, *coarse(pins, override))
