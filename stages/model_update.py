"""Stage model_update: values of a body that its modal test asks for."""

import copy
from types import SimpleNamespace
from typing import Literal

import numpy as np

from pipeline.case_models.bodies.brake_bodies import Caliper, Disc, Pad, Seal
from pipeline.case_models.bodies.measured_points import Point, rows
from pipeline.contract import ConfigError, Context, Section, option, stage
from pipeline.contract import documents as yaml
from pipeline.contract.settings import leaves
from pipeline.physics.fem.supports import free_modes
from pipeline.physics.modal.disc_modes import describe
from pipeline.physics.modal.mode_pairing import assurance, grouped, nearest_mixture, real
from pipeline.physics.modal.model_updating import CLOSE, ModelModes, Test, update
from pipeline.physics.modal.natural_modes import slopes
from pipeline.products import ModalTest, ModelUpdate, ResponseFunctions
from pipeline.systems import disc_brake

#: parts of the brake, and how each is meshed alone
BODIES = {"disc": lambda parts: disc_brake.disc(parts.disc), "pad": lambda parts: disc_brake.pad(parts, +1),
          "caliper": disc_brake.caliper}
#: step of differences to either side, in standard deviations of the priors
_STEP = 1e-3
#: modes of the model are computed up to this many standard deviations of the values, and a share, above the test
_DEVIATIONS, _ABOVE = 3.0, 1.1


class Value(Section):
    """A value that may be off."""

    spread: float = option(..., "standard deviation of its logarithm: 0.05 = about 5 %", gt=0, le=1)


class Settings(Section):
    """The body, hung freely, the values that may be off, and where the points of the test lie."""

    run: str | None = option(None, "run of the modal test; none = the only one")
    body: Literal[*BODIES] = option("disc", "body that was tested, hung freely")
    disc: Disc = option(Disc(), "brake disc, as in the section structure")
    pad: Pad = option(Pad(), "pad, as in the section structure")
    caliper: Caliper = option(Caliper(), "caliper, as in the section structure")
    values: dict[str, Value] = option({}, "values of the body that may be off, by their names in its section")
    points: tuple[Point, ...] = option((), "points of the test on the body; none = modes are paired by frequency alone")


def stated(settings):
    """Refuse a case that states no value that may be off."""
    if not settings["model_update"].values:
        raise ConfigError("model_update.values", "values of the body that may be off, such as young: {spread: 0.05}",
                          "none")


def companions(product, case):
    """The case with the values that the test asks for, with their standard deviations."""
    if case is None:
        return {}
    document = copy.deepcopy(case.document)
    section = document.setdefault("model_update", {}).setdefault(str(product.body), {})
    for name, unit, value, spread in zip(product.parameter, product.unit, product.after, product.after_spread,
                                         strict=True):
        section[str(name)] = {"value": f"{float(value):.6g} {unit}" if str(unit) else float(f"{value:.6g}"),
                              "origin": "measured", "source": f"modal test {case.name}, {spread:.1%}"}
    document["title"] = f"{document.get('title', case.name)}, updated"
    return {f"{case.name}_updated.yaml": yaml.yaml_text(document)}


@stage(companions=companions, check=stated)
def model_update(responses: ResponseFunctions, modes: ModalTest, settings: Settings, context: Context) -> ModelUpdate:
    """Update the values of a body by its modal test, and tell how well they are known.

    Method:
    Measured modes of the free body were paired with those of its finite-element model by frequency and shape (MAC, of
    pairs of a disc with the nearest mixture of both); pairs in doubt (odds below e^3) do not count. The values declared
    were updated by all others, ln f being normal about that of the model with the error of the test and one of the
    model, which is integrated out; a split pair counts by its mean; priors are log-normal with the spreads declared.
    """
    name, test = _test(modes, settings)
    body = Body(settings, context.solver, float(test.frequency.max()))
    seen = rows(settings.points, test.place, test.reference, responses.tests[name].unit, body.solid(0.0).mesh.node,
                "model_update")
    shown = np.zeros((len(test.frequency), 0)) if seen is None else _shown(test, seen)
    measured = Test(test.frequency, test.frequency_std / test.frequency, shown)
    found = update(body, seen and seen.products, measured, len(body.names))
    context.log(f"{int(found.pairing.clear.sum())} of {len(test.frequency)} measured modes have a pair beyond doubt")
    return ModelUpdate(run=name, body=settings.body, **_values(body, found), **_modes(test, body, found),
                       **_points(test, shown, seen, found))


class Body:
    """A freely hung part of the brake as a model of its values, each ``u`` standard deviations from what is stated."""

    def __init__(self, settings, solver, highest):
        self.part, self.solver = settings.body, solver
        self.parts = {"disc": settings.disc, "pad": settings.pad, "caliper": settings.caliper, "piston": Seal()}
        known = {key: (value, unit) for key, value, unit, _ in leaves(self.parts[self.part])
                 if isinstance(value, float) and value > 0}
        strange = [name for name in settings.values if name not in known]
        if strange:
            raise ConfigError("model_update.values", f"values of {self.part} above 0: {', '.join(known)}",
                              ", ".join(strange))
        self.names = tuple(settings.values)
        self.stated, self.units = (np.array(each) for each in zip(*(known[n] for n in self.names), strict=True))
        self.spread = np.array([value.spread for value in settings.values.values()])
        self.below = _ABOVE * highest * np.exp(_DEVIATIONS * np.linalg.norm(self.spread) / 2)

    def values(self, latent):
        """Values (p,) in SI units."""
        return self.stated * np.exp(self.spread * latent)

    def solid(self, latent):
        """The Solid at ``latent`` values (p,)."""
        given = dict(zip(self.names, self.values(np.broadcast_to(latent, self.stated.shape)).tolist(), strict=True))
        parts = {**self.parts, self.part: self.parts[self.part].model_copy(update=given)}
        return BODIES[self.part](SimpleNamespace(**parts))

    def __call__(self, latent):
        """ModelModes at ``latent`` values, the shapes at all nodes."""
        matrices = self.solid(latent).matrices()
        frequency, shape = free_modes(*matrices, self.solver, self.below, f"model_update: {self.part}")
        sides = ([self.solid(latent + side * _STEP * unit).matrices() for side in (-1, 1)]
                 for unit in np.eye(len(latent)))
        slope = [slopes(frequency, shape, *both) / (2 * _STEP) for both in sides]
        return ModelModes(frequency, np.array(slope).T, shape)


def _test(modes, settings):
    """(name, TestModes) of the run of the settings."""
    held = {name: run for name, run in modes.runs.items() if len(run.frequency)}
    wanted = settings.run or (next(iter(held)) if len(held) == 1 else None)
    if wanted not in held:
        raise ConfigError("model_update.run", f"a run with modes: {', '.join(held) or 'none has any'}",
                          repr(settings.run))
    return wanted, held[wanted]


def _shown(test, seen):
    """Real shapes (t, n) as displacements: residues of velocities and accelerations are i w and (i w)^2 times those."""
    turn = 2j * np.pi * test.frequency[:, None]
    return np.array([real(row) for row in test.shape[:, seen.index] / turn ** seen.order])


def _values(body, found):
    spread = np.sqrt(np.diag(found.covariance))
    return {"parameter": list(body.names), "unit": body.units.tolist(), "before": body.stated,
            "before_spread": body.spread, "after": body.values(found.latent), "after_spread": body.spread * spread,
            "correlation": found.covariance / np.outer(spread, spread), "model_error": found.error,
            "model_error_spread": found.error_spread}


def _modes(test, body, found):
    """Fields of measured modes and of the groups of the model; a group before is that of the most alike shapes."""
    pairing, after, before = found.pairing, found.after, grouped(found.before.frequency, CLOSE)
    first = [group[0] for group in found.groups]
    alike = assurance(after.shown[:, first].T, [found.before.shown[:, group] for group in before]).argmax(axis=1)
    diameters = np.full(len(first), -1)
    if body.part == "disc":
        diameters = describe(body.solid(found.latent).mesh.node, after.shown)[0][first]
    return {"measured_frequency": test.frequency, "measured_std": test.frequency_std, "pair": pairing.group,
            "rival": pairing.rival, "odds": pairing.odds, "clear": pairing.clear.astype(int),
            "likeness": found.likeness, "frequency_spread": found.spread, "diameters": diameters,
            "frequency_before": [found.before.frequency[before[k]].mean() for k in alike],
            "frequency": [after.frequency[group].mean() for group in found.groups],
            "members": [len(group) for group in found.groups]}


def _points(test, shown, seen, found):
    """Fields of the points: how well each agrees over the pairs, shapes of the model scaled to those measured."""
    if seen is None:
        return {"place": [], "reference": [], "agreement": [], "distance": []}
    clear = np.flatnonzero(found.pairing.clear)
    own = shown[clear] / np.linalg.norm(shown[clear], axis=1, keepdims=True)
    members = [found.groups[group] for group in found.pairing.group[clear]]
    model = np.array([nearest_mixture(shape, seen.products(found.after.shown[:, group]))
                      for shape, group in zip(own, members, strict=True)])
    both = np.sum(own**2, axis=0) * np.sum(model**2, axis=0)
    place, reference = ([str(each[i]) for i in seen.index] for each in (test.place, test.reference))
    return {"place": place, "reference": reference, "distance": seen.distance,
            "agreement": np.sum(own * model, axis=0) / np.sqrt(np.maximum(both, 1e-300))}
