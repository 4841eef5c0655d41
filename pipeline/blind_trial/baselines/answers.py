"""Answers in the form of a diagnosis."""


def nothing():
    """Other values suffice."""
    return {"verdict": "parameters", "effects": [], "alternatives": []}


def named(ranked, count=1, shares=None):
    """The first ``count`` of Terms, best first, as what is missing; the next are alternatives.

    ``shares`` {Term: stated probability}, where there are any.
    """
    def told(term):
        posterior = {"posterior": float(shares[term])} if shares else {}
        return {"name": term.name, "place": term.place, "kind": term.kind, **posterior}

    candidates = list(ranked)
    sensor = all(term.kind == "sensor" for term in candidates[:count])
    return {"verdict": "sensor" if sensor else "missing", "effects": [told(t) for t in candidates[:count]],
            "alternatives": [told(t) for t in candidates[count:count + 3]]}
