"""The friction law with memory of docs/add_an_effect.md, as it stands there, in the whole brake and in a diagnosis."""

import re
import textwrap

import numpy as np
import pytest

import pipeline.effects as effects
from pipeline.case_models import virtual_rig as benches
from pipeline.case_models.operating_points import StabilitySettings
from pipeline.case_models.runs import recorded as as_benched
from pipeline.case_models.scatter import family
from pipeline.contract.settings import fill
from pipeline.diagnosis import forced_response
from pipeline.diagnosis.output.files import as_json
from pipeline.diagnosis.signals import forward_model
from pipeline.physics.stability.draws.sampled_roots import sampled
from pipeline.physics.stability.draws.scatter import NOMINAL
from pipeline.physics.virtual_rig.response import respond
from pipeline.products import Channel, Effects, Recording
from pipeline.products import Run as RunProduct
from stages.bench import Settings as Bench
from stages.bench import bench
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.diagnosis import Settings as Diagnosis
from stages.diagnosis import diagnosis
from stages.limit_cycle import Settings as Cycle
from stages.limit_cycle import limit_cycle
from stages.lumped import Settings as Lumped
from stages.lumped import lumped
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.commands import ROOT
from tests.effects.benches import slider, steady
from tests.stages.effect_table import reduced
from tests.stages.small_structure import small_friction_map
from tests.stages.test_effects_everywhere import ONSET


@pytest.fixture(scope="module")
def law():
    """The effect of the page."""
    page = (ROOT / "docs" / "add_an_effect.md").read_text(encoding="utf-8")
    code = re.search(r'^( +)"""Wet film.*?(?=^\S)', page, re.MULTILINE | re.DOTALL)[0]
    module = {}
    exec(compile(textwrap.dedent(code), "docs/add_an_effect.md", "exec"), module)
    return module["EFFECT"]


@pytest.fixture
def catalogue(law, monkeypatch):
    """The catalogue with it: what one line in ``_FILES`` does."""
    monkeypatch.setattr(effects, "CATALOGUE", (*effects.CATALOGUE, law))
    monkeypatch.setattr(forward_model, "NAMES", forward_model.NAMES | {law.name})
    for module in (forward_model, forced_response):
        monkeypatch.setattr(module, "CATALOGUE", effects.CATALOGUE)
    return law


@pytest.mark.exact
@pytest.mark.parametrize("speed", [0.1, 2.0])
def test_steady_friction_and_its_null(law, speed):
    rubbed = law.on(slider(), "contact", {"gain": 0.5, "time": 0.02})
    np.testing.assert_allclose(respond(rubbed, steady(speed=speed))["t"], 0.3 / (1 + 0.5 * speed) * 40.0, rtol=1e-9)
    null = law.on(slider(), "contact", {"gain": 0.0, "time": 0.02})
    np.testing.assert_array_equal(respond(null, steady())["t"], respond(slider(), steady())["t"])


def test_in_the_whole_brake(catalogue):
    """Unstable roots of complex modes are those of the draws and grow so in the limit cycle; it moves them."""
    added = Effects(effect=["wet_film"], place=["contact"], term=[0, 0], parameter=["gain", "time"], value=[0.2, 1e-4],
                    unit=["1", "s"], condition=[], condition_value=[])
    model, friction = reduced(), small_friction_map(0.6)
    settings = Modes(friction_steps=2, speeds=("10 rad/s",), frequency_max="8 kHz", followed=0)
    modes, bare = (complex_modes(model, friction, each, settings=settings) for each in (added, None))
    assert len(modes.unstable_root) and abs(modes.unstable_root[0] - bare.unstable_root[0]) > 1.0
    points, last = StabilitySettings.of(modes), len(model.pressure) - 1
    made = family(model, last, friction, points, added)
    drawn = sampled(made, points.speeds, points.frequency_max).modes(NOMINAL, 10.0)
    for root in modes.unstable_root[modes.unstable_operating == last]:
        assert abs(drawn.value - root).min() < 1e-4 * abs(root)
    found = limit_cycle(model, friction, modes, added, settings=Cycle(**ONSET))
    strongest = np.argmax(found.onset_root.real)
    assert found.onset_simulated[strongest].real == pytest.approx(found.onset_root[strongest].real, rel=0.05)


RATE, SAMPLES, NOISE = 1000.0, 600, (0.05, 1e-3)
LUMPED = {"masses": {"block": {"mass": "0.5 kg", "moves": ["x"]}},
          "springs": {"machine": {"between": ["block.x", "ground"], "stiffness": "20 N/mm", "damping": "20 N s/m"}},
          "contacts": {"track": {"tangent": {"block.x": 1}, "normal_force": "10 N"}},
          "inputs": {"machine": {"displaces": "machine", "displacement": "1 m"}},
          "sensors": {"block": {"along": {"block.x": 1}, "quantity": "velocity", "unit": "m/s"}}}
COURSES = {f"pull_{k}": {"at": ["0 s", *(f"{0.08 * (i + 1)} s" for i in range(6))], "speed": [
    f"{v} m/s" for v in np.roll((0.2, 0.6, 0.3, 0.8, 0.25, 0.5, 0.9), k)]} for k in range(3)}


def laid_out(step):
    return {"step": step, "speed": "0 rad/s", "friction": 0.4, "courses": {"machine": COURSES},
            "channels": {"cell": {"quantity": "joint_force", "source": "machine"},
                         "laser": {"quantity": "velocity", "source": "block"}}}


def recorded(shown):
    """Product Recording of {run: {channel: samples}}."""
    def channel(name, samples):
        unit, measures = {"cell": ("N", "force"), "laser": ("m/s", "velocity")}[name]
        return Channel(samples=samples, missing=np.empty((0, 2), int), unit=unit, measures=measures, rate=RATE,
                       begin=0.0, place="", position=[], direction=[], role="response")

    return Recording(source=["made for a test"], runs={
        run: RunProduct(description="", repeat_of="", conditions={},
                        channels={name: channel(name, samples) for name, samples in channels.items()})
        for run, channels in shown.items()})


def test_in_a_diagnosis(catalogue):
    """A block that a machine pulls at changing speeds: the law is named beside one that falls with speed as well."""
    model = reduced_model(lumped(settings=fill(Lumped, LUMPED, "lumped")), settings=Reduction())
    blank, fine = {run: dict.fromkeys(("cell", "laser"), np.zeros(SAMPLES)) for run in COURSES}, laid_out("25 us")
    runs = as_benched(recorded(blank), fill(Bench, fine, "bench"), model)
    true = catalogue.on(benches.built(model, fill(Bench, fine, "bench")), "contact", {"gain": 0.6, "time": 0.02})
    random, shown = np.random.default_rng(3), {}
    for name, one in runs.items():
        clean = respond(true, one.run)
        shown[name] = {channel: clean[channel] + size * random.standard_normal(SAMPLES)
                       for channel, size in zip(("cell", "laser"), NOISE, strict=True)}
    settings = fill(Bench, laid_out("100 us"), "bench")
    asked = fill(Diagnosis, {
        "parameters": {"friction": {"spread": 0.1}, "joints.machine.stiffness": {"spread": 0.05}}, "solver": False,
        "held_out": ["pull_2"], "effects": ["falling_friction", "wet_film"],
        "noise": {"std": {"cell": f"{NOISE[0]} N", "laser": f"{NOISE[1]} m/s"}}}, "diagnosis")
    given = recorded(shown)
    found = as_json(diagnosis(model, None, given, bench(model, None, given, settings=settings), settings=asked))
    assert found["verdict"] == "missing" and found["effects"][0]["name"] == "wet_film", found["reasons"]
    values = found["effects"][0]["parameters"]
    assert values["gain"]["value"] == pytest.approx(0.6, abs=3 * values["gain"]["std"])
    assert values["time"]["value"] == pytest.approx(0.02, abs=3 * values["time"]["std"])
