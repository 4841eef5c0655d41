"""What baselines read of a case, and which cases they refuse."""

import numpy as np
import pytest
import yaml

from pipeline.blind_trial.baselines.rig import read
from pipeline.contract.errors import ConfigError


def test_a_rig_is_read_as_it_is_stated(control):
    rig, case = read(control), yaml.safe_load((control / "nominal.yaml").read_text())
    assert (rig.masses, rig.joints, rig.channels) == (("mass_0",), ("link_0",), ("x_0",))
    assert f"{rig.mass[0]:.6g} kg" == case["lumped"]["masses"]["mass_0"]["mass"] and rig.rows.tolist() == [[1.0]]
    assert len(rig.runs) == 3 and [run.name for run in rig.held_out] == ["run_3"] and rig.contact is None
    assert rig.sensors == ((2.5e-3, 40.0),) and "joints.link_0.damping" in rig.free
    assert np.sqrt(np.mean(rig.runs[0].push**2)) == pytest.approx(2.0) and rig.rate == 100.0


@pytest.mark.parametrize("section, value, told", [
    ("diagnosis", {"forward": "poles"}, "a forced lumped rig"), ("lumped", {}, "a forced lumped rig"),
    ("bench", {"channels": {}}, "a displacement channel of every mass")])
def test_another_kind_of_case_is_refused(control, tmp_path, section, value, told):
    case = yaml.safe_load((control / "nominal.yaml").read_text())
    (tmp_path / "nominal.yaml").write_text(yaml.safe_dump({**case, section: value}))
    (tmp_path / "recordings.h5").write_bytes((control / "recordings.h5").read_bytes())
    with pytest.raises(ConfigError, match=told):
        read(tmp_path)
