"""What an exported functional mock-up unit runs: a model about steady sliding, its inputs, its outputs.

Copied into the unit beside interface.json and the model: model.npz of the linearised one, stepped exactly in its
complex modes, which needs NumPy and nothing of brakechain; or products of the run, whose contacts brakechain steps.
Inputs are held over each communication step, which may have any length; outputs are those at its end.
"""

import json
from pathlib import Path
from uuid import UUID
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from pythonfmu.enums import Fmi2Status

#: units by powers of base units
_UNITS = {"N": {"kg": 1, "m": 1, "s": -2}, "Pa": {"kg": 1, "m": -1, "s": -2}, "m": {"m": 1},
          "m/s": {"m": 1, "s": -1}, "m/s2": {"m": 1, "s": -2}}


class ComplexModes:
    """x_k' = s_k x_k + b_k u, q = Re sum_k c_k x_k; outputs: displacement, velocity, acceleration of each sensor."""

    def __init__(self, folder, about):
        with np.load(folder / "model.npz") as held:
            self.root, self.drive, self.rows = (held[name] for name in ("root", "drive", "rows"))
        self.state, self.outputs = np.zeros(len(self.root), complex), np.zeros(3 * len(self.rows))

    def step(self, inputs, length):
        """Go on by ``length`` s under ``inputs`` (i,) that are held. ArithmeticError beyond all numbers."""
        grown, at_rest = self.root * length, self.root == 0
        given = np.where(at_rest, length, np.expm1(grown) / np.where(at_rest, 1, self.root))
        state = np.exp(grown) * self.state + given * (self.drive @ inputs)
        if not np.isfinite(state).all():
            raise ArithmeticError("the motion grew beyond all numbers: the linearised model ends there")
        self.state, rate = state, self.root * state
        motion = state, rate, self.root * (rate + self.drive @ inputs)
        self.outputs = np.column_stack([(self.rows @ each).real for each in motion]).ravel()

    def kept(self):
        """State and outputs as lists."""
        return np.column_stack((self.state.real, self.state.imag)).tolist(), self.outputs.tolist()

    def restore(self, kept):
        """Take state and outputs as ``kept`` gave them."""
        parts, self.outputs = (np.array(part) for part in kept)
        self.state = parts[:, 0] + 1j * parts[:, 1]


def contacts(folder, about):
    """The same with contacts that lift and stick, by the brakechain of this machine."""
    from pipeline import __version__
    from pipeline.exports.contact_motion import ContactMotion

    if __version__ != about["version"]:
        raise RuntimeError(f"expected brakechain {about['version']}, which wrote this unit, found {__version__}")
    return ContactMotion.of(folder, about["operating"], about["step"])


class SteadySliding(Fmi2Slave):
    """A model about steady sliding, from its start at the first communication point."""

    def __init__(self, **options):
        super().__init__(**options)
        self.folder = Path(self.resources)
        self.about = about = json.loads((self.folder / "interface.json").read_text(encoding="utf-8"))
        self.modelName, self.description, self.version = about["name"], about["description"], about["version"]
        self.guid, self.inputs = UUID(about["guid"]), np.zeros(len(about["inputs"]))
        self.motion = (contacts if "operating" in about else ComplexModes)(self.folder, about)
        self.units = {name: unit for name, _, unit in (*about["inputs"], *about["outputs"])}
        for k, (name, meaning, _) in enumerate(about["inputs"]):
            self.register_variable(Real(name, causality=Fmi2Causality.input, description=meaning, start=0.0,
                                        variability=Fmi2Variability.continuous, getter=lambda k=k: self.inputs[k],
                                        setter=lambda value, k=k: self.inputs.__setitem__(k, value)))
        for k, (name, meaning, _) in enumerate(about["outputs"]):
            self.register_variable(Real(name, causality=Fmi2Causality.output, description=meaning,
                                        variability=Fmi2Variability.continuous,
                                        getter=lambda k=k: self.motion.outputs[k]))

    def to_xml(self, model_options=None):
        """The description of the unit, with the units of its variables and its unknowns at the start."""
        root = super().to_xml(model_options or {})
        definitions = Element("UnitDefinitions")
        for name, powers in _UNITS.items():
            SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", {k: str(p) for k, p in powers.items()})
        root.insert(1, definitions)
        variables = root.find("ModelVariables")
        for variable in variables:
            variable.find("Real").set("unit", self.units[variable.get("name")])
        unknowns = SubElement(root.find("ModelStructure"), "InitialUnknowns")
        for index, variable in enumerate(variables, 1):
            if variable.get("causality") == "output":
                SubElement(unknowns, "Unknown", index=str(index))
        return root

    def do_step(self, current_time, step_size):
        """Whether a step of ``step_size`` s could be done; what prevents it stands in the log."""
        try:
            self.motion.step(self.inputs, step_size)
        except Exception as error:      # what a solver says, in the log of the importer
            self.log(str(error), Fmi2Status.error)
            return False
        return True

    def _get_fmu_state(self):
        return {**super()._get_fmu_state(), "motion": self.motion.kept()}

    def _set_fmu_state(self, state):
        known = dict(state)
        self.motion.restore(known.pop("motion"))
        super()._set_fmu_state(known)
