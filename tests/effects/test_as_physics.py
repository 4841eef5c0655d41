"""Effects of the catalogue as ordinary physics: what the block of a YAML case does in the stages of every system."""

from dataclasses import fields
from functools import cache, partial

import numpy as np
import pytest

from pipeline.contract import ConfigError
from pipeline.effects import CATALOGUE, named
from pipeline.effects.effect import null_values, shaped_values
from pipeline.effects.typical import ASPERITIES, CHANNEL
from pipeline.physics.virtual_rig.response import Run
from pipeline.physics.virtual_rig.roots import roots
from stages.bench import bench as bench_stage
from tests.diagnosis.small_rig import effects, laid_out, model, recording
from tests.effects.systems import MODES, SYSTEMS, Telling, lumped_bench, system

PHYSICS = tuple(e for e in CATALOGUE if e.kind == "physics" and e.location != ASPERITIES)
SENSORS = tuple(e for e in CATALOGUE if e.location == CHANNEL)
UPPER, MEDIAN, BELOW = (partial(shaped_values, probability=p) for p in (0.75, 0.6, 0.4))
#: a pin that is pressed down does not come to a stop above it, but to one below
PRESSED = (("impact", "pin transient"),)
#: needs a row of contacts that wear: of all transients only those of lumped systems have one
ROWS_ALONE = ("taper_wear",)


def each(effects):
    return pytest.mark.parametrize("effect", effects, ids=[e.name for e in effects])


@cache
def plain(name):
    return system(name).run({})


def differing(name, found):
    """Fields of a product that are not, bit for bit, those of the system without effects."""
    return [f.name for f in fields(found)
            if not np.array_equal(np.asarray(getattr(found, f.name)), np.asarray(getattr(plain(name), f.name)))]


@each(PHYSICS)
def test_an_effect_changes_two_systems_or_more(effect):
    """One sentence says so where it has no location or the contact law cannot carry it."""
    changed = set()
    for name in SYSTEMS:
        if system(name).location(effect) is None:
            with pytest.raises(ConfigError, match=f"effect {effect.name}: location: expected .*found 'nowhere'"):
                system(name).run(system(name).block(effect, UPPER, location="nowhere"))
            continue
        try:
            values = BELOW if (effect.name, name) in PRESSED else MEDIAN
            found = differing(name, system(name).run(system(name).block(effect, values)))
        except ConfigError as error:
            hard = ("a hard one", "found Hard", "found another law")
            refused = ("an effect that acts in the stage multibody",)
            assert any(said in str(error) for said in {"beam": hard, "brake": refused}.get(name.split()[0], ()))
            assert "\n" not in str(error)
            continue
        if name in MODES and not effect.small:
            assert not found
        else:
            assert found, name
            changed.add(name.split()[0])
    assert len(changed) >= (1 if effect.name in ROWS_ALONE else 2)


@pytest.mark.parametrize("name", SYSTEMS)
def test_effects_at_their_nulls_change_nothing(name):
    """All that have a location in the system, in one block, bit for bit."""
    placed = [effect for effect in PHYSICS if system(name).location(effect) is not None]
    blocks = [system(name).block(effect, null_values) for effect in placed]
    together = {key: value for block in blocks for key, value in block.items()}
    assert len(together) == len(placed) + 1 > 10 and not differing(name, system(name).run(together))


@each(tuple(e for e in PHYSICS if e.small))
def test_complex_modes_are_the_roots_of_the_bench(effect):
    """Two ways to one matrix: that of complex modes on real modes, and that of a diagnosis of poles."""
    name = "lumped modes"
    block = system(name).block(effect, UPPER)
    found = system(name).run(block).operating_root[0]
    whole = roots(lumped_bench(block), Run("steady", 1.0, 100.0, {"press": 40.0}))
    assert (abs(found[:, None] - whole).min(axis=1) < 1e-6 * abs(found)).all()


@each(tuple(e for e in PHYSICS if not e.small))
def test_what_small_motions_do_not_see_moves_no_root(effect):
    """On undamped contacts of constant stiffness and friction, which may come to rest elsewhere."""
    steady = Run("steady", 1.0, 100.0, {"press": 40.0})
    base, found = (roots(lumped_bench(block, "1e9 m/s"), steady)
                   for block in ({}, system("lumped modes").block(effect, UPPER)))
    np.testing.assert_allclose(abs(found[:, None] - base).min(axis=0), 0.0, atol=1e-6 * abs(base).max())


def test_complex_modes_report_effects_they_ignore():
    told = Telling()
    system("lumped modes").run(system("lumped modes").block(named("wear"), UPPER), context=told)
    assert any("wear at contact does not enter linearised models" in line for line in told.lines)


def test_conditions_of_the_block_are_asked_for():
    with pytest.raises(ConfigError, match="humidity"):
        system("lumped modes").run({"moisture": {"contact": {"slope": 0.3}}})
    with pytest.raises(ConfigError, match="humidity"):
        system("lumped transient").run({"moisture": {"contact": {"slope": 0.3}}})


def test_friction_that_turns_is_added_once():
    block = system("lumped modes").block(named("friction_induced_damping"), UPPER)
    with pytest.raises(ConfigError, match="friction_damping: false"):
        system("lumped modes").run(block, friction_damping=True)


@each(SENSORS)
def test_an_effect_of_a_sensor_belongs_to_benches(effect):
    said = {"sensor_gain": {"error": 0.1}, "sensor_delay": {"delay": "5 ms"}, "clipping": {"inverse_limit": 100.0},
            "sensor_offset_drift": {"offset": 1e-3, "drift": 1e-3}, "reversed_channel": {"factor": -1.0},
            "unit_factor": {"factor": 10.0}}[effect.name]
    taken = recording(levels=(5.0,))
    before, after = (bench_stage(model(), effects(block), taken, laid_out()).runs["level_1"].predicted
                     for block in ({}, {effect.name: {"x": said}}))
    assert not np.array_equal(before, after)
    for name in ("lumped transient", "lumped modes"):
        with pytest.raises(ConfigError, match="sensors are part of a bench"):
            system(name).run({effect.name: {"along": said}})
