"""Sliding models of a few lumps, for tests of the time stepping."""

from dataclasses import replace

import numpy as np

from pipeline.physics.sliding.model import Contacts, Joints, SlidingModel


def lumps(mass, joints=(), stiffness=(), damping=None, normal=(), tangent=(), speed=0.0, lever=1.0):
    """Masses (n,) kg on springs along the rows ``joints`` (j, n); contacts of 1 m^2 along ``normal``, ``tangent``.

    Every coordinate is an input and a sensor; contacts slide at ``speed`` times ``lever``.
    """
    count = len(mass)
    rows, normal, tangent = (np.reshape(np.asarray(r, float), (-1, count)) for r in (joints, normal, tangent))
    stiffness = np.asarray(stiffness, float)
    damping = np.zeros(len(rows)) if damping is None else np.asarray(damping, float)
    contacts, none = len(normal), np.zeros((count, count))
    still = np.zeros(contacts)
    return SlidingModel(
        ("lumps",), np.zeros(count, int), np.diag(np.asarray(mass, float)), none, none, none, none,
        Joints(tuple(f"joint_{k}" for k in range(len(rows))), rows, stiffness, damping),
        Contacts(normal, tangent, np.zeros((contacts, count)), np.zeros((contacts, 3)), np.ones(contacts),
                 np.full(contacts, lever), still, still, still),
        tuple(f"input_{k}" for k in range(count)), np.eye(count), tuple(f"sensor_{k}" for k in range(count)),
        np.eye(count), float(speed))


def ball(mass=1.0):
    """A free mass above the ground: coordinate 0 is its height."""
    return lumps([mass], normal=[[1.0]], tangent=[[0.0]])


def belt(stiffness=100.0, damping=0.0, speed=0.1):
    """A mass of 1 kg on a spring along a belt, pressed onto it by its second coordinate."""
    return lumps([1.0, 1.0], [[1.0, 0.0]], [stiffness], [damping], [[0.0, 1.0]], [[1.0, 0.0]], speed)


def random_structure(modes, highest, seed=1, contacts=1, ratio=0.002):
    """Modes from 200 Hz to ``highest`` Hz with random participation in contacts, one input and two sensors.

    The input presses the first contact.
    """
    random = np.random.default_rng(seed)
    angular = 2 * np.pi * np.linspace(200, highest, modes)
    model = lumps(np.ones(modes), np.eye(modes), angular**2, 2 * ratio * angular,
                  random.standard_normal((contacts, modes)), random.standard_normal((contacts, modes)), 0.05)
    return replace(model, input_name=("load",), input_rows=-model.contacts.normal[:1],
                   sensor_name=("one", "other"), sensor_rows=random.standard_normal((2, modes)))
