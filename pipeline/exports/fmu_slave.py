"""What an exported functional mock-up unit runs: steady sliding, linearised, stepped exactly in its complex modes.

Copied into the unit beside model.npz and interface.json; needs NumPy and nothing of brakechain. Inputs are held over
each communication step, which may have any length; outputs are motions about steady sliding at its end.
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


class SteadySliding(Fmi2Slave):
    """x_k' = s_k x_k + b_k u, q = Re sum_k c_k x_k."""

    def __init__(self, **options):
        super().__init__(**options)
        folder = Path(self.resources)
        about = json.loads((folder / "interface.json").read_text(encoding="utf-8"))
        with np.load(folder / "model.npz") as held:
            self.root, self.drive, self.rows = (held[name] for name in ("root", "drive", "rows"))
        self.modelName, self.description, self.version = about["name"], about["description"], about["version"]
        self.guid = UUID(about["guid"])
        self.state, self.inputs = np.zeros(len(self.root), complex), np.zeros(len(about["inputs"]))
        self.outputs = np.zeros(len(about["outputs"]))
        self.units = {name: unit for name, _, unit in (*about["inputs"], *about["outputs"])}
        for k, (name, meaning, _) in enumerate(about["inputs"]):
            self.register_variable(Real(name, causality=Fmi2Causality.input, description=meaning, start=0.0,
                                        variability=Fmi2Variability.continuous, getter=lambda k=k: self.inputs[k],
                                        setter=lambda value, k=k: self.inputs.__setitem__(k, value)))
        for k, (name, meaning, _) in enumerate(about["outputs"]):
            self.register_variable(Real(name, causality=Fmi2Causality.output, description=meaning,
                                        variability=Fmi2Variability.continuous, getter=lambda k=k: self.outputs[k]))

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

    def exit_initialization_mode(self):
        self.state = np.zeros(len(self.root), complex)
        self._observe()

    def do_step(self, current_time, step_size):
        grown, force = self.root * step_size, self.drive @ self.inputs
        at_rest = self.root == 0
        given = np.where(at_rest, step_size, np.expm1(grown) / np.where(at_rest, 1, self.root))
        state = np.exp(grown) * self.state + given * force
        if not np.isfinite(state).all():
            self.log("the motion grew beyond all numbers: the linearised model ends there", Fmi2Status.error)
            return False
        self.state = state
        self._observe()
        return True

    def _observe(self):
        """Displacements, velocities and accelerations, output by output."""
        rate = self.root * self.state
        motion = self.state, rate, self.root * (rate + self.drive @ self.inputs)
        self.outputs[:] = np.column_stack([(self.rows @ each).real for each in motion]).ravel()

    def _get_fmu_state(self):
        parts = np.column_stack((self.state.real, self.state.imag)).tolist()
        return {**super()._get_fmu_state(), "parts": parts, "seen": self.outputs.tolist()}

    def _set_fmu_state(self, state):
        known = dict(state)
        parts, self.outputs = np.array(known.pop("parts")), np.array(known.pop("seen"))
        self.state = parts[:, 0] + 1j * parts[:, 1]
        super()._set_fmu_state(known)
