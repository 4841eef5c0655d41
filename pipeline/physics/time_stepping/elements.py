"""Nonlinear elements of a SlidingModel: each a force along an elongation row, with or without memory.

    replace(model, elements=(Element("stop", row, Gap(stop=1e6, upper=1e-4)),))

The laws and their signs are those of ``element_forces``. Every law has values at which its force is exactly 0. Joints
carry the linear part; an element that takes something away from a joint does so by a negative ``linear``.
"""

from dataclasses import dataclass

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.time_stepping import element_forces as kinds


@dataclass(frozen=True)
class Polynomial:
    """F = linear e + quadratic e^2 + cubic e^3, in N/m, N/m^2, N/m^3. Duffing's is ``cubic``."""

    linear: float = 0.0
    quadratic: float = 0.0
    cubic: float = 0.0


@dataclass(frozen=True)
class Power:
    """F = coefficient |v|^(exponent - 1) v: 1 viscous (N s/m), 2 quadratic damping (N s^2/m^2)."""

    coefficient: float = 0.0
    exponent: float = 2.0


@dataclass(frozen=True)
class Sliders:
    """Jenkins elements in parallel, ``stiffness`` (s,) N/m each held up to ``limit`` (s,) N, and ``linear`` e."""

    stiffness: np.ndarray
    limit: np.ndarray
    linear: float = 0.0


@dataclass(frozen=True)
class Dry:
    """Dry friction, sliding force of each direction in N; rigid, or with an elastic way of ``stiffness`` N/m before.

    At the speed v the force is (1 + rise exp(-|v| / decay_speed)) times that of its direction.
    """

    stiffness: float = np.inf
    forward: float = 0.0
    backward: float = 0.0
    rise: float = 0.0
    decay_speed: float = 1.0


@dataclass(frozen=True)
class BoucWen:
    """Hysteresis that forgets with the way: k z up to k ``size``, and ``linear`` e; ``shape`` in 0.5 to 1, n >= 1."""

    linear: float = 0.0
    stiffness: float = 0.0
    size: float = 1.0
    exponent: float = 1.0
    shape: float = 0.5


@dataclass(frozen=True)
class Maxwell:
    """Springs ``stiffness`` (s,) N/m in series with dampers, relaxing within ``time`` (s,) s, and ``linear`` e.

    Relaxed where a motion starts: steady loads do not stress the branches.
    """

    stiffness: np.ndarray
    time: np.ndarray
    linear: float = 0.0


@dataclass(frozen=True)
class Gap:
    """Stops of stiffness ``stop`` N/m beyond -lower and upper (m), and the stiffness ``inner`` between them.

    Backlash of a joint is ``inner`` = minus its stiffness, which vanishes with the gap.
    """

    stop: float = 0.0
    inner: float = 0.0
    lower: float = np.inf
    upper: float = np.inf


@dataclass(frozen=True)
class Softening:
    """F = -stiffness (1 - exp(-t / time)) e: a spring that loses ``stiffness`` N/m as it warms up."""

    stiffness: float = 0.0
    time: float = 1.0


@dataclass(frozen=True)
class Wave:
    """The far end of a spring and damper moves by u = amplitude cos(order angle + 2 pi frequency t - phase).

    ``angle`` is that of the drive since time 0; m, Hz, rad. With stiffness 1 N/m ``amplitude`` is a force in N along
    the row.
    """

    stiffness: float = 0.0
    damping: float = 0.0
    amplitude: float = 0.0
    order: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0


@dataclass(frozen=True)
class Turning:
    """Friction of ``contact`` turns in its plane with the motion along the row: a damper ``share`` |T| / |slip|."""

    contact: int
    share: float = 1.0


@dataclass(frozen=True)
class Parametric:
    """A stiffness that swings: ``stiffness`` N/m times cos(order angle + 2 pi frequency t - phase); Hz, rad."""

    stiffness: float = 0.0
    order: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0


@dataclass(frozen=True)
class Detent:
    """F = sine sin(2 pi e / period) + cosine cos(2 pi e / period): N, and m of elongation after which it repeats."""

    sine: float = 0.0
    cosine: float = 0.0
    period: float = 1.0


@dataclass(frozen=True)
class Stop:
    """Stops beyond -lower and upper (m) that push back alone: a spring ``stiffness`` N/m beside a ``damping`` N s/m."""

    stiffness: float = 0.0
    damping: float = 0.0
    lower: float = np.inf
    upper: float = np.inf


@dataclass(frozen=True)
class Presliding:
    """Friction of bristles: ``force`` N is built up over ``length`` m; ``rise`` more at rest, gone by ``speed`` m/s.

    ``time`` s damps the bristles, ``viscous`` N s/m adds to the force. Dahl's law has none of the last four.
    """

    force: float
    length: float
    rise: float = 0.0
    speed: float = 1.0
    time: float = 0.0
    viscous: float = 0.0


@dataclass(frozen=True)
class RateState:
    """Rate-and-state friction: ``force`` N at 1e-6 m/s, direct effect, evolution over ``length`` m; ``slip`` law: 1.

    Without ``evolution`` the force follows the logarithm of the speed alone.
    """

    force: float
    direct: float
    evolution: float = 0.0
    length: float = 1.0
    slip: float = 0.0


@dataclass(frozen=True)
class Positional:
    """Dry friction ``force`` N where the elongation is 0, with a relative ``gradient`` per m; ``creep`` m/s at rest."""

    force: float
    gradient: float
    creep: float


_KIND = {Polynomial: kinds.POLYNOMIAL, Power: kinds.POWER, Sliders: kinds.SLIDERS, Dry: kinds.DRY,
         BoucWen: kinds.BOUC_WEN, Gap: kinds.GAP, Softening: kinds.SOFTENING, Wave: kinds.WAVE, Maxwell: kinds.MAXWELL,
         Turning: kinds.TURNING, Parametric: kinds.PARAMETRIC, Detent: kinds.DETENT, Stop: kinds.STOP,
         Presliding: kinds.PRESLIDING, RateState: kinds.RATE_STATE, Positional: kinds.POSITIONAL}
#: laws whose forces are enclosed, not found by Newton's method
ENCLOSED = tuple(law for law, kind in _KIND.items() if kind >= kinds.ENCLOSED)
#: numbers that a law remembers, where they are no forces of sliders or branches
_REMEMBERS = {Dry: 1, BoucWen: 1, Presliding: 2, RateState: 3}


@dataclass(frozen=True)
class Element:
    """A law along the elongation ``row`` (n,) of a model; ``name`` for messages."""

    name: str
    row: np.ndarray
    law: object

    def __post_init__(self):
        if type(self.law) not in _KIND:
            raise ConfigError(f"element {self.name}", f"one of {', '.join(c.__name__ for c in _KIND)}",
                              type(self.law).__name__)
        _check(self.name, self.law)


@dataclass(frozen=True)
class Waviness:
    """Shape of the surface under ``contact``, whose gap grows by u = amplitude cos(order angle + 2 pi f t - phase).

    With a ``growth`` s it comes up from nothing: u (1 - exp(-t / growth)).
    """

    contact: int
    amplitude: float
    order: float
    phase: float = 0.0
    frequency: float = 0.0
    growth: float = 0.0


def wave_table(waviness):
    """(w, 6) of Waviness, as the compiled loops need it."""
    rows = [(w.contact, w.amplitude, w.order, w.frequency, w.phase, w.growth) for w in waviness]
    return np.array(rows, float).reshape(-1, 6)


def iwan(stiffness, force, exponent=0.0, count=40, elastic=False):
    """Sliders of a joint that slips in full at ``force`` N, ``stiffness`` N/m while nothing slips.

    Their slip ways are spread as phi^exponent up to phi_max = (exponent + 2) / (exponent + 1) force / stiffness
    (Segalman, J. Appl. Mech. 72 (2005) 752, with beta = 0), so that the loss of a cycle grows as the power
    exponent + 3 of its amplitude; exponent > -1. The ways are cut into ``count`` bands of one stiffness, each of its
    exact force; of a ``count`` that is not whole the last band is narrower. ``elastic`` takes ``stiffness`` away again:
    what the slip of a joint changes.
    """
    if not (exponent > -1 and force > 0 and stiffness >= 0 and count >= 1):
        raise ConfigError("iwan", "exponent > -1, force > 0, stiffness >= 0, count >= 1",
                          f"{exponent:g}, {force:g} N, {stiffness:g} N/m, {count}")
    within = np.minimum(np.arange(np.ceil(count) + 1) / count, 1)       # share of the stiffness up to each edge
    share, strength = np.diff(within), np.diff(within ** ((exponent + 2) / (exponent + 1)))
    empty = 0.0 if stiffness == 0 else 1.0
    return Sliders(stiffness * share, empty * force * strength, -stiffness if elastic else 0.0)


def element_kernel(elements, waviness, wear=(), captured=False, **linear):
    """ElementKernel of Elements, Waviness and ``wear`` (c,); ``linear``: its arrays that depend on modes and step.

    ``captured``: rigid friction is judged at the end of steps, as beside contacts, instead of being located in them.
    """
    kept = [_remembered(e.law) for e in elements]
    parameter = np.zeros((len(elements), 6))
    for k, element in enumerate(elements):
        law = element.law
        values = (law.linear,) if isinstance(law, Sliders | Maxwell) else tuple(vars(law).values())
        parameter[k, :len(values)] = values
        if isinstance(law, Dry):
            parameter[k, 5] = float(captured)
    return kinds.ElementKernel(
        np.array([_KIND[type(e.law)] for e in elements], np.int64), parameter,
        np.cumsum([0, *(len(k[0]) for k in kept)]),
        *(np.concatenate([np.empty(0), *(np.asarray(k[part], float) for k in kept)]) for part in (0, 1)),
        waviness=wave_table(waviness), wear=np.array(wear, float), **linear)


def _remembered(law):
    """(stiffness, limit) of what a law remembers: sliders, branches with a clock behind them, one force, nothing."""
    if isinstance(law, Sliders):
        return law.stiffness, law.limit
    if isinstance(law, Maxwell):
        return [*law.stiffness, 0.0], [*law.time, 0.0]
    return ([0.0] * _REMEMBERS.get(type(law), 0),) * 2


def alone(elements):
    """ElementKernel of Elements that stand for themselves: their force laws, without bodies or a step."""
    count = len(elements)
    return element_kernel(elements, (), rows=np.zeros((2 * count, 2, 1)), response=np.zeros((2, count, count)),
                          to_contacts=np.zeros((4, 0, count)), to_elements=np.zeros((2, count, 2, 0)))


def bears(element):
    """Whether an Element has a force at rest on some elongation, as where a motion starts; dry friction has none."""
    kernel, force = alone((element,)), 0.0
    if kernel.kind[0] in kinds.FRICTION:
        return False
    memory = np.zeros(int(kernel.first[-1]))
    for elongation in (-1.0, 1.0):
        force += abs(kinds.element_force(kernel, 0, elongation, 0.0, 0.0, memory, memory.copy(), (0.0, 0.0, 0.0))[0])
    return force > 0


#: values that may be infinite: stops that are never reached, friction without an elastic way
_ENDLESS = {(Gap, "lower"), (Gap, "upper"), (Stop, "lower"), (Stop, "upper"), (Dry, "stiffness")}


def _check(name, law):
    wrong = {Power: lambda p: p.exponent < 1, Dry: lambda p: min(p.forward, p.backward) < 0 or p.stiffness < 0
             or p.decay_speed <= 0 or p.rise <= -1,
             BoucWen: lambda p: p.size <= 0 or p.exponent < 1 or not 0.5 <= p.shape <= 1,
             Gap: lambda p: p.lower < 0 or p.upper < 0,
             Stop: lambda p: min(p.lower, p.upper, p.stiffness, p.damping) < 0,
             Presliding: lambda p: min(p.force, p.time, p.viscous) < 0 or min(p.length, p.speed) <= 0 or p.rise <= -1,
             RateState: lambda p: min(p.force, p.evolution) < 0 or min(p.direct, p.length) <= 0,
             Positional: lambda p: min(p.force, p.creep) < 0, Softening: lambda p: p.time <= 0,
             Detent: lambda p: p.period <= 0,
             Maxwell: lambda p: np.shape(p.stiffness) != np.shape(p.time) or np.min(p.time, initial=1) <= 0
             or np.min(p.stiffness, initial=0) < 0,
             Sliders: lambda p: np.shape(p.stiffness) != np.shape(p.limit) or np.min(p.limit, initial=0) < 0}
    values = [v for key, v in law.__dict__.items() if (type(law), key) not in _ENDLESS or not np.isinf(v)]
    if not all(np.isfinite(v).all() for v in values) or wrong.get(type(law), lambda p: False)(law):
        raise ConfigError(f"element {name}", f"values as the description of {type(law).__name__} says", str(law))
