"""'make paper_micro': friction, real area and wear of the 2021 paper beside ours, over several pairs of surfaces.

The rough pair of configs/disc_brake.yaml is generated anew from further seeds, on a patch of the size asked for, and
taken through the paper's study: three pressures, three speeds, 200 cycles. Every number is that of the mean over the
pairs, with the standard error that the numbers of the single pairs give. Patch, modulus, hardness and third-body factor
may be given, so that a search over them shows what the paper's numbers decide.
"""

import argparse
from dataclasses import fields, replace
from functools import partial

import numpy as np
import yaml

from pipeline.contract.settings import fill, without_origins
from pipeline.validation.friction import friction_rows
from pipeline.validation.published_facts import load
from stages.comparison import SIZE, bounds, known_values
from stages.micro_friction import Settings as MicroSettings
from stages.micro_friction import micro_friction
from stages.surface import Settings as SurfaceSettings
from stages.surface import surface
from tests.studies.forced import ROOT, shared_out

CASE, FACTS = ROOT / "configs" / "disc_brake.yaml", ROOT / "data" / "reference" / "disc_brake.yaml"
#: the paper's points; nodes per mm of the patch
PRESSURES, SPEEDS, DENSITY = ["1 MPa", "2 MPa", "3 MPa"], ["8.5 rad/s", "10.25 rad/s", "12 rad/s"], 128


def sections(patch, **changes):
    """(section surface, section micro_friction) of the default case on a ``patch`` in mm, at the paper's points.

    ``changes``: of micro_friction, those of a body as {"pad": {...}}.
    """
    case = without_origins(yaml.safe_load(CASE.read_text(encoding="utf-8")), "case")
    points = {"pressures": PRESSURES, "disc_speeds": SPEEDS, "realisations": 1, "refinement": [1]}
    micro = case["micro_friction"] | points
    for key, value in changes.items():
        micro[key] = micro[key] | value if isinstance(value, dict) else value
    return case["surface"] | {"patch_length": f"{patch} mm", "nodes": round(DENSITY * patch), "pairs": 1}, micro


def computed(asked, seed):
    """MicroFriction of the pair of this ``seed``; 0 is that of the case. ``asked`` as of ``sections``."""
    return slid(*sections(**asked), seed)


def slid(rough, micro, seed):
    """The same of a section surface and a section micro_friction."""
    for body in ("disc", "pad"):
        rough[body] = rough[body] | {"seed": rough[body]["seed"] + 2 * seed}
    made = surface(settings=fill(SurfaceSettings, rough, "surface"))
    return micro_friction(made, settings=fill(MicroSettings, micro, "micro_friction"))


def averaged(products):
    """MicroFriction of the mean figures over several pairs, each a MicroFriction of one."""
    means = {field.name: np.mean([getattr(p, field.name) for p in products], axis=0) for field in fields(products[0])
             if field.metadata["dims"] == ("pressure", "speed", "distance")}
    return replace(products[0], **means)


def rows(products, facts):
    """[(Published, ours, standard error)] in the units printed, of the facts that the pairs give."""
    known = known_values(facts)
    mean, each = friction_rows(averaged(products), known), [friction_rows(p, known) for p in products]
    told = []
    for fact in facts:
        if fact.key not in mean or mean[fact.key].value is None or not fact.comparable or fact.role == "input":
            continue
        spread = np.std([row[fact.key].value for row in each], ddof=1) if len(each) > 1 else np.nan
        told.append((fact, mean[fact.key].value / SIZE[fact.unit], spread / np.sqrt(len(each)) / SIZE[fact.unit]))
    return told


def table(told):
    """Lines: quantity, the paper's value, ours with its error, the tolerance or bound, whether it is met."""
    lines = [f"{'':<72} {'paper':>8} {'ours':>18} {'tolerance':>12}"]
    for fact, value, error in told:
        paper = "" if fact.value is None else f"{fact.value:g}"
        allowed = bounds(fact) if fact.tolerance is None else f"{fact.tolerance:g}"
        lines.append(f"{fact.quantity[:66]:<66} {'' if fact.unit == '1' else fact.unit:<5} {paper:>8}"
                     f" {value:>8.3g} +- {error:<6.2g} {allowed:>12} {'met' if fact.met_by(value) else 'missed'}")
    return lines


def largest_wear_bound(products):
    """(wear of one node after all cycles over that after the first, the number of cycles, largest over the pairs)."""
    first, last = (np.array([p.largest_wear[..., k].max() for p in products]) for k in (1, -1))
    cycles = products[0].distance[-1] / products[0].distance[1]
    return float((last / first).max()), float(cycles)


def main():
    """Compute the pairs, print the table."""
    parser = argparse.ArgumentParser(prog="make paper_micro", description=__doc__)
    parser.add_argument("--patch", type=float, default=2.0, help="edge of the patch in mm")
    parser.add_argument("--pairs", type=int, default=4, help="pairs of surfaces")
    parser.add_argument("--young", help="Young's modulus of the pad's asperities, e.g. '0.27 GPa'")
    parser.add_argument("--hardness", help="hardness of the pad, e.g. '40 MPa'")
    parser.add_argument("--third-body", type=float, help="third-body factor")
    parser.add_argument("--workers", type=int, default=2, help="processes")
    chosen = parser.parse_args()
    pad = {name: value for name, value in (("youngs_modulus", chosen.young), ("hardness", chosen.hardness)) if value}
    asked = {"patch": chosen.patch} | ({"pad": pad} if pad else {})
    if chosen.third_body:
        asked["third_body_factor"] = chosen.third_body
    products = shared_out(partial(computed, asked), list(range(chosen.pairs)), chosen.workers)
    print("\n".join(table(rows(products, load(FACTS)))))
    ratio, cycles = largest_wear_bound(products)
    print(f"largest wear of a node at the end over that at the first recorded distance: {ratio:.3g}, of at most"
          f" {cycles:g} times the largest pressure then over the largest new one")


if __name__ == "__main__":
    main()
