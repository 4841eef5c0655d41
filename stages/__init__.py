"""The chains, in reading order. Each stage is in the file of its name, loaded when needed."""

import re
from importlib import import_module
from pathlib import Path

CHAINS = {
    "disc_brake": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                   "complex_modes", "multibody", "response", "squeal", "comparison", "report"),
    "brake_squeal": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                     "complex_modes", "convergence", "limit_cycle", "probability", "sensitivities",
                     "design_search", "countermeasures", "comparison", "report"),
    "own_brake": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                  "complex_modes", "convergence", "limit_cycle", "probability", "sensitivities", "design_search",
                  "countermeasures", "report"),
    "pin_on_disc": ("surface", "interface_law", "friction_descriptions", "pin_on_disc", "reduced_model",
                    "effects", "complex_modes", "transient", "lock_in", "squeal", "comparison", "report"),
    "lumped": ("lumped", "reduced_model", "effects", "complex_modes", "transient", "comparison", "report"),
    "matrices": ("matrices", "matrix_modes", "comparison", "report"),
    "bimaterial_rupture": ("rupture", "comparison", "report"),
    "beam_on_beam": ("beam_on_beam", "reduced_model", "effects", "complex_modes", "transient", "motion_scatter",
                     "squeal", "comparison", "report"),
    "beam_geometry": ("beam_geometry", "report"),
    "recording": ("recording", "noise_events", "orders", "report"),
    "modal_test": ("recording", "response_functions", "modal_test", "report"),
    "model_update": ("recording", "response_functions", "modal_test", "model_update", "report"),
    "lumped_bench": ("lumped", "reduced_model", "effects", "recording", "bench", "diagnosis", "report"),
    "disc_modes": ("surface", "micro_friction", "friction_map", "structure", "recording", "diagnosis", "report"),
    "disc_squeal": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                    "complex_modes", "recording", "line_evidence", "diagnosis", "report"),
    "disc_squeal_records": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                            "complex_modes", "recording", "noise_events", "line_evidence", "report"),
    "lumped_squeal_records": ("lumped", "reduced_model", "effects", "complex_modes", "recording", "noise_events",
                              "line_evidence", "report"),
    "lumped_brake": ("lumped", "reduced_model", "effects", "complex_modes", "probability", "sensitivities",
                     "countermeasures", "report"),
    "lumped_modes": ("lumped", "reduced_model", "complex_modes", "report"),
    "lumped_squeal": ("lumped", "reduced_model", "effects", "complex_modes", "recording", "line_evidence", "report"),
    "noise_matrix": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                     "complex_modes", "noise_matrix", "report"),
    "noise_matrix_records": ("surface", "effects", "micro_friction", "friction_map", "structure", "reduced_model",
                             "complex_modes", "recording", "noise_events", "noise_matrix", "report"),
    "lumped_noise_matrix": ("lumped", "reduced_model", "effects", "complex_modes", "noise_matrix", "report"),
    "lumped_noise_matrix_records": ("lumped", "reduced_model", "effects", "complex_modes", "recording", "noise_events",
                                    "noise_matrix", "report"),
    "worn_pad": ("surface", "effects", "micro_friction", "friction_map", "recording", "diagnosis", "report"),
    "measured_friction": ("surface", "effects", "micro_friction", "friction_map", "recording", "friction_update",
                          "report"),
    "pin_squeal": ("surface", "interface_law", "pin_on_disc", "reduced_model", "complex_modes", "recording",
                   "diagnosis", "report"),
}

#: every stage once, in the order of its first chain
NAMES = tuple(dict.fromkeys(name for names in CHAINS.values() for name in names))


def load(name):
    """The Stage called ``name``."""
    return getattr(import_module(f"stages.{name}"), name)


def summary(name):
    """First line of the docstring of stage ``name``, read without importing or parsing its file."""
    text = (Path(__file__).parent / f"{name}.py").read_text(encoding="utf-8")
    return re.search(rf'^def {name}\(.*?:\n    """(.+?)(?:"""|\n)', text, re.MULTILINE | re.DOTALL)[1]
