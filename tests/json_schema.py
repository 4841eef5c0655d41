"""The part of JSON Schema (draft 2020-12) that 'brakechain schema' uses; a keyword unknown here is an error."""

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None), "integer": int,
         "number": (int, float)}
#: keywords that tell, but refuse nothing
TOLD = {"$schema", "$defs", "title", "description", "default", "examples", "x-unit", "discriminator"}
BOUNDS = {"minimum": lambda v, b: v >= b, "maximum": lambda v, b: v <= b, "exclusiveMinimum": lambda v, b: v > b,
          "exclusiveMaximum": lambda v, b: v < b, "multipleOf": lambda v, b: v % b == 0}
LENGTHS = {"minItems": (list, False), "minLength": (str, False), "maxItems": (list, True),
           "minProperties": (dict, False), "maxProperties": (dict, True)}


def faults(value, schema, root, where="case"):
    """Sentences, one per fault of ``value``, a document of plain Python values; ``root`` holds the definitions."""
    found = []
    for keyword, rule in schema.items():
        if keyword not in TOLD:
            found += _faults(keyword, value, rule, schema, root, where)
    return found


def _faults(keyword, value, rule, schema, root, where):
    match keyword:
        case "$ref":
            return faults(value, root["$defs"][rule.removeprefix("#/$defs/")], root, where)
        case "anyOf" | "oneOf":
            return _alternatives(keyword, value, rule, root, where)
        case "properties" if isinstance(value, dict):
            known = sorted(value.keys() & rule)
            return [f for key in known for f in faults(value[key], rule[key], root, f"{where}.{key}")]
        case "additionalProperties" if isinstance(value, dict):
            return _others(value, rule, schema, root, where)
        case "items" if isinstance(value, list):
            return [f for i, item in enumerate(value) for f in faults(item, rule, root, f"{where}.{i}")]
        case "prefixItems" if isinstance(value, list):
            return [f for i, (item, one) in enumerate(zip(value, rule, strict=False))
                    for f in faults(item, one, root, f"{where}.{i}")]
        case "properties" | "additionalProperties" | "items" | "prefixItems":
            return []
    return [] if _holds(keyword, value, rule) else [f"{where}: {keyword} {rule}, found {value!r}"]


def _alternatives(keyword, value, rule, root, where):
    tried = [faults(value, option, root, where) for option in rule]
    fitting = sum(not faults_ for faults_ in tried)
    if fitting == 1 or (fitting and keyword == "anyOf"):
        return []
    return min(tried, key=len) if not fitting else [f"{where}: fits {fitting} alternatives, not one"]


def _others(value, rule, schema, root, where):
    others = sorted(value.keys() - schema.get("properties", {}))
    if rule is False:
        return [f"{where}.{key}: unknown key" for key in others]
    return [f for key in others for f in faults(value[key], rule, root, f"{where}.{key}")]


def _holds(keyword, value, rule):
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if keyword == "type":
        return any(_is(value, name) for name in ([rule] if isinstance(rule, str) else rule))
    if keyword == "required":
        return not isinstance(value, dict) or set(rule) <= value.keys()
    if keyword in BOUNDS:
        return not number or BOUNDS[keyword](value, rule)
    if keyword in LENGTHS:
        kind, most = LENGTHS[keyword]
        return not isinstance(value, kind) or (len(value) <= rule if most else len(value) >= rule)
    return {"enum": lambda: value in rule, "const": lambda: value == rule}[keyword]()


def _is(value, name):
    return isinstance(value, TYPES[name]) and (name == "boolean" or not isinstance(value, bool))
