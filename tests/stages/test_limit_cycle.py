"""Stage limit_cycle on a brake of a few elements."""

import io
from functools import partial
from importlib import import_module

import numpy as np
import pytest
import scipy

from pipeline.contract import ConfigError, ConvergenceError
from pipeline.products import Effects
from stages.complex_modes import Settings as Modes
from stages.complex_modes import complex_modes
from stages.limit_cycle import CHECKS, Settings, limit_cycle
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.effects.systems import Telling
from tests.stages.small_structure import small_friction_map, small_structure

stage = import_module("stages.limit_cycle")
SETTINGS = {"duration": "120 ms", "window": "20 ms", "step": "5 us", "patch": 1, "checks": ("step",)}
#: for what needs no limit cycle
SHORT = SETTINGS | {"duration": "6 ms", "window": "2 ms"}


@pytest.fixture(scope="module")
def model():
    return reduced_model(small_structure(), settings=Reduction(fixed_below="20 kHz"))


@pytest.fixture(scope="module")
def modes(model):
    return complex_modes(model, small_friction_map(0.6), settings=Modes(
        friction_steps=2, speeds=("8 rad/s", "12 rad/s"), frequency_max="8 kHz", friction_slopes=False))


@pytest.fixture(scope="module")
def cycle(model, modes):
    return limit_cycle(model, small_friction_map(0.6), modes, settings=Settings(**SETTINGS))


@pytest.mark.exact
def test_small_motion_grows_as_the_complex_modes_say(modes, cycle):
    assert len(cycle.onset_root) == len(modes.unstable_root) > 0
    np.testing.assert_array_equal(np.sort_complex(cycle.onset_root), np.sort_complex(modes.unstable_root))
    np.testing.assert_allclose(cycle.onset_simulated.imag, cycle.onset_root.imag, rtol=1e-3)
    error = abs(cycle.onset_simulated.real - cycle.onset_root.real)
    assert (error < np.maximum(0.1 * cycle.onset_root.real, 1.0)).all()


def test_growth_ends_and_energy_balances(cycle):
    total = (cycle.level**2).sum(axis=1)
    assert (total[:, -1] > 0).all() and np.isfinite(total).all()
    assert (cycle.imbalance < 0.01).all()
    growth = np.log(total[:, 1:] / total[:, :-1]) / (2 * float(cycle.window))
    fastest = np.array([cycle.onset_root.real[cycle.onset_operating == k].max() for k in range(len(total))])
    assert (growth[:, -1] < 0.5 * fastest).all()


@pytest.mark.exact
def test_the_loudest_cycle_is_written_to_listen_to(cycle):
    """The strongest line within 1 Hz, as strong as its harmonics say."""
    rate, samples = scipy.io.wavfile.read(io.BytesIO(limit_cycle.companions(cycle)["squeal.wav"]))
    loudest = (cycle.level[..., -1]**2).sum(axis=1).argmax()
    sensor = cycle.level[loudest, :, -1].argmax()
    harmonics = cycle.cycle_frequency[loudest] * np.arange(1, cycle.harmonic_amplitude.shape[2] + 1)
    strongest = harmonics[cycle.harmonic_amplitude[loudest, sensor].argmax()]
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples)), 2**20))
    assert spectrum.argmax() * rate / 2**20 == pytest.approx(strongest, abs=1.0)
    middle = samples[1000:-1000].std() * cycle.listen["squeal"].full_scale / 32767
    heard = cycle.harmonic_amplitude[loudest, sensor][harmonics < 0.45 * rate]
    assert middle == pytest.approx(np.sqrt((heard**2).sum() / 2), rel=0.02)


@pytest.mark.exact
def test_half_the_step_changes_neither_level_nor_frequency(model, modes):
    """While contacts already open and stick; later this small brake moves chaotically, and waveforms part."""
    short = limit_cycle(model, small_friction_map(0.6), modes, settings=Settings(
        **SETTINGS | {"duration": "12 ms", "window": "4 ms", "step": "2 us"}))
    assert tuple(short.check) == ("step",) and short.open_share.max() > 0
    line = 1 / (2 * float(short.window))      # what the record resolves, in Hz
    assert abs(short.check_level[0]) < 0.5
    assert abs(short.check_frequency[0]) * short.cycle_frequency.max() < 0.2 * line


@pytest.mark.golden
def test_exudyn_and_compiled_code_agree(model, modes):
    """Growth of small motion and level within 0.1 %, over 3 ms; later this small brake moves chaotically."""
    law = small_friction_map(0.6)
    short = {**SHORT, "duration": "3 ms", "window": "1 ms", "checks": (), "speeds": "middle", "step": "1 us"}
    compiled, exudyn = (limit_cycle(model, law, modes, settings=Settings(**short, solver=solver))
                        for solver in ("compiled", "exudyn"))
    np.testing.assert_allclose(exudyn.onset_simulated, compiled.onset_simulated, rtol=1e-3)
    np.testing.assert_allclose(exudyn.level, compiled.level, rtol=1e-3)
    assert exudyn.imbalance.max() < 0.01


def test_every_check_changes_one_thing(model, modes):
    cycle = limit_cycle(model, small_friction_map(0.6), modes, settings=Settings(
        **SHORT | {"checks": CHECKS, "speeds": "middle", "stick_speed": "0.5 m/s"}))
    assert tuple(cycle.check) == CHECKS and len(cycle.pressure) == 1
    assert np.isfinite(cycle.check_level).all()


def test_patches_too_large_to_limit_the_motion_are_refused(model, modes):
    with pytest.raises(ConvergenceError, match="smaller patches|lower limit_cycle.patch"):
        limit_cycle(model, small_friction_map(0.6), modes, settings=Settings(
            **SETTINGS | {"patch": 4, "speeds": "middle", "checks": ()}))


@pytest.mark.parametrize("failing", [1, 2, 3])
def test_a_step_at_which_motion_has_no_bounds_is_halved_twice(model, modes, monkeypatch, failing):
    """The result is that of the first step that serves, and says so."""
    simulated, seen = stage._simulated, []

    def tried(*given):
        seen.append(given[4].step)
        if len(seen) <= failing:
            raise stage._OutOfBounds("limit_cycle", "bounds", "none")
        return simulated(*given)

    monkeypatch.setattr(stage, "_simulated", tried)
    told = Telling()
    run = partial(limit_cycle, model, small_friction_map(0.6), modes, settings=Settings(
        **SHORT | {"speeds": "middle", "checks": ()}), context=told)
    if failing < 3:
        assert float(run().step) == seen[-1]
    else:
        with pytest.raises(ConvergenceError, match="expected bounds, found none"):
            run()
    assert seen == pytest.approx([5e-6, 2.5e-6, 1.25e-6][:failing + 1]) and len(told.lines) == min(failing, 2)


def test_without_unstable_modes_nothing_is_simulated(model):
    still = complex_modes(model, small_friction_map(0.0), settings=Modes(friction_steps=2, frequency_max="8 kHz"))
    cycle = limit_cycle(model, small_friction_map(0.0), still, settings=Settings(**SHORT))
    assert cycle.level.shape[0] == len(cycle.onset_root) == len(cycle.check) == 0


def test_memory_and_elements_ask_for_compiled_steps(model, modes):
    cubic = Effects(effect=["cubic_stiffness"], place=[str(model.joint_name[0])], term=[0], parameter=["coefficient"],
                    value=[1e15], unit=["N/m^3"], condition=[], condition_value=[])
    with pytest.raises(ConfigError, match="limit_cycle.solver"):
        limit_cycle(model, small_friction_map(0.6), modes, cubic, settings=Settings(**SHORT, solver="exudyn"))


def test_windows_fit_into_the_motion():
    with pytest.raises(ConfigError, match="duration"):
        limit_cycle.check({"limit_cycle": Settings(duration="20 ms", window="10 ms")})
