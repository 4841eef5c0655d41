"""Folders of runs of small systems, as the chains leave them: a brake of a few elements, a lumped one."""

from dataclasses import fields

import numpy as np

from pipeline.contract import store
from stages.complex_modes import Settings, complex_modes
from stages.reduced_model import Settings as Reduction
from stages.reduced_model import reduced_model
from tests.stages.flutter_rig import flutter_rig
from tests.stages.small_structure import small_friction_map, small_structure

SETTINGS = {"friction_steps": 2, "speeds": ("8 rad/s", "12 rad/s"), "frequency_max": "8 kHz", "followed": 0,
            "friction_damping": False}


def changed(product, **values):
    return type(product)(**{**{f.name: getattr(product, f.name) for f in fields(product)}, **values})


def written(folder, *products):
    """The folder with the products in it."""
    for product in products:
        store.write(product, folder / f"{product.name}.h5", {})
    return folder


def brake_run(folder):
    """A brake with loss factors and brake fluid whose roots are those of its full finite-element matrices."""
    structure = small_structure(modes_below=7e3)
    bodies = {name: changed(getattr(structure, name), damping_ratio=0.0, loss_factor=[loss])
              for name, loss in zip(structure.body_name, (0.001, 0.01, 0.02, 0.002), strict=True)}
    structure = changed(structure, **bodies, fluid_stiffness=[1e6], fluid_loss_factor=[0.1], line_inertia=[10.0],
                        line_drag=[1e3], joint_loss_factor=np.linspace(0.0, 0.05, len(structure.joint_name)))
    model = reduced_model(structure, settings=Reduction(fixed_below="7 kHz", residual_below="10 kHz"))
    modes = complex_modes(model, small_friction_map(), None, structure, settings=Settings(**SETTINGS))
    return written(folder, structure, model, small_friction_map(), modes)


def flutter_run(folder):
    """A block on a belt, unstable by mode coupling."""
    return written(folder, *flutter_rig())
