"""The rules of the house, enforced: imports, doors, mirrored tests, one name for one thing."""

import ast
import re
from collections import Counter
from functools import cache
from graphlib import TopologicalSorter
from importlib import import_module
from pathlib import Path

import pytest

import stages
from pipeline import products
from pipeline.contract.product import is_product
from pipeline.views.pages.report import CHAPTERS, NO_CHAPTER

ROOT = Path(__file__).parents[1]
FILES = sorted([*ROOT.glob("pipeline/**/*.py"), *ROOT.glob("stages/**/*.py")])

#: layer -> layers of the house it may import
MAY_IMPORT = {
    "pipeline.environment": set(),
    "pipeline.sources": set(),
    "pipeline.contract": {"pipeline.contract", "pipeline.environment", "pipeline.sources"},
    "pipeline.products": {"pipeline.products", "pipeline.contract"},
    "pipeline.physics": {"pipeline.physics", "pipeline.contract.errors", "pipeline.environment", "pipeline.sources"},
    "pipeline.physics.fem.mesh_file": {"pipeline.physics", "pipeline.contract.errors",
                                       "pipeline.contract.received.process"},
    "pipeline.inference.priors": {"pipeline.contract.errors"},
    "pipeline.inference": {"pipeline.inference", "pipeline.physics", "pipeline.contract.errors",
                           "pipeline.environment"},
    "pipeline.effects": {"pipeline.effects", "pipeline.physics", "pipeline.inference.priors",
                         "pipeline.contract.errors"},
    "pipeline.systems": {"pipeline.systems", "pipeline.physics", "pipeline.decks.meshes", "pipeline.contract.errors"},
    "pipeline.systems.fem_bodies": {"pipeline.products", "pipeline.physics"},
    "pipeline.validation": {"pipeline.validation"},
    "pipeline.validation.published_facts": {"pipeline.contract"},
    "pipeline.recordings": {"pipeline.recordings", "pipeline.products", "pipeline.contract", "pipeline.environment"},
    "pipeline.recordings.registry": {"pipeline.contract"},
    "pipeline.decks": {"pipeline.decks", "pipeline.contract.received.process", "pipeline.contract.errors"},
    "pipeline.decks.meshes": {"pipeline.decks.meshes", "pipeline.physics", "pipeline.contract.errors",
                              "pipeline.contract.received"},
    "pipeline.case_models": {"pipeline.case_models", "pipeline.products", "pipeline.effects", "pipeline.physics",
                             "pipeline.inference.priors", "pipeline.contract"},
    "pipeline.case_models.bodies": {"pipeline.case_models.bodies", "pipeline.products", "pipeline.physics",
                                    "pipeline.systems", "pipeline.contract"},
    "pipeline.case_models.refinement": {"pipeline.case_models", "pipeline.systems", "pipeline.physics",
                                        "pipeline.contract"},
    "pipeline.case_models.lumped": {"pipeline.contract", "pipeline.systems"},
    "pipeline.diagnosis": {"pipeline.diagnosis", "pipeline.case_models", "pipeline.products", "pipeline.effects",
                           "pipeline.inference", "pipeline.physics", "pipeline.contract"},
    "pipeline.exports": {"pipeline.exports", "pipeline.contract", "pipeline.products", "pipeline.physics",
                         "pipeline.systems.fem_bodies", "pipeline.case_models"},
    "pipeline.blind_trial": set(),
    "pipeline.blind_trial.generators": {"pipeline.blind_trial.generators", "pipeline.contract.errors"},
    "pipeline.blind_trial.baselines": {"pipeline.blind_trial.baselines", "pipeline.recordings.neutral",
                                       "pipeline.products", "pipeline.contract"},
    "pipeline.blind_trial.metrics": {"pipeline.blind_trial.metrics", "pipeline.contract"},
    "pipeline.blind_trial.protocol": {"pipeline.blind_trial.protocol", "pipeline.blind_trial.metrics",
                                      "pipeline.blind_trial.baselines.BASELINES",
                                      "pipeline.blind_trial.generators.systems", "pipeline.effects",
                                      "pipeline.inference.rules", "pipeline.contract",
                                      "pipeline.environment"},
    "pipeline.views.chapters.bench.trial": {"pipeline.views", "pipeline.blind_trial.metrics.wording"},
    "pipeline.views.pages.trial": {"pipeline.views", "pipeline.contract", "pipeline.blind_trial.metrics.wording"},
    "pipeline.views": {"pipeline.views", "pipeline.products", "pipeline.contract", "pipeline.environment"},
    "stages": {"pipeline.contract", "pipeline.products", "pipeline.physics", "pipeline.systems", "pipeline.validation",
               "pipeline.views", "pipeline.recordings", "pipeline.decks", "pipeline.case_models", "pipeline.diagnosis"},
    "pipeline.cli": {"pipeline.contract"},
    "pipeline.cli.options": set(),
    "pipeline.cli.early_pages": {"pipeline.contract", "pipeline.case_models.early", "pipeline.views.pages.early"},
    "pipeline.cli.pace": {"pipeline.case_models.early", "pipeline.environment", "pipeline.physics.numerics.memory"},
    "pipeline.cli.facts": {"pipeline.cli", "pipeline.contract", "pipeline.products", "pipeline.views.pages.facts",
                           "pipeline.views.pages.modes", "pipeline.case_models.named_modes"},
    "pipeline.cli.compare": {"pipeline.cli", "pipeline.contract", "pipeline.products",
                             "pipeline.views.chapters.models.countermeasures"},
    "pipeline.cli.trial": {"pipeline.cli.options", "pipeline.blind_trial.protocol", "pipeline.contract",
                           "pipeline.blind_trial.metrics.summary",
                           "pipeline.blind_trial.generators.systems.SYSTEMS", "pipeline.views.pages.trial"},
    "pipeline.cli.export": {"pipeline.cli.options", "pipeline.contract", "pipeline.products", "pipeline.recordings"},
    "pipeline.cli.run_export": {"pipeline.cli.options", "pipeline.exports", "pipeline.contract",
                                "pipeline.physics.numerics.sparse_solver"},
    "pipeline.cli.new_case": {"pipeline.cli.options", "pipeline.cli.bench.new_rig", "pipeline.contract", "stages"},
    "pipeline.cli.bench.check": {"pipeline.cli.options", "pipeline.contract", "pipeline.recordings.registry",
                                 "pipeline.case_models", "pipeline.diagnosis", "stages"},
    "pipeline.cli.bench.data": {"pipeline.cli", "pipeline.contract", "pipeline.recordings"},
    "pipeline.cli.bench.catalogue": {"pipeline.cli.options", "pipeline.contract", "pipeline.case_models"},
    "pipeline.cli.bench.new_rig": {"pipeline.cli.bench", "pipeline.contract"},
    "pipeline.cli.bench.rig": {"pipeline.contract", "pipeline.recordings.survey"},
    "pipeline.cli.bench.rig_text": {"pipeline.cli.bench", "pipeline.contract"},
    "pipeline.cli.first_use": {"pipeline.cli.options", "pipeline.cli.new_case", "pipeline.contract", "stages",
                               "pipeline.physics.numerics.sparse_solver"},
    "pipeline.cli.surface_fit": {"pipeline.case_models.rough", "pipeline.contract", "pipeline.recordings"},
    "pipeline.cli.main": {"pipeline.cli", "pipeline.contract", "pipeline.recordings", "stages",
                          "pipeline.physics.numerics.sparse_solver", "pipeline.physics.numerics.memory",
                          "pipeline.case_models", "pipeline.diagnosis.campaign_planning"},
    "pipeline.__main__": {"pipeline.cli.main", "pipeline.environment"},
}
#: third-party package -> its doors
DOORS = {
    "h5py": {"pipeline.contract.store", "pipeline.contract.received.hdf5", "pipeline.cli.inspect",
             "pipeline.recordings.columns", "pipeline.recordings.neutral",
             "pipeline.blind_trial.generators.case_files"},
    "pyuff": {"pipeline.recordings.uff"}, "pythonfmu": {"pipeline.exports.fmu", "pipeline.exports.fmu_slave"},
    "soundfile": {"pipeline.recordings.audio"},
    "nptdms": {"pipeline.recordings.tdms"}, "asammdf": {"pipeline.recordings.mdf"},
    "yaml": {"pipeline.contract.documents", "pipeline.contract.received.yaml_limits",
             "pipeline.blind_trial.generators.case_files"},
    "click": {"pipeline.cli.bench.catalogue", "pipeline.cli.bench.check", "pipeline.cli.bench.data",
              "pipeline.cli.bench.new_rig",
              "pipeline.cli.compare", "pipeline.cli.export", "pipeline.cli.facts", "pipeline.cli.first_use",
              "pipeline.cli.main", "pipeline.cli.new_case", "pipeline.cli.options", "pipeline.cli.run_export",
              "pipeline.cli.surface_fit", "pipeline.cli.trial"},
    "rich": {"pipeline.cli.console"},
    "cryptography": {"pipeline.blind_trial.protocol.sealing"}, "pint": {"pipeline.contract.units"},
    "pydantic_core": {"pipeline.cli.main"},
    "pydantic": {"pipeline.contract.settings", "pipeline.validation.published_facts", "pipeline.recordings.registry"},
    "pooch": {"pipeline.recordings.registry"}, "distributed": {"pipeline.contract.executors.cluster"},
    "skfem": {"pipeline.physics.fem.reference_cells", "pipeline.physics.fem.face_averages",
              "pipeline.physics.rough.layer_element"},
    "meshio": {"pipeline.physics.fem.mesh_file"},
    "exudyn": {"pipeline.physics.pads.exudyn_model", "pipeline.physics.sliding_motion.exudyn_motion"},
    "pypardiso": {"pipeline.physics.numerics.sparse_solver"},
    "SurfaceTopography": {"pipeline.physics.rough.topography"},
    "numba": {"pipeline.physics.numerics.compiled", "pipeline.physics.numerics.compiled_cache",
              "pipeline.blind_trial.generators.benches.pin_bench"},
    "pyvista": {"pipeline.views"}, "matplotlib": {"pipeline.views"}, "jinja2": {"pipeline.views"},
}
#: packages that must not be loaded before they are needed
HEAVY = {"skfem", "meshio", "exudyn", "pypardiso", "SurfaceTopography", "pyvista", "matplotlib", "distributed", "pooch",
         "pint"}
#: SciPy loads its packages when they are first used; 'from scipy.signal import x' loads them at once
EAGER = re.compile(r"scipy\.")


#: packages whose files all have a test of their own
MIRRORED = ("stages", "pipeline/physics", "pipeline/systems", "pipeline/recordings", "pipeline/decks",
            "pipeline/inference", "pipeline/effects", "pipeline/case_models", "pipeline/diagnosis",
            "pipeline/exports", "pipeline/blind_trial")
#: formulas without code of their own, tested where they serve as the reference
REFERENCES = "pipeline/physics/closed_form"
MOST_FILES = 16
#: compiled kernels, one loop each: a call per step costs more than the step
LONG = {"pipeline.physics.time_stepping.step_loop.integrate"}


@cache
def dotted(path):
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
    return name.removesuffix(".__init__")


@cache
def tree(path):
    return ast.parse(path.read_text())


def imports(nodes):
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "write absolute imports"
            for alias in node.names:
                yield f"{node.module}.{alias.name}"


@cache
def everywhere(path):
    return tuple(imports(ast.walk(tree(path))))


@cache
def holders(name):
    """A dotted name and the packages that it is in, from the inside out."""
    parts = name.split(".")
    return tuple(".".join(parts[:k]) for k in range(len(parts), 0, -1))


def within(name, allowed):
    return any(holder in allowed for holder in holders(name))


def innermost(name, known):
    """The longest of the ``known`` names that a name is within, None where it is in none."""
    return next((holder for holder in holders(name) if holder in known), None)


def layer_of(path):
    return innermost(dotted(path), MAY_IMPORT)


def test_imports_point_inwards():
    offenders = []
    for path in FILES:
        layer = layer_of(path)
        if dotted(path) in ("pipeline", "stages"):
            continue
        if layer is None:
            offenders.append(f"{dotted(path)}: not in MAY_IMPORT")
            continue
        own = [n for n in everywhere(path) if within(n, {"pipeline", "stages"}) and n != "pipeline.__version__"]
        offenders += [f"{dotted(path)} ({layer}) may not import {n}" for n in own if not within(n, MAY_IMPORT[layer])]
    assert not offenders


def test_contributing_states_what_each_package_may_import():
    """The list below the layout tree is MAY_IMPORT by package, with the names that the text above the list gives."""
    layout = (ROOT / "CONTRIBUTING.md").read_text().partition("## Imports")[2].partition("`tests/")[0]
    rows = re.findall(r"^    (\w+) +(.*)$", layout, re.MULTILINE)
    stated = {name: set(allowed.split(", ")) for name, allowed in rows}
    enforced = {}
    for layer, allowed in MAY_IMPORT.items():
        package = layer.removeprefix("pipeline.").split(".")[0]
        enforced.setdefault(package, set()).update(name.removeprefix("pipeline.") for name in allowed)
    short = {"contract.errors": "errors", "contract.received.process": "process", "inference.priors": "priors"}
    for package, names in enforced.items():
        heads = {name.split(".")[0] for name in names if name not in short}
        special = {short[name] for name in names & set(short) if name.split(".")[0] not in heads | {package}}
        enforced[package] = (heads | special) - {package}
    assert stated == {k: v for k, v in enforced.items() if v and k != "__main__"}


def test_no_import_circle():
    names = {dotted(path) for path in FILES}
    graph = {dotted(path): {innermost(n, names) for n in everywhere(path)} - {None, dotted(path)} for path in FILES}
    list(TopologicalSorter(graph).static_order())       # CycleError names the circle


def test_third_party_packages_enter_by_their_doors():
    anywhere = {"pipeline", "stages"}
    assert not [f"{dotted(path)} may not import {name}: see DOORS" for path in FILES for name in everywhere(path)
                if not within(dotted(path), DOORS.get(name.split(".")[0], anywhere))]


def test_heavy_packages_load_when_needed():
    assert not [f"{dotted(path)}: import {name} where it is used" for path in FILES
                for name in imports(tree(path).body) if name.split(".")[0] in HEAVY
                or (EAGER.match(name) and not within(dotted(path), {"pipeline.blind_trial"}))]


def test_every_module_has_a_docstring():
    assert not [dotted(path) for path in FILES if not ast.get_docstring(tree(path))]


def test_every_file_has_its_test():
    missing = []
    for path in (p for folder in MIRRORED for p in (ROOT / folder).rglob("*.py") if p.stem != "__init__"):
        parts = path.relative_to(ROOT).parts
        mirror = ROOT.joinpath("tests", *parts[parts[0] == "pipeline":-1], f"test_{path.stem}.py")
        if not mirror.exists() and not path.is_relative_to(ROOT / REFERENCES):
            missing.append(f"{path.relative_to(ROOT)} has no {mirror.relative_to(ROOT)}")
    assert not missing


def test_every_test_mirrors_a_package():
    tests = {path.parent.relative_to(ROOT / "tests") for package in MIRRORED[1:]
             for path in (ROOT / package.replace("pipeline", "tests")).rglob("*.py")}
    assert not [str(folder) for folder in tests if not (ROOT / "pipeline" / folder).is_dir()]


def test_no_folder_holds_more_than_a_reader_can_survey():
    sizes = Counter(path.parent.relative_to(ROOT).as_posix() for path in FILES if path.parts[-2] != "stages")
    assert not {folder: n for folder, n in sizes.items() if n > MOST_FILES}


def test_modules_and_functions_stay_short():
    """Modules mostly below 200 lines, functions mostly below 25."""
    modules = {dotted(path): len(path.read_text().splitlines()) for path in FILES}
    functions = {f"{dotted(path)}.{node.name}": node.end_lineno - node.lineno + 1 for path in FILES
                 for node in ast.walk(tree(path)) if isinstance(node, ast.FunctionDef)}
    for sizes, usual, most in ((modules, 200, 400), (functions, 25, 80)):
        assert not {name: n for name, n in sizes.items() if n > most and name not in LONG}
        assert sum(n > usual for n in sizes.values()) < len(sizes) / 8


@pytest.mark.parametrize("name", stages.NAMES)
def test_one_name_for_one_thing(name):
    stage = stages.load(name)
    assert stage.name == stage.output.name == name and stages.summary(name) == stage.summary
    assert stage.method.format(**dict(stage.settings())), "the method sentence fits the settings"


@pytest.mark.parametrize("chain", stages.CHAINS)
def test_a_chain_reads_only_what_was_written_before(chain):
    seen = set()
    for stage in map(stages.load, stages.CHAINS[chain]):
        for argument, options in stage.inputs.items():
            assert argument in stage.optional or {p.name for p in options} & seen, f"{stage.name}.{argument}"
        assert stage.output.name not in seen
        seen.add(stage.output.name)


def test_every_stage_file_stands_in_a_chain_and_has_a_make_target():
    assert {p.stem for p in ROOT.glob("stages/*.py")} - {"__init__"} == set(stages.NAMES)
    listed = re.search(r"^STAGES := (.*)$", (ROOT / "Makefile").read_text(), re.MULTILINE)[1].split()
    assert listed == list(stages.NAMES)


def test_every_stage_has_a_chapter_of_the_report():
    """A new stage needs a chapter; one whose product is shown elsewhere on the page says where, in NO_CHAPTER."""
    missing = [name for name in stages.NAMES if name not in {**CHAPTERS, **NO_CHAPTER}]
    assert not missing, f"no chapter in pipeline/views/pages/report.py: {', '.join(missing)}"
    assert set(CHAPTERS).isdisjoint(NO_CHAPTER) and {*CHAPTERS, *NO_CHAPTER} <= set(stages.NAMES)


def test_every_product_says_what_it_is():
    for cls in filter(is_product, vars(products).values()):
        assert cls.__doc__ and not cls.__doc__.startswith(f"{cls.__name__}("), f"{cls.__name__} has no docstring"


def test_every_product_is_exported():
    for path in ROOT.glob("pipeline/products/*.py"):
        for cls in filter(is_product, vars(import_module(dotted(path))).values()):
            assert getattr(products, cls.__name__, None) is cls, f"{cls.__name__}: not in pipeline/products/__init__.py"


def test_no_measured_bytes_are_part_of_the_project():
    allowed = {".py", ".yaml", ".json", ".md", ".toml", ".j2", ".lock", ".png", ".svg", ""}
    folders = ("configs", "data/reference", "data/measured", "tests")
    files = [p for folder in folders for p in (ROOT / folder).rglob("*") if p.is_file()]
    foreign = [p for p in files if p.suffix not in allowed and "__pycache__" not in p.parts]
    assert not foreign
