"""Every picture is drawn, has the same bytes twice, and changes with the data it claims to show."""

from dataclasses import replace

import numpy as np
import pytest

from pipeline.views.figures import (
    agreement,
    complex_modes,
    contact_spots,
    friction,
    friction_paths,
    pad_motion,
    preload,
    probability,
    surfaces,
    vibration,
)
from pipeline.views.figures.bench import line_evidence, line_fit, measured_friction, noise_events
from pipeline.views.figures.models import limit_cycle, lock_in, rupture, transient
from pipeline.views.figures.models import sensitivities as derived
from tests.views import products_for_views as small

LINES = (16600.0, 17800.0)


def few_distances():
    """Friction at two distances: for pictures with a frame of each."""
    return small.micro_friction(distances=2)


PICTURES = {
    "normal law": (lock_in.normal_law, small.interface_law, "gap_pressure"),
    "shear law": (lock_in.shear_law, small.interface_law, "shear"),
    "descriptions": (lock_in.descriptions, small.interface_law, "evolution_shear"),
    "lock-in": (lock_in.length_map, small.lock_in, "base"),
    "height map": (lambda p: surfaces.height_map(p, 0, 60), small.surface, "disc_height"),
    "profile": (surfaces.profile, small.surface, "pad_height"),
    "heights": (surfaces.height_distribution, small.surface, "pad_height"),
    "spectrum": (surfaces.power_spectrum, small.surface, "power_spectrum"),
    "spots new": (lambda p: contact_spots.contact_spots(p, 0, 60), small.micro_friction, "contact_pressure"),
    "spots worn": (lambda p: contact_spots.contact_spots(p, -1, 60), small.micro_friction, "contact_pressure"),
    "spots in motion": (lambda p: contact_spots.over_cycles(p, "spots", 40), few_distances, "contact_pressure"),
    "wear in motion": (lambda p: contact_spots.over_cycles(p, "disc", 40), few_distances, "disc_wear"),
    "stress": (lambda p: contact_spots.stress(p, 60), small.micro_friction, "stress"),
    "from rest": (friction.from_rest, small.micro_friction, "presliding_friction"),
    "bearing": (friction.bearing, small.micro_friction, "pad_bearing"),
    "wear": (lambda p: contact_spots.wear_map(p, "pad", 60), small.micro_friction, "pad_wear"),
    "area": (lambda p: friction.over_distance(p, "real_area"), small.micro_friction, "real_area"),
    "wear depth": (lambda p: friction.over_distance(p, "wear_depth"), small.micro_friction, "wear_depth"),
    "friction": (lambda p: friction.over_distance(p, "friction"), small.micro_friction, "friction"),
    "over pressure": (friction.over_pressure, small.micro_friction, "friction"),
    "convergence": (friction.convergence, small.micro_friction, "refinement_area"),
    "limit cycle levels": (limit_cycle.levels, small.limit_cycle, "level"),
    "limit cycle spectrum": (lambda c: limit_cycle.spectrum(c, 1), small.limit_cycle, "spectrum"),
    "probability": (probability.per_point, small.probability, "probability"),
    "probable bands": (probability.per_band, small.probability, "band_any"),
    "sensitivities": (lambda p: probability.sensitivities(p, list(p.source)), small.probability, "sensitivity"),
    "tornado": (lambda p: derived.tornado(p, 0, [0, 1, 3], ["a", "b", "c"], ["1 %"] * 3), small.sensitivities,
                "change"),
    "bayes factors": (lambda p: line_evidence.factors(p, list(p.hypothesis)), small.line_evidence, "factor"),
    "predicted tones": (lambda p: line_evidence.tones(p, list(p.hypothesis)), small.line_evidence, "tone"),
    "fit of lines": (lambda p: line_fit.before_after(p, list(p.hypothesis)), small.line_evidence, "tone"),
    "pressure cycle": (lambda p: line_fit.cycle(p, ["nominal", "best"]), small.line_evidence, "cycle_root"),
    "measured friction": (measured_friction.over_conditions, small.friction_update, "friction"),
    "measured over predicted": (measured_friction.measured_over_predicted, small.friction_update, "unseen"),
    "simulated lists": (line_evidence.simulated, small.line_evidence, "simulated"),
    "spectrogram": (lambda p: noise_events.spectrogram(p, 0, 60), small.noise_events, "event_start"),
    "level of events": (noise_events.level_frequency, small.noise_events, "event_level"),
    "squeal over conditions": (lambda p: noise_events.over_conditions(p, "pressure", "speed"), small.noise_events,
                               "event_level"),
    "share of squeal": (noise_events.occurrence, small.occurrence_map, "squealing"),
    "loudest squeal": (noise_events.loudest, small.occurrence_map, "level"),
    "map": (friction.friction_map, small.friction_map, "friction"),
    "preload": (lambda p: preload.contact_pressure(p, preload.loads(p), 60), small.structure, "preload"),
    "sliding load": (lambda p: preload.contact_pressure(small.structure(), preload.loads(small.structure(), p), 60),
                     small.complex_modes, "operating_force"),
    "roots": (lambda p: complex_modes.growth_over_frequency(p, LINES, 60), small.complex_modes, "root"),
    "growth sweep": (complex_modes.growth_over_friction, small.complex_modes, "root"),
    "lock in": (complex_modes.lock_in, small.complex_modes, "root"),
    "operating roots": (lambda p: complex_modes.operating_growth(p, 60), small.complex_modes, "operating_root"),
    "path": (lambda p: friction_paths.path(p, 0, "the other"), small.complex_modes, "path_root"),
    "contacts": (lambda p: _contact_map(p.unstable_contact[0]), small.complex_modes, "unstable_contact"),
    "motion": (lambda p: pad_motion.pad_motion(p, 8, 60), small.multibody, "pad_motion"),
    "forces": (lambda p: pad_motion.patch_forces(p, 8, 0, 60), small.multibody, "patch_force"),
    "growth": (lambda p: pad_motion.growth(p, 60), small.multibody, "growth_rate"),
    "stability": (lambda p: pad_motion.stability_map(p, 8, 60), small.multibody, "stability"),
    "spectra": (lambda p: vibration.spectra(p, [0, 8], 0, LINES, 60), small.response, "velocity_spectrum"),
    "occurrence": (lambda p: vibration.occurrence(p, 60), small.squeal, "peak_level"),
    "levels": (lambda p: vibration.level_frequency(p, LINES), small.squeal, "event_level"),
    "bands": (lambda p: vibration.band_levels(p, [0, 8], 0), small.squeal, "band_level"),
    "velocities": (lambda p: transient.velocities(p, 1, 60), small.transient, "velocity"),
    "portrait": (lambda p: transient.phase_portrait(p, 1, 0, 60), small.transient, "displacement"),
    "force and slip": (lambda p: transient.force_and_slip(p, 1, 0, 60), small.transient, "normal_force"),
    "harmonics": (lambda p: transient.spectrum(p, 1, 0, 60), small.transient, "velocity_spectrum"),
    "rupture field": (lambda p: rupture.field(p, 2, 60), small.rupture, "speed_field"),
    "rupture moving": (lambda p: rupture.animation(p, 50), small.rupture, "speed_field"),
    "rupture slip": (rupture.slip_profiles, small.rupture, "slip"),
    "rupture arrivals": (rupture.arrivals, small.rupture, "arrival"),
    "rupture speed": (rupture.speed_over_x, small.rupture, "front_speed"),
    "rupture phases": (rupture.phase_diagram, small.rupture, "study_speed"),
    "rupture mesh": (rupture.mesh_study, small.rupture, "study_width"),
    "rupture preload": (rupture.static_state, small.rupture, "static_shear"),
    "agreement": (agreement.agreement, small.comparison, "ours"),
}


def _contact_map(parts):
    model = small.reduced_model()
    return friction_paths.contact_maps(model.contact_position, model.contact_area, model.contact_body, parts,
                                       ("outer pad", "inner pad"), 60)


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_shows_its_data_with_the_same_bytes_twice(
        name, every_picture_has_its_data_with_units_and_nothing_is_clipped):
    draw, build, field = PICTURES[name]
    product = build()
    first = draw(product)
    assert first.image.startswith(b"\x89PNG") if isinstance(first.image, bytes) else "<svg" in first.image
    with every_picture_has_its_data_with_units_and_nothing_is_clipped():
        assert draw(product) == first
    assert first.csv.count("\n") > 1
    values = getattr(product, field)
    assert draw(replace(product, **{field: values * np.linspace(0.7, 1.1, values.size).reshape(values.shape)})) != first


def test_a_line_drawing_says_neither_when_nor_by_whom_it_was_drawn():
    picture = surfaces.power_spectrum(small.surface())
    assert "<dc:" not in picture.image


def test_harmonics_look_different_from_own_tones():
    own, above = small.squeal(), small.squeal(harmonic=True)
    assert vibration.level_frequency(own, LINES) != vibration.level_frequency(above, LINES)
    assert vibration.occurrence(own, 60) != vibration.occurrence(above, 60)


def test_fields_of_nothing_are_drawn():
    worn = small.micro_friction()
    empty = replace(worn, contact_pressure=0 * worn.contact_pressure, pad_wear=0 * worn.pad_wear)
    assert contact_spots.contact_spots(empty, 0, 40)
    assert contact_spots.wear_map(empty, "pad", 40)
    assert vibration.level_frequency(small.squeal(quiet=True), ())
    assert complex_modes.growth_over_friction(small.complex_modes(stable=True))


@pytest.mark.exact
def test_loads_are_those_of_the_middle_pressure_and_speed():
    brake, modes = small.structure(), small.complex_modes()
    still, moved = preload.loads(brake, modes)
    assert (still.title, moved.title) == ("without friction", "sliding, friction 0.46")
    np.testing.assert_array_equal(still.force, brake.preload[1])
    np.testing.assert_array_equal(moved.force, modes.operating_force[4])
    assert still.closed.all() and np.flatnonzero(~moved.closed).tolist() == [11]
    assert preload.loads(brake)[0].title == still.title and len(preload.loads(brake)) == 1


def test_an_open_patch_is_crossed():
    """A force of nothing differs from one too small for its colour."""
    brake, (load,) = small.structure(), preload.loads(small.structure())
    light, none = (replace(load, force=np.append(load.force[:-1], force)) for force in (1e-9, 0.0))
    assert preload.contact_pressure(brake, (light,), 60) != preload.contact_pressure(brake, (none,), 60)


@pytest.mark.exact
def test_operating_points_find_their_tile():
    from pipeline.views.figures.style import operating_grid

    pressures, speeds, grid = operating_grid([1.0, 3.0, 1.0], [8.0, 8.0, 12.0], [10.0, 20.0, 30.0])
    assert pressures.tolist() == [1.0, 3.0]
    assert speeds.tolist() == [8.0, 12.0]
    np.testing.assert_array_equal(grid, [[10.0, 30.0], [20.0, np.nan]])


@pytest.mark.exact
def test_an_envelope_keeps_every_peak():
    from pipeline.views.figures.style import envelope

    time = np.linspace(0, 1, 100_000)
    signal = np.sin(2 * np.pi * 400 * time)
    signal[31_415] = 7.0
    shown_time, shown = envelope(time, signal, bins=500)
    assert len(shown) == len(shown_time) == 1000
    assert shown.max() == 7.0
    assert shown.min() == signal.min()
    assert envelope(time[:50], signal[:50])[1] is not None


def test_status_band_shows_the_status():
    product = small.transient()
    first = transient.status_band(product, 0, 60)
    assert transient.status_band(product, 0, 60) == first
    assert transient.status_band(replace(product, status=2 - product.status), 0, 60) != first


@pytest.mark.exact
def test_an_animation_moves_and_keeps_its_size():
    from io import BytesIO

    from PIL import Image

    whole = rupture.animation(small.rupture(), 50)
    assert Image.open(BytesIO(whole.image)).n_frames == 3
    shorter = rupture.animation(small.rupture(), 50, most=len(whole.image) - 1)
    assert len(shorter.image) < len(whole.image)


def test_spots_and_wear_move_over_the_distances():
    """Frame by frame, whatever is written above."""
    from io import BytesIO

    from PIL import Image

    untitled = replace(small.micro_friction(8), distance=np.zeros(5))
    for what in ("spots", "pad"):
        assert Image.open(BytesIO(contact_spots.over_cycles(untitled, what, 40).image)).n_frames == 5


def test_the_interface_shows_its_state():
    moving = small.rupture()
    opened = replace(moving, frame_state=2 * moving.frame_state)
    assert rupture.field(opened, 2, 60) != rupture.field(moving, 2, 60)
