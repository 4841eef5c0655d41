"""Stage convergence: what is refined, and what counts as converged."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.contract import ConfigError, Section
from stages.convergence import REFINEMENTS, Settings, convergence
from stages.reduced_model import Settings as Reduction
from stages.structure import Settings as Brake
from tests.views import products_for_views as small


class Speeds(Section):
    """Stands for the section complex_modes."""

    speeds: tuple[float, ...] = (8.5, 10.25, 12.0)


def variants(brake, reduction=None, **settings):
    return convergence.variants({"convergence": Settings(**settings), "structure": brake,
                                 "reduced_model": reduction or Reduction(), "complex_modes": Speeds()})


def test_everything_is_refined_in_turn_at_one_operating_point():
    brake = Brake.model_validate({"pad": {"contact_points": 3}})
    made = variants(brake, Reduction(load_patterns=(10, 6)))
    assert tuple(made) == REFINEMENTS
    for changes in made.values():
        assert changes["structure.pressures"] == ["3000000.0 Pa"] and changes["complex_modes.speeds"] == ["10.25 rad/s"]
    assert made["contact"]["structure.pad.contact_points"] == 4
    assert made["pad_mesh"]["structure.pad.cells_per_patch"] == made["pad_mesh"]["structure.pad.lining_layers"] == 3
    assert "structure.pad.contact_points" not in made["pad_mesh"]      # as many on each of more faces
    assert made["disc_mesh"]["structure.disc.angular_cells"] == 128
    assert made["bases"]["structure.frequency_max"] == "27000.0 Hz"
    assert made["bases"]["reduced_model.load_patterns"] == [14, 9]


def test_the_mesh_of_a_disc_from_a_file_is_not_refined(tmp_path):
    (tmp_path / "disc.inp").write_text("")
    brake = Brake.model_validate({"disc": {"mesh_file": str(tmp_path / "disc.inp")}})
    assert tuple(variants(brake)) == ("contact", "pad_mesh", "bases")
    with pytest.raises(ConfigError, match="convergence.refinements: expected more than meshes that come from files"):
        variants(brake, refinements=("disc_mesh",))


def test_contact_patches_are_refined_without_the_mesh():
    made = variants(Brake(), refinements=("contact",), pressure="1 MPa", speed="12 rad/s")
    assert made == {"contact": {
        "structure.pressures": ["1000000.0 Pa"], "complex_modes.speeds": ["12.0 rad/s"],
        "structure.free_frequency_max": "100 Hz", "complex_modes.friction_steps": 2,
        "complex_modes.residual_tolerance": None, "complex_modes.followed": 0,
        "structure.pad.patches_angular": 12, "structure.pad.patches_radial": 6, "structure.pad.cells_per_patch": 1}}


@pytest.fixture
def modes():
    return small.complex_modes()


def refined(modes, factor=1.0, shift=0.0, speed=10.25):
    """The complex modes at 3 MPa and ``speed`` alone, with scaled roots."""
    here = np.flatnonzero((modes.operating_pressure == 3e6) & (modes.operating_speed == speed))
    root = (modes.operating_root[here] * factor) + shift
    return replace(modes, operating_root=root, operating_force=modes.operating_force[here],
                   **{f"operating_{name}": getattr(modes, f"operating_{name}")[here]
                      for name in ("pressure", "speed", "friction", "open")})


def test_small_changes_are_converged_and_told(modes):
    made = convergence(modes, {"contact": refined(modes, 1 + 1e-3), "bases": refined(modes, shift=-3)},
                       settings=Settings())
    assert made.converged == 1 and made.held.all() and list(made.refinement) == ["contact", "bases"]
    assert made.frequency_change == pytest.approx(1e-3) and made.growth_change == pytest.approx(3.0)
    assert made.growth_share == pytest.approx(3.0 / made.root[0].real) and made.contacts == 12


def test_changes_are_those_of_the_reduced_model(modes):
    """Roots of the full matrices stay apart from those of the reduced model, which alone is refined."""
    full = replace(modes, unstable_reduced=modes.unstable_root, unstable_root=modes.unstable_root - 6 + 2j)
    made = convergence(full, {"bases": refined(modes, shift=-3)}, settings=Settings())
    np.testing.assert_allclose(made.refined_root - made.root, -3.0)
    assert made.root[0] in full.unstable_root and made.growth_change == pytest.approx(3.0)


@pytest.mark.parametrize("change", [{"factor": 1.006}, {"shift": -30}, {"factor": 1.05}], ids=["f", "growth", "gone"])
def test_large_changes_are_not(modes, change):
    made = convergence(modes, {"contact": refined(modes), "disc_mesh": refined(modes, **change)}, settings=Settings())
    assert made.converged == 0 and made.held[0].all() and not made.held[1].any()
    assert made.found[1].all() == (change != {"factor": 1.05})


def test_a_further_unstable_mode_is_not_converged(modes):
    more = refined(modes)
    root = more.operating_root.copy()
    root[0, 0] = 50 + 1j * root[0, 0].imag
    made = convergence(modes, {"contact": replace(more, operating_root=root)}, settings=Settings())
    assert made.converged == 0 and list(made.added) == [1] and made.held.all()


def test_stable_brakes_converge_too():
    still = small.complex_modes(stable=True)
    made = convergence(still, {"contact": refined(still)}, settings=Settings())
    assert made.converged == 1 and not len(made.root) and made.growth_share == 0
