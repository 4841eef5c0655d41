"""A small diagnosis and a small bench: what their views are tried on."""

from dataclasses import fields

import numpy as np

from pipeline.products import Bench, BenchRun, DiagnosedRun, Diagnosis, Follows, LatentForce, Located

TIME = np.arange(600) / 200


def changed(product, **values):
    return type(product)(**{**{f.name: getattr(product, f.name) for f in fields(product)}, **values})


def run(held_out):
    """One channel: the completed model leaves noise of 0.01, the recalibrated one a tone of 5 Hz, the nominal two."""
    random = np.random.default_rng(held_out)
    noise, truth = 0.01 * random.standard_normal((1, 600)), np.sin(2 * np.pi * 2 * TIME)[None]
    tone = 0.3 * np.sin(2 * np.pi * 5 * TIME)[None]
    return DiagnosedRun(held_out=held_out, condition=[], condition_value=[], time=TIME, measured=truth + noise,
                        valid=np.ones((1, 600), int), nominal=truth - 2 * tone, recalibrated=truth - tone,
                        completed=truth, noise=[0.01], error=[0.6, 0.3, 0.014, 0.014])


def diagnosis(verdict="missing", **values):
    """Coulomb friction at the guide among three hypotheses, found in two runs."""
    place = Located(item=["guide", "arm"], low=[0, 0], high=[0, 0], unit="", score=[9.0, 1.0], p_value=[0.001, 0.8],
                    member=[1, 0])
    amplitude = Located(item=["small", "large"], low=[0, 1e-3], high=[1e-3, 5e-3], unit="m", score=[-1.0, 5.0],
                        p_value=[1.0, 0.01], member=[0, 1])
    x = 1e-3 * np.sin(TIME)
    given = {
        "verdict": verdict, "reason": ["Coulomb_at guide: posterior 0.97"],
        "other_machine": "", "failure": "", "runs_differ": "", "family": "", "model_error": 1.0, "in_part": 0,
        "channel": ["position"], "channel_unit": ["m"],
        "named": [1] if verdict in ("missing", "sensor", "numerics") else [1, 2] if verdict == "tie" else [],
        "known": [], "leading": [], "leading_takes": [], "leading_stays": [], "leading_values": [],
        "noise_level": [0.5, 2.0], "noise_verdict": [verdict, verdict], "noise_named": ["", ""],
        "left_floors": 1.01, "left_sentence": "", "left_candidate": "",
        "hypothesis": ["nothing missing", "coulomb at guide", "quadratic_damping at arm",
                       "sensor_gain at position"],
        "effect": ["", "coulomb", "quadratic_damping", "sensor_gain"],
        "place": ["", "guide", "arm", "position"], "contacts": ["", "", "", ""],
        "kind": ["physics", "physics", "physics", "sensor"],
        "stage": ["", "friction", "structure", "measurement"],
        "posterior": [0.01, 0.97, 0.015, 0.005], "score": [0, 9.0, 3.0, 1.0], "p_value": [1, 0.0005, 0.02, 0.6],
        "power": [0, 12.0, 4.0, 2.0], "evidence_gain": [0, 40.0, 3.0, 0.0], "refitted": [0, 1, 1, 0],
        "held_out_error": [0.0, 1.2, 0.0, 0.0], "combination": ["coulomb at a + cubic_stiffness at a"],
        "combination_gain": [12.0], "combination_refitted": [1], "combination_objective": [120.0],
        "combination_held_out": [1.1], "combination_outcome": ["coulomb at a adds an evidence of 1.0 nat"],
        "combination_left": [0.11], "combination_values": ["coulomb at a.force 0.19 N"], "leading_set": [],
        "objection": ["", "", "its sign cannot be", ""],
        "parameter": ["joints.guide.damping", "coulomb@guide.force"], "parameter_unit": ["N s/m", "N"],
        "parameter_nominal": [200.0, 0.0], "parameter_value": [215.0, 20.4], "parameter_std": [4.0, 0.3],
        "completed_step": 0.0,
        "start_run": [], "start_quantity": [], "start_unit": [], "start_value": [], "start_std": [],
        "parameter_owner": [0, 1], "parameter_factor": [0, 0],
        "fit": [[0.6, 0.3, 0.014, 0.014], [0.6, 0.3, 0.015, 0.014]],
        "unexplained_share": 0.01, "drift_p_value": 0.2,
        "location": {"place": place, "amplitude": amplitude}, "latent_place": "guide",
        "latent_sentence": "At guide a force of 3 N root mean square is missing.",
        "latent": {"bang": LatentForce(time=TIME, force=3 * np.sign(x), std=np.ones(600), displacement=x,
                                    velocity=1e-3 * np.cos(TIME))},
        "follows": {name: Follows(share=0.8, p_value=0.001, unit=unit, centre=[-1e-3, 1e-3], curve=[-3, 3])
                 for name, unit in (("displacement", "m"), ("velocity", "m/s"))},
        "latent_use": "", "latent_term": [], "latent_coefficient": [], "latent_unit": [], "latent_predicted": {},
        "squeal": {},
        "next_condition": ["level = 8 N"], "next_separates": ["coulomb at guide", "quadratic_damping at arm"],
        "next_value": 3.2, "threshold": ["decision.posterior", "poles.delay_std"], "threshold_value": [0.9, 1e-6],
        "threshold_unit": ["1", "s"], "threshold_meaning": ["posterior of the named set", "least deviation of a delay"],
        "runs": {"bang": run(0), "pulses": run(1)}}
    return Diagnosis(**{**given, **values})


def bench():
    """Two runs of one channel, predicted with 20 % error in the second."""
    wave = np.sin(TIME)[None]
    runs = {name: BenchRun(time=TIME, measured=wave, predicted=share * wave, valid=np.ones((1, 600), int),
                           error=[1 - share], root_mean_square=[0.7 * (1 - share)])
            for name, share in (("first", 1.0), ("second", 0.8))}
    return Bench(settings="{}", channel=["position"], unit=["m"], runs=runs)
