"""Another body in the place of one of a sliding model, as where one part of a system is varied and the rest stays."""

from dataclasses import replace

import numpy as np
import scipy

from pipeline.contract.errors import ConfigError


def exchanged(model, body, terms):
    """The SlidingModel with the coordinates of the named ``body`` replaced by its BodyTerms ``terms``.

    Rows of ``terms`` are stacked as joints, normal, tangent and lateral contact rows, inputs, sensors. The new
    coordinates stand last. Joints, contacts and states stay as they are. Raises ConfigError for a body with loss
    factors, whose damping depends on the modes of the whole system.
    """
    if np.any(terms.loss):
        raise ConfigError(f"exchanged body {body}", "materials without loss factors", "one that has some",
                          "give it a damping ratio instead")
    index = model.body_name.index(body)
    kept = np.flatnonzero(model.coordinate_body != index)
    matrices = {name: scipy.linalg.block_diag(getattr(model, name)[np.ix_(kept, kept)], getattr(terms, name))
                for name in ("mass", "damping", "gyroscopic", "stiffness", "centrifugal")}
    contacts = model.contacts
    old = (model.joints.rows, contacts.normal, contacts.tangent, contacts.lateral, model.input_rows, model.sensor_rows)
    split = np.split(terms.rows, np.cumsum([len(rows) for rows in old])[:-1])
    rows = [np.hstack((before[:, kept], new)) for before, new in zip(old, split, strict=True)]
    owner = np.concatenate((model.coordinate_body[kept], np.full(len(terms.mass), index)))
    return replace(model, **matrices, coordinate_body=owner,
                   joints=replace(model.joints, rows=rows[0]),
                   contacts=replace(contacts, normal=rows[1], tangent=rows[2], lateral=rows[3]),
                   input_rows=rows[4], sensor_rows=rows[5])
