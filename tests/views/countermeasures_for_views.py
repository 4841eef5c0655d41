"""A small synthetic product Countermeasures: one variant that helps, one that makes another mode worse."""

import numpy as np

from pipeline.products import Countermeasures


def countermeasures(draws=100, variants=("shim", "shorter_lining")):
    """Two operating points with two unstable modes each; without ``draws`` no probabilities."""
    before = np.array([120 + 50.3e3j, 40 + 22e3j] * 2)
    after = {"shim": [-15 + 50.2e3j, 20 + 22e3j] * 2, "shorter_lining": [90 + 52e3j, 41 + 22.1e3j] * 2}
    state = {"shim": ["gone", "weaker"] * 2, "shorter_lining": ["weaker", "unchanged"] * 2}
    count, points, rows = len(variants), 2 if draws else 0, []
    for k, name in enumerate(variants):
        rows += [(k, m // 2, before[m], 1, after[name][m], 1, 0.97, 0.0, 1, state[name][m]) for m in range(4)]
        if name == "shorter_lining":
            rows += [(k, 1, 0, 0, 75 + 31e3j, 1, 0.2, 0.0, 0, "new"),
                     (k, 1, 10 + 9e3j, 1, -2 + 9.2e3j, 1, 0.5, 0.45, 0, "ambiguous")]
    columns = list(zip(*rows, strict=True)) or [[]] * 10
    share, ends = np.array([0.4, 0.8])[:points], np.array([-0.08, 0.08])
    fewer = np.array([-0.3, 0.02])[:count]
    mode = dict(zip(("mode_variant", "mode_operating", "before", "before_known", "after", "after_known", "mac",
                     "rival_mac", "clear", "state"), map(list, columns), strict=True))
    mode |= {name: np.array(mode[name], complex) for name in ("before", "after")}
    drawn = bool(draws)
    octaves = 1e3 * 10 ** (np.array([8, 9, 10]) / 10 if draws else np.empty(0))
    band = np.array([0.0, 0.8, 0.1])[:len(octaves)]
    band_change = np.array([[0.0, -0.3, 0.0], [0.0, 0.0, 0.2]])[:count, :len(octaves)]
    return Countermeasures(
        variant=list(variants),
        change=["structure.pad.backplate_loss_factor: 0.1", "structure.pad.angle: 44 deg"][:count],
        note=["shims on both pads", ""][:count], cost_name=["mass", "price"], cost_unit=["kg", ""],
        cost=np.array([[0.1, 2.0], [-0.05, 0.0]])[:count], cost_known=np.array([[1, 1], [1, 0]])[:count],
        pressure=[1e6, 3e6], speed=[8.5, 12.0], **mode, error=np.full(len(rows), 10.0),
        sampled_pressure=[1e6, 3e6][:points], sampled_speed=[8.5, 12.0][:points], draws=draws,
        variant_draws=[draws] * count, paired=[int(drawn)] * count, probability=share, interval=share[:, None] + ends,
        variant_probability=share + fewer[:, None], variant_interval=(share + fewer[:, None])[..., None] + ends,
        probability_change=np.broadcast_to(fewer[:, None], (count, points)),
        change_interval=np.broadcast_to(fewer[:, None, None] + ends, (count, points, 2)),
        overall=0.85 * drawn, overall_interval=(0.85 + ends) * drawn, variant_overall=(0.85 + fewer) * drawn,
        variant_overall_interval=(0.85 + fewer[:, None] + ends) * drawn, overall_change=fewer * drawn,
        overall_change_interval=(fewer[:, None] + ends) * drawn, squeal_from=1e3, band=octaves, band_probability=band,
        variant_band_probability=band + band_change, band_change_interval=band_change[..., None] + ends)
