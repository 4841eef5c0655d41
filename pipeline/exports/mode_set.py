"""Mode shapes of a run on a mesh: unstable complex modes on the surface of all bodies, or real modes of one body."""

from dataclasses import dataclass

import numpy as np

from pipeline.contract import ConfigError
from pipeline.exports.run_products import described, product_of
from pipeline.physics.fem.reference_cells import by_kind
from pipeline.products import ComplexModes, ReducedModel, Structure


@dataclass(frozen=True)
class ModeSet:
    """Modes of a system: ``root`` (m,) 1/s and ``shape`` (m, v, 3), complex or, of an undamped body, real.

    ``node`` (v, 3) m; ``cells``: (meshio cell type, (c, k) numbers of nodes) of each kind; ``body`` (v,) index into
    ``body_name``; ``about`` (m,): each mode in words; ``scale``: how shapes are scaled, in words; ``modal_mass`` kg and
    ``damping_ratio`` (m,), of real modes.
    """

    node: np.ndarray
    cells: tuple
    body: np.ndarray
    body_name: tuple
    root: np.ndarray
    shape: np.ndarray
    about: tuple
    scale: str
    modal_mass: float = 0.0
    damping_ratio: np.ndarray | None = None

    @property
    def is_complex(self):
        """Whether these are complex modes."""
        return np.iscomplexobj(self.shape)

    @property
    def frequency(self):
        """Frequencies (m,) Hz."""
        return self.root.imag / (2 * np.pi)


def complex_modes_of(folder):
    """ModeSet of the unstable modes of a run ``folder``, strongest first, on the surface that pictures show.

    Raises ProductError for a missing product, ConfigError where nothing is unstable or nothing can be shown.
    """
    modes, model = product_of(ComplexModes, folder), product_of(ReducedModel, folder)
    if not len(modes.unstable_root):
        raise ConfigError(f"{folder}: complex_modes.h5", "unstable modes", "none", "export modes of a body: --body")
    if not len(model.visible_position):
        raise ConfigError(f"{folder}: reduced_model.h5", "nodes on the surface of the bodies", "none, as of lumped"
                          " systems", "export modes of a brake")
    about = [f"{root.imag / (2 * np.pi):.6g} Hz, growth {root.real:.5g} 1/s, operating point {described(modes, point)}"
             for root, point in zip(modes.unstable_root, modes.unstable_operating, strict=True)]
    faces = (("quad", model.visible_face),) if len(model.visible_face) else ()
    return ModeSet(model.visible_position, faces, model.visible_body, tuple(map(str, model.body_name)),
                   modes.unstable_root, modes.unstable_shape, tuple(about), "largest component 1")


def body_modes_of(folder, name):
    """ModeSet of the real modes of the body ``name`` of a run ``folder`` on its supports, on its whole mesh.

    Raises ConfigError for a body that does not exist or has no modes, ProductError for a missing product.
    """
    structure = product_of(Structure, folder)
    names = [str(each) for each in structure.body_name]
    if name not in names:
        raise ConfigError("--body", f"one of {', '.join(names)}", repr(name))
    body = structure.body(name)
    if not len(body.frequency):
        having = [each for each in names if len(structure.body(each).frequency)]
        raise ConfigError("--body", f"one with modes: {', '.join(having) or 'none'}", name)
    about = [f"{name}: {frequency:.6g} Hz" for frequency in body.frequency]
    cells = tuple((kind, cell) for kind, _, cell in by_kind(str(body.kind), body.element))
    return ModeSet(body.node, cells, np.zeros(len(body.node), int), (name,), 2j * np.pi * body.frequency,
                   np.asarray(body.shape, float), tuple(about), "unit modal mass", 1.0,
                   np.full(len(body.frequency), float(body.damping_ratio)))
