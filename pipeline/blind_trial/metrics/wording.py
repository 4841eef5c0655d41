"""Names of rates: as result.json keeps them, so that published records stay comparable, and in words."""

#: name of a rate in the record -> in words
_RATES = {"type and place, one effect": "single effect: type and location correct",
          "type and place, one effect, forced": "single effect, forced rigs",
          "type and place, one effect, self-excited": "single effect, self-excited rigs",
          "type alone, one effect": "single effect: type correct",
          "truth among the tied, one effect": "single effect: truth among tied answers",
          "truth among the first three, one effect": "single effect: truth among the first three",
          "both of a pair": "pair of effects: both correct",
          "nothing missing told so": "controls: nothing missing, and reported so",
          "sensor: which and where": "sensor faults: type and channel correct",
          "below the threshold: nothing wrong named": "below the threshold: no wrong effect named",
          "not in the catalogue: unknown": "outside the catalogue: reported as unknown",
          "sensor and solver called so": "sensor faults and solver errors classified correctly",
          "held out within 1.2 noise floors, named": "named effects: held-out error within 1.2 noise floors",
          "stated with about 90 %: right": "calibration: correct among answers stated at about 90 %"}


def rate_in_words(name):
    """The name of a rate as a reader sees it."""
    return _RATES.get(name, name)
