"""The product field that a row names is the one its number comes from: change the field, and the number changes."""

from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from pipeline import products
from pipeline.contract.product import is_product
from pipeline.products import ComplexModes, Lumped, Transient
from pipeline.validation import field_of
from pipeline.validation.published_facts import load
from stages.comparison import SYSTEMS, known_values
from tests.validation import test_beam_on_beam as beams
from tests.validation import test_friction as friction
from tests.validation import test_motion as motion
from tests.validation import test_pin_on_disc as pin
from tests.views.products_for_views import complex_modes, filled, interface_law, rupture, squeal, structure

REFERENCE = Path(__file__).parents[2] / "data" / "reference"
CLASSES = {cls.name: cls for cls in filter(is_product, vars(products).values())}
#: rows that count entries, whatever their values
COUNTS = {"no_squeal_at_constant_load", "coalescence_count"}


def sliding_mass():
    """A sweep with an onset of growth, and two settled motions that stick for part of the time."""
    friction_axis, time = np.linspace(0, 0.5, 6), np.linspace(0, 5, 5001)
    root = np.where(friction_axis > 0.25, 1.0, -1.0)[None, :, None] + 100j
    position = 3e-3 * np.sin(4 * np.pi * time) * np.ones((2, 1, 1))
    return {"lumped": filled(Lumped),
            "complex_modes": filled(ComplexModes, friction=friction_axis, root=root, operating_root=[[2.0 + 100j]],
                                    real_frequency=[[16.0]]),
            "transient": filled(Transient, time=time, window=4.0, displacement=position, settled=[[1], [1]],
                                grew=[[1], [1]], velocity=np.gradient(position, time, axis=2), pressure=[1.0, 2.0],
                                growth_rate=[[1.0], [2.0]], cycle_amplitude=[[0.01], [0.02]],
                                status=np.where((2 * time) % 1 < 0.25, 1, 2) * np.ones((2, 1, 1), int))}


SAMPLES = {
    "disc_brake": lambda: {"structure": structure(), "micro_friction": friction.table(), "multibody": motion.motion(),
                           "complex_modes": complex_modes(), "squeal": squeal()},
    "pin_on_disc": lambda: {"pin_on_disc": pin.system(), "interface_law": interface_law(),
                            "transient": pin.transient(), "lock_in": pin.lock_in()},
    "beam_on_beam": lambda: {"beam_on_beam": replace(beams.beams(), closed_frequency=np.arange(1.0, 8.0)),
                             "motion_scatter": beams.scatter(),
                             "complex_modes": filled(ComplexModes, unstable_operating=[0, 0],
                                                     unstable_root=2j * np.pi * np.array([400.0, 9999.0]) + 5)},
    "bimaterial_rupture": lambda: {"rupture": rupture()}, "two_mode_flutter": sliding_mass}


def rows_of(sample, facts):
    rows, by_key = next(system for name, system in SYSTEMS.items() if name in sample)
    return rows(sample, facts, known_values(facts)), by_key


def changed(product, name, seed):
    """``product`` with other values in one field: any magnitude around its mean, signs moved on by one."""
    values = getattr(product, name)
    if values.dtype.kind == "i":
        return replace(product, **{name: values + 1 + seed})
    size = (np.abs(values).mean() or 1.0) * 10.0 ** np.random.default_rng(seed).uniform(-4, 4, values.shape)
    return replace(product, **{name: size * np.exp(1j * np.angle(np.roll(values, 1))) if np.iscomplexobj(values)
                               else size * np.where(np.roll(values, 1) < 0, -1, 1)})


@pytest.mark.parametrize("system", SAMPLES)
def test_the_number_follows_its_field(system):
    facts, sample = load(REFERENCE / f"{system}.yaml"), SAMPLES[system]()
    inputs = {fact.key for fact in facts if fact.role == "input"}
    rows, by_key = rows_of(sample, facts)
    checked = 0
    for key, row in rows.items():
        named = (row.field or field_of(key, by_key)).split(", ")
        assert named != [""], f"{key}: no product field named in FIELDS"
        for product, name in (field.split(".") for field in named):
            assert name in {f.name for f in fields(CLASSES[product])}, f"{key}: {product} has no field {name}"
            if row.value is None or key in inputs | COUNTS:
                continue
            others = (rows_of({**sample, product: changed(sample[product], name, seed)}, facts)[0] for seed in range(9))
            assert any(other.get(key) != row for other in others), f"{key} does not depend on {product}.{name}"
            checked += 1
    assert checked >= len(rows) / 2, "the sample products give most of the rows a number"


@pytest.mark.parametrize("system", SAMPLES)
def test_no_field_is_named_for_a_fact_that_does_not_exist(system):
    keys = [fact.key for name in ("belt", "wobbling_disc", system) for fact in load(REFERENCE / f"{name}.yaml")]
    _, by_key = rows_of(SAMPLES[system](), ())
    unused = [pattern for pattern in by_key if not any(field_of(key, {pattern: "x"}) for key in keys)]
    assert not unused
