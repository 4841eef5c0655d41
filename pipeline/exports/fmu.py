"""The reduced sliding model of a run as a functional mock-up unit: FMI 2.0, co-simulation. The door of pythonfmu.

The unit holds the model linearised about steady sliding, with friction, gyroscopic terms and the damping of its
contacts; loss factors are viscous dampers of equal loss, as in all motions over time. It is true while contacts stay
closed and slide: a growing mode grows without end. It steps itself exactly, with Python and NumPy of the machine it
runs on. With contacts that lift and stick the unit holds the products of the run instead, and brakechain has to be
installed where it runs.
"""

import json
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory
from uuid import UUID

import numpy as np

from pipeline import __version__
from pipeline.case_models.matrices.sliding_terms import sliding_state
from pipeline.contract import ConfigError
from pipeline.contract.store import publish
from pipeline.exports.contact_motion import ContactMotion, with_inputs
from pipeline.exports.run_products import (
    described,
    operating_point,
    product_of,
    refuse_existing,
    safe_names,
    sliding_products,
)
from pipeline.physics.modal.modal_form import ModalForm, modal_form
from pipeline.products import ComplexModes, Effects, FrictionMap, ReducedModel

_SLAVE = Path(__file__).with_name("fmu_slave.py")
#: what is observed at each sensor, and its unit
_OBSERVED = (("displacement", "m"), ("velocity", "m/s"), ("acceleration", "m/s2"))
#: characters of the hash in the name of the module of a unit, which importers load into one process
_HASH = 12


@dataclass(frozen=True)
class Unit:
    """A model with (name, meaning, unit) of its inputs (i,) and outputs (o,), and what it is in words.

    ``form``: of a linearised model its ModalForm; else ``products``, files of the run, and what ContactMotion is made
    of beside them: ``operating`` point and longest ``step`` in s.
    """

    inputs: tuple
    outputs: tuple
    about: str
    form: ModalForm | None = None
    products: tuple = ()
    operating: int = 0
    step: float = 0.0


def unit_of(folder, wanted=None):
    """Unit of the reduced sliding model of a run ``folder`` about an operating point (None: the most unstable).

    Inputs are the change of the pad pressure, forces on the inputs of the model and forces at its sensors. Errors as of
    ``reduced_system``; ConvergenceError where complex modes do not span the motion.
    """
    modes, model, friction_map, effects = sliding_products(folder)
    operating = operating_point(modes, wanted)
    state = sliding_state(modes, model, friction_map, effects, operating)
    about = state.about
    form = modal_form(state.linearised, with_inputs(about, model.input_area).input_rows, about.sensor_rows)
    return Unit(*_interface(about.input_name, about.sensor_name, _OBSERVED),
                f"reduced sliding model linearised about operating point {described(modes, operating)}", form)


def contact_unit_of(folder, wanted, step):
    """Unit of the same with contacts that lift and stick, in steps of at most ``step`` s. Errors as of
    ``ContactMotion.of``."""
    modes = product_of(ComplexModes, folder)
    operating = operating_point(modes, wanted)
    motion = ContactMotion.of(folder, operating, step)
    given, sensors = motion.bench.model.input_name, motion.bench.model.sensor_name
    inputs, outputs = _interface(given[1:len(given) - len(sensors)], sensors, _OBSERVED[:2])
    forces = (("contacts.normal_force", "normal force of all contacts", "N"),
              ("contacts.friction_force", "friction force of all contacts along sliding", "N"))
    files = (folder / f"{cls.name}.h5" for cls in (ComplexModes, ReducedModel, FrictionMap, Effects))
    return Unit(inputs, outputs + forces, f"reduced sliding model with its contacts, from operating point"
                f" {described(modes, operating)}", products=tuple(f for f in files if f.exists()), operating=operating,
                step=step)


def _interface(given, sensors, observed):
    """(inputs, outputs) of a unit: of the inputs ``given`` and the ``sensors`` of a model, by name, at which (quantity,
    unit) are ``observed``."""
    given, sensors = safe_names(given), safe_names(sensors)
    inputs = (("pressure", "change of the nominal pad pressure", "Pa"),
              *((f"force.{n}", f"force on the input {n} beside the steady one", "N") for n in given),
              *((f"force_at.{n}", f"force at the sensor {n}, in its direction", "N") for n in sensors))
    return inputs, tuple((f"{n}.{seen}", f"{seen} at the sensor {n} about steady sliding", unit) for n in sensors
                         for seen, unit in observed)


def write_fmu(unit, path, source):
    """Write a Unit to the new file ``path``, whose name is that of the model; ``source``: what it is from, in words.

    Raises ConfigError where the file exists or the extra 'fmu' is not installed.
    """
    refuse_existing(path)
    try:
        from pythonfmu.builder import FmuBuilder
    except ImportError:
        raise ConfigError("export fmu", "pythonfmu, which writes the unit", "no such package",
                          "install the extra: pip install 'brakechain[fmu]'") from None
    name = _identifier(path.stem)
    interface = {"name": name, "description": f"{unit.about}, from {source}", "version": __version__,
                 "inputs": unit.inputs, "outputs": unit.outputs,
                 **({"operating": unit.operating, "step": unit.step} if unit.products else {})}
    hashed = _hash(unit, interface)
    with TemporaryDirectory(prefix="fmu_") as folder, _own_imports(f"{name}_{hashed[:_HASH]}") as module:
        script, built = Path(folder) / f"{module}.py", path.with_name(f".{path.stem}.partial.fmu")
        copyfile(_SLAVE, script)
        about, files = script.with_name("interface.json"), [*unit.products]
        about.write_text(json.dumps({**interface, "guid": str(UUID(hashed[:32]))}), encoding="utf-8")
        if unit.form is not None:
            files = [script.with_name("model.npz")]
            np.savez(files[0], root=unit.form.root, drive=unit.form.drive, rows=unit.form.rows)
        kept = unit.form is not None
        try:
            FmuBuilder.build_FMU(script, dest=built, project_files=[*files, about], canGetAndSetFMUstate=kept,
                                 canSerializeFMUstate=kept)
            publish(built, path)
        finally:
            built.unlink(missing_ok=True)


def _identifier(name):
    """``name`` as an identifier of C."""
    plain = safe_names([name])[0].replace("-", "_")
    return plain if not plain[0].isdigit() else f"model_{plain}"


def _hash(unit, interface):
    """SHA-256 of what the unit holds."""
    digest = sha256(json.dumps(interface, sort_keys=True).encode())
    for part in () if unit.form is None else (unit.form.root, unit.form.drive, unit.form.rows):
        digest.update(np.ascontiguousarray(part).tobytes())
    for file in unit.products:
        digest.update(file.read_bytes())
    return digest.hexdigest()


@contextmanager
def _own_imports(module):
    """The name of a ``module`` that pythonfmu imports; afterwards neither it nor its folder is known any more."""
    known = list(sys.path)
    try:
        yield module
    finally:
        sys.path[:] = known
        sys.modules.pop(module, None)
