"""The section structure of a brake of a few elements: disc, pads, caliper, no bracket, no piston."""

from stages.structure import Settings

SECTION = Settings.model_validate({
    "disc": {"web_cells": 2, "ring_cells": 1, "angular_cells": 10, "damping_ratio": 0, "loss_factor": 0.002},
    "pad": {"patches_angular": 2, "patches_radial": 1, "cells_per_patch": 1, "lining_layers": 1, "contact_points": 2,
            "damping_ratio": 0, "lining_loss_factor": 0.03},
    "caliper": {"radial_cells": 1, "angular_cells": 2, "housing_cells": 1, "bridge_cells": 1, "damping_ratio": 0},
    "joints": {"loss_time": "0 us", "finger_loss_factor": 0.02}})
