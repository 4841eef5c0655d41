"""Stage convergence: what is refined at once, what counts as converged, and when causes are sought."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pipeline.case_models.refinement.element_modes import ElementModes
from pipeline.case_models.refinement.finer_settings import REFINEMENTS, finer
from pipeline.contract import ConfigError, store, stored
from pipeline.products import Convergence
from stages import convergence as stage
from stages.complex_modes import Settings as Linear
from stages.convergence import Settings, convergence
from stages.structure import Settings as Brake
from tests.case_models.refinement.tiny_brake import SECTION
from tests.stages.small_brake import small_brake, small_map
from tests.views import products_for_views as small

MESHES = ("contact", "pad_mesh", "disc_mesh", "caliper_mesh")


@pytest.fixture
def modes():
    return replace(small.complex_modes(), settings=np.array(stored(Linear())))


class Bench:
    """Stands for the models of elements: roots of the case moved by ``changes`` {part refined: {mode: change}}."""

    def __init__(self, monkeypatch, modes, changes=None, others=()):
        here = np.flatnonzero((modes.operating_pressure == 3e6) & (modes.operating_speed == 10.25))[0]
        unstable = np.flatnonzero(modes.unstable_operating == here)
        self.root = modes.unstable_reduced[unstable]
        self.stated, self.changes, self.asked = modes.unstable_root[unstable], changes or {}, []
        self.starts = SimpleNamespace(root=np.append(self.root, others), body=np.zeros(16))
        monkeypatch.setattr(stage, "reduced_starts", lambda *_: self.starts)
        monkeypatch.setattr(stage, "_of", lambda starts, chosen: SimpleNamespace(root=starts.root[chosen]))
        monkeypatch.setattr(stage, "element_modes", self.modes)
        monkeypatch.setattr(stage, "finer", lambda brake, names, *_: names)

    def modes(self, names, point, starts, matrices, tolerance):
        self.asked.append(tuple(names))
        root = np.append(self.stated, self.starts.root[len(self.root):])
        for name in names:
            for mode, change in self.changes.get(name, {}).items():
                root[mode] += change
        chosen = [int(np.argmin(abs(self.starts.root - each))) for each in starts.root]
        return ElementModes(root[chosen], np.ones(len(chosen)), 1000 + 100 * len(names), 16)


def run(modes, tmp_path, **settings):
    """The product as it is read again, and the sections that it was made with."""
    settings = {"refinements": ("bases", *MESHES), **settings}
    exact = replace(modes, unstable_residual=np.full(len(modes.unstable_root), 1e-8))
    product = convergence(exact, small_brake(), small_map(), None, sections={"structure": SECTION},
                          settings=Settings(**settings))
    store.write(product, tmp_path / "convergence.h5", {})
    return store.read(Convergence, tmp_path / "convergence.h5")


def test_everything_is_refined_at_once_and_nothing_by_itself_where_modes_stay(modes, monkeypatch, tmp_path):
    bench = Bench(monkeypatch, modes, {"disc_mesh": {0: -2 + 1j}, "pad_mesh": {0: 1.0}}, [-20 + 3e4j])
    made = run(modes, tmp_path)
    assert bench.asked == [MESHES] and made.converged == 1 and made.held.all() and not len(made.cause)
    np.testing.assert_allclose(made.refined_root, np.sort_complex(made.root + [-1 + 1j])[::-1])
    assert list(made.refinement) == ["bases", *MESHES] and not len(made.left_out)
    assert made.growth_change == pytest.approx(1.0) and list(made.near_root) == [-20 + 3e4j]
    assert (made.freedoms, made.refined_freedoms) == (made.freedoms, 1400) and made.refined_contacts == 16


@pytest.mark.parametrize("change, gone", [(-60.0, 0), (complex(0, 1e3), 0), (complex(np.nan, np.nan), 1)])
def test_what_moved_a_mode_too_far_is_sought_part_by_part(modes, monkeypatch, tmp_path, change, gone):
    bench = Bench(monkeypatch, modes, {"disc_mesh": {0: change}, "pad_mesh": {0: 1.0}})
    made = run(modes, tmp_path)
    assert bench.asked == [MESHES, (), *((name,) for name in MESHES)]
    assert made.converged == 0 and not made.held[0] and made.found[0] == 1 - gone
    assert list(made.cause) == ["model", *MESHES] and len(made.moved_root) == 1
    expected = [0, 0, 1, 0 if gone else change, 0]
    np.testing.assert_allclose(made.cause_change[:, 0], expected)


def test_a_mode_that_only_the_finer_model_has_is_not_converged(modes, monkeypatch, tmp_path):
    bench = Bench(monkeypatch, modes, {"caliper_mesh": {-1: 45.0}}, [-20 + 3e4j])
    made = run(modes, tmp_path)
    assert made.added == 1 and made.converged == 0 and made.held.all()
    assert list(made.moved_root) == [-20 + 3e4j] and bench.asked[-1] == ("caliper_mesh",)
    assert abs(made.cause_change).argmax() == list(made.cause).index("caliper_mesh")


def test_bases_alone_cost_nothing_and_are_never_called_converged(modes, monkeypatch, tmp_path):
    bench = Bench(monkeypatch, modes)
    made = run(replace(modes, unstable_root=modes.unstable_root - 4), tmp_path, refinements=("bases",))
    assert not bench.asked and made.held.all() and made.converged == 0 and made.growth_change == pytest.approx(4)
    assert list(made.left_out) == list(MESHES) and set(made.left_out_reason) == {"was not asked for"}


def test_roots_of_the_reduced_model_are_compared_by_the_change_between_two_models(modes, monkeypatch, tmp_path):
    bench = Bench(monkeypatch, modes, {"pad_mesh": {0: -3.0}})
    bench.stated = bench.root + 50 + 7j      # elements of the same meshes say something else: not judged without bases
    product = convergence(modes, small_brake(), small_map(), None, sections={"structure": SECTION},
                          settings=Settings(refinements=MESHES))
    assert bench.asked[:2] == [(), MESHES] and product.held.all()
    assert product.growth_change == pytest.approx(3)


def test_old_cases_are_read_and_refine_what_they_name():
    old = Settings.model_validate({"refinements": ["contact", "pad_mesh", "disc_mesh", "bases"], "bases": 1.5})
    assert finer(SECTION, old.refinements, old.meshes).caliper == SECTION.caliper
    assert Settings().refinements == REFINEMENTS


def test_meshes_from_files_alone_are_refused_before_anything_is_computed(tmp_path):
    (tmp_path / "disc.inp").write_text("")
    brake = Brake.model_validate({"disc": {"mesh_file": str(tmp_path / "disc.inp")}})
    with pytest.raises(ConfigError, match="convergence.refinements: expected more than meshes that come from files"):
        convergence.check({"convergence": Settings(refinements=("disc_mesh",)), "structure": brake})
    convergence.check({"convergence": Settings(), "structure": brake})
