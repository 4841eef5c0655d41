"""A part of the brake that hangs freely, as a model of its values."""

from types import SimpleNamespace

import numpy as np

from pipeline.case_models.bodies.brake_bodies import Seal
from pipeline.case_models.bodies.declared_values import declared, known_values, named
from pipeline.physics.fem.supports import free_modes
from pipeline.physics.modal.model_updating import ModelModes
from pipeline.physics.modal.natural_modes import slopes
from pipeline.systems import disc_brake

#: parts of the brake, and how each is meshed alone
PARTS = {"disc": lambda parts: disc_brake.disc(parts.disc), "pad": lambda parts: disc_brake.pad(parts, +1),
         "caliper": disc_brake.caliper}
#: step of differences to either side, in standard deviations of the priors
STEP = 1e-3
#: modes of the model are computed up to this many standard deviations of the values, and a share, above the test
DEVIATIONS, ABOVE = 3.0, 1.1


class FreeBody:
    """A freely hung part as a model of its values, each ``u`` standard deviations from what is stated."""

    def __init__(self, settings, solver, highest):
        """``settings``: section model_update, of whose values those of the part count; ``highest``: frequency of the
        test in Hz."""
        self.part, self.solver = settings.body, solver
        self.sections = {name: getattr(settings, name) for name in PARTS}
        members = {name: value for name, value in named(settings.values, self.part).items()
                   if name.startswith(f"{self.part}.")}
        self.declared = declared(members, known_values(self.sections), "model_update")
        self.below = ABOVE * highest * np.exp(DEVIATIONS * np.linalg.norm(self.declared.spread) / 2)

    @property
    def nodes(self):
        """{body: nodes (k, 3)} as stated."""
        return {self.part: self.solid(0.0).mesh.node}

    def solid(self, latent):
        """The Solid at ``latent`` values (p,)."""
        parts = self.declared.laid_over(self.sections, self.declared.values(latent))
        return PARTS[self.part](SimpleNamespace(**parts, piston=Seal()))

    def __call__(self, latent):
        """ModelModes at ``latent`` values, the shapes at all nodes."""
        matrices = self.solid(latent).matrices()
        frequency, shape = free_modes(*matrices, self.solver, self.below, f"model_update: {self.part}")
        sides = ([self.solid(latent + side * STEP * unit).matrices() for side in (-1, 1)]
                 for unit in np.eye(len(latent)))
        slope = [slopes(frequency, shape, *both) / (2 * STEP) for both in sides]
        return ModelModes(frequency, np.array(slope).T, shape)
