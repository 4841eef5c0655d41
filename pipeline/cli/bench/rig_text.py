"""The commented YAML of a first case of recorded files."""

import os
from pathlib import Path

import numpy as np

from pipeline.cli.bench.rig import quasi_static
from pipeline.contract.units import in_si

#: what comments say where a file cannot
_CURRENT = "the motor constant in N m/A (servo motors .02 to 2) times the gear ratio; of a linear drive in N/A"
_COUNTS = "factor: 2 pi over the counts of a turn (4096: 0.001534); of a linear scale m per count"
_HEAD = """# {title}: a first case of recorded files. Every line with <- holds a value that only you know; those written
# here are typical, or least squares over these runs, so that it runs as it stands:
#   brakechain check {file}      in seconds: what these runs can tell
#   brakechain run {file}        the diagnosis
# Signs and channels: docs/what_to_record.md. All settings: brakechain schema lumped_bench
chain: lumped_bench
title: {title}
"""
_INFERRED = 'origin: inferred, source: "least squares over these runs"'
#: gravity in m/s^2, and how near a constant acceleration is taken for it
_GRAVITY, _LIKE_GRAVITY = 9.81, 0.3
#: by how much a zero of a force may be off, of its size, and a weight, of itself: lengths on a video are known to that
_ZERO, _WEIGHT = 0.5, 0.03
#: channels that a comment lists at most
_LISTED = 12


def text(rig, file):
    """The YAML of a Rig for the case ``file``."""
    bodies = _bodies(rig)
    title = Path(file).stem.replace("_", " ")
    return "\n".join([_HEAD.format(title=title, file=file), *_recording(rig, Path(file)), "", *_lumped(rig, bodies), "",
                      *_bench(rig, bodies), "", *_diagnosis(rig, bodies)]) + "\n"


def _bodies(rig):
    turning = [s.meaning.turns for s in rig.roles.responses]
    stem = "shaft" if all(turning) else "body"
    return [stem] if len(turning) == 1 else [f"{stem}_{k + 1}" for k in range(len(turning))]


def _turns(rig):
    return [s.meaning.turns for s in rig.roles.responses]


def _used(rig):
    roles = rig.roles
    return {s.name: s for s in (*roles.responses, *(s for s, _ in roles.drives), *([roles.base] if roles.base else []))}


def _recording(rig, file):
    lines = ["recording:", *(f"  # {remark}" for remark in dict.fromkeys(rig.remarks)), "  files:"]
    columns = None
    for contents, runs, how in zip(rig.files, rig.runs, rig.how, strict=True):
        if not runs:
            continue
        lines += [f"    - kind: {contents.kind}", f"      file: {_quoted(_beside(contents.path, file))}"]
        if contents.kind == "uff":
            lines.append(f"      run: {contents.settings['run']}")
            continue
        if contents.kind == "hdf5":
            continue
        lines += [f"      {key}: {_quoted(value)}{_rate_remark(key, contents)}"
                  for key, value in contents.settings.items()]
        if columns is None:
            columns = {name: s.column for name, s in _used(rig).items()}
            lines += ["      columns: &columns", *_columns(rig)]
            lines += _left_out(rig)
        else:
            lines.append("      columns: *columns")
        stretches = [f"        {name}: {{{', '.join(f'{k}: {v}' for k, v in setting.items())}}}"
                     for name, setting in runs.items()]
        lines += [f"      runs:                              # {how}; name them after what was done", *stretches]
    return lines


def _rate_remark(key, contents):
    return "   # <- the sampling rate of the record" if key == "sample_rate" and "time" not in contents.settings else ""


def _columns(rig):
    lines, drives = [], {s.name for s, _ in rig.roles.drives} | ({rig.roles.base.name} if rig.roles.base else set())
    for name, s in _used(rig).items():
        m, parts = s.meaning, [f"column: {_quoted(s.column)}"]
        unit, note = m.unit, ""
        if m.measures == "counts":
            note = f"   # <- {_COUNTS}"
            parts += ["unit: rad", "factor: 0.001534"]
        else:
            parts.append(f"unit: {_quoted(unit)}")
            if not m.stated:
                note = f"   # <- the file states no unit: write yours; {_others(m)}"
        parts.append(f"measures: {_measures(m)}")
        if name in drives:
            parts.append("role: excitation")
        if rig.roles.guessed:
            note = "   # <- CHECK: neither name nor unit tells what it measures"
        lines.append(f"        {name}: {{{', '.join(parts)}}}{note}")
    return lines


def _measures(m):
    return {"counts": "angle", "strain": "strain", "stress": "stress"}.get(m.measures, m.measures or "value")


def _others(m):
    return {"angle": "rad, deg or rev", "displacement": "m, mm or um", "force": "N or kN", "torque": "N m or mN m",
            "current": "A or mA", "velocity": "m/s or rad/s", "acceleration": "m/s^2 or g", "stress": "MPa or Pa",
            "strain": "1 or %", "voltage": "V or mV"}.get(m.measures, "or 1")


def _left_out(rig):
    left = [f"{column}: {why}" for column, why in rig.roles.left_out.items()]
    more = [f"and {len(left) - _LISTED} more"] if len(left) > _LISTED else []
    return ["      # left out", *(f"      #   {each}" for each in left[:_LISTED] + more)] if left else []


def _lumped(rig, bodies):
    """Section of the model: a mass a response, springs, inputs, sensors."""
    turns, v, roles = _turns(rig), rig.values, rig.roles
    names = [f"{b}.{'rotation' if t else 'x'}" for b, t in zip(bodies, turns, strict=True)]
    still = quasi_static(rig)
    own_mass = np.diag(v.mass) - [sum(abs(v.mass[k, j]) for j in range(len(bodies)) if j != k)
                                  for k in range(len(bodies))]
    own_mass = np.where(own_mass > 0.05 * np.diag(v.mass), own_mass, np.maximum(0.05 * np.diag(v.mass), 1e-9))
    assumed = not roles.drives
    lines = ["lumped:", "  masses:"]
    for k, body in enumerate(bodies):
        kind, unit = ("inertia", "kg m^2") if turns[k] else ("mass", "kg")
        value = 1.0 if assumed and not turns[k] else own_mass[k]
        move, what = ("rotation", "moment of inertia about the axis") if turns[k] else ("x", "moving mass")
        if _massless(rig, k):
            why = "without a time nothing is accelerated" if still else f"<- {what}: these runs tell none"
            lines.append(f"    {body}: {{moves: [{move}]}}   # {why}")
            continue
        origin = 'origin: assumed, source: "a scale: without a force only ratios count"' if assumed else _INFERRED
        lines.append(f"    {body}: {{{kind}: {{value: {value:.4g} {unit}, {origin}}}, moves: [{move}]}}   # <- {what}")
    couplings = [(i, j) for i in range(len(bodies)) for j in range(i) if v.mass[i, j] and not assumed]
    if couplings:
        lines.append("  inertias:                              # masses that several coordinates move")
        for i, j in couplings:
            sign = 1 if v.mass[i, j] > 0 else -1
            kind, unit = ("inertia", "kg m^2") if turns[i] else ("mass", "kg")
            value = f"{{value: {abs(v.mass[i, j]):.4g} {unit}, {_INFERRED}}}"
            lines.append(f"    coupling_{j + 1}{i + 1}: {{along: {{{names[j]}: 1, {names[i]}: {sign}}}, {kind}:"
                         f" {value}}}   # <- what both move")
    lines.append("  springs:")
    for k, name in enumerate(names):
        lines.append(_spring(_joint(bodies, turns, k), f"between: [{name}, ground]", _held(v, k), _damping(rig, k),
                             turns[k], still))
    if rig.roles.base is not None:     # laws are looked for at joints whose far end stands still
        lines.append(_spring("surroundings", f"between: [{names[0]}, ground]", 0.0, _damping(rig, 0), turns[0], still))
    lines += [_spring(name, f"between: [{names[j]}, {names[i]}]" if v.stiffness[i, j] < 0 else
                      f"along: {{{names[j]}: 1, {names[i]}: 1}}", abs(v.stiffness[i, j]), None, turns[i], still)
              for name, i, j in _links(v)]
    if any(turns):
        lines.append(f"  # pendulums: {{gravity: {{swings: {{{names[0]}: 1}}, mass: 0.5 kg, length: 0.2 m}}}}"
                     "   # <- where a weight hangs on the axis")
    lines += _inputs(rig, bodies, names, turns) + ["  sensors:"]
    for k, s in enumerate(roles.responses):
        quantity = ("displacement", "velocity", "acceleration")[roles.order]
        unit = ("m", "m/s", "m/s^2")[roles.order]
        weight = "1 m" if turns[k] else "1"
        lines.append(f"    {s.name}: {{along: {{{names[k]}: {weight}}}, quantity: {quantity}, unit: {unit}}}"
                     + ("   # an angle: what a radius of 1 m shows" if turns[k] else ""))
    return lines


def _joint(bodies, turns, k):
    stem = "bearing" if turns[k] else "support"
    return stem if len(bodies) == 1 else f"{stem}_{k + 1}"


def _massless(rig, k):
    """Whether a coordinate of a balance has no mass: loops without a time, or records that tell none."""
    return rig.balance and not rig.values.mass[k, k] > 0


def _held(values, k):
    """Stiffness of a support: what couplings do not carry."""
    return 2 * values.stiffness[k, k] - np.abs(values.stiffness[k]).sum()


def _links(values):
    """[(name, i, j)] of the springs that couple coordinates: along their difference, or their sum."""
    return [(f"link_{j + 1}{i + 1}", i, j) for i in range(len(values.stiffness)) for j in range(i)
            if values.stiffness[i, j]]


def _damping(rig, k):
    """Damping of a support: as fitted, else a hundredth of what carries it; none of what falls."""
    v = rig.values
    if _falls(rig):
        return None
    if v.damping[k] > 0:
        return float(v.damping[k])
    stiff, mass = max(v.stiffness[k, k], 0.0), v.mass[k, k]
    return float(0.02 * np.sqrt(stiff * mass)) if stiff > 0 and mass > 0 else 0.01 * max(mass, 1e-6)


def _spring(name, ends, stiffness, damping, turns, still):
    kind = ("torsional_stiffness", "torsional_damping", "N m/rad", "N m s/rad") if turns else (
        "stiffness", "damping", "N/m", "N s/m")
    parts = [ends]
    if stiffness > 0:
        parts.append(f"{kind[0]}: {{value: {stiffness:.4g} {kind[2]}, {_INFERRED}}}")
    if damping is not None and not still:
        parts.append(f"{kind[1]}: {{value: {damping:.4g} {kind[3]}, {_INFERRED}}}")
    return f"    {name}: {{{', '.join(parts)}}}   # <- what holds it, without what you look for"


def _falls(rig):
    """Whether nothing but a constant force acts: no spring, no input."""
    return not rig.roles.drives and rig.roles.base is None and not rig.values.stiffness.any()


def _weights(rig):
    """{index of a coordinate: constant force on it} where nothing else acts; that of a fall is its weight."""
    if rig.roles.drives or rig.roles.base is not None:
        return {}
    forces = {k: -float(force) for k, force in enumerate(rig.values.constant) if force}
    return {k: float(np.sign(force)) * _GRAVITY if _falls(rig) and not _turns(rig)[k] and
            abs(abs(force) / _GRAVITY - 1) < _LIKE_GRAVITY else force for k, force in forces.items()}


def _inputs(rig, bodies, names, turns):
    """Lines of the inputs: what acts, a base that moves, a constant force."""
    roles, lines = rig.roles, []
    for signal, k in roles.drives:
        unit = "torque: 1 N m" if turns[k] else "force: 1 N"
        sign = -1 if rig.values.reversed[k] else 1
        note = "-1 by these runs: the motion needs the opposite" if sign < 0 else "-1: it acts against the motion shown"
        lines.append(f"    {signal.name}: {{along: {{{names[k]}: {sign}}}, {unit}}}   # <- {note}")
    if roles.base is not None:
        lines.append(f"    {roles.base.name}: {{displaces: {_joint(bodies, turns, 0)}, "
                     + ("angle: 1 rad}" if turns[0] else "displacement: 1 m}"))
    lines += [f"    weight_{k + 1}: {{along: {{{names[k]}: 1}}, {'torque: 1 N m' if turns[k] else 'force: 1 N'}}}"
              "   # constant: see bench.corrections" for k in _weights(rig)]
    return ["  inputs:", *lines] if lines else []


def _bench(rig, bodies):
    roles, v, turns = rig.roles, rig.values, _turns(rig)
    lines = ["bench:"]
    if rig.balance:
        lines += ["  forward: equation                      # measured motions are put into the equation of motion",
                  f"  equation: {{corner: {v.corner:g} Hz, decimation: {v.decimation}, trim: {v.trim}}}"
                  "   # corner: up to where the motion stands out of its noise" if not quasi_static(rig) else
                  "  # without a time nothing is filtered"]
    else:
        step = min(1 / (2 * roles.responses[0].rate), 2 * np.pi / v.fastest / 40 if v.fastest > 0 else np.inf)
        lines.append(f"  step: {1e3 * step:.3g} ms                          # of the time integration: 40 a period")
        if rig.start:
            lines.append("  start: fitted                          # runs begin in motion; rest: at rest")
    offsets = [f"inputs.weight_{k + 1}.offset: {force:.4g} {'N m' if turns[k] else 'N'}"
               for k, force in _weights(rig).items()]
    units = {s.name: "rad" if turn else "m" for s, turn in zip(roles.responses, turns, strict=True)}
    if rig.zeros and not offsets:
        zeros = ", ".join(f"channels.{name}.offset: {value:.6g} {units[name]}" for name, value in rig.zeros.items())
        lines.append(f"  corrections: {{{zeros}}}   # <- where it is in equilibrium")
    if offsets:
        lines.append(f"  corrections: {{{', '.join(offsets)}}}"
                     "   # <- weight = mass x 9.81 m/s^2, - where the channel counts upwards")
    lines.append("  channels:")
    for k, s in enumerate(roles.responses):
        quantity = ("displacement", "velocity", "acceleration")[roles.order]
        shown = in_si(1.0, "rad" if s.meaning.measures == "counts" else s.meaning.unit, s.column)[1]
        wanted = (("m", "m/s", "m/s^2"), ("rad", "rad/s", "rad/s^2"))[turns[k]][roles.order]
        gain = "" if shown == wanted else ", gain: 1"
        note = "" if not gain else "   # <- its units per SI unit of the motion: 1, where a bar of 1 m strains" if (
            s.meaning.measures == "strain") else f"   # <- gain: {shown} per {wanted}"
        lines.append(f"    {s.name}: {{quantity: {quantity}, source: {s.name}{gain}}}{note}")
    fed = [(s, k) for s, k in roles.drives] + ([(roles.base, 0)] if roles.base else [])
    lines += ["  inputs:"] if fed else []
    for s, k in fed:
        shown = in_si(1.0, s.meaning.unit, s.column)[1]
        wanted = ("m" if not turns[k] else "rad") if s is roles.base else "N m" if turns[k] else "N"
        gain = "" if shown == wanted else ", gain: 1"
        note = "" if not gain else f"   # <- gain: {_CURRENT}" if s.meaning.measures == "current" else (
            "   # <- the area in m^2: 1, where a bar of 1 m^2 is pulled" if s.meaning.measures == "stress" else
            f"   # <- gain: {wanted} per {shown}")
        hold = ", hold: band_limited" if v.coarse and not rig.balance else ""
        lines.append(f"    {s.name}: {{channel: {s.name}{gain}{hold}}}{note}")
    return lines


def _diagnosis(rig, bodies):
    roles, v, turns, still = rig.roles, rig.values, _turns(rig), quasi_static(rig)
    lines = ["diagnosis:", "  parameters:                            # what may be off: spread .2 = by about 20 %"]
    free = not roles.drives
    for k, body in enumerate(bodies):
        joint = _joint(bodies, turns, k)
        if not free and not _massless(rig, k):
            lines.append(f"    masses.{body}: {{spread: 0.3}}" if len(bodies) == 1 else
                         f"    bodies.{body}.mass: {{spread: 0.3}}")
        if _held(v, k) > 0:
            lines.append(f"    joints.{joint}.stiffness: {{spread: 0.2}}")
        if not still and not _falls(rig):
            lines.append(f"    joints.{joint}.damping: {{spread: 0.7}}")
    lines += [f"    joints.{name}.stiffness: {{spread: 0.2}}" for name, _, _ in _links(v)]
    lines += ["    joints.surroundings.damping: {spread: 1.0}"] if roles.base is not None else []
    for k, force in _weights(rig).items():
        std = f"{_WEIGHT * abs(force):.2g} {'N m' if turns[k] else 'N'}"
        lines.append(f"    inputs.weight_{k + 1}.offset: {{prior: normal, std: {std}}}")
    for signal, k in roles.drives:
        unit = "N m" if turns[k] else "N"
        lines.append(f"    inputs.{signal.name}.offset: {{prior: normal, std: {_ZERO * v.size[k]:.2g} {unit}}}"
                     "   # a zero that is off, a constant force")
    if rig.held_out:
        lines.append(f"  held_out: [{rig.held_out}]   # <- never fitted: best another amplitude or another signal")
    else:
        lines.append("  # held_out: [RUN]                      # <- one run verifies nothing: record another")
    lines.append("  # nuisances: [loads, zeros, drifts]    # weights and zeros that nobody stated, where the data ask")
    lines += ["  noise:", "    std:                                 # <- of the sensor, or spread of repeats"]
    if rig.balance:
        lines += [f"      force on {body}: {{value: {v.noise[k]:.2g} N, {_NOISE}}}"
                  for k, body in enumerate(bodies)]
    else:
        lines += [f"      {s.name}: {{value: {_noise_text(s, rig.noise[s.name])}, {_NOISE}}}" for s in roles.responses]
    lines.append("  # effects: [coulomb, cubic_stiffness]  # a few of the catalogue are quicker than all of it")
    return lines


_NOISE = 'origin: inferred, source: "differences of neighbours in these runs"'


def _noise_text(signal, value):
    unit = in_si(1.0, "rad" if signal.meaning.measures == "counts" else signal.meaning.unit, signal.column)[1]
    return f"{value:.2g}" + (f" {unit}" if unit != "1" else "")


def _quoted(value):
    plain = str(value)
    return f'"{plain}"' if any(c in plain for c in "[]{}#:,&*'\"%@!|>") or plain != plain.strip() or (
        plain.replace(".", "", 1).isdigit()) or plain in ("y", "n", "on", "off") else plain


def _beside(path, file):
    """A path from the folder of the case, where it lies below; else the whole one."""
    whole, folder = Path(path).resolve(), Path(file).resolve().parent
    return os.path.relpath(whole, folder) if whole.is_relative_to(folder) else str(whole)
