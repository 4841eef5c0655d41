"""Arrays that the compiled steps work on: rows of contacts, inputs and elements, driven through one step."""

import numpy as np

from pipeline.contract.errors import ConfigError
from pipeline.physics.contact.groups import parts
from pipeline.physics.friction.dry_friction import RIGID, STIFFNESS
from pipeline.physics.friction.state_kernels import MEMORY
from pipeline.physics.time_stepping.contact_solver import LARGEST_STIFFNESS, PENALTY, TABLE
from pipeline.physics.time_stepping.elements import element_kernel
from pipeline.physics.time_stepping.linear_step import LinearKernel
from pipeline.physics.time_stepping.modal_integrator import newmark_matrices, step_matrices
from pipeline.physics.time_stepping.normal_laws import Forward, Hard, contiguous
from pipeline.physics.time_stepping.rigid_friction import located

#: fewest steps in a period of the highest mode
STEPS_PER_PERIOD = 2.5


def linear_kernel(model, system, law, dry, step, captured=False):
    """LinearKernel: rows of contacts, inputs and elements, seen and driven through one step; ``dry`` FrictionKernel.

    ``captured``: the forces of rigid elements are constant over a step.
    """
    contacts, count = model.contacts, len(model.contacts.area)
    law = parts(law, count)[0][0]       # those of all groups are stepped alike
    gamma, matrices = getattr(law, "gamma", None), matrices_of(system, law, count, step)
    forced = system.driven(np.vstack((contacts.normal, contacts.tangent, model.input_rows, -_element_rows(model))))
    first, last = (np.einsum("bxy,ryb->rxb", matrix, forced) for matrix in matrices[1:])
    kicks = isinstance(law, Forward)
    hold = np.array([kicks or isinstance(law, Hard), dry.description == RIGID])
    if gamma is not None:
        hold[:] = False
    for f in np.flatnonzero(hold):
        block = slice(f * count, (f + 1) * count)
        flown = step * np.einsum("bxy,ryb->rxb", matrices[0], forced[block])
        last[block], first[block] = flown if kicks else first[block] + last[block], 0.0
    rigid = len(last) - len(model.elements) + np.flatnonzero([captured and located(e) for e in model.elements])
    last[rigid], first[rigid] = first[rigid] + last[rigid], 0.0
    rows = np.concatenate([system.observed(r) for r in (contacts.normal, contacts.tangent)])
    response = np.einsum("oibx,fjbx->ofij", rows, last[:2 * count].reshape(2, count, *last.shape[1:]))
    struck = step * np.repeat(hold, count)[:, None, None] * forced[:2 * count]
    energy, power = _forms(system)
    arrays = (np.moveaxis(matrices[0], 0, 2), first, last, _stacked(rows), response,
              system.observed(model.input_rows)[0], _stacked(system.observed(model.sensor_rows)), hold, system.squared,
              np.diag(system.damping), energy, power, struck if kicks else struck[:0])
    return LinearKernel(*(contiguous(a) for a in arrays))


def matrices_of(system, law, count, step):
    """Step matrices of a ModalSystem under a law of ``count`` contacts: exact, or by Newmark's rule."""
    gamma = getattr(parts(law, count)[0][0], "gamma", None)
    return step_matrices(system, step) if gamma is None else newmark_matrices(system, step, gamma)


def _element_rows(model):
    return np.array([e.row for e in model.elements], float).reshape(-1, model.size)


def elements_kernel(model, system, linear, captured=False):
    """ElementKernel: rows of the elements, seen and driven through one step, with those of the contacts."""
    contacts, count, elements = model.contacts, len(model.contacts.area), len(model.elements)
    wear = np.broadcast_to(contacts.wear, count) if np.any(contacts.wear) else ()
    seen = system.observed(_element_rows(model))
    drawn, pressed = linear.last[len(linear.last) - elements:], linear.last[:2 * count]
    contact_rows = linear.rows.reshape(4, count, *linear.rows.shape[1:])
    arrays = {"rows": _stacked(seen), "response": np.einsum("oeax,fax->oef", seen, drawn),
              "to_contacts": np.einsum("ocax,fax->ocf", contact_rows, drawn),
              "to_elements": np.einsum("oeax,fax->oef", seen, pressed).reshape(2, elements, 2, count)}
    return element_kernel(model.elements, contacts.waviness, wear, captured,
                          **{n: contiguous(a) for n, a in arrays.items()})


def _stacked(rows):
    """(a, r, 2, m) as (a r, 2, m)."""
    return rows.reshape(-1, *rows.shape[2:])


def _forms(system):
    """Quadratic forms (2m, 2m) of energy and loss in coupled pairs; empty where the modes are the pairs."""
    if not system.coupled:
        return np.empty((0, 0)), np.empty((0, 0))
    displacement, velocity = np.split(system.state.reshape(len(system.state), -1), 2)
    damping = (system.damping + system.damping.T) / 2
    energy = (velocity.T @ velocity + displacement.T @ (system.squared[:, None] * displacement)) / 2
    return energy, velocity.T @ damping @ velocity


def refuse(system, linear, normal, dry, states, model, step):
    """Refuse, before the first step, one that is too long, contacts that nothing can move, memory of impulses."""
    if np.any(states.kind == MEMORY) and (normal.kind not in (PENALTY, TABLE) or normal.newmark):
        raise ConfigError("time stepping: friction with memory", "contacts that yield, Penalty or Table without gamma",
                          "another law", "give the contacts a stiffness")
    if not normal.newmark and system.highest * step > 2 * np.pi / STEPS_PER_PERIOD:
        longest = 2 * np.pi / STEPS_PER_PERIOD / system.highest
        raise ConfigError("time stepping: step", f"at most {longest:.3g} s, {STEPS_PER_PERIOD:g} steps in a period of"
                          f" the highest mode ({system.highest / (2 * np.pi):.4g} Hz)", f"{step:.3g} s",
                          "shorten the step, or leave out the highest modes")
    for i in range(len(normal.gap)):
        if normal.fixed[i] < 0 and not linear.response[1, 0, i, i] > 0:
            raise ConfigError(f"time stepping: contact {i}", "bodies that its normal force moves", "none")
        if normal.newmark:
            continue
        products = [normal.stiffness[i] * linear.response[0, 0, i, i]]
        if dry.description != RIGID:
            products.append(dry.contact[i, STIFFNESS] * linear.response[2, 1, i, i])
        if max(products) > LARGEST_STIFFNESS:
            longest = step * np.sqrt(LARGEST_STIFFNESS / max(products))
            raise ConfigError("time stepping: step", f"at most about {longest:.2g} s for the stiffness of contact {i}",
                              f"{step:.3g} s", "shorten the step, soften the contact, or take hard contacts")
