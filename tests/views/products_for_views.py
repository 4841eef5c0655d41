"""Small synthetic products with the shapes of real ones: what the views are tried on; fields they do not read are 0."""

from dataclasses import fields

import numpy as np

from pipeline.contract.context import CaseSummary
from pipeline.contract.product import is_product
from pipeline.products import (
    Body,
    Comparison,
    ComplexModes,
    Convergence,
    Excerpt,
    FrictionMap,
    FrictionUpdate,
    Incidence,
    InterfaceLaw,
    LimitCycle,
    LineEvidence,
    LockIn,
    Lumped,
    MicroFriction,
    ModalTest,
    ModelUpdate,
    Multibody,
    NoiseEvents,
    OccurrenceMap,
    Orders,
    OrderSpectra,
    PinOnDisc,
    Probability,
    ReducedModel,
    Response,
    ResponseFunctions,
    Rupture,
    Sensitivities,
    Spectrogram,
    Squeal,
    Structure,
    Surface,
    TestModes,
    TestResponses,
    Transient,
)

PRESSURE, SPEED, OMEGA = np.array([1e6, 2e6, 3e6]), np.array([0.9, 1.1, 1.3]), np.array([8.5, 10.25, 12.0])
OPERATING_PRESSURE, OPERATING_SPEED = np.repeat(PRESSURE, 3), np.tile(OMEGA, 3)
SENSORS, SQUEAL_LINE = ["disc_outer_rim", "pad_outer_back"], 16600.0


def filled(cls, **given):
    """A product with the values ``given`` and zeros elsewhere; dimensions nobody gives have length 2."""
    plain = {f.name: f.metadata for f in fields(cls) if "dims" in f.metadata}
    sizes = {dim: size for name, value in given.items() if name in plain
             for dim, size in zip(plain[name]["dims"], np.shape(value), strict=True)}
    values = {name: np.zeros([sizes.get(dim, 2) for dim in said["dims"]], dtype=said["dtype"])
              for name, said in plain.items()}
    parts = {f.name: filled(f.type) if is_product(f.type) else {} for f in fields(cls)
             if f.name not in plain and f.name not in given}
    return cls(**{**{name: value.tolist() if value.dtype.kind == "U" else value for name, value in values.items()},
                  **parts, **given})


def surface(nodes=48):
    """Turning marks against plateaus on a square millimetre."""
    x = np.linspace(0, 1e-3, nodes)
    noise = np.random.default_rng(1).normal(size=(2, nodes, nodes))
    disc = 5e-6 * np.sin(2 * np.pi * x / 2e-4)[:, None] + 1e-6 * noise[0]
    pad = 3e-6 * np.tanh(noise[1])
    heights = np.stack([disc - disc.mean(), pad - pad.mean()])
    rms = heights.std(axis=(1, 2))
    wavenumber = np.geomspace(6e3, 2e5, 30)
    return filled(
        Surface, y=x, x=x, disc_height=heights[:1], pad_height=heights[1:2], body=["disc", "pad"],
        source=["generated: turned disc", "generated: plateau pad"], rms_height=rms, mean_height=0.8 * rms,
        peak_to_valley=np.ptp(heights, axis=(1, 2)), skewness=[0.1, -0.6], kurtosis=[2.1, 3.4],
        rms_slope=[0.12, 0.09], outlier_share=[0.0, 0.001], filled_share=[0.0, 0.002],
        shortest_wavelength=[3.1e-5, 3.1e-5], nodes_per_wavelength=[8.0, 8.0], wavenumber=wavenumber,
        power_spectrum=np.stack([1e-20 * (wavenumber / 1e4) ** -3.0, 4e-21 * (wavenumber / 1e4) ** -2.5]))


def micro_friction(nodes=48, distances=5):
    """Friction that rises with wear."""
    distance = np.linspace(5e-5, 1e-2, distances)
    worn = distance / distance[-1]
    area = (PRESSURE[:, None, None] / 1e6 * 0.03 + 0.02 * worn) * np.ones((1, 3, 1))
    friction = 0.40 + 0.02 * np.arange(3)[:, None, None] + 0.002 * np.arange(3)[:, None] + 0.2 * worn
    field = np.random.default_rng(2).normal(size=(nodes, nodes))
    x = np.linspace(0, 1e-3, nodes)
    return filled(
        MicroFriction, pressure=PRESSURE, speed=SPEED, disc_speed=OMEGA, distance=distance, friction=friction,
        friction_std=0.02 * friction, real_area=area, wear_depth=7e-7 * worn * np.ones((3, 3, 1)),
        largest_wear=6e-6 * worn * np.ones((3, 3, 1)),
        normal_stiffness=1e12 * (1 + worn) * np.ones((3, 3, 1)), flash_temperature=5 + 0 * area, shear_limit=13.5e6,
        block_compliance=3.5e-12,
        y=x, x=x, contact_pressure=[np.clip(field - 1.8 + 0.3 * w, 0, None) * 5e7 for w in worn],
        pad_wear=[np.clip(field - 1.4, 0, None) * 2e-6 * w for w in worn], bearing_share=np.linspace(0, 1, 21),
        disc_wear=[np.clip(field - 1.4, 0, None) * 2e-7 * w for w in worn],
        pad_bearing=[np.linspace(8e-6 - 2e-6 * w, -8e-6, 21) for w in worn],
        disc_bearing=[np.linspace(6e-6 - 2e-7 * w, -6e-6, 21) for w in worn], stress_depth=np.linspace(0, 9e-5, 11),
        stress=5e7 * np.exp(-np.linspace(0, 3, 11))[:, None] * np.clip(field[0], 0, None),
        stress_largest=5e7 * np.exp(-np.linspace(0, 3, 11)) * field[0].max(), stress_row=x[0],
        presliding_displacement=np.outer([1.0, 1.2, 1.4], np.linspace(0.1, 1, 5)) * 1e-6,
        presliding_friction=np.outer([0.4, 0.42, 0.44], np.linspace(0.1, 1, 5) ** 0.6),
        tangential_stiffness=[8e11, 1.6e12, 2.4e12], refinement=[4.0, 8.0, 16.0],
        refinement_area=[0.04, 0.031, 0.030], nodes_per_wavelength=8.0, area_limit=0.0295, area_limit_error=0.0005,
        area_order=1.4)


def friction_map():
    """The map of the friction above, one speed wider than computed."""
    micro = micro_friction(8)
    return filled(FrictionMap, pressure=PRESSURE, speed=SPEED, distance=micro.distance, friction=micro.friction,
                       friction_std=micro.friction_std, normal_stiffness=micro.normal_stiffness.mean(axis=1),
                       computed_pressure=PRESSURE, computed_speed=SPEED,
                       best_pressure=np.full(len(micro.distance), PRESSURE[1]),
                       pressure_slope_std=np.full(len(micro.distance), 0.005),
                       speed_slope_std=np.full(len(micro.distance), 0.05),
                       error_correlation=np.tile(np.eye(3), (len(micro.distance), 1, 1)))


def modal_test(empty=False):
    """A run with a pair of modes and a single one, or none."""
    count, line = 0 if empty else 3, np.linspace(0, 2000, 200)
    frequency = np.array([800.0, 802.0, 1500.0])[:count]
    peaks = 1e-3 + sum((1 / (1 + ((line - f) / 5) ** 2) for f in frequency), 0 * line)
    order = np.repeat(np.arange(2, 12), max(count, 1))
    shape = np.array([[1, 0, -1, 0], [0, 1, 0, -1], [1, 1, 1, 1]], complex)[:count]
    modes = TestModes(
        frequency=frequency, frequency_std=1e-5 * frequency, damping_ratio=np.full(count, 2e-3),
        damping_ratio_std=np.full(count, 1e-5), narrow=np.zeros(count, int), partner=[1, 0, 2][:count],
        place=[f"node {k} direction 3" for k in range(4)], reference=["node 0 direction 3"] * 4, shape=shape,
        shape_std=np.full((count, 4), 0.01),
        likeness=np.eye(3)[:count, :count], noise=np.full(4, 0.012), line=line, measured=1.01 * peaks, fitted=peaks,
        order=order, pole_frequency=np.resize(frequency if count else [500.0], len(order)),
        pole_damping=np.full(len(order), 2e-3), stable=np.full(len(order), int(not empty)),
        chosen=np.resize(np.arange(count) if count else [-1], len(order)))
    return ModalTest(runs={"hammer": modes})


def model_update(points=True, body="disc"):
    """Three measured modes: a pair of a disc, one in doubt, and one that the model lacks; or the same of a brake."""
    return ModelUpdate(
        run="hammer", body=body, parameter=["disc.young", "disc.poisson"], mover=["disc", "caliper", "pad_outer"],
        mover_share=[0.93, 0.6, 0.7], mesh_spread=[0.002 * points, 0.0], mesh_checked=int(points),
        unit=["Pa", "1"], before=[120e9, 0.27], before_spread=[0.1, 0.1], after=[128.3e9, 0.272],
        after_spread=[0.004, 0.09], correlation=np.eye(2), model_error=0.003, model_error_spread=0.3,
        measured_frequency=[800.0, 801.0, 1500.0, 1710.0],
        measured_std=[0.01, 0.01, 0.02, 0.1], pair=[0, 0, 1, -1], rival=[-1, -1, 2, -1], odds=[25.0, 25.0, 1.1, 4.0],
        clear=[1, 1, 0, 0], likeness=np.array([[0.99, 0.01, 0], [0.98, 0, 0.01], [0, 0.7, 0.6], [0, 0, 0]]) * points,
        frequency_before=[770.0, 1450.0, 1470.0], frequency=[801.2, 1495.0, 1512.0],
        frequency_spread=[0.001, 0.001, 0.001], members=[2, 1, 2], diameters=[2, 0, 3],
        place=["node 1 direction 3", "node 2 direction 3"] * points, reference=["node 1 direction 3"] * 2 * points,
        agreement=[0.99, 0.5][:2 * points], distance=[1e-3, 4e-3][:2 * points])


def response_functions(known=True):
    """Two blows with a third left out, or responses as a file gives them."""
    line = np.linspace(0, 2000, 200)
    response = np.array([1e-6 * (1 + k) / (1 + 1j * (line - 800) / 20) for k in range(4)])
    return ResponseFunctions(tests={"hammer": TestResponses(
        line=line, response=response, coherence=np.full((4, 200), 0.98) if known else np.empty((0, 200)),
        label=[f"x_{k}" for k in range(4)], unit=["m/N"] * 4, place=[f"node {k} direction 3" for k in range(4)],
        reference=["node 0 direction 3"] * 4, method="blows" if known else "given", averages=[2 if known else 0],
        left_out=["2.1 s: struck twice"] if known else [], decay=3.5 if known else 0.0,
        remark=[] if known else ["phases have the opposite sign"])})


def noise_events(quiet=False):
    """Two runs of a microphone and an accelerometer: squeal with a harmonic at two pressures, a groan; or nothing."""
    kept = slice(0, 0) if quiet else slice(None)
    spectrogram = Spectrogram(time=np.linspace(0, 10, 40), frequency=np.linspace(0, 16e3, 30),
                              level=40 + 20 * np.random.default_rng(6).random((40, 30)))
    rows = {"record": [0, 0, 2, 2, 1], "kind": ["squeal", "harmonic", "squeal", "groan", "squeal"],
            "frequency": [2780.0, 5560.0, 7340.0, 240.0, 2780.0], "level": [89.0, 74.0, 78.0, 91.0, 149.0],
            "start": [2.0, 2.0, 6.0, 8.0, 2.0], "duration": [2.4, 2.4, 1.1, 1.5, 2.4], "order": [1, 2, 1, 1, 1],
            "fundamental": [2780.0, 2780.0, 7340.0, 240.0, 2780.0],
            "condition": [[1.7e6, 20.0, 0.0]] * 2 + [[1.2e6, 10.0, 0.0], [1e6, 3.0, 0.0], [1.7e6, 20.0, 0.0]],
            "condition_known": [[1, 1, 0]] * 5}
    events = {f"event_{name}": np.array(values)[kept] for name, values in rows.items()}
    return filled(
        NoiseEvents, threshold=70.0, band=[2e3, 16e3], record_run=["stop_1", "stop_1", "stop_2"],
        record_channel=["mic", "pad", "mic"], record_kind=["sound", "vibration", "sound"], record_duration=[10.0] * 3,
        record_peak=[89.0, 149.0, 78.0], record_peak_frequency=[2780.0, 2780.0, 7340.0], record_background=[62.0] * 3,
        record_overload=[0.0] * 3, record_range=[0.0] * 3,
        condition=["pressure", "speed", "temperature"], event_lowest=0.999 * events["event_frequency"],
        event_highest=1.001 * events["event_frequency"], **events, mode_name=["umbrella", "mode 7"],
        mode_frequency=[2800.0, 9000.0], mode_unstable=[1, 0], near=0.03,
        event_chance=np.array([[0.06, 0.03], [0.08, 0.0], [0.02, 0.01], [0.0, 0.0], [0.06, 0.03]])[kept],
        event_mode=np.array([0, -1, -1, -1, 0])[kept], maps={} if quiet else {"pressure.speed": occurrence_map()},
        remarks=[], listen={} if quiet else {"squeal": excerpt("Pa", "run stop_1, mic")},
        spectrogram={"stop_1.mic": spectrogram, "stop_1.pad": spectrogram, "stop_2.mic": spectrogram})


def occurrence_map():
    """Pressures to 3 MPa and speeds to 20 rad/s, not all of them recorded, squeal at the middle pressure."""
    time = np.array([[2.0, 4.0], [3.0, 1.0], [0.0, 5.0]])
    return filled(OccurrenceMap, condition=["pressure", "speed"], first_edge=[0.0, 1e6, 2e6, 3e6],
                  second_edge=[0.0, 10.0, 20.0], time=time, squealing=time * [[0, 0], [0.5, 1], [0, 0]],
                  runs=[[2, 2], [2, 1], [0, 2]], squealing_runs=[[0, 0], [1, 1], [0, 0]],
                  level=[[0, 0], [78.0, 89.0], [0, 0]])


def orders(quiet=False):
    """A stop from 25 to 5 revolutions per second: orders 1 and 10 of the torque stand out, or none does."""
    edge = 2 * np.pi * np.linspace(5.0, 25.0, 11)
    frequency, random = np.linspace(0.0, 500.0, 40), np.random.default_rng(7)
    found = np.array([] if quiet else [1.0, 10.0])
    return Orders(spectra={"stop.torque": filled(
        OrderSpectra, run="stop", channel="torque", shaft="wheel", remark="", unit="N m", time=np.arange(30.0),
        speed=np.linspace(edge[-1], edge[0], 30), order=np.arange(161) / 8, edge=edge, outstanding=found,
        sure=[0, 1][:len(found)], level=np.outer(found, 1.0 + random.random(10)).reshape(-1, 10),
        blocks=[3] * 9 + [0], frequency=frequency, campbell=random.random((10, 40)), frames=[5] * 9 + [0])})


def friction_update():
    """A level a fifth too high, and a scatter of 2 %; pressure and speed vary, distance and temperature do not."""
    random = np.random.default_rng(4)
    mapped = 0.45 + 0.05 * random.uniform(size=12)
    measured = 0.8 * mapped * (1 + 0.02 * random.standard_normal(12))
    return filled(
        FrictionUpdate, run=["stop"] * 6 + ["drag"] * 6, friction=measured, friction_std=0.01 * measured, mapped=mapped,
        updated=0.8 * mapped, unseen=0.81 * mapped, pressure=random.uniform(1e6, 3e6, 12),
        speed=random.uniform(0.9, 1.3, 12), distance=np.full(12, 5e-3), temperature=np.full(12, 300.0),
        outside=[1] + [0] * 11, term=["level", "pressure", "speed", "distance", "temperature"],
        tested=[1, 1, 1, 0, 0], fitted=[1, 0, 0, 0, 0],
        needed=[1, 0, 0, 0, 0], value=[-0.22, 0.01, 0.0, 0.0, 0.0], value_std=[0.01, 0.02, 0.02, 0.0, 0.0],
        map_std=[0.03, 0.01, 0.01, 0.0, 0.0], p_value=[1e-9, 0.6, 0.9, 1.0, 1.0], scatter=0.02, scatter_before=0.2,
        model=["level", "the map as it is"], bic=[-40.0, 0.0], setting=["third_body_factor"], setting_before=[0.1],
        setting_after=[0.08], setting_std=[0.003], verdict="values", alike=[])


def structure():
    """A ring, two pads and a block as caliper, of few elements."""
    bodies = {"disc": _ring(0.066, 0.157, 0.0, 0.007, 0.0, 2 * np.pi, 32, True),
              "pad_outer": _ring(0.11, 0.15, 0.0071, 0.017, 1.2, 1.9, 6, False),
              "pad_inner": _ring(0.11, 0.15, -0.0101, -0.0001, 1.2, 1.9, 6, False),
              "caliper": _ring(0.10, 0.18, 0.018, 0.03, 1.1, 2.0, 6, False)}
    others = {"bracket": _ring(0.09, 0.18, 0.0, 0.02, 1.9, 2.1, 3, False),
              "piston": _ring(0.11, 0.14, -0.03, -0.0101, 1.4, 1.7, 4, False)}
    held = filled(Incidence, rows=2, row=[0, 1, 1], body=[1, 1, 4], weight=[1.0, 1.0, -1.0], node=[0, 0, 0],
                  axis=[0, 1, 1])
    angle = np.tile(np.linspace(1.25, 1.85, 6), 2)
    position = np.stack([0.13 * np.cos(angle), 0.13 * np.sin(angle), np.repeat([0.007, 0.0], 6)], axis=1)
    preload = PRESSURE[:, None] * 2e-4 * np.linspace(1.4, 0.6, 12)
    return filled(
        Structure, body_name=[*bodies, *others], **bodies, others=others,
        free_frequency=[259.4, 259.4, 431.6, 660.1, 660.1], free_diameters=[2, 2, 0, 3, 3],
        free_out_of_plane=[1.0, 1.0, 1.0, 0.99, 0.99],
        joint_name=["abutment_outer_leading", "abutment_outer_trailing"], joint_stiffness=[1e7, 2e7],
        joint_damping=[10.0, 0.0], joint_loss_factor=[0.0, 0.05], joint_rows=held, fluid_stiffness=[4e8],
        contact_body=np.repeat([1, 2], 6), contact_position=position, contact_area=np.full(12, 2e-4),
        pressure=PRESSURE, preload=preload,
        contact_stiffness=preload * 1e5, closed=np.ones((3, 12), dtype=int), law_closure=[0.0, 1e-6],
        law_pressure=[0.0, 1e6], sensor_name=SENSORS, sensor_position=np.zeros((2, 3)),
        sensor_direction=np.tile([0.0, 0.0, 1.0], (2, 1)), piston_area=2.4e-3)


def lumped():
    """Two masses: one pressed onto a belt, tied to ground and to the other."""
    return filled(
        Lumped, body_name=["block", "tool"], coordinate_name=["block.x", "block.y", "tool.x"],
        coordinate_body=[0, 0, 1], mass=np.diag([2.0, 2.0, 5.0]), joint_name=["tie", "link", "dashpot"],
        joint_stiffness=[800.0, 1e4, 0.0], joint_damping=[0.0, 2.0, 3.0],
        joint_rows=[[1.0, 0, 0], [1.0, 0, -1.0], [0, 0, 1.0]], contact_name=["tip", "rail"],
        contact_normal=[[0, 1.0, 0], [0, 0, 0]], contact_tangent=[[1.0, 0, 0], [0, 0, 1.0]], pressure=[1.0],
        preload=[[20.0, 5.0]], contact_stiffness=[[1e6, 0.0]], input_name=["weight", "motor"], input_area=[20.0, 0.0],
        input_rows=[[0, -1.0, 0], [0, 0, 1.0]], history_interval=0.1, input_history=np.ones((11, 2)), drive_history=[],
        sensor_name=["block"], sensor_rows=[[1.0, 0, 0]], sensor_quantity=["velocity"], sensor_unit=["m/s"],
        sensor_gain=[1.0])


def reduced_model():
    """The visible surface of the ring."""
    built = structure()
    disc = built.disc
    return filled(ReducedModel, body_name=["disc"], visible_position=disc.node, visible_face=disc.element[:, 4:8],
                  visible_body=np.zeros(len(disc.node), int), contact_body=built.contact_body,
                  contact_position=built.contact_position, contact_area=built.contact_area)


def complex_modes(stable=False):
    """Eight modes, one of which becomes unstable at friction 0.4."""
    friction = np.linspace(0, 0.7, 8)
    frequency = np.array([800.0, 2200.0, 4100.0, 7300.0, 11000.0, 14800.0, SQUEAL_LINE, 17900.0])
    growth = -0.002 * 2 * np.pi * frequency * np.ones((3, 8, 1))
    growth[:, :, 6] += 0.0 if stable else (friction * 520)[None, :] * np.array([0.9, 1.0, 1.1])[:, None]
    root = growth + 2j * np.pi * (frequency + 30 * friction[:, None] ** 2)
    mu = 0.40 + 0.03 * np.repeat([1, 2, 3], 3)
    at = np.stack([root[p, np.searchsorted(friction, m)] for p, m in zip(np.repeat([0, 1, 2], 3), mu, strict=True)])
    operating, which = np.nonzero(at.real > 0)
    order = np.argsort(-at[operating, which].real, kind="stable")
    disc = structure().disc
    angle = np.arctan2(disc.node[:, 1], disc.node[:, 0])
    shape = np.zeros((len(operating), len(disc.node), 3), dtype=complex)
    shape[:, :, 2] = np.exp(5j * angle)
    return filled(
        ComplexModes, pressure=PRESSURE, friction=friction, root=root, real_frequency=np.tile(frequency, (3, 1)),
        operating_pressure=OPERATING_PRESSURE, operating_speed=OPERATING_SPEED, operating_friction=mu,
        operating_force=OPERATING_PRESSURE[:, None] * 2e-4 * np.append(np.linspace(2.2, 0.4, 11), 0.0),
        operating_open=np.ones(9, dtype=int), operating_root=at, unstable_operating=operating[order],
        unstable_root=at[operating, which][order], unstable_reduced=at[operating, which][order],
        unstable_residual=np.full(len(operating), -1.0),
        unstable_shape=shape, unstable_diameters=np.full(len(operating), 5),
        unstable_in_plane=np.full(len(operating), 2), unstable_out_of_plane=np.full(len(operating), 5),
        unstable_axial=np.full(len(operating), 0.87),
        body_name=["disc", "pad_outer", "pad_inner", "caliper"],
        unstable_share=np.tile([0.7, 0.2, 0.1, 0.0], (len(operating), 1)),
        growth_term=["friction at pad_outer", "friction at pad_inner", "contact damping",
                     "friction turning with the slip", "friction over slip speed", "damping of disc",
                     "damping of pad_inner", "damping at abutment"],
        growth_owner=["contacts"] * 5 + ["body", "body", "joints"],
        growth_part=["pad_outer", "pad_inner", "", "", "", "disc", "pad_inner", "abutment"],
        unstable_growth=np.tile([300.0, 100.0, -150.0, -100.0, -30.0, -2.6, -30.0, -10.0], (len(operating), 1)),
        **_path(len(operating)), corrections=55, squeal_from=1e3)


def _path(unstable):
    """The strongest mode meets another of the inner pad at friction 0.4."""
    count = min(unstable, 1)
    share = np.linspace(0, 1, 9 * count)
    gap = 2 * np.pi * 200 * np.sqrt(np.maximum(1 - share / 0.8, 0))
    root = -50 + 150 * share + 1j * (2 * np.pi * SQUEAL_LINE + gap)
    return {"unstable_contact": np.tile(np.linspace(-40, 60, 12), (unstable, 1)),
            "unstable_first": np.zeros(unstable, int), "followed_mode": np.arange(count),
            "followed_mechanism": ["mode coupling"] * count,
            "followed_critical": np.full(count, 0.4), "followed_alike": np.full(count, 0.9),
            "followed_nearest": np.full(count, 3.0), "pair_body": np.tile([0, 2], (count, 1)),
            "pair_root": np.tile(2j * np.pi * np.array([SQUEAL_LINE, SQUEAL_LINE - 200]), (count, 1)),
            "pair_diameters": np.tile([5, 5], (count, 1)), "path_mode": np.zeros(len(share), int),
            "path_friction": 0.5 * share, "path_root": root, "path_meeting": root - 2j * gap - 200 * share}


def convergence(converged=True):
    """Three unstable modes beside a finer model; if not converged, the second is gone there, the first grows less."""
    root = np.array([360 + 50.5e3j, 220 + 68.2e3j, 8 + 47.2e3j])
    refined, found = root * (1 + 1e-3 * np.array([1, -2, 3])), np.ones(3, int)
    if not converged:
        refined[:2], found[1] = (250 + 50.4e3j, root[1]), 0
    moved = np.zeros(0) if converged else root[:2]
    return filled(
        Convergence, pressure=3e6, speed=10.25,
        refinement=["contact", "pad_mesh", "disc_mesh", "caliper_mesh", "bracket_mesh", "piston_mesh", "bases"],
        left_out=[], left_out_reason=[], root=root, reduced_root=root - 3, refined_root=refined, found=found,
        held=[int(converged), found[1], 1], near_root=[-12 + 40e3j], near_refined=[-11 + 40.1e3j],
        added=0 if converged else 1, moved_root=moved, cause=[] if converged else ["model", "bracket_mesh"],
        cause_change=np.array([[3, 3], [-110 - 100j, 0]])[:, :len(moved)] if not converged else np.empty((0, 0)),
        freedoms=62442, refined_freedoms=146382, contacts=576, refined_contacts=1296, frequency_change=0.003,
        growth_change=50.5, growth_share=0.03, frequency_tolerance=0.005, growth_tolerance=0.1, neutral=10.0,
        error_factor=2.4, converged=int(converged))


def limit_cycle(settled=True):
    """Two operating points with three unstable modes, the second louder."""
    level = np.array([0.1, 0.2])[:, None, None] * np.array([1.0, 0.6])[:, None] * np.array([0.4, 1.0, 1.01])
    frequency = np.linspace(0, 25e3, 501)
    spectrum = 1e-4 + 0.2 * np.exp(-((frequency - 8050) / 60) ** 2)
    return filled(
        LimitCycle, pressure=[1e6, 3e6], speed=[8.5, 12.0], onset_operating=[0, 1, 1],
        onset_root=[110 + 48e3j, 360 + 50.6e3j, 210 + 68e3j], onset_simulated=[111 + 48e3j, 361 + 50.6e3j, 209 + 68e3j],
        sensor_name=SENSORS, window=0.01, level=level, open_share=np.full((2, 3), 0.03),
        stick_share=np.full((2, 3), 0.05), settled=[1, int(settled)], settled_within=0.5, imbalance=[1e-3, 2e-3],
        added_loss=[0.02, 0.05], frequency=frequency, spectrum=np.broadcast_to(spectrum, (2, 2, 501)),
        cycle_frequency=[7640.0, 8050.0], harmonic_amplitude=np.full((2, 2, 4), 0.01), patches=128, modes=374,
        step=2e-6,
        check=["step"], check_level=[0.05], check_frequency=[1e-4],
        listen={"squeal": excerpt("m/s", "strongest line of the velocity at sensor a and its multiples, held for 2 s")})


def probability(draws=60):
    """Draws that are unstable the more, the higher the pressure; friction decides."""
    rng = np.random.default_rng(5)
    value = np.exp(0.3 * rng.standard_normal((draws, 3)))
    growth = 200 * (value[:, 2:] - 1) + 20 * np.arange(9) - 180
    draw, operating = np.nonzero(growth > 0)
    share = (growth > 0).mean(axis=0)
    ends = np.array([-0.05, 0.05])
    band = 1e3 * 10 ** (np.arange(-7, 14) / 10)
    return filled(
        Probability, source=["joint_stiffness:finger", "damping_speed", "friction"],
        origin=["lognormal, coefficient of variation 0.3"] * 3, value=value, most_draws=draws, least_draws=20,
        within=0.05, whole_spectra=3, root_residual=np.full(len(draw), 2e-4), spectrum_differ=0,
        pressure=OPERATING_PRESSURE, speed=OPERATING_SPEED, growth=growth, root_draw=draw, root_operating=operating,
        root=growth[draw, operating] + 50e3j, probability=share, interval=np.clip(share[:, None] + ends, 0, 1),
        overall=share.max(), overall_interval=np.clip(share.max() + ends, 0, 1), explained=0.3, band=band,
        band_probability=np.where(abs(band / 8e3 - 1) < 0.3, 1.0, 0.0)[:, None] * share,
        band_any=np.where(abs(band / 8e3 - 1) < 0.3, share.max(), 0.0),
        band_interval=np.where(abs(band / 8e3 - 1) < 0.3, share.max(), 0.0)[:, None] + 0.01 * ends[1:] * [0, 1],
        sensitivity=[0.05, 0.2, 0.7], sensitivity_error=[0.02, 0.03, 0.05], trend=[0.1, -0.3, 0.9],
        checked_root=[300.5 + 50e3j], whole_root=[300 + 50.001e3j], checked_draws=4, missed=0, least_growth=0.0,
        squeal_from=1e3)


def sensitivities(stable=False):
    """Two modes of 300 and 100 1/s; stiffer shims add most to the first, whose growth 30 % less friction takes away."""
    change = np.array([[120.0, -60.0, 30.0, -5.0, 0.0], [-10.0, 20.0, 40.0, 0.0, 0.0]])
    value = np.tile([5e7, 0.03, 0.6, 7200.0, 0.0], (2, 1))
    width = np.tile([1.5e7, 0.015, 0.012, 360.0, 0.004], (2, 1))
    none = np.zeros(0)
    return filled(
        Sensitivities, mode=[0, 2], pressure=[2e6, 1e6], speed=[10.25, 8.5], friction=[0.6, 0.6],
        root=[302 + 2j * np.pi * 10.9e3, 101 + 2j * np.pi * 3.2e3],
        mode_root=[300 + 2j * np.pi * 10.9e3, 100 + 2j * np.pi * 3.2e3],
        parameter=["structure.joints.shim_stiffness", "structure.pad.lining_loss_factor", "friction",
                   "structure.disc.density", "friction_over_pressure"], unit=["N/m", "1", "1", "kg/m^3", "1"],
        method=["analytic"] * 5, value=value,
        source=["joint_stiffness:piston", "body_loss", "friction", "", "friction_over_pressure"],
        derivative=change / width + 0j, error=0.05 * abs(change) / width, known=np.ones((2, 5), int),
        scatter=width, declared=[1, 1, 1, 0, 1], unstated_scatter=0.05, change=change,
        rank=[[1, 2, 3, 4, 5], [3, 2, 1, 4, 5]], remedy_mode=[] if stable else [0, 0],
        remedy_parameter=[] if stable else [2, 1], remedy_value=none if stable else [0.42, 0.09],
        remedy_root=none.astype(complex) if stable else [-3 + 68e3j, 40 + 68e3j],
        left_out=["structure.*.poisson"], left_out_reason=["the reduced matrices do not follow it"])


def line_evidence(draws=40):
    """Lines that a flexible disc with less damping explains best; stiffer joints bring tones to them."""
    names = ["one_way", "flexible_disc", "flexible_less_damping", "unexplained"]
    rng = np.random.default_rng(4)
    tone = np.concatenate([np.arange(2e3, 2e4, 800.0), [7.6e3, 10.9e3], rng.normal(16.6e3, 200, 20)])
    owner = np.repeat([0, 1, 2], [23, 2, 20])
    near, shift = np.zeros((4, 3)), np.zeros((4, 3, 2))
    near[2], shift[2, 0] = (0.5, 0.2, 0.15), (-4.5, 0.2)
    simulated = np.array([-3.0, 3.0, 4.0, 0.0])[:, None] + rng.standard_normal((4, 20))
    evidence = np.array([-24.0, -23.0, -19.0, -23.5])
    return filled(
        LineEvidence, hypothesis=names, disc=["rigid", "flexible", "flexible", "none"], line=[16.6e3, 17.8e3],
        verdict="flexible", test=["cycle", "constant load"], heard_in=[[1, 0], [1, 0]], elsewhere=0.05,
        band=[1250.0, 20e3], unexplained=0.1, model_error=0.01, pressure=[0.4e6, 3e6], speed=[8.5, 8.5],
        operating_test=[1, 0], **_pressure_cycle(),
        evidence=evidence, evidence_error=[0.3, 0.3, 0.5, 0.0], lines_alone=evidence + 1, silence=[0.4, 0.3, 0.3, 0.9],
        carried=[9.0, 11.0, 5.0, 40.0], reference=0, factor=evidence + 24, factor_error=[0.0, 0.42, 0.58, 0.3],
        flexible=4.3, flexible_error=0.5, column=["joint_loss", "falling friction"],
        value=rng.uniform(size=(4, draws, 2)), weight=np.full((4, draws), 1 / draws),
        line_growth=rng.normal(size=(4, draws, 2)), tone=tone, tone_hypothesis=owner, tone_draw=np.zeros(45, int),
        near=near, target_shift=shift, target_quantile=np.full((4, 3, 2, 3), 0.3), all_quantile=np.full((4, 2, 3), 0.6),
        confusion=np.full((4, 5), 0.2), simulated=simulated)


def _pressure_cycle(phases=8):
    """Fields of a cycle in which one mode swells at the nominal values, and two at those of the best draw."""
    time = (np.arange(phases) + 0.5) / phases * 2
    root = np.array([20 + 2j * np.pi * 10.9e3] * 4 + [30 + 2j * np.pi * 16.6e3] * 3 + [5 + 2j * np.pi * 3.2e3])
    return {
        "cycle_time": time, "cycle_pressure": 2e6 + 1e6 * np.sin(np.pi * time), "cycle_speed": np.full(phases, 10.0),
        "cycle_audible": 6.9, "cycle_hypothesis": [2, 2], "cycle_draw": [-1, 7], "cycle_temperature": [423.0, 423.0],
        "cycle_friction": [0.94, 0.94], "cycle_root": root, "cycle_root_cycle": [0] * 4 + [1] * 4,
        "cycle_root_phase": [0, 1, 2, 3, 1, 2, 3, 5], "still_pressure": [0.4e6], "still_root": [4 + 2j * np.pi * 1.5e3],
        "still_root_cycle": [0], "still_root_pressure": [0], "swell_cycle": [0, 1, 1],
        "swell_frequency": [10.9e3, 16.6e3, 3.2e3], "swell_growth": [20.0, 30.0, 5.0], "swell_phase": [0, 1, 5],
        "swell_phases": [4, 3, 1], "swell": [20.0, 22.5, 1.25]}


def multibody(samples=3000):
    """Pads that settle at low and swing on at high load."""
    time = np.linspace(0, 0.1, samples)
    rate = np.linspace(-60.0, 4.0, 9)
    swing = np.exp(rate[:, None] * time) * np.sin(2 * np.pi * 180 * time)
    motion = np.zeros((9, 2, 3, samples))
    motion[:, 0, 0], motion[:, 1, 0] = 2e-5 * swing, 1.8e-5 * swing
    phase = 2 * np.pi * (40 * time + 0.25 * np.arange(4)[:, None])
    force = OPERATING_PRESSURE[:, None, None, None] * 6e-4 * (1 + np.sin(phase)) * np.ones((1, 2, 1, 1))
    factors = np.array([0.3, 0.55, 1.0, 1.8, 3.0])
    stability = 40 * np.log(np.outer(factors, factors)) + rate[:, None, None]
    contact = np.zeros((9, 2, samples), dtype=np.float32)
    return filled(
        Multibody, pressure=OPERATING_PRESSURE, speed=OPERATING_SPEED, time=time,
        pad_name=["outer", "inner"], pad_motion=motion, patch_force=force, normal_force=contact,
        friction_force=contact, mean_friction=np.linspace(0.41, 0.5, 9),
        growth_rate=rate, growth_rate_std=np.full(9, 3.0), growth_decided=np.abs(rate) >= 6.0,
        oscillation_frequency=np.full(9, 180.0), separated_share=np.zeros(9),
        outside_map_share=np.full(9, 0.01), stored_energy=np.full(9, 5.1), friction_work=np.full(9, 5.2),
        sliding_loss=np.full(9, 800.0), damping_loss=np.full(9, 0.1), added_loss=np.full(9, 0.25),
        imbalance=np.full(9, 2e-4), caliper_factor=factors, abutment_factor=factors, stability=stability,
        stability_root=np.full(stability.shape, 812.0))


def response(samples=2000):
    """Spectra with a line at 16.6 kHz that grows with load."""
    time = np.linspace(0, 0.05, samples)
    frequency = np.linspace(0, 20000, 800)
    line = 1e-8 * np.exp(-((frequency - SQUEAL_LINE) / 40) ** 2)
    floor = 1e-12 * (1 + (frequency / 3000) ** 2) ** -1
    spectrum = floor + np.linspace(0.01, 1, 9)[:, None, None] * line * np.ones((1, 2, 1))
    velocity = np.random.default_rng(3).normal(scale=1e-4, size=(9, 2, samples)).astype(np.float32)
    return filled(Response, pressure=OPERATING_PRESSURE, speed=OPERATING_SPEED, time=time, sensor_name=SENSORS,
                    sensor_position=np.zeros((2, 3)), velocity=velocity, frequency=frequency,
                    velocity_spectrum=spectrum, mode_frequency=np.linspace(260, 19800, 120),
                    mode_damping=np.full(120, 0.002), coupling="assembly")


def transient(settled=True):
    """A stick-slip cycle of two sensors and two contacts at two operating points."""
    time = np.linspace(0, 0.05, 4001)
    swing = (1 - np.exp(-time / 0.005)) * np.sin(2 * np.pi * 2200 * time)
    velocity = 0.03 * (swing + 0.2 * swing**2) * np.array([1.0, 0.4])[:, None] * np.array([1.0, 2.0])[:, None, None]
    force = 20 + 15 * np.ones((2, 2, 1)) * swing
    frequency = np.arange(0, 20000, 50.0)
    lines = sum(10.0 ** (-2 * k) * np.exp(-((frequency - 2200 * k) / 40) ** 2) for k in (1, 2, 3))
    status = np.where(swing > 0.5, 1, np.where(swing < -0.9, 0, 2)) * np.ones((2, 2, 1), int)
    return filled(
        Transient, pressure=[1e6, 3e6], speed=[1.0, 1.0], time=time, sensor_name=SENSORS, velocity=velocity,
        displacement=velocity / 14e3, normal_force=force, friction_force=0.3 * force, slip=0.05 - velocity,
        gap=0 * force, status=status, status_share=np.tile([0.2, 0.3, 0.5], (2, 2, 1)), step=1e-6, window=0.02,
        frequency=frequency, velocity_spectrum=np.ones((2, 2, 1)) * (lines + 1e-9),
        cycle_frequency=np.full((2, 2), 2200.0), cycle_amplitude=np.abs(velocity).max(axis=2),
        cycle_drift=np.full((2, 2), 0.004 if settled else 0.4), settled=np.full((2, 2), int(settled)),
        growth_rate=np.full((2, 2), 200.0), growth_rate_std=np.full((2, 2), 5.0), grew=np.ones((2, 2), int),
        harmonic_amplitude=np.ones((2, 2, 1)) * np.array([0.03, 0.003, 0.0004, 0.0]), imbalance=[1e-4, 2e-4])


def squeal(quiet=False, harmonic=False):
    """Two events at the highest load, the louder one a harmonic if so wished, or none."""
    band = 1000 * 2 ** (np.arange(0, 14) / 3)
    level = 60 + 4 * np.arange(9)[:, None] + np.array([0.0, -6.0])
    events = 0 if quiet else 2
    return filled(
        Squeal, coupling="assembly", pressure=OPERATING_PRESSURE, speed=OPERATING_SPEED, sensor_name=SENSORS,
        reference=5e-8, threshold=120.0 if quiet else 88.0, peak_level=level,
        peak_frequency=np.full((9, 2), SQUEAL_LINE), band=band,
        band_level=level[:, :, None] - 20 + 10 * np.exp(-((band - 16000) / 3000) ** 2),
        event_operating=[7, 8][:events], event_sensor=[0, 0][:events], event_frequency=[16580.0, 16600.0][:events],
        event_order=[1, 20 if harmonic else 1][:events],
        event_fundamental=[16580.0, 830.0 if harmonic else 16600.0][:events], event_level=[88.5, 92.0][:events],
        event_start=[0.02, 0.01][:events], event_duration=[0.01, 0.03][:events],
        listen={} if quiet else {"squeal": excerpt("m/s", "tones of the velocity at sensor a, held for 2 s")})


def excerpt(unit, content):
    """A tenth of a second to listen to."""
    return filled(Excerpt, samples=(2e4 * np.sin(0.3 * np.arange(4800))).astype(np.int16), rate=48e3, full_scale=0.02,
                  unit=unit, content=content, begin=1.25)


def interface_law():
    """An exponential normal law and a linear shear law with its limit."""
    gap, pressure = np.linspace(2e-6, 0, 40), np.geomspace(1e3, 4e8, 5)
    displacement = np.linspace(0, 1e-6, 60)
    limit = 0.25 * pressure
    shear = np.minimum(limit[:, None], limit[:, None] * displacement / 1e-7)
    return filled(
        InterfaceLaw, source="given parameters", summit_density=2.5e9, summit_spread=5e-7, summit_curvature=2e4,
        shear_limit=3.85e8, gap=gap, gap_pressure=4e8 * np.exp(-gap / 2e-7), real_area=0.2 * np.exp(-gap / 2e-7),
        pressure=pressure, displacement=displacement, shear=shear, evolution_shear=0.98 * shear, elastic_shear=shear,
        tangential_stiffness=limit / 1e-7, limit=limit, exponent=np.full(5, 0.6), friction=np.full(5, 0.25))


def pin_on_disc():
    """Modes of disc and pin at one weight."""
    return filled(
        PinOnDisc, load=[1.5], contact_stiffness=[[8e7]], friction=[0.25], disc_frequency=[440.0, 2250.0],
        disc_diameters=[1, 3], disc_out_of_plane=[0.98, 0.93], pin_length=[0.1515, 0.1465], tilt=0.07,
        contact_offset=-0.0045, base_mass=0.005, pin_frequency=[[340.0, 2105.0], [362.0, 2245.0]])


def lock_in():
    """Two cases and five lengths, one of each kind."""
    kinds = ["classical", "dual base", "none", "classical", "intermediate", "multiple", "other"]
    base = np.array([2215.0, 4000.0, 0.0, 2220.0, 1900.0, 2210.0, 3000.0])
    return filled(
        LockIn, scan=["case", "tilt", *["length"] * 5], length=[0.1515, 0.1515, *np.linspace(0.12, 0.2, 5)],
        load=np.full(7, 1.5), speed=np.full(7, 0.25), tilt=np.full(7, 0.07), base_mass=np.full(7, 0.005), kind=kinds,
        base=base, root=np.where(base > 0, 100 + 2j * np.pi * base, 0), harmonics=np.full((7, 2), 3),
        settled=[1, 0, 1, 1, 1, 0, 1], trace_time=[0.299, 0.3], trace=np.ones((1, 2, 2)), frequency=[0.0, 1e4],
        spectrum=np.zeros((1, 2, 2)))


def comparison():
    """Rows of every kind: within, outside, tuned, doubted, not comparable."""
    rows = (("friction, lowest", "friction", "1", 0.4, 1, 0.41, 1, 0.05, "within", "shear limit", "Sec. 4", ""),
            ("real contact at 1 MPa", "friction", "%", 3, 1, 3.1, 1, 0.6, "within", "pad roughness", "Fig. 10a", ""),
            ("free disc, mode 1/2", "modes", "Hz", 267, 1, 259.4, 1, 10, "within", "disc section", "Table 1", ""),
            ("free disc, mode 18", "modes", "Hz", 3075, 1, 3399, 1, 150, "outside", "", "Table 1", "prints 337.3 Hz"),
            ("growth at lowest load", "multibody", "1/s", 0, 0, -60.0, 1, 0, "not comparable", "", "Fig. 13", ""),
            ("first squeal line", "squeal", "kHz", 16.6, 1, 16.6, 1, 0.3, "within", "", "Fig. 18", ""),
            ("second squeal line", "squeal", "kHz", 17.8, 1, 0, 0, 0.3, "not comparable", "", "Fig. 18", ""))
    names = ("row", "section", "unit", "published", "published_known", "ours", "ours_known", "tolerance", "verdict",
             "tuned", "source", "doubt")
    columns = {name: list(column) for name, column in zip(names, zip(*rows, strict=True), strict=True)}
    for name in ("published", "ours", "tolerance"):
        columns[name] = np.array(columns[name], dtype=float)
    keys = ("friction_lowest", "real_area_start", "mode_01_02_test", "mode_18_test", "damped_at_low_load",
            "squeal_line_1", "squeal_line_2")
    sources = ("micro_friction.friction", "micro_friction.real_area", "structure.free_frequency",
               "structure.free_frequency", "multibody.growth_rate", "squeal.event_frequency", "")
    columns |= {"key": list(keys), "field": list(sources), "note": ["read from the product"] * len(rows)}
    return filled(Comparison, **columns)


def rupture():
    """A left pulse that fades and stops, a right one that grows and runs on, three studies."""
    x, centre = np.linspace(8e-3, 12.5e-3, 161), 10.25e-3
    x = x - centre + 10e-3
    reach = np.where(x < 10e-3, 1.25e-3, 2e-3)
    reached = np.abs(x - 10e-3) <= reach * (1 + 1e-9)
    speed = np.where(x < 10e-3, 1650.0, 975.0)
    arrival = np.where(reached, np.abs(x - 10e-3) / speed, 0.0)
    time = np.array([0.5e-6, 1e-6, 2.02e-6])
    size = np.where(x < 10e-3, np.clip(1.0 - (10e-3 - x) / 1.25e-3, 0, None), 0.3 + np.abs(x - 10e-3) / 2e-3)
    slip = 1e-8 * size * reached * (arrival <= time[:, None])
    frames, columns = 3, np.linspace(7.75e-3, 12.25e-3, 31)
    rows = np.r_[np.linspace(-2e-3, 0, 11), np.linspace(0, 2e-3, 11)]
    far = np.hypot(columns - 10e-3, rows[:, None])
    when = np.linspace(0.7e-6, 2.02e-6, frames)
    field = np.exp(-((far - 1200 * when[:, None, None]) / 2e-4) ** 2).astype(np.float32)
    states = ((np.abs(x - 10e-3) < 1000 * when[:, None]) & (np.abs(x - 10e-3) > 800 * when[:, None])).astype(int)
    study = ["mesh"] * 4 + ["stress"] * 4 + ["damping"] * 2
    runs = len(study)
    return filled(
        Rupture, x=x, static_pressure=1e6 + 0 * x, static_shear=9.4e5 + 1e4 * np.cos(400 * x), static_slip=0 * x,
        shift=[5.7e-6, 2.1e-6], reached=reached.astype(int), arrival=arrival, first_slip=0.6 * arrival,
        healed=arrival + 3e-8 * reached, front_speed=speed * reached, profile_time=time, slip=slip,
        slip_growth=1.4, side=["left", "right"], stop=[8.75e-3, 12e-3], outcome=["stopped", "running"],
        speed=[1650.0, 975.0], speed_error=[7.0, 2.0], kind=["pulse", "pulse"], healing_time=[3e-8, 6e-8],
        precursor_lead=[1e-8, 2e-7], precursor_reach=[1.3e-3, 2.0e-3], mach_known=[[1, 1], [0, 0]],
        mach_angle=[[0.8, 0.612], [0, 0]], mach_expected=[[0.9, 0.68], [0, 0]],
        phrase="the left front stops, the right one runs on",
        solid=["upper", "lower"], dilatational_speed=[2259.0, 1807.0], shear_speed=[1304.0, 1044.0],
        rayleigh_speed=[1199.0, 959.0], interface_wave=1, generalised_rayleigh_speed=1036.0, pulse_exists=1,
        pulse_speed=[1806.9, 1807.0], energy_name=["released", "heat", "kinetic", "strain", "taken"],
        energy=[6e-5, 5e-5, 2e-6, 6e-6, 2e-6], step=7.2e-9, duration=2.02e-6, node_updates=90_000_000, frame_time=when,
        frame_state=states, field_x=columns, field_y=rows, speed_field=0.05 * field, study=study,
        study_spacing=[5e-5, 2.5e-5, 5e-5, 2.5e-5, *[2.5e-5] * 6], study_memory=[0, 0, 2e-8, 2e-8, *[0.0] * 6],
        study_ratio=[0.94] * 4 + [0.7, 0.9, 0.94, 0.99] + [0.94] * 2, study_damping=[0.1] * 9 + [0.2],
        study_poisson=[0.25] * runs, study_stop=np.linspace([8.8e-3, 11e-3], [8.4e-3, 12e-3], runs),
        study_speed=np.linspace([1600.0, 920.0], [1750.0, 1000.0], runs),
        study_width=np.linspace([9e-5, 1e-4], [5e-5, 6e-5], runs),
        study_outcome=[["stopped", "running"]] * 4 + [["died", "died"]] + [["stopped", "running"]] * (runs - 5),
        study_kind=[["pulse", "pulse"]] * 7 + [["crack", "crack"]] + [["pulse", "pulse"]] * 2,
        study_growth=[0.4, 0.6, 0.5, 0.8, 0.0, 0.0, 0.6, 2.0, 0.6, 0.3],
        study_phrase=["the left front stops, the right one runs on"] * runs)


def case():
    """A case with settings of every kind."""
    return CaseSummary(
        name="small", title="Small brake", description="A synthetic case for the views",
        settings={"surface": {"period": 1e-3, "seed": 7, "filled": True},
                  "micro_friction": {"shear_limit": 13.5e6, "pressures": (1e6, 2e6, 3e6)}},
        origins={"surface": {"period": {"origin": "assumed", "source": "size of the scan"}},
                 "micro_friction": {"shear_limit": {"origin": "tuned", "source": "Figure 10c"}}},
        units={"surface": {"period": "m"}, "micro_friction": {"shear_limit": "Pa", "pressures": "Pa"}},
        meanings={"micro_friction": {"shear_limit": "largest shear stress of a spot"}},
        methods={"surface": "Two maps were generated.", "micro_friction": "Tresca limit of 13.5 MPa."}, version="0.1")


def products(**replaced):
    """Every product the report reads, by name; ``replaced`` overrides."""
    return {"surface": surface(), "micro_friction": micro_friction(), "friction_map": friction_map(),
            "structure": structure(), "lumped": lumped(), "reduced_model": reduced_model(),
            "complex_modes": complex_modes(), "multibody": multibody(), "transient": transient(),
            "response": response(), "squeal": squeal(), "comparison": comparison(), **replaced}


def _ring(inner, outer, low, high, start, end, sectors, closed):
    """Sector of a ring, one element across and through, as a Body of 20-node hexahedra with two modes."""
    angle = np.linspace(start, end, sectors + 1)[: sectors if closed else None]
    corner = np.array([[r * np.cos(a), r * np.sin(a), z] for a in angle for z in (low, high) for r in (inner, outer)])
    here, there = np.arange(sectors), (np.arange(sectors) + 1) % len(angle)
    corners = np.stack([4 * here, 4 * here + 1, 4 * there + 1, 4 * there, 4 * here + 2, 4 * here + 3, 4 * there + 3,
                        4 * there + 2], axis=1)
    pairs = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)])
    edges, number = np.unique(np.sort(corners[:, pairs], axis=2).reshape(-1, 2), axis=0, return_inverse=True)
    node = np.concatenate([corner, corner[edges].mean(axis=1)])
    element = np.concatenate([corners, len(corner) + number.reshape(-1, 12)], axis=1)
    shape = np.zeros((2, len(node), 3))
    turn = np.arctan2(node[:, 1], node[:, 0])
    shape[:, :, 2] = np.cos(np.array([[2], [3]]) * turn)
    return filled(Body, node=node, element=element, kind="hexahedron20", material_name=["iron"],
                density=[7200.0], damping_ratio=0.002,
                frequency=[259.4, 660.1], shape=shape, supported=[])
