"""Motion about steady sliding by the integrator of the package, with contacts that are springs."""

import numpy as np

from pipeline.case_models.matrices.sliding_terms import sliding_state
from pipeline.exports.run_products import sliding_products
from pipeline.physics.friction.dry_friction import constant
from pipeline.physics.time_stepping.contact_solver import SLIP
from pipeline.physics.time_stepping.simulate import Penalty, Start, simulate


def deviation(folder, operating, number, force, step, duration, records):
    """(displacement, velocity) of the first sensor, each (records,), about steady sliding of a run ``folder``.

    ``number``: input of the unit that ``force`` N is held on. Contacts have the stiffness and damping of the state, and
    one coefficient of friction; they must stay closed and slide.
    """
    products = sliding_products(folder)
    state = sliding_state(*products, operating)
    model, contacts, mu = state.about, state.about.contacts, float(np.mean(state.friction.coefficient))
    rows = np.vstack((products[1].input_area @ model.input_rows, model.input_rows, model.sensor_rows))
    steady = products[1].pressure[operating // len(state.settings.speeds)] * products[1].input_area
    pushed = contacts.normal + (model.direction() * mu)[:, None] * contacts.tangent
    place = np.linalg.solve(model.supported()[2], pushed.T @ contacts.preload + steady @ model.input_rows)
    closed = contacts.stiffness > 0
    stiffness = np.where(closed, contacts.stiffness, 1.0)
    gap = np.where(closed, -contacts.normal @ place - contacts.preload / stiffness, 1.0)
    law = Penalty(stiffness, contacts.damping, gap)
    start = Start(place, np.zeros(model.size), contacts.preload, model.direction() * mu * contacts.preload)
    pulled = model.__class__(**{**vars(model), "input_name": (*model.input_name, "probe"),
                                "input_rows": np.vstack((model.input_rows, rows[number]))})
    every = round(duration / records / step)
    motion = simulate(pulled, law, constant(mu), step=step, duration=duration, inputs=np.append(steady, force),
                      record_every=every, start=start, book=False)
    assert (motion.status[closed] == SLIP).all(), "contacts that lift or stick are not those of the linearised model"
    return motion.displacement[0, 1:] - motion.displacement[0, 0], motion.velocity[0, 1:]
