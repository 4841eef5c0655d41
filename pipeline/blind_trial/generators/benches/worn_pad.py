"""A practice bench for friction: replicas of one small pad, dragged over those of one disc until both are worn.

Both bodies are half-spaces with rough, periodic faces. With c the compliance of Boussinesq and h the heights, pressures
minimise p c p / 2 - p h under p >= 0 and a given mean (accelerated projected gradients, the projection by sorting);
every contact spot shears at

    tau = factor strength / sqrt(3) (1 + rate ln(v / v_0)) (1 - softening rise) (1 + gain x),   x' = (p / p_0 - x) / d,

the rise by Jaeger's resting circle of the mean spot; friction is tau times the real area over the load, both faces lose
coefficient times pressure times way, and a share of what the pad loses may stay on the disc. Instruments
add noise, tilt and offset. All lengths in m, pressures in Pa.
"""

from dataclasses import dataclass

import numpy as np
from scipy import fft, ndimage

from pipeline.contract.errors import ConvergenceError

#: what can be hidden, with the sizes it is given: low and high of a draw
HIDDEN = {"third_body": {"gain": (0.2, 0.4), "distance": (1e-3, 3e-3), "pressure": (1.9e6, 2.1e6)},
          "transfer": {"share": (0.4, 0.9)}}
#: what the drawings say of the pair; the truth is off by a normal logarithm of the spread
NOMINAL = {"modulus": 0.235e9, "strength": 234e6, "pad_wear": 4e-12, "disc_wear": 4e-13, "rate": 0.015}
SPREAD = 0.2
FACTOR, POISSON, SOFTENING, CONDUCTIVITY, MEAN_SPEED = 0.1, 0.25, 5e-4, 50.0, 1.3
PATCH, SHORTEST, SHIFT = 1e-3, 62.5e-6, 5e-5
PRESSURES = (0.7e6, 1.2e6, 2e6, 2.6e6, 3.4e6)
WAYS, SPEEDS = (0.0, 0.3e-3, 1e-3, 2.5e-3, 5e-3, 7.5e-3, 10e-3), (0.9, 1.3, 1.8)
#: standard deviations of a friction value, of a height, and of tilt and offset over the patch
NOISE = {"friction": 0.005, "height": 20e-9, "tilt": 0.3e-6}
_TOLERANCE, _MOST = 2e-3, 400


@dataclass(frozen=True)
class Bench:
    """Faces ``pad`` and ``disc`` (n, n) m, outwards of each body; ``values`` as NOMINAL; ``hidden`` {physics: values}.

    ``cycles``: those to the last way.
    """

    pad: np.ndarray
    disc: np.ndarray
    values: dict
    hidden: dict
    cycles: int


def make(seed, hidden="", nodes=96, cycles=100):
    """(Bench, truth) of a draw: every value off, ``hidden`` one of HIDDEN or '' for nothing else."""
    random = np.random.default_rng(seed)
    factors = {name: float(np.exp(np.clip(SPREAD * random.standard_normal(), -0.3, 0.3))) for name in NOMINAL}
    drawn = {hidden: {key: float(random.uniform(*ends)) for key, ends in HIDDEN[hidden].items()}} if hidden else {}
    values = {name: factors[name] * value for name, value in NOMINAL.items()}
    bench = Bench(_pad(random, nodes), _disc(random, nodes), values, drawn, cycles)
    return bench, {"factors": factors, "hidden": drawn}


def record(bench, seed):
    """{run: ...} as ``write_neutral`` takes it: the new faces as mounted, then a drag of replicas at every pressure."""
    random = np.random.default_rng([seed, 1])
    runs = {"new": {**_said("both faces before the tests"), "topography": _maps(random, bench.pad, bench.disc, "new")}}
    for pressure in PRESSURES:
        friction, pad, disc = drag(bench, pressure)
        way, speed = (a.ravel() for a in np.meshgrid(WAYS, SPEEDS, indexing="ij"))
        noise = NOISE["friction"] * random.standard_normal(len(way))
        runs[f"drag_{pressure / 1e6:g}MPa"] = {
            **_said(f"fresh replicas dragged under {pressure / 1e6:g} MPa, speeds stepped at every way"),
            "friction": {"load_cell": {"friction": friction.ravel() + noise, "friction_std": np.full(len(way), NOISE[
                "friction"]), "pressure": pressure, "speed": speed, "distance": way}},
            "topography": _maps(random, pad, disc, "worn")}
    return runs


def drag(bench, pressure):
    """(friction (ways, speeds), worn pad, worn disc) of one drag."""
    pad, disc = bench.pad, bench.disc
    values, step, film, rows, press = bench.values, WAYS[-1] / bench.cycles, 0.0, [], None
    third, share = bench.hidden.get("third_body"), bench.hidden.get("transfer", {}).get("share", 0.0)
    marks = {round(way / step) for way in WAYS}
    shift = round(SHIFT / PATCH * len(pad))
    for cycle in range(bench.cycles + 1):
        moved = cycle % (shift + 1)
        if cycle in marks:
            gain = 1 + third["gain"] * film if third else 1.0
            met = [pressed(pad + np.roll(disc, k, 1), pressure, values["modulus"], press) for k in range(shift + 1)]
            rows.append([gain * np.mean([coefficient(m, values, speed) for m in met]) for speed in SPEEDS])
        if cycle == bench.cycles:
            break
        press = pressed(pad + np.roll(disc, moved, 1), pressure, values["modulus"], press)
        lost = values["pad_wear"] * press * step
        pad = pad - lost
        kept = share * ndimage.uniform_filter(lost, 3, mode="wrap")
        disc = disc - np.roll(values["disc_wear"] * press * step - kept, -moved, 1)
        if third:
            film += step / third["distance"] * (pressure / third["pressure"] - film)
    return np.array(rows), pad, disc


def pressed(height, mean, modulus, start=None):
    """Pressures (n, n) of a half-space (``modulus``, POISSON) of this height pressed flat under a ``mean`` pressure."""
    nodes = len(height)
    wave = 2 * np.pi * np.hypot(fft.fftfreq(nodes, PATCH / nodes)[:, None], fft.rfftfreq(nodes, PATCH / nodes))
    compliance = np.divide(2 * (1 - POISSON**2) / modulus, wave, out=np.zeros_like(wave), where=wave > 0)
    steepest, size = compliance.max(), height.std()
    now = ahead = np.full(height.shape, float(mean)) if start is None else start
    pace = 1.0
    for _ in range(_MOST):
        slope = fft.irfft2(compliance * fft.rfft2(ahead), s=height.shape) - height
        new = _allowed(ahead - slope / steepest, mean)
        if np.vdot(ahead - new, new - now) > 0:
            pace = 1.0
        faster = (1 + np.sqrt(1 + 4 * pace**2)) / 2
        moved, now, ahead = abs(new - now).max(), new, new + (pace - 1) / faster * (new - now)
        pace = faster
        if moved < _TOLERANCE * size / steepest:
            return now
    raise ConvergenceError("practice bench: contact", f"steps below {_TOLERANCE:g} within {_MOST} iterations",
                           f"{moved * steepest / size:.2g}")


def _allowed(pressure, mean):
    """The nearest map that is nowhere negative and has this mean."""
    ordered = np.sort(pressure, axis=None)[::-1]
    levels = (np.cumsum(ordered) - mean * pressure.size) / np.arange(1, pressure.size + 1)
    return np.maximum(pressure - levels[np.flatnonzero(ordered > levels)[-1]], 0.0)


def coefficient(press, values, speed):
    """Coefficient of friction of a pressure map at a sliding speed, without any film."""
    touching = press > 0
    area, spots = _area(touching), max(ndimage.label(touching)[1], 1)
    limit = FACTOR * values["strength"] / np.sqrt(3) * (1 + values["rate"] * np.log(speed / MEAN_SPEED))
    radius = PATCH * np.sqrt(area / (np.pi * spots))
    rise = 8 / (3 * np.pi) * limit * speed * radius / CONDUCTIVITY
    return limit * (1 - SOFTENING * rise) * area / press.mean()


def _area(touching):
    """Share of the area that touches; cells on its edge count in part (Yastrebov and others 2017)."""
    edges = sum(int(np.sum(touching ^ np.roll(touching, 1, axis))) for axis in (0, 1))
    return (touching.sum() - (np.pi - 1 + np.log(2)) / 24 * edges) / touching.size


def _pad(random, nodes):
    """Rough plateaus over a smoother matrix, root mean square 3.8 um."""
    raised = ndimage.gaussian_filter(random.standard_normal((nodes, nodes)), 0.03 * nodes, mode="wrap")
    top = 1 / (1 + np.exp(-12 * (raised - np.quantile(raised, 0.75)) / raised.std()))
    rough, matrix = (_texture(random, nodes) for _ in range(2))
    return _scaled(top * (1 + 6 * rough) + (1 - top) * matrix, 3.8e-6)


def _disc(random, nodes):
    """Turning marks along sliding, eight a patch, with some roughness; root mean square 3.5 um."""
    across = np.abs(np.sin(8 * np.pi * np.arange(nodes) / nodes))[:, None] - 2 / np.pi
    return _scaled(across / across.std() + 0.33 * _texture(random, nodes), 3.5e-6)


def _texture(random, nodes, knee=8, fall=1.8):
    """Gaussian roughness of unit root mean square, flat up to ``knee`` waves a patch, then as their power."""
    field = fft.irfft2(np.maximum(_waves(nodes), knee) ** -fall * fft.rfft2(random.standard_normal((nodes, nodes))),
                       s=(nodes, nodes))
    return field / field.std()


def _scaled(height, size):
    """Without waves shorter than SHORTEST, zero mean, root mean square ``size``."""
    waves = _waves(len(height))
    kept = fft.irfft2((waves <= PATCH / SHORTEST) * (waves > 0) * fft.rfft2(height), s=height.shape)
    return size * kept / kept.std()


def _waves(nodes):
    """Waves a patch of every entry of a half spectrum."""
    return np.hypot(fft.fftfreq(nodes, 1 / nodes)[:, None], fft.rfftfreq(nodes, 1 / nodes))


def _maps(random, pad, disc, state):
    """{name: (heights, pixel in m, body, state)} as an instrument shows both faces."""
    return {f"{body}_{state}": (_seen(random, face), PATCH / len(face), body, state)
            for body, face in (("pad", pad), ("disc", disc))}


def _seen(random, face):
    coordinate = np.linspace(-0.5, 0.5, len(face))
    offset, along, across = NOISE["tilt"] * random.standard_normal(3)
    noise = NOISE["height"] * random.standard_normal(face.shape)
    return face + offset + along * coordinate + across * coordinate[:, None] + noise


def _said(description):
    return {"description": description, "repeat_of": "", "conditions": {}, "channels": {}}
