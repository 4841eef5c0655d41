"""Command 'new': a short YAML of a brake of one's own, written from the settings and defaults of the program."""

import re
from pathlib import Path

import click

import stages
from pipeline.cli.options import options

CHAIN = "own_brake"
#: where the first words of a meaning end
_END = re.compile(r";| \(|: |, an? ")
#: what matters most, by section and part: typical values of the program, for you to replace
YOURS = {
    "structure": {
        "disc": ("ring_outer_radius", "ring_inner_radius", "ring_thickness", "bore_radius", "web_thickness", "young",
                 "density"),
        "pad": ("inner_radius", "outer_radius", "angle", "lining_thickness", "backplate_thickness",
                "lining_young_normal", "lining_young_tangential", "lining_young_radial", "lining_shear_normal",
                "lining_density"),
        "caliper": ("finger_thickness", "housing_depth", "young"),
        "bracket": ("mount_radius", "young"),
        "piston": ("diameter", "length"),
        "joints": ("abutment_stiffness", "finger_stiffness", "shim_stiffness", "guide_pin_stiffness",
                   "mount_stiffness"),
        "": ("pressures",)},
    "surface": {"disc": ("rms_height",), "pad": ("rms_height",), "": ()},
    "micro_friction": {"pad": ("youngs_modulus",), "": ("third_body_factor",)},
    "complex_modes": {"": ("speeds", "damping_speed")}}
#: what '--ask' asks for: the dimensions that every brake differs in
ASKED = ("structure.disc.ring_outer_radius", "structure.disc.ring_inner_radius", "structure.disc.ring_thickness",
         "structure.pad.lining_thickness", "structure.pad.lining_young_normal", "structure.piston.diameter",
         "structure.joints.abutment_stiffness")
#: lines at the end of a part: loss factors where the program has viscous damping, parts that are meshed, accuracy
GIVEN = {
    "structure.disc": ("damping_ratio: 0", "loss_factor: {value: 0.002, origin: assumed, source: grey cast iron}"),
    "structure.pad": ("contact_points: 2  # at the integration points of the lining", "damping_ratio: 0",
                      "lining_loss_factor: {value: 0.03, origin: assumed, source: filled resin}",
                      "backplate_loss_factor: {value: 0.01, origin: assumed, source: steel with a bonded shim}"),
    "structure.caliper": ("inner_radius: 92 mm  # leaves 6 mm of wall beside the bore of the piston; 'fixed: true':"
                          " one on both sides",
                          "damping_ratio: 0",
                          "loss_factor: {value: 0.002, origin: assumed, source: nodular cast iron}"),
    "structure.bracket": ("kind: body  # ground: pads are held on the ground", "corner_cells: 3  # small ones",
                          "loss_factor: {value: 0.002, origin: assumed, source: nodular cast iron}"),
    "structure.piston": ("kind: body  # seal: neither piston nor brake fluid; 'count: 2': twin pistons",),
    "structure.joints": ("loss_time: 0 us",
                         "abutment_loss_factor: {value: 0.05, origin: assumed, source: dry steel joint}",
                         "finger_loss_factor: {value: 0.02, origin: assumed, source: through a shim}",
                         "piston_loss_factor: {value: 0.05, origin: assumed, source: through a shim}",
                         "guide_pin_loss_factor: {value: 0.1, origin: assumed, source: rubber}",
                         "seal_loss_factor: {value: 0.1, origin: assumed, source: rubber}",
                         "mount_loss_factor: {value: 0.02, origin: assumed, source: bolted joint}"),
    "structure": ("frequency_max: 30 kHz  # half as high again as the modes sought",),
    "surface.disc": ("kind: generated  # scan, file: PATH for a scan of yours",),
    "surface.pad": ("kind: generated",),
    "surface": ("nodes: 256  # 8 per shortest wavelength", "patch_length: 2 mm", "pairs: 4"),
    "micro_friction": ("realisations: 1",), "complex_modes": ("friction_steps: 11", "smallest_correction: 3.0e-3")}
TITLES = {"structure": "bodies, joints and pressures of the pads", "surface": "roughness of the faces",
          "micro_friction": "friction of the rough faces", "complex_modes": "speed of the disc, damping of contacts"}
END = """
# accuracy: see the convergence table of the report
friction_map: {order: 2}
reduced_model: {load_patterns: [10, 6]}
limit_cycle: {speeds: middle, patch: 6}

# Values scatter: how likely is squeal? State what you know of yours under 'sources', and the answer narrows.
probability: {speeds: middle, least_growth: 10 1/s}
# What would you change, at what cost? The report puts it beside the brake as it is ('design_search' seeks it):
# countermeasures: {variants: {shim: {change: {structure.pad.backplate_loss_factor: 0.1}, cost: {mass: 0.1 kg}}}}
"""
QUICK = """# {name} on coarse grids, for a first try in minutes: no result is converged.
based_on: {name}
title: {title}, quick

surface: {{nodes: 64, patch_length: 1 mm, pairs: 1}}
micro_friction: {{cycles: 20, realisations: 2, refinement: [1], recorded_distances: [0 mm, 1 mm, 10 mm]}}
friction_map: {{order: null, pressure_subdivisions: 4, speed_subdivisions: 2, distance_subdivisions: 3}}
structure:
  pressures: [1 MPa, 3 MPa]
  disc: {{web_cells: 2, ring_cells: 5, angular_cells: 36}}
  pad: {{patches_angular: 4, patches_radial: 2, cells_per_patch: 1, lining_layers: 1}}
  caliper: {{radial_cells: 2, angular_cells: 4, housing_cells: 2, bridge_cells: 2}}
  bracket: {{element_size: 20 mm, corner_cells: 0}}
  frequency_max: 9 kHz
  free_frequency_max: 2 kHz
reduced_model: {{fixed_below: 9 kHz, residual_below: 100 kHz, load_patterns: [5, 3]}}
complex_modes: {{friction_steps: 5, frequency_max: 6 kHz}}
convergence: {{refinements: [bases]}}
limit_cycle: {{duration: 15 ms, window: 5 ms, step: 5 us, checks: []}}
probability: {{draws: 20, training: 2, checked: 1}}
report: {{dots_per_inch: 80, mode_pictures: 1}}
"""


@click.command("new")
@click.argument("name", type=click.Path(dir_okay=False, path_type=Path))
@click.option("--ask", is_flag=True, help="ask for the main dimensions; Enter keeps the typical value")
@click.option("--quick", is_flag=True, help="write NAME_quick.yaml too: the same on coarse grids, for a first try")
@click.option("--from", "recorded", multiple=True, metavar="FILE", type=click.Path(path_type=Path),
              help="write a first diagnosis of what this file recorded instead; may be repeated, a run each")
@options("debug")
def new(name, ask, quick, recorded):
    """Write NAME.yaml, a short commented case of a disc brake of your own, ready to run.

    With --from it is the diagnosis of a rig whose records these files are: channels, runs, a first model.
    """
    from pipeline.contract.store import write_companion

    if recorded and (ask or quick):
        raise click.UsageError("--from goes with neither --ask nor --quick, which are of a disc brake")
    file = name if name.suffix in (".yaml", ".yml") else name.with_name(f"{name.name}.yaml")
    files = [file, *([file.with_name(f"{file.stem}_quick.yaml")] if quick else [])]
    _refuse_taken(files)
    if recorded:
        from pipeline.cli.bench.new_rig import write

        write(file, recorded)
        return
    answers = {key: _answer(key) for key in ASKED} if ask else {}
    for each, written in zip(files, (text(file, answers), quick_text(file)), strict=False):
        write_companion(each, written)
    click.echo(f"{file}: write your values in it, then\n    brakechain run {files[-1]}")


def _refuse_taken(files):
    from pipeline.contract import ConfigError

    for file in files:
        if file.exists():
            raise ConfigError(file, "a name that is free", "a file", "choose another name, or delete it")
    if not files[0].parent.is_dir():
        raise ConfigError(files[0].parent, "a folder", "none", "make it first")


def _answer(key):
    """What the user states for a dotted setting; None where it stays typical."""
    from pipeline.contract.errors import ConfigError
    from pipeline.contract.units import to_si

    usual, meaning, unit = _known(key)
    while True:
        answer = click.prompt(f"{meaning} ({key.partition('.')[2]})", default=str(usual)).strip()
        try:
            if answer == str(usual) or to_si(answer, unit, key) > 0:
                return None if answer == str(usual) else answer
            click.echo(f"expected more than 0, found {answer!r}", err=True)
        except ConfigError as error:
            click.echo(str(error), err=True)


def _known(key):
    """(default as the program writes it, meaning, SI unit) of the setting 'stage.part.name'."""
    from pipeline.contract.settings import declared

    stage, _, steps = key.partition(".")
    return declared(stages.load(stage).settings, steps.split("."))


def text(file, answers):
    """The YAML of a new case for ``file``; ``answers`` {dotted setting: value or None} stand in it as the user's."""
    title = _title(file)
    lines = [f"# {title}: a disc brake of your own, from rough surfaces to the modes that squeal.",
             f"#   brakechain run {file.name}",
             "# Take away the # before a value and write yours, with its unit; {value: 7 mm, origin: measured,",
             "# source: drawing 4711} keeps where it is from. What stays behind a # is a typical value of the program.",
             "# The report lists first those that decide (\"Measure these\"). Others: brakechain schema own_brake",
             "", f"chain: {CHAIN}", f"title: {title}"]
    for stage, parts in YOURS.items():
        lines += ["", f"{stage}:{' ' * (37 - len(stage))}# {TITLES[stage]}"]
        for part, names in parts.items():
            lines += _part(f"{stage}.{part}".rstrip("."), names, answers)
    return "\n".join(lines) + "\n" + END


def quick_text(file):
    """The YAML of the case of ``file`` on coarse grids."""
    return QUICK.format(name=file.name, title=_title(file))


def _title(file):
    return file.stem.replace("_", " ")


def _part(key, names, answers):
    """Lines of one part of a section: what is given, then the values that are the user's to state."""
    _, nested, part = key.partition(".")
    indent = "    " if nested else "  "
    lines = [f"  {part}:"] if nested else []
    for name in names:
        usual, meaning, _ = _known(f"{key}.{name}")
        usual = f"[{', '.join(usual)}]" if isinstance(usual, tuple) else usual
        stated = answers.get(f"{key}.{name}")
        setting = indent + (f"{name}: {stated}" if stated else f"# {name}: {usual}")
        lines.append(f"{setting:<37} # {_END.split(meaning)[0]}")
    return lines + [_beside(indent + line) for line in GIVEN.get(key, ())]


def _beside(line):
    """A line with its remark where all remarks are."""
    setting, mark, remark = line.partition("  # ")
    return f"{setting:<37} # {remark}" if mark else line
