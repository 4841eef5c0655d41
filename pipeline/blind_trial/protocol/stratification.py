"""Which cases a set has: shares of classes, shared out over systems, effects, sizes and noise in random blocks."""

from pipeline.blind_trial.generators.systems import Draw
from pipeline.contract.errors import ConfigError

#: share of each class: 130 controls show less than 3 % false alarms at best, 320 cases have 134
SHARES = {"control": 0.42, "effect": 0.26, "foreign": 0.15, "pair": 0.05, "sensor": 0.04, "below": 0.04,
          "wrong_value": 0.02, "solver": 0.02}


def drawn(count, systems, random, shares=SHARES):
    """[Draw] of ``count`` cases in random order, seeds 0; classes that no system makes are left out.

    systems : {name: System}; random : numpy Generator.
    """
    makers = {kind: [s for s in systems.values() if kind in s.hides] for kind in shares}
    possible = {kind: share for kind, share in shares.items() if makers[kind]}
    if count < len(possible):
        raise ConfigError("--cases", f"at least one of each of the {len(possible)} classes", str(count))
    draws = []
    for kind, many in shared_out(count, possible).items():
        for name, own in shared_out(many, {s.name: s.weight for s in makers[kind]}).items():
            draws += _stratified(own, systems[name], kind, random)
    return [draws[k] for k in random.permutation(len(draws))]


def shared_out(count, weights):
    """{key: whole number} by the largest remainders, of sum ``count``, at least 1 of each where there are enough."""
    least = 1 if count >= len(weights) else 0
    rest, total = count - least * len(weights), sum(weights.values())
    exact = {key: max(count * weight / total - least, 0.0) for key, weight in weights.items()}
    exact = {key: rest * part / (sum(exact.values()) or 1) for key, part in exact.items()}
    counts = {key: least + int(part) for key, part in exact.items()}
    for key in sorted(exact, key=lambda k: int(exact[k]) - exact[k])[:count - sum(counts.values())]:
        counts[key] += 1
    return counts


def _stratified(count, system, kind, random):
    """Draws of one class and system: what is hidden, sizes and noises each in blocks of random order."""
    hidden, sizes, noises = (_blocks(count, options, random) for options in (
        system.hides[kind], system.sizes, system.noises))
    nothing = all(not group for group in system.hides[kind])
    return [Draw(0, system.name, kind, h, 0.0 if nothing else s, n) for h, s, n in zip(
        hidden, sizes, noises, strict=True)]


def _blocks(count, options, random):
    """``count`` of the options: each once in random order, then each again."""
    sequence = []
    while len(sequence) < count:
        sequence += [options[k] for k in random.permutation(len(options))]
    return sequence[:count]
