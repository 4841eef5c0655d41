"""The assembled brake at rest as a model of its values: those of its joints and of its bodies.

Bodies are reduced once and again only where a value changes their finite elements; springs enter the reduced model as
they are. Pads pressed on the disc stick: each patch of a lining is a spring normal to the disc and two along it, as
stiff as its pressure under the force of the piston asks for, which is found once with the values as stated.
"""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import scipy

from pipeline.case_models.bodies.declared_values import JOINED, declared, known_values
from pipeline.case_models.bodies.free_body import ABOVE, DEVIATIONS, STEP
from pipeline.physics.contact.static_preload import contact_law, solve_preload
from pipeline.physics.modal.coupled_bodies import CoupledBodies, reduced_body, side_by_side
from pipeline.physics.modal.model_updating import ModelModes
from pipeline.physics.modal.natural_modes import slopes
from pipeline.systems import disc_brake
from pipeline.systems.disc_brake_joints import joints
from pipeline.systems.solids import Rows

#: bodies keep modes to this many times the highest frequency of the assembly, residual shapes beside them
_BASIS = 1.5
#: moduli that rise by one factor to this share have modes that stay
_EQUAL = 1e-12
#: the contact law is linear in pressure up to this many times its mean, and tabulated up to the next
_LINEAR, _TABLE = 8.0, 160.0


@dataclass(frozen=True)
class BrakeModes(ModelModes):
    """ModelModes with the ``share`` (b, m) of each body in the kinetic energy."""

    share: np.ndarray


class AssembledBrake:
    """Bodies on their joints as a model of values, each ``u`` standard deviations from what is stated."""

    part = "assembly"

    def __init__(self, settings, solver, highest):
        """``settings``: section model_update; ``highest``: frequency of the test in Hz."""
        self.solver = solver
        self.sections = sections(settings)
        self.declared = declared(settings.values, known_values(self.sections), "model_update")
        springs = np.array([name.split(".")[0] in JOINED for name in self.declared.names])
        spread = self.declared.spread
        reach = np.linalg.norm([spread[springs].max(initial=0.0), *spread[~springs]])
        self.below = ABOVE * highest * np.exp(DEVIATIONS * reach / 2)
        self._bodies, self._seen, self.weights = {}, None, np.zeros(0)
        brake = self.brake(self.declared.stated)
        self.names, self.nodes = brake.names, dict(zip(brake.names, (b.mesh.node for b in brake.bodies), strict=True))
        if settings.pressed.force:
            self.weights = self._pressed(brake, settings.pressed)
        self.members = self._members(brake)

    def brake(self, values):
        """The DiscBrake with ``values`` (p,), a contact for each patch of the linings."""
        parts = self.declared.laid_over(self.sections, values)
        pad = parts["pad"].model_copy(update={"contact_points": None})
        return disc_brake.build(SimpleNamespace(**parts | {"pad": pad}, sensors=()))

    def observe(self, seen):
        """Let shapes show the Rows ``seen`` on all nodes; returns the same responses as Rows of what is shown."""
        self._seen = [seen.moved] if seen.struck is None else [seen.moved, seen.struck]
        return seen.of_shown()

    def __call__(self, latent):
        """BrakeModes at ``latent`` values (p,); the shapes are what ``observe`` asked for, else those of all nodes."""
        values = self.declared.values(latent)
        brake = self.brake(values)
        bodies, coupled = self._coupled(brake)
        springs = self._springs(brake, self.declared.laid_over(self.sections, values)["pressed"])
        frequency, shape, strain = coupled.modes(springs, self.below)
        first = np.cumsum([0, *(len(b.mass) for b in bodies)])
        parts = [shape[a:z] for a, z in zip(first, first[1:], strict=False)]
        share = [np.einsum("km,kl,lm->m", x, b.mass, x) for x, b in zip(parts, bodies, strict=True)]
        motion = [b.shape @ x for b, x in zip(bodies, parts, strict=True)]
        slope = self.declared.spread[:, None] * (self.members.T @ strain) / 2
        slope = slope + self._slopes(values, frequency, parts, bodies)
        whole = np.vstack(motion)
        shown = whole if self._seen is None else np.vstack([rows @ whole for rows in self._seen])
        return BrakeModes(frequency, slope.T @ self.declared.root, shown, np.array(share))

    def _slopes(self, values, frequency, parts, bodies):
        """(p, m) of ln f over each u by values of bodies, from reduced shapes [(k, m)] of the ReducedBodies."""
        slope = np.zeros((len(values), len(frequency)))
        for k, name in enumerate(self.declared.names):
            if name.split(".")[0] in JOINED:
                continue
            step = STEP * self.declared.spread[k] * np.eye(len(values))[k]
            sides = (self.brake(values * np.exp(side * step)).bodies for side in (-1, 1))
            for less, more, x, body in zip(*sides, parts, bodies, strict=True):
                if _times(more, less) != (1.0, 1.0):
                    matrices = _changed(less, more, x, body)
                    slope[k] += slopes(frequency, *matrices) / (2 * STEP)
        return slope

    def _springs(self, brake, pressed):
        """Stiffness (s,) N/m of joints, fluid and contacts in the order of ``_rows``; ``pressed``: that section."""
        fluid = [] if brake.fluid is None else [brake.fluid.stiffness] * brake.piston.count
        normal, along = (self.weights * each for each in (pressed.stiffness, pressed.tangential_stiffness))
        return np.concatenate((brake.joints.stiffness, fluid, normal, along, along, [0.0]))

    def _rows(self, brake):
        """[(s, 3 nodes)] of each body: joints, fluid column and contacts, last the row of the piston."""
        contacts = (brake.contacts.normal, brake.contacts.tangent, brake.contacts.lateral) if len(self.weights) else ()
        column = () if brake.fluid is None else (brake.piston,)
        return [scipy.sparse.vstack([rows.parts[b] for rows in (brake.joints.rows, *column, *contacts, _pushed(brake))],
                                    format="csr") for b in range(len(brake.bodies))]

    def _coupled(self, brake):
        """(ReducedBody of each, CoupledBodies): bodies that are as they were are not reduced again."""
        rows, bodies = self._rows(brake), []
        for name, solid, row in zip(brake.names, brake.bodies, rows, strict=True):
            first, row_before, reduced = self._bodies.get(name, (None, None, None))
            times = None if reduced is None or (row != row_before).nnz else _times(solid, first)
            if times is None:
                reduced, times = reduced_body(solid, row, _BASIS * self.below, self.solver), (1.0, 1.0)
                self._bodies[name] = solid, row, reduced
            bodies.append(replace(reduced, stiffness=times[0] * reduced.stiffness, mass=times[1] * reduced.mass))
        coupled = side_by_side(bodies, rows)
        return bodies, coupled if brake.fluid is None else _with_line(coupled, brake)

    def _pressed(self, brake, pressed):
        """Areas (c,) m^2 of the patches, each times its pressure over the mean; 0 of open ones."""
        area = brake.contacts.area
        self.weights = np.zeros(len(area))
        coupled, springs = self._coupled(brake)[1], self._springs(brake, pressed)
        piston, normal = coupled.rows[-1], coupled.rows[-1 - 3 * len(area):][:len(area)]
        moved = normal @ np.linalg.solve(coupled.held(springs), np.column_stack((normal.T, piston * pressed.force)))
        pressure = pressed.force / brake.pad_area
        law = contact_law([_LINEAR * pressure], [_LINEAR * pressed.stiffness], _TABLE * pressure)
        compliance = (moved[:, :-1] + moved[:, :-1].T) / 2
        return solve_preload(compliance, -moved[:, -1], area, *law).force / pressure

    def _members(self, brake):
        """(s, p): 1 where a spring follows a value of a joint, which each is in proportion to."""
        meshes, before = [body.mesh for body in brake.bodies], self._springs(brake, self.sections["pressed"])
        members = np.zeros((len(before), len(self.declared.names)))
        for k, (name, value) in enumerate(zip(self.declared.names, self.declared.stated, strict=True)):
            section, key = name.split(".")
            if section in JOINED:
                parts = self.sections | {section: self.sections[section].model_copy(update={key: 2 * value})}
                other = replace(brake, joints=joints(meshes, SimpleNamespace(**parts)))
                members[:, k] = self._springs(other, parts["pressed"]) > 1.5 * before
        return members


def _pushed(brake):
    """Rows of the force that pistons press with: one row, of all pads that they press."""
    return Rows(tuple(scipy.sparse.csr_matrix(part.sum(axis=0)) for part in brake.piston.parts))


def sections(settings):
    """{section: settings} of an assembled brake in the section model_update."""
    return {name: getattr(settings, name) for name in ("disc", "pad", "caliper", "bracket", "piston", *JOINED)}


def _times(solid, first):
    """(stiffness, mass) of a Solid over those of the ``first``, whose modes it has; None where it has others."""
    ratios = [new[old != 0] / old[old != 0] for new, old in ((solid.elasticity, first.elasticity),
                                                     (solid.density, first.density))]
    same = (np.array_equal(solid.mesh.node, first.mesh.node) and np.array_equal(solid.supported, first.supported)
            and all(np.ptp(each) <= _EQUAL * each[0] for each in ratios))
    return tuple(float(each[0]) for each in ratios) if same else None


def _changed(less, more, shape, body):
    """(shape, (K, M) of the Solid ``less``, those of ``more``) of a ReducedBody with reduced ``shape`` (k, m).

    Where both differ by factors these are those of the reduced body, taken as what lies between them.
    """
    times = _times(more, less)
    if times is None:
        return body.shape @ shape, less.matrices(), more.matrices()
    sides = [[side * matrix for side, matrix in zip(np.power(times, power), (body.stiffness, body.mass), strict=True)]
             for power in (-0.5, 0.5)]
    return shape, *sides


def _with_line(coupled, brake):
    """CoupledBodies with the inertia of the fluid in the lines, on which the columns in the bores end."""
    count, first = brake.piston.count, len(brake.joints.name)
    rows = np.hstack((coupled.rows, np.zeros((len(coupled.rows), count))))
    rows[first:first + count, -count:] = -np.eye(count)
    return CoupledBodies(scipy.linalg.block_diag(coupled.mass, brake.fluid.inertia * np.eye(count)),
                         scipy.linalg.block_diag(coupled.stiffness, np.zeros((count, count))), rows)
