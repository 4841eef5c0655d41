"""Random small benches with recordings, as a case and a file: anything that the docs allow, and some that they do not.

A chain of one to three coordinates, driven, led, tapped or free, integrated here alone, under laws that are hidden or
not; runs, lengths, rates, channels, starts, forms and sections of a case are drawn.
"""

import h5py
import numpy as np
import yaml

#: integration steps per sample
_FINER = 8
#: effects that a chain can have, by what they act on
JOINT = ("coulomb", "joint_damping", "asymmetric_friction", "cubic_stiffness", "quadratic_stiffness",
         "quadratic_damping", "hysteretic_joint", "bouc_wen", "backlash", "compliant_arm", "moving_base", "base_shake",
         "thermal_softening", "viscoelastic_pad", "shim_damping", "logarithmic_friction", "rate_state_ageing",
         "rate_state_slip", "parametric_stiffness", "dahl", "jenkins", "lugre", "series_stiffness", "stribeck_joint",
         "position_friction")
OTHER = ("attached_mass", "added_stiffness", "sensor_gain", "sensor_delay", "sensor_offset_drift", "clipping",
         "pressure_ripple", "hydraulic_compliance", "tuned_absorber", "second_mode", "impact", "reversed_channel",
         "swapped_channels", "unit_factor")
UNIT = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s^2"}
_LAWS = {"none": lambda x, v: 0.0, "coulomb": lambda x, v: np.tanh(v / 0.02), "cubic": lambda x, v: x**3 * 10,
         "drag": lambda x, v: v * abs(v), "hysteresis": lambda x, v: np.tanh(v / 0.05) * (1 + abs(x))}


class Bench:
    """One random bench; ``document`` is its case, ``runs`` {name: {channel: (samples, unit, quantity)}}."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.kind = self._one("force", "force", "force", "base", "base", "free", "free", "tap", "course", "poles")
        self.size = int(self._one(1, 1, 1, 2, 2, 3))
        self.turns = self.size == 1 and self.kind in ("force", "free") and self._if(0.2)
        self.frequency = float(self.rng.uniform(1, 6))
        self.rate = float(np.round(self.frequency * self.rng.uniform(8, 40)))
        self.names = [f"m{k}" for k in range(self.size)]
        self.mass = self.rng.uniform(0.3, 3, self.size)
        self.stiffness = self.mass * (2 * np.pi * self.frequency * self.rng.uniform(0.7, 2, self.size))**2
        self.damping = self.rng.uniform(0.005, 0.1, self.size) * 2 * np.sqrt(self.stiffness * self.mass)
        self.law, self.share = self._one(*_LAWS), 10 ** self.rng.uniform(-2, 0)
        self.lengths = [self._length() for _ in range(int(self._one(1, 2, 2, 3, 3, 4, 5)))]
        self.names_of_runs = [f"run_{k}" for k in range(len(self.lengths))]
        self.noise = 10 ** self.rng.uniform(-4, -1)
        self.courses, self.repeats, self.runs = {}, {}, {}
        if self.kind == "poles" and self._if(0.9):      # seen in two records each
            self.lengths = [max(n, 400) for n in self.lengths[:1]] * 2
            self.names_of_runs, self.repeats = ["run_0", "run_1"], {"run_1": "run_0"}
        self._record()
        self.document = self._case()

    def _one(self, *choices):
        return choices[int(self.rng.integers(len(choices)))]

    def _if(self, chance):
        return bool(self.rng.random() < chance)

    def _some(self, items, most):
        count = int(self.rng.integers(0, most + 1))
        return [str(each) for each in self.rng.permutation(list(items))[:count]]

    def _length(self):
        return int(self.rng.integers(*self._one((4, 40), *[(40, 120)] * 7, (120, 300))))

    # ---- the recording

    def _record(self):
        quantities = [self._one("displacement", "displacement", "velocity", "acceleration") for _ in self.names]
        if self._if(0.3):
            quantities = ["displacement"] * self.size
        missing = set(self._some(self.names, self.size - 1)) if self._if(0.25) else set()
        self.sensors = {n: q for n, q in zip(self.names, quantities, strict=True) if n not in missing}
        self.scale = {}
        for name, length in zip(self.names_of_runs, self.lengths, strict=True):
            fed, motion = self._motion(name, length)
            channels = {}
            for k, sensor in enumerate(self.names):
                if sensor not in self.sensors:
                    continue
                clean = motion[self.sensors[sensor]][:, k]
                size = self.scale.setdefault(sensor, float(np.std(clean)) or 1.0)
                unit = self._unit(self.sensors[sensor])
                channels[sensor] = [clean + self.noise * size * self.rng.standard_normal(length),
                                    unit, self.sensors[sensor]]
            if fed is not None:
                channels["fed"] = [fed, {"base": "m"}.get(self.kind, "N m" if self.turns else "N"), ""]
            self.runs[name] = channels
        self._spoil()

    def _unit(self, quantity):
        return UNIT[quantity].replace("m", "rad", 1) if self.turns else UNIT[quantity]

    def _spoil(self):
        """What should not be: copies, constants, noise alone, lost samples, runs without a channel, other units."""
        everyone = [(run, c) for run, channels in self.runs.items() for c in channels]
        for run, name in everyone:
            channel = self.runs[run][name]
            if name != "fed" and self._if(0.05):
                channel[0] = channel[0].copy()
                channel[0][self.rng.random(len(channel[0])) < self._one(0.02, 0.02, 0.1, 0.3, 0.3, 0.8)] = np.nan
            if self._if(0.02):
                channel[0] = np.zeros(len(channel[0])) + self._one(0.0, 1.0)
            if self._if(0.02):
                channel[0] = self.rng.standard_normal(len(channel[0])) * float(np.nanstd(channel[0]) or 1.0)
            if self._if(0.01):
                channel[1] = self._one("mm", "g", "V", "kN", "deg", "m")
        if len(self.sensors) > 1 and self._if(0.08):     # one channel a copy of another
            first, second = list(self.sensors)[:2]
            self.sensors[second] = self.sensors[first]
            for channels in self.runs.values():
                channels[second] = list(channels[first])
        if len(self.runs) > 1 and len(self.sensors) > 1 and self._if(0.08):
            self.runs[self.names_of_runs[-1]].pop(list(self.sensors)[-1])
        if len(self.runs) > 1 and not self.repeats and self._if(0.15):
            self.repeats = {self.names_of_runs[1]: self.names_of_runs[0]}

    def _motion(self, name, length):
        """(what was fed (n,) or None, {quantity: (n, size)}) of one run."""
        time = np.arange(length) / self.rate
        fed, base, start, level = None, None, np.zeros((2, self.size)), float(self.rng.uniform(0.3, 3))
        if self.kind == "force":
            fed = level * self._excitation(time) * self.stiffness[0] * 0.01 * (0 if self._if(0.03) else 1)
        elif self.kind == "base":
            base = fed = level * self._excitation(time) * 0.01
        elif self.kind == "course":
            instants = np.sort(self.rng.choice(np.arange(0.0, max(time[-1], 0.1), 0.05), 2, replace=False))
            speeds = self.rng.choice([0.001, 0.003, 0.01, -0.005], 2)
            self.courses[name] = {"at": [f"{t:.3f} s" for t in instants], "speed": [f"{v} m/s" for v in speeds]}
            base = np.maximum(time[:, None] - instants, 0) @ np.diff(speeds, prepend=0.0)
        else:
            if self.kind == "tap":
                blow = np.zeros(length)
                blow[min(4, length - 1):min(7, length)] = level * 0.05 * self.stiffness[-1]
                return None, self._integrated(time, blow, np.zeros(length), start)
            start = 0.02 * level * self.rng.standard_normal((2, self.size)) * [[1], [2 * np.pi * self.frequency]]
        return fed, self._integrated(time, np.zeros(length) if fed is None or base is not None else fed,
                                     np.zeros(length) if base is None else base, start)

    def _excitation(self, time):
        kind = self._one("sine", "sweep", "noise", "step")
        if kind == "sine":
            return np.sin(2 * np.pi * self.frequency * self.rng.uniform(0.3, 2) * time)
        if kind == "sweep":
            return np.sin(2 * np.pi * (0.3 + self.frequency * time / max(time[-1], 0.1)) * time)
        if kind == "step":
            return (time > time[-1] / 3) * 1.0
        return np.convolve(self.rng.standard_normal(len(time)), np.hanning(7) / 3, "same")

    def _integrated(self, time, force, base, start):
        off = 1 + 0.2 * self.rng.standard_normal(2)
        stiffness, damping = self.stiffness * abs(off[0]), self.damping * abs(off[1])
        hidden, typical = _LAWS[self.law], 0.02 * self.stiffness[0] * self.share
        x, v, step = start[0].copy(), start[1].copy(), 1 / self.rate / _FINER
        rows = {quantity: np.zeros((len(time), self.size)) for quantity in UNIT}
        for i in range(len(time)):
            for _ in range(_FINER):
                elongation, closing = x.copy(), v.copy()
                elongation[0] -= base[i]
                elongation[1:] -= x[:-1]
                closing[1:] -= v[:-1]
                joint = stiffness * elongation + damping * closing
                joint[0] += typical * hidden(elongation[0] / 0.02, v[0])
                total = -joint
                total[:-1] += joint[1:]
                total[-1] += force[i]
                a = total / self.mass
                v = v + step * a
                x = x + step * v
            for quantity, row in zip(UNIT, (x, v, a), strict=True):
                rows[quantity][i] = np.clip(row, -1e6, 1e6)
        return rows

    # ---- the case

    def _case(self):
        case = {"chain": "lumped_bench", "title": "Random", "lumped": self._lumped(), "bench": self._bench(),
                "recording": {"files": [{"kind": "hdf5", "file": "recording.h5"}]}}
        if self._if(0.1 if case["bench"].get("forward") != "equation" else 0.03):
            case["effects"] = {"cubic_stiffness": {"spring_0": {"coefficient": "100 N/m^3"}}}
        case["diagnosis"] = self._diagnosis(case["bench"])
        return case

    def _lumped(self):
        move, per = ("rotation", "torsional_") if self.turns else ("x", "")
        units = ("N m/rad", "N m s/rad") if self.turns else ("N/m", "N s/m")
        coordinate = [f"{n}.{move}" for n in self.names]
        masses = {n: ({"inertia": f"{m:.5g} kg m^2"} if self.turns else {"mass": f"{m:.5g} kg"}) | {"moves": [move]}
                  for n, m in zip(self.names, self.mass, strict=True)}
        springs = {f"spring_{k}": {
            "between": [coordinate[k], coordinate[k - 1] if k else "ground"],
            f"{per}stiffness": f"{self.stiffness[k]:.5g} {units[0]}",
            f"{per}damping": f"{self.damping[k]:.5g} {units[1]}"} for k in range(self.size)}
        if self._if(0.1):
            springs["face"] = {"between": [coordinate[0], "ground"], f"{per}damping": f"0.01 {units[1]}"}
        inputs = {}
        if self.kind == "force":
            inputs = {"push": {"along": {coordinate[-1]: 1}} | (
                {"torque": "1 N m"} if self.turns else {"force": "1 N"})}
        elif self.kind in ("base", "course"):
            inputs = {"base": {"displaces": "spring_0", "displacement": "1 m"}}
        elif self.kind == "tap":
            inputs = {"hammer": {"along": {coordinate[-1]: 1}, "force": "1 N"}}
        sensors = {n: {"along": {c: "1 m" if self.turns else 1}, "quantity": "displacement", "unit": "m"}
                   for n, c in zip(self.names, coordinate, strict=True)}
        return {"masses": masses, "springs": springs, "sensors": sensors} | ({"inputs": inputs} if inputs else {})

    def _bench(self):
        bench = {"step": f"{1000 / self.rate / self._one(1, 1, 2, 3):.5g} ms", "channels": {
            n: {"quantity": q, "source": n} for n, q in self.sensors.items()}}
        if self.kind in ("force", "base"):
            bench["inputs"] = {"push" if self.kind == "force" else "base": {"channel": "fed"}}
            if self._if(0.2):
                next(iter(bench["inputs"].values()))["hold"] = self._one("linear", "step", "band_limited")
        if self.kind == "course":
            bench["courses"] = {"base": self.courses}
        if self.kind == "tap" and self._if(0.8):
            bench["blow"] = "hammer"
        if self.kind == "poles":
            bench["poles"] = {"low": f"{0.2 * self.frequency:.4g} Hz", "high": f"{0.45 * self.rate:.4g} Hz"}
        elif (len(self.sensors) == self.size and all(q == "displacement" for q in self.sensors.values())
              and self._if(0.5 if "inputs" in bench else 0.03)):
            bench["forward"] = "equation"
            if self._if(0.6):
                bench["equation"] = {"corner": f"{self.rate / self._one(3, 5, 10):.4g} Hz",
                                     "decimation": self._one(1, 1, 2, 4), "trim": self._one(0, 5, 30)}
        for key, chance, values in (("start", 0.2, ("rest", "fitted")), ("settled", 0.1, (True,)),
                                    ("settle", 0.1, ("100 ms", "1 s")), ("measured_start", 0.03, (True,))):
            if self._if(chance):
                bench[key] = self._one(*values)
        for channel in bench["channels"].values():
            if self._if(0.08):
                channel |= self._one({"gain": -1.0}, {"delay": "2 ms"}, {"corner": f"{self.rate / 4:.4g} Hz"},
                                     {"limit": 0.01})
        if self._if(0.05):
            bench["corrections"] = {"joints.spring_0.damping": 3.0 if self._if(0.3) else "0.4 N m s/rad" if self.turns
                                    else "0.4 N s/m"}
        return bench

    def _diagnosis(self, bench):
        names = [*(f"joints.spring_{k}.{what}" for k in range(self.size) for what in ("stiffness", "damping")),
                 *(f"masses.{n}" for n in self.names), *(f"channels.{c}.gain" for c in self.sensors)]
        if self.kind == "force":
            names += ["inputs.push.offset", "inputs.push.gain"]
        asked = {"parameters": {name: self._prior(name) for name in self._some(names, 3)}, "kept": self._one(1, 1, 2),
                 "draws": 200, "effects": [*self._some(JOINT, 2), *self._some(OTHER, 1)] or ["coulomb"]}
        if self.kind == "poles":
            asked |= {"forward": "poles"}
        held_out = self._some(self.names_of_runs, min(2, len(self.names_of_runs) - (not self._if(0.03))))
        asked |= {"held_out": held_out} if held_out and self.kind != "poles" else {}
        noise = {}
        if self._if(0.92 - 0.5 * bool(self.repeats)):
            std = {c: max(self.noise * self.scale[c], 1e-12) * self._one(1, 1, 1, 0.3, 3) for c in self.sensors}
            if "forward" in bench:
                std = {f"force on {n}": 0.02 * float(self.stiffness[0]) * self.noise for n in self.names}
            unit = "N m" if self.turns else "N"
            noise["std"] = {c: f"{s:.4g} {unit if 'forward' in bench else self._unit(self.sensors[c])}"
                            for c, s in std.items()}
        if self._if(0.1):
            noise["above"] = f"{0.3 * self.rate:.4g} Hz"
        if self._if(0.1):
            noise["levels"] = [0.1, 10.0]
        asked |= {"noise": noise} if noise else {}
        for key, chance, value in (
                ("solver", 0.4, False), ("seed", 0.1, 3),
                ("latent_force", 0.3 if "held_out" in asked and "forward" not in bench else 0.01, {"predict": True}),
                ("time", 0.3, self._one("1 s", "5 s", "20 s")),
                ("without", 0.1, ["lugre"]), ("places", 0.1, ["spring_0"]), ("kept", 0.02, 8),
                ("priors", 0.1, {"coulomb.force": {"prior": "half_normal", "std": "1 N"}}),
                ("next", 0.15, {"joints.spring_0.stiffness": [2.0]}),
                ("plan", 0.05, {"runs": {"p": {"duration": "1 s", "sample_rate": f"{self.rate:g} Hz"}}})):
            if self._if(chance):
                asked[key] = value
        return asked

    def _prior(self, name):
        if name.endswith("offset"):
            return {"prior": "normal", "std": "0.1 N m" if self.turns else "0.1 N"}
        return {"spread": float(self._one(0.02, 0.2, 1.0))} if not name.endswith("gain") or self._if(0.5) else {
            "prior": "uniform", "low": 0.5, "high": 2.0}

    def write(self, folder):
        """Write case.yaml and recording.h5."""
        with h5py.File(folder / "recording.h5", "w") as h5:
            for name, channels in self.runs.items():
                group = h5.create_group(f"runs/{name}")
                group.attrs["repeat_of"] = self.repeats.get(name, "")
                for key, (samples, unit, quantity) in channels.items():
                    node = group.create_dataset(f"channels/{key}", data=samples)
                    node.attrs.update(units=unit, quantity=quantity, sample_rate=self.rate)
        (folder / "case.yaml").write_text(yaml.safe_dump(self.document, sort_keys=False))
